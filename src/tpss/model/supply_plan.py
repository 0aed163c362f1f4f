"""Nodes, branches, sections and links of a supply by name, before they become arrays."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tpss.model.contact_line import LineLayout, Run
from tpss.model.parting import (
    Joint,
    edges_of_any,
    edges_of_both,
    representatives,
)
from tpss.powerflow.assembly import BranchPart, SectionPart
from tpss.powerflow.bundles import BundlePart, edges_of_bundles
from tpss.powerflow.groups import edges_within
from tpss.powerflow.links import LinkPart, edges_of_links
from tpss.units import kilometres

CONTACT_LINE = "contact line"
HIGH_VOLTAGE_LINE = "high-voltage line"
TRANSFORMER = "transformer"
CONNECTION = "connection"
FEEDER = "AT feeder"
BUSBAR = "busbar"
RAILS_KIND, FEEDER_KIND = "rails", "feeder"

FLAT_PU = {RAILS_KIND: 0.0, FEEDER_KIND: -1.0}
"""Voltage of nodes without load, where it is another one than that of the contact line. [1]"""


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
    """Links that are windings of a station, by its number: they are out as far as its units are."""
    autotransformer_links: dict[tuple[str, float], list[int]] = field(default_factory=dict)
    """Links of each autotransformer, by the name of its line and its place. [km]"""
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
