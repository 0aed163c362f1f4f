"""The supply network of a scenario as arrays.

Every feeding station and every transformer stands at a feeding point.  A feeding point has a node
on the contact line, and on an AT system, if a station stands there, one more behind the connection
impedance; with a high-voltage line it has a node on that line too.  The ends of a line are nodes; where
lines meet, there is one node for all of them.
"""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.model.conductors import FLAT_PU, add_conductors, autotransformers_of
from tpss.model.contact_line import LineLayout, Run, catenary_at, lay_contact_line
from tpss.model.feeding import Feeding, feedings_of
from tpss.model.parting import (
    Joint,
    Parting,
    edges_of_any,
    edges_of_both,
    renamed,
    representatives,
)
from tpss.model.shared_grids import mutual_impedances_ohm
from tpss.model.sources import build_sources
from tpss.model.stores import build_stores
from tpss.powerflow.bundles import BundlePart, edges_of_bundles
from tpss.powerflow.groups import edges_within
from tpss.powerflow.in_service import mark_unfed
from tpss.powerflow.links import LinkPart, edges_of_links
from tpss.powerflow.network import BranchPart, Network, SectionPart, assemble
from tpss.powerflow.system import System, system
from tpss.scenario.line import Line
from tpss.scenario.supply import Catenary, HighVoltageLine, Station, Supply
from tpss.scenario.supply.system import system_named
from tpss.scenario.supply.transformers import transformer_positions_km
from tpss.units import kilometres, si

CONTACT_LINE = "contact line"
HIGH_VOLTAGE_LINE = "high-voltage line"
TRANSFORMER = "transformer"
CONNECTION = "connection"
FEEDER = "AT feeder"
BUSBAR = "busbar"


@dataclass
class SupplyPlan:
    """Nodes, branches and sections by name, before they become arrays."""

    nodes: list[str] = field(default_factory=list)
    node_kinds: list[str] = field(default_factory=list)
    node_km: list[float] = field(default_factory=list)
    node_level: list[float] = field(default_factory=list)
    """Own voltage of the node over that of the contact line."""
    branches: list[BranchPart] = field(default_factory=list)
    branch_names: list[str] = field(default_factory=list)
    branch_kinds: list[str] = field(default_factory=list)
    sections: list[SectionPart] = field(default_factory=list)
    section_names: list[str] = field(default_factory=list)
    section_kinds: list[str] = field(default_factory=list)
    coupled: list[tuple[int, ...]] = field(default_factory=list)
    """Sections side by side that have an impedance in common."""
    branch_level: list[float] = field(default_factory=list)
    sources: list[int] = field(default_factory=list)
    stores: list[int] = field(default_factory=list)
    """Nodes of the stores of energy."""
    runs: list[list[Run]] = field(default_factory=list)
    """Of each line."""
    feeding: list[dict[float, int]] = field(default_factory=list)
    """Nodes of the contact line of each line where its tracks are tied, by their places. [km]"""
    node_line: list[int] = field(default_factory=list)
    """Index of the line of each node."""
    joints: list[Joint] = field(default_factory=list)
    """Pairs of nodes that are one in the whole state, see `model.parting`."""
    guards: list[Joint] = field(default_factory=list)
    """Pairs of nodes, the second one at the end of a section, that are one until that trips."""
    links: list[LinkPart] = field(default_factory=list)
    link_names: list[str] = field(default_factory=list)
    link_kinds: list[str] = field(default_factory=list)
    station_links: dict[int, list[int]] = field(default_factory=dict)
    """Links that are windings of a station, by its number: they are out when it is."""
    bundles: list[BundlePart] = field(default_factory=list)
    """Sections that are conductors side by side."""
    rails_beside: dict[int, int] = field(default_factory=dict)
    """Nodes of the contact line, and those of the rails there, where these are conductors."""
    inner_ohm: list[float] = field(default_factory=list)
    """Resistance between the node of each source and its terminals, where there are bundles. [Ω]"""

    kinds_of_contact_line: ClassVar = (CONTACT_LINE, FEEDER, BUSBAR)
    """Kinds of nodes that have the voltage of the contact line."""

    @property
    def edges(self) -> list[tuple[int, int]]:
        """Nodes that branches and sections couple."""
        ends = [(section.start_node, section.end_node) for section in self.sections]
        within = edges_within(self.coupled, ends)
        lumped = [(branch.start_node, branch.end_node) for branch in self.branches]
        joined = edges_of_links(self.links) + edges_of_bundles(self.bundles, ends)
        return ends + within + lumped + joined

    @property
    def at_line_level(self) -> npt.NDArray[np.bool_]:
        """Whether each node has a voltage at which trains could run; not one to earth beside rails."""
        levels = zip(self.node_level, self.node_kinds, strict=True)
        apart = (*FLAT_PU, *self.kinds_of_contact_line) if self.bundles else ()
        return np.array([level == 1.0 and kind not in apart for level, kind in levels])

    @property
    def flat_pu(self) -> list[float]:
        """Voltage of each node without load, over that of the contact line. [1]"""
        return [FLAT_PU.get(kind, 1.0) for kind in self.node_kinds]

    def contact_node(self, line: LineLayout, position_km: float) -> int:
        """Node of the contact line of a line at a place where all its tracks are tied."""
        return self.feeding[line.number][position_km]

    def one_with(self, joints: Sequence[Joint]) -> list[int]:
        """The node that each node is one with where some pairs are joined."""
        return representatives(len(self.nodes), joints, self.sources)

    def room(self) -> list[tuple[int, int]]:
        """Pairs of nodes that are coupled in any state."""
        whole = self.one_with([*self.joints, *self.guards])
        if not self.guards:
            return edges_of_both(self.edges, whole)
        return edges_of_any(self.edges, [whole, self.one_with(self.guards)])

    def add_node(
        self, kind: str, line: LineLayout, position_km: float, level: float = 1.0, words: str = ""
    ) -> int:
        """Add a node and return its index; its name begins with its kind and may end in words."""
        self.nodes.append(f"{kind} at {line.prefix}{kilometres(position_km)} km{words}")
        self.node_line.append(line.number)
        self.node_kinds.append(kind)
        self.node_km.append(position_km)
        self.node_level.append(level)
        return len(self.nodes) - 1

    def add_branch(
        self, kind: str, name: str, start: int, end: int, impedance_ohm: complex, level: float = 1.0
    ) -> None:
        """Add a lumped branch; its label begins with its kind."""
        self.branches.append(BranchPart(start, end, impedance_ohm))
        self.branch_names.append(f"{kind} {name}")
        self.branch_kinds.append(kind)
        self.branch_level.append(level)

    def add_link(
        self,
        kind: str,
        name: str,
        nodes: tuple[int, ...],
        weights: tuple[float, ...],
        impedance_ohm: complex,
    ) -> None:
        """Add a lumped element between several nodes; its label begins with its kind."""
        self.links.append(LinkPart(nodes, weights, impedance_ohm))
        self.link_names.append(f"{kind} {name}")
        self.link_kinds.append(kind)

    def branch_labels(self) -> list[str]:
        """Names of what `Recording.branch_current` holds."""
        ends = [f"{name}, {end}" for name in self.section_names for end in ("start", "end")]
        return [*self.branch_names, *ends]

    def branch_levels(self) -> list[float]:
        """Own voltage of each of them over that of the contact line."""
        return [*self.branch_level, *(1.0 for _ in self._section_ends())]

    def branch_kind_of_each(self) -> list[str]:
        """Kind of each of them."""
        return [*self.branch_kinds, *(kind for kind in self.section_kinds for _ in range(2))]

    def branch_resistance_ohm(self) -> list[float]:
        """Resistance of each of them at its own level; NaN for the ends of sections. [ohm]"""
        lumped = [
            branch.impedance_ohm.real * level**2
            for branch, level in zip(self.branches, self.branch_level, strict=True)
        ]
        return [*lumped, *(math.nan for _ in self._section_ends())]

    def _section_ends(self) -> range:
        return range(2 * len(self.section_names))


NOTHING_PARTED = Parting()


@lru_cache(maxsize=64)
def build_supply(
    supply: Supply, lines: tuple[LineLayout, ...], parting: Parting = NOTHING_PARTED
) -> tuple[Network, SupplyPlan]:
    """Network along lines, with the names of its parts, in which all is parted that is said to be.

    Cases of a study have few supplies; those of the same one share what this gives, and only read it.
    """
    plan = plan_supply(supply, lines, parting)
    sources = build_sources(plan.sources, supply.stations)
    parts = len(plan.nodes), plan.sections, plan.branches, sources, system_of(supply)
    network = assemble(
        *parts, room=plan.room(), groups=plan.coupled, links=plan.links, bundles=plan.bundles,
        flat_pu=plan.flat_pu, inner_ohm=plan.inner_ohm, mutual_ohm=mutual_impedances_ohm(supply),
        stores=build_stores(plan.stores, supply.storage),
    )  # fmt: skip
    return mark_unfed(network), plan


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
    return mark_unfed(network), {n: other for n, other in enumerate(node) if n != other}


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
