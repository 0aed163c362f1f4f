"""The supply network of a scenario as arrays.

Every feeding station and every transformer stands at a feeding point.  A feeding point has a node
on the contact line, and on an AT system, if a station stands there, one more behind the connection
impedance; with a high-voltage line it has a node on that line too.  The ends of a line are nodes; where
lines meet, there is one node for all of them.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from tpss.model.conductors import add_conductors, autotransformers_of
from tpss.model.contact_line import LineLayout, catenary_at, lay_contact_line
from tpss.model.feeding import Feeding, feedings_of
from tpss.model.parting import (
    Joint,
    Parting,
    renamed,
)
from tpss.model.shared_grids import mutual_impedances_ohm
from tpss.model.sources import build_sources
from tpss.model.stores import build_stores
from tpss.model.supply_plan import (
    BUSBAR,
    CONNECTION,
    CONTACT_LINE,
    FEEDER,
    HIGH_VOLTAGE_LINE,
    TRANSFORMER,
    SupplyPlan,
)
from tpss.powerflow.assembly import assemble
from tpss.powerflow.network import Network
from tpss.powerflow.system import System, system
from tpss.scenario.line import Line
from tpss.scenario.supply import Catenary, HighVoltageLine, Station, Supply
from tpss.scenario.supply.system import system_named
from tpss.scenario.supply.transformers import transformer_positions_km
from tpss.units import kilometres, si

NOTHING_PARTED = Parting()


def build_supply(
    supply: Supply, lines: tuple[LineLayout, ...], parting: Parting = NOTHING_PARTED
) -> tuple[Network, SupplyPlan]:
    """Network along lines, with the names of its parts, in which all is parted that is said to be."""
    plan = plan_supply(supply, lines, parting)
    sources = build_sources(plan.sources, supply.stations)
    parts = len(plan.nodes), plan.sections, plan.branches, sources, system_of(supply)
    network = assemble(
        *parts, room=plan.room(), groups=plan.coupled, links=plan.links, bundles=plan.bundles,
        flat_pu=plan.flat_pu, inner_ohm=plan.inner_ohm, mutual_ohm=mutual_impedances_ohm(supply),
        stores=build_stores(plan.stores, supply.storage),
    )  # fmt: skip
    return network, plan


def joined_network(
    parted: Network, plan: SupplyPlan, supply: Supply, joints: Sequence[Joint]
) -> tuple[Network, dict[int, int]]:
    """The network of the shapes of a parted one in which some pairs of nodes are one.

    Parameters
    ----------
    parted : Network
    plan : SupplyPlan
        Its parts.
    supply : Supply
        Of which it is.
    joints : sequence of pairs of nodes
        Some of those of the plan.

    Returns
    -------
    network : Network
        None of whose nodes follows.
    leaders : dict of int to int
        Nodes to which nothing is joined, and those that they are one with: see `following`.
    """
    if not joints:
        return parted, {}
    node = plan.one_with(joints)
    network = assemble(
        len(node),
        renamed(plan.sections, node),
        renamed(plan.branches, node),
        build_sources([node[n] for n in plan.sources], supply.stations),
        parted.system,
        room=plan.room(),
        groups=plan.coupled,
        links=[link._replace(nodes=tuple(node[n] for n in link.nodes)) for link in plan.links],
        bundles=plan.bundles,
        flat_pu=plan.flat_pu,
        inner_ohm=plan.inner_ohm,
        mutual_ohm=mutual_impedances_ohm(supply),
        stores=build_stores([node[n] for n in plan.stores], supply.storage),
    )
    return network, {n: other for n, other in enumerate(node) if n != other}


def system_of(supply: Supply) -> System:
    """Electrification system of a supply, at the supply's frequency."""
    values = system_named(supply.system)
    return system(
        nominal_voltage_v=si(values, "nominal_kv"),
        base_voltage_v=si(values, "base_kv"),
        base_power_va=si(values, "base_mva"),
        frequency_hz=supply.frequency_hz,
        lowest_pu=values.lowest_pu,
        highest_pu=values.highest_pu,
    )


def layouts_of(lines: Mapping[str, Line]) -> tuple[LineLayout, ...]:
    """What the supply has to know of lines."""
    stands_on = Counter(station.name for line in lines.values() for station in line.stations)
    return tuple(
        LineLayout(
            name=name,
            number=number,
            begin_km=line.begins_at_km,
            end_km=line.end_km,
            junctions=tuple(
                (station.position_km, station.name)
                for station in line.stations
                if stands_on[station.name] > 1
            ),
            tracks=tuple(line.tracks_by_stretch),
            alone=len(lines) == 1,
        )
        for number, (name, line) in enumerate(lines.items())
    )


def plan_supply(
    supply: Supply, lines: Sequence[LineLayout], parting: Parting = NOTHING_PARTED
) -> SupplyPlan:
    """Lay out nodes, sections and branches along lines, which are tied where they meet.

    References
    ----------
    [Boullanger2009]_, figure 2-4 and appendix A.2.
    """
    plan = SupplyPlan()
    meeting: dict[str, int] = {}
    feedings = feedings_of(supply, lines, parting)
    fed = [_OnLine.of(supply, line, feedings) for line in lines]
    feeding = [
        _lay_line(plan, line, meeting, here, supply, parting)
        for line, here in zip(lines, fed, strict=True)
    ]
    _join_busbars(plan, lines, feedings, feeding)
    node_of: dict[str, int] = {}
    store_node: dict[str, int] = {}
    for line, here, node in zip(lines, fed, feeding, strict=True):
        for km, station in sorted(here.stations.items()):
            connection = _connection_impedance(catenary_at(km, line, supply))
            if connection:
                contact_line, node[km] = node[km], plan.add_node(FEEDER, line, km)
                plan.add_branch(CONNECTION, station.name, node[km], contact_line, connection)
        if here.has_high_voltage:
            _lay_high_voltage_line(plan, line, here, node, supply)
        node_of |= {station.name: node[km] for km, station in here.stations.items()}
        own = (each for each in supply.storage if line.holds(each.line))
        store_node |= {each.name: node[each.position_km] for each in own}
    plan.sources = [node_of[station.name] for station in supply.stations]
    add_conductors(plan, supply, lines)
    plan.stores = [store_node[each.name] for each in supply.storage]
    return plan


def _join_busbars(
    plan: SupplyPlan,
    lines: Sequence[LineLayout],
    feedings: Sequence[Feeding],
    nodes: Sequence[dict[float, int]],
) -> None:
    """Give each station the node of its busbar, on its line, and note the joints of open feeds."""
    on = {line.name: (line, node) for line, node in zip(lines, nodes, strict=True)}
    for each in feedings:
        home, place_km = on[each.home], each.station.position_km
        there = {name: on[name][1][km] for name, km in each.places_km.items()}
        shared = next((node for name, node in there.items() if name in each.shared), None)
        busbar = plan.add_node(BUSBAR, home[0], place_km) if shared is None else shared
        plan.joints += [(there[name], busbar) for name in each.parted]
        home[1][place_km] = busbar


class _OnLine(NamedTuple):
    """What feeds a line."""

    stations: dict[float, Station]
    transformers_km: list[float]
    has_high_voltage: bool
    junctions: dict[float, str]
    """Places where it is tied to other lines, and the names of the stations there."""
    feeding_km: set[float]
    """Places where it is fed, joined to a store, or tied to others. [km]"""

    @classmethod
    def of(cls, supply: Supply, line: LineLayout, feedings: Sequence[Feeding]) -> "_OnLine":
        """What feeds one of several lines."""
        high_voltage = supply.high_voltage_line
        beside = high_voltage is not None and line.holds(high_voltage.line)
        transformers = transformer_positions_km(supply) if beside else []
        busbars = {each.junction: each.shared for each in feedings}
        junctions = {
            km: name
            for km, name in line.junctions
            if (line.name in busbars[name] if name in busbars else supply.junctions_tied)
        }
        autotransformers = (km for km, _ in autotransformers_of(supply, line))
        stores_km = {each.position_km for each in supply.storage if line.holds(each.line)}
        fed_km = {each.places_km[line.name] for each in feedings if line.name in each.places_km}
        return cls(
            stations={s.position_km: s for s in supply.stations if line.holds(s.line)},
            transformers_km=transformers,
            has_high_voltage=beside,
            junctions=junctions,
            feeding_km={*fed_km, *transformers, *junctions, *autotransformers, *stores_km},
        )


def _lay_line(
    plan: SupplyPlan,
    line: LineLayout,
    meeting: dict[str, int],
    here: _OnLine,
    supply: Supply,
    parting: Parting,
) -> dict[float, int]:
    """The contact line of a line; return its nodes at feeding points by their places. [km]"""

    def make_node(km: float, words: str) -> int:
        # What has words of its own is apart from what else there is at the place.
        name = None if words else here.junctions.get(km)
        if name is None or name not in meeting:
            node = plan.add_node(CONTACT_LINE, line, km, words=words)
        else:
            node = meeting[name]
        if name is not None:
            meeting[name] = node
        return node

    first = len(plan.sections)
    laid = lay_contact_line(line, supply, here.feeding_km, make_node, first, parting)
    if supply.conductors is None:  # otherwise they are bundles
        plan.coupled += laid.coupled(first)
    plan.sections += laid.sections
    plan.section_names += [f"{CONTACT_LINE} {name}" for name in laid.names]
    plan.section_kinds += [CONTACT_LINE] * len(laid.names)
    plan.runs.append(laid.runs)
    plan.feeding.append(dict(laid.node))
    plan.joints += laid.joints
    plan.guards += laid.guards
    return laid.node


def _connection_impedance(catenary: Catenary) -> complex:
    return complex(si(catenary, "connection_r_ohm"), si(catenary, "connection_x_ohm"))


def _lay_high_voltage_line(
    plan: SupplyPlan, line: LineLayout, here: _OnLine, feeding: dict[float, int], supply: Supply
) -> None:
    """High-voltage nodes, the line between them, and a transformer at each.

    A transformer between stations on an AT system stands behind a connection impedance of its own,
    in series.
    """
    high_voltage: HighVoltageLine = supply.high_voltage_line  # type: ignore[assignment]
    level = si(high_voltage, "base_kv") / system_of(supply).base_voltage_v
    kind = high_voltage.type
    per_m = complex(si(kind, "r_ohm_per_km"), si(kind, "x_ohm_per_km")) / level**2
    stands = sorted({*here.stations, *here.transformers_km})
    node = {km: plan.add_node(HIGH_VOLTAGE_LINE, line, km, level) for km in stands}
    for km in stands:
        at_station = km in here.stations
        unit = high_voltage.station_transformer if at_station else high_voltage.line_transformer
        impedance = complex(si(unit, "r_ohm"), si(unit, "x_ohm"))
        if not at_station:
            impedance += _connection_impedance(catenary_at(km, line, supply))
        name = f"{line.prefix}{kilometres(km)} km"
        plan.add_branch(TRANSFORMER, name, feeding[km], node[km], impedance)
    for start, end in zip(stands, stands[1:], strict=False):
        impedance = per_m * (end - start) * 1e3
        name = f"{line.prefix}{kilometres(start)}-{kilometres(end)} km"
        plan.add_branch(HIGH_VOLTAGE_LINE, name, node[start], node[end], impedance, level)
