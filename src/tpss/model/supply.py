"""The supply network of a scenario as arrays.

Every feeding station and every transformer stands at a feeding point.  A feeding point has a node
on the contact line, and on an AT system, if a station stands there, one more behind the connection
impedance; with a high-voltage line it has a node on that line too.  The line's ends are nodes.
"""

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from tpss.model.sources import build_sources
from tpss.powerflow.network import BranchPart, Network, SectionPart, assemble
from tpss.powerflow.system import System, system
from tpss.scenario.supply import Catenary, HighVoltageLine, Supply
from tpss.scenario.supply.system import system_named
from tpss.units import kilometres, si

CONTACT_LINE = "contact line"
HIGH_VOLTAGE_LINE = "high-voltage line"
TRANSFORMER = "transformer"
CONNECTION = "connection"
FEEDER = "AT feeder"


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
    branch_level: list[float] = field(default_factory=list)
    sources: list[int] = field(default_factory=list)

    def add_node(self, kind: str, position_km: float, level: float = 1.0) -> int:
        """Add a node and return its index; its name begins with its kind."""
        self.nodes.append(f"{kind} at {kilometres(position_km)} km")
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

    def branch_labels(self) -> list[str]:
        """Names of what `Recording.branch_current` holds."""
        ends = [f"{name}, {end}" for name in self.section_names for end in ("start", "end")]
        return [*self.branch_names, *ends]

    def branch_levels(self) -> list[float]:
        """Own voltage of each of them over that of the contact line."""
        return [*self.branch_level, *(1.0 for _ in self._section_ends())]

    def branch_kind_of_each(self) -> list[str]:
        """Kind of each of them."""
        return [*self.branch_kinds, *(CONTACT_LINE for _ in self._section_ends())]

    def branch_resistance_ohm(self) -> list[float]:
        """Resistance of each of them at its own level; NaN for the ends of sections. [ohm]"""
        lumped = [
            branch.impedance_ohm.real * level**2
            for branch, level in zip(self.branches, self.branch_level, strict=True)
        ]
        return [*lumped, *(math.nan for _ in self._section_ends())]

    def _section_ends(self) -> range:
        return range(2 * len(self.section_names))


@lru_cache(maxsize=64)
def build_supply(supply: Supply, begin_km: float, end_km: float) -> tuple[Network, SupplyPlan]:
    """Network along a line between its ends [km], with the names of its parts.

    Cases of a study have few supplies; those of the same one share what this gives, and only read it.
    """
    plan = plan_supply(supply, begin_km, end_km)
    sources = build_sources(plan.sources, supply.stations)
    network = assemble(len(plan.nodes), plan.sections, plan.branches, sources, system_of(supply))
    return network, plan


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


def plan_supply(supply: Supply, begin_km: float, end_km: float) -> SupplyPlan:
    """Lay out nodes, sections and branches along the line between its ends. [km]

    References
    ----------
    [Boullanger2009]_, figure 2-4 and appendix A.2.
    """
    plan = SupplyPlan()
    transformers = transformer_positions_km(supply)
    stations = {station.position_km: station for station in supply.stations}
    points = sorted({begin_km, end_km, *stations, *transformers})
    line_node = {km: plan.add_node(CONTACT_LINE, km) for km in points}
    _lay_contact_line(plan, points, line_node, supply)
    feeding = dict(line_node)
    connection = _connection_impedance(supply.catenary)
    if connection:
        for km, station in sorted(stations.items()):
            feeding[km] = plan.add_node(FEEDER, km)
            plan.add_branch(CONNECTION, station.name, feeding[km], line_node[km], connection)
    if supply.high_voltage_line is not None:
        stands = sorted({*stations, *transformers})
        _lay_high_voltage_line(plan, stands, set(stations), feeding, supply)
    plan.sources = [feeding[station.position_km] for station in supply.stations]
    return plan


def transformer_positions_km(supply: Supply) -> list[float]:
    """Positions of the transformers between stations, given or equally spaced."""
    high_voltage = supply.high_voltage_line
    if high_voltage is None:
        return []
    if high_voltage.transformers_km is not None:
        return list(high_voltage.transformers_km)
    stations = sorted(station.position_km for station in supply.stations)
    count = high_voltage.transformers or 0
    return [
        start + (end - start) * (i + 1) / (count + 1)
        for start, end in zip(stations, stations[1:], strict=False)
        for i in range(count)
    ]


def _connection_impedance(catenary: Catenary) -> complex:
    return complex(si(catenary, "connection_r_ohm"), si(catenary, "connection_x_ohm"))


def _lay_contact_line(
    plan: SupplyPlan, points: list[float], node: dict[float, int], supply: Supply
) -> None:
    catenary = supply.catenary
    impedance = complex(si(catenary, "r_ohm_per_km"), si(catenary, "x_ohm_per_km"))
    susceptance = 2 * np.pi * supply.frequency_hz * si(catenary, "capacitance_nf_per_km")
    for start, end in zip(points, points[1:], strict=False):
        plan.sections.append(
            SectionPart(node[start], node[end], start * 1e3, end * 1e3, impedance, susceptance)
        )
        plan.section_names.append(f"{CONTACT_LINE} {kilometres(start)}-{kilometres(end)} km")


def _lay_high_voltage_line(
    plan: SupplyPlan, stands: list[float], stations: set[float], feeding: dict[float, int],
    supply: Supply,
) -> None:  # fmt: skip
    """High-voltage nodes, the line between them, and a transformer at each.

    A transformer between stations on an AT system stands behind a connection impedance of its own,
    in series.
    """
    high_voltage: HighVoltageLine = supply.high_voltage_line  # type: ignore[assignment]
    level = si(high_voltage, "base_kv") / system_of(supply).base_voltage_v
    kind = high_voltage.type
    per_m = complex(si(kind, "r_ohm_per_km"), si(kind, "x_ohm_per_km")) / level**2
    node = {km: plan.add_node(HIGH_VOLTAGE_LINE, km, level) for km in stands}
    for km in stands:
        unit = high_voltage.station_transformer if km in stations else high_voltage.line_transformer
        impedance = complex(si(unit, "r_ohm"), si(unit, "x_ohm"))
        if km not in stations:
            impedance += _connection_impedance(supply.catenary)
        plan.add_branch(TRANSFORMER, f"{kilometres(km)} km", feeding[km], node[km], impedance)
    for start, end in zip(stands, stands[1:], strict=False):
        impedance = per_m * (end - start) * 1e3
        name = f"{kilometres(start)}-{kilometres(end)} km"
        plan.add_branch(HIGH_VOLTAGE_LINE, name, node[start], node[end], impedance, level)
