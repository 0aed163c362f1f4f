"""Lines of direct current with constant and with braking trains."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tpss.powerflow.assembly import BranchPart, SectionPart, assemble
from tpss.powerflow.network import Loads, loads_alone
from tpss.powerflow.system import system
from tpss.sources.kinds import Source, SourceKind
from tpss.sources.rectifier import MOST_POINTS, RectifierLaw
from tpss.storage.wayside import StoreLaw
from tpss.vehicle.regeneration import Regeneration
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

from line_cases import Case, place

BASE_W = {600.0: 1e6, 750.0: 1e6, 1500.0: 3e6, 3000.0: 5e6}


class Braking(NamedTuple):
    """A train that offers a power, of which the line takes all up to one voltage, none from another."""

    km: float
    offered_w: float
    whole_v: float
    none_v: float
    auxiliary_w: float


class Drawing(NamedTuple):
    """A train that draws the same power at any voltage."""

    km: float
    power_w: float


def diode(u0_v: float, r_ohm: float, **inverter: float) -> dict[str, Any]:
    """Parameters of a `RectifierLaw` with a straight characteristic."""
    return curve([0.0, 0.9 * u0_v / r_ohm], [u0_v, 0.1 * u0_v], **inverter)


def curve(current_a: Sequence[float], voltage_v: Sequence[float], **more: float) -> dict[str, Any]:
    """Parameters of a `RectifierLaw` through points."""
    unused = [0.0] * (MOST_POINTS - len(current_a))
    return {
        "points": len(current_a),
        "current_a": (*current_a, *unused),
        "voltage_v": (*voltage_v, *unused),
        **more,
    }


def rectifiers(laws: Sequence[Mapping[str, Any]]) -> Any:
    """Sources at nodes 0, 1, ..., one of each law."""
    return Source.array(
        [
            Source.row(
                node=node, kind=SourceKind.RECTIFIER, installed=1, controlled=False, rating_va=1e6,
                rectifier=RectifierLaw.row(**law),
            )
            for node, law in enumerate(laws)
        ]
    )  # fmt: skip


def direct_line(
    nominal_v: float, ohm_per_km: float, stations: Sequence[tuple[float, Mapping[str, Any]]],
    trains: Sequence[Braking | Drawing], stores: Sequence[tuple[float, Mapping[str, Any]]] = (),
) -> Case:  # fmt: skip
    """A line of which every train lies between its ends, ready to be solved; stores by their fields."""
    ends = [min(train.km for train in trains) - 1.0, max(train.km for train in trains) + 1.0]
    places = [km for km, _ in stations]
    nodes = {km: node for node, km in enumerate(places)}
    for km, _ in stores:
        nodes.setdefault(km, len(nodes))
    for end in ends:
        if not min(places) <= end <= max(places):
            nodes.setdefault(end, len(nodes))
    ordered = sorted(nodes)
    impedance = complex(ohm_per_km / 1e3, 0.0)
    sections = [
        SectionPart(nodes[one], nodes[other], one * 1e3, other * 1e3, impedance, 0.0)
        for one, other in zip(ordered, ordered[1:], strict=False)
    ]
    own = system(nominal_v, nominal_v, BASE_W[nominal_v], 0.0, 0.5, 1.35)
    no_branches: list[BranchPart] = []
    network = assemble(
        len(nodes), sections, no_branches, rectifiers([law for _, law in stations]), own,
        stores=StoreLaw.array(StoreLaw.row(node=nodes[km], **law) for km, law in stores),
    )  # fmt: skip
    return place(network, loads_of(trains))


def loads_of(trains: Sequence[Braking | Drawing]) -> Loads:
    """Trains of all kinds along one line."""
    types, records = TrainType.blank(len(trains)), Train.blank(len(trains))
    types.inertia_kg, types.slip_factor = 1.0, 1.0
    records.train_type = np.arange(len(trains))
    records.motion.position_m = [1e3 * train.km for train in trains]
    records.demand.per_efficiency = 1.0
    for k, train in enumerate(trains):
        if isinstance(train, Drawing):
            types.auxiliary_power_w[k] = train.power_w
            continue
        types.auxiliary_power_w[k] = train.auxiliary_w
        types[k].regeneration = Regeneration.array(
            [Regeneration.row(
                highest_force_n=1.0, highest_power_w=train.offered_w, none_up_to_m_s=0.0,
                whole_from_m_s=1.0, reactive_ratio=0.0, whole_up_to_v=train.whole_v,
                none_from_v=train.none_v, rounded_v=0.0,
            )]
        )[0]  # fmt: skip
        records[k].demand.offered_power_w = train.offered_w
    return loads_alone(records, types)
