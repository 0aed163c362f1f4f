"""Small supply networks with constant loads, for tests of the load flow."""

import math

import numpy as np
from scipy.optimize import fsolve

from tpss.powerflow.assembly import BranchPart, SectionPart, assemble
from tpss.powerflow.network import Loads, Network, loads_alone
from tpss.powerflow.system import system
from tpss.record import Records
from tpss.sources.converter import ConverterLaw, terminal_voltage
from tpss.sources.kinds import Source, SourceKind
from tpss.track.leg import Leg
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

from continuation import admittance_matrix
from line_cases import Case, place

SYSTEM = system(15e3, 16.5e3, 10e6, 16.7, 0.5, 1.2)
"""15 kV, 16.7 Hz, with the base quantities of the thesis."""

BT = complex(0.21, 0.20) * 1e-3
STIFF = {
    "no_load_voltage_v": 16_500.0,
    "installed": 1,
    "motor_voltage_v": 16_500.0,
    "rating_va": 10e6,
}
ROTARY = {
    **STIFF,
    "droop_v_per_var": 50e-6,
    "generator_reactance_ohm": 0.53 * 16.5**2 / 10,
    "motor_reactance_ohm": 0.49 * 16.5**2 / 10.7,
}


def network_of(
    n_nodes: int, sections: list[tuple], branches: list[tuple], sources: Records[Source]
) -> Network:
    """Network of the 15 kV system from plain tuples."""
    return assemble(
        n_nodes,
        [SectionPart(*each) for each in sections],
        [BranchPart(*each) for each in branches],
        sources,
        SYSTEM,
    )


def sources(*kinds: tuple[int, dict[str, float]]) -> Records[Source]:
    """Converter stations from pairs of node and parameters; what is not given is 0."""
    rows = []
    for node, given in kinds:
        law = {name: given.get(name, 0.0) for name in ConverterLaw.dtype.names}
        rows.append(
            Source.row(
                node=node,
                kind=SourceKind.CONVERTER,
                installed=given["installed"],
                controlled=False,
                rating_va=given["rating_va"],
                converter=ConverterLaw.row(**law),
            )
        )
    return Source.array(rows)


def constant_loads(positions_m: list[float], powers_va: list[complex]) -> Loads:
    """Trains that draw the same power at any voltage."""
    types = TrainType.blank(len(powers_va))
    types.inertia_kg, types.slip_factor = 1.0, 1.0
    types.auxiliary_power_w = np.real(powers_va)
    types.auxiliary_reactive_power_var = np.imag(powers_va)
    trains = Train.blank(len(powers_va))
    trains.train_type = np.arange(len(powers_va))
    trains.motion.position_m = positions_m
    trains.demand.per_efficiency = 1.0
    return loads_alone(trains, types)


def simple_line(
    length_m: float, positions_m: list[float], powers_va: list[complex], *ends: dict[str, float],
    impedance: complex = BT, susceptance: float = 0.0,
) -> Case:  # fmt: skip
    """A line of one section with a source at its start, and at its end if a second one is given."""
    section = (0, 1, 0.0, length_m, impedance, susceptance)
    network = network_of(2, [section], [], sources(*enumerate(ends)))
    return place(network, constant_loads(positions_m, powers_va))


def side_by_side(
    points_m: list[float], nodes: list[list[int]], trains: list[tuple[int, float, complex]],
    fed: Records[Source], mutual: complex, *, impedance: complex = BT, susceptance: float = 0.0,
    coupled: bool = True,
) -> Case:  # fmt: skip
    """Tracks between the same points, each with its nodes there; trains by track, place and power."""
    tracks, pieces = len(nodes), len(points_m) - 1
    sections = [
        SectionPart(
            of_track[i],
            of_track[i + 1],
            points_m[i],
            points_m[i + 1],
            impedance,
            susceptance,
            mutual,
        )
        for of_track in nodes
        for i in range(pieces)
    ]
    groups = [[k * pieces + i for k in range(tracks)] for i in range(pieces)]
    n_nodes = max(node for of_track in nodes for node in of_track) + 1
    network = assemble(n_nodes, sections, [], fed, SYSTEM, groups=groups if coupled else ())
    loads = constant_loads([m for _, m, _ in trains], [power for _, _, power in trains])
    loads.trains.route = [track for track, _, _ in trains]
    rows = [(-np.inf, 1.0, 0.0, 0, k + 1, k * pieces, (k + 1) * pieces) for k in range(tracks)]
    return place(network, loads, Leg.array(rows).reshape(tracks, 1))


def highest_root(e, z, load):
    """U² = [(E² - 2(RP + XQ)) + √((E² - 2(RP + XQ))² - 4|Z|²|S|²)] / 2: one load, one stiff source."""
    b = e * e - 2 * (z.real * load.real + z.imag * load.imag)
    return math.sqrt((b + math.sqrt(b * b - 4 * abs(z * load) ** 2)) / 2)


def solve_slowly(case):
    """Voltages of nodes and trains by scipy's fsolve on the polar mismatches (F.35)-(F.41)."""
    y = admittance_matrix(case.network, case.flow)
    n = case.flow.nodes.size
    types = case.loads.types[case.flow.standing.train]
    drawn = types.auxiliary_power_w + 1j * types.auxiliary_reactive_power_var
    law = case.network.sources

    def mismatch(x):
        voltage = 16_500.0 * (x[: len(y)] + 1j * x[len(y) :])
        power = voltage * np.conj(y @ voltage)
        residual = power / 10e6
        residual[n:] += drawn / 10e6
        for s, node in enumerate(law.node):
            u, direction, *_ = terminal_voltage(
                power[node].real, power[node].imag, 1.0, law[s].converter
            )
            residual[node] = (voltage[node] - u * direction) / 16_500.0
        return np.concatenate([residual.real, residual.imag])

    start = np.concatenate([np.ones(len(y)), np.zeros(len(y))])
    found, _, ok, message = fsolve(mismatch, start, full_output=True, xtol=1e-13)
    assert ok == 1 or np.abs(mismatch(found)).max() < 1e-9, message
    return 16_500.0 * (found[: len(y)] + 1j * found[len(y) :])
