"""Groups of sections side by side whose currents induce voltages in each other, as arrays.

The sections of a group begin at one place and end at one place, have the same impedance z_s and
susceptance, and any two of them the same common impedance z_m.  What is constant stands in `Groups`;
what a solution finds, and scratch, in `GroupFlow`.  The equations are those of `coupled`.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import NamedTuple, cast

import numpy as np
import numpy.typing as npt

from tpss.record import Record, Records

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


class Groups(NamedTuple):
    """Groups of coupled sections; those of fewer sections than the widest one leave places unused.

    A network without any has an empty tuple in its place, see `kernel.where_any`.
    """

    is_coupled: Flags
    """Whether each section of the network is one of a group."""
    mutual_ohm_per_m: Complexes
    """Impedance that each section has in common with any other of its group. [Ω/m]"""
    size: Indices
    """Number of sections of each group."""
    section: Indices
    """Sections of each group, shape (groups, widest)."""
    place: Indices
    """Places of the blocks of each group, shape (groups, 2 widest, 2 widest): rows and columns are the
    start nodes of its sections, then their end nodes."""


class Conductor(Record):
    """Where a conductor of a group stands while the group is pushed from its start to its end."""

    section: int
    """Its section."""
    next: int
    """Its next train in `Flow.standing`."""
    is_open: bool
    """Whether its end is not reached yet."""
    is_fed: bool
    """Whether a source reaches it; a dead conductor carries no current, and none is induced."""
    piece_m: float
    """Line between its last point and its next one. [m]"""
    ahead_m: float
    """What of that is left. [m]"""
    voltage_v: complex
    """Its voltage. [V]"""
    current_a: complex
    """Its current. [A]"""


class GroupFlow(NamedTuple):
    """State of the groups, and scratch; an empty tuple if there are none."""

    conductors: Records[Conductor]
    """Of the group that is being pushed."""
    sensitivity: Complexes
    """Its conductors' voltages and currents, over their start voltages, then their start currents;
    shape (2, widest, 2 widest, 2), a pair each."""
    rows: Complexes
    """The linearised equations of each group, shape (groups, widest, 3 widest, 2): [B | 1 | A], and
    solved, [1 | B⁻¹ | B⁻¹A]."""
    lost_w: Floats
    """Losses of each group. [W]"""


NO_GROUPS, NO_GROUP_FLOW = cast("Groups", ()), cast("GroupFlow", ())


def sections_of(groups: Groups) -> list[list[int]]:
    """Numbers of the sections of each group."""
    if groups == NO_GROUPS:
        return []
    return [group[:size].tolist() for size, group in zip(groups.size, groups.section, strict=True)]


def edges_within(
    groups: Sequence[Sequence[int]], sections: Sequence[tuple[int, int]]
) -> list[tuple[int, int]]:
    """Pairs of nodes that groups couple; parameters are those of `groups_of`."""
    nodes = [sorted(set(_nodes(group, sections))) for group in groups]
    return [pair for each in nodes for pair in combinations(each, 2)]


def groups_of(
    groups: Sequence[Sequence[int]],
    sections: Sequence[tuple[int, int]],
    place: Mapping[tuple[int, int], int],
    mutual_ohm_per_m: Sequence[complex],
) -> Groups:
    """Groups from the numbers of their sections.

    Parameters
    ----------
    groups : sequence of sequences of int
    sections : sequence of (int, int)
        Start and end node of each section of the network.
    place : mapping
        Place of the block of each two nodes.
    mutual_ohm_per_m : sequence of complex
        What each section has in common with any other of its group. [Ω/m]
    """
    if not groups:
        return NO_GROUPS
    widest = max(len(group) for group in groups)
    section = np.zeros((len(groups), widest), dtype=np.int64)
    places = np.zeros((len(groups), 2 * widest, 2 * widest), dtype=np.int64)
    for g, group in enumerate(groups):
        section[g, : len(group)] = group
        nodes = _nodes(group, sections)
        places[g, : len(nodes), : len(nodes)] = [[place[a, b] for b in nodes] for a in nodes]
    return Groups(
        is_coupled=np.isin(np.arange(len(sections)), np.concatenate([*groups])),
        mutual_ohm_per_m=np.array(mutual_ohm_per_m, dtype=complex),
        size=np.array([len(group) for group in groups], dtype=np.int64),
        section=section,
        place=places,
    )


def _nodes(group: Sequence[int], sections: Sequence[tuple[int, int]]) -> list[int]:
    """Start nodes of a group's sections, then their end nodes."""
    return [sections[s][end] for end in (0, 1) for s in group]


def new_group_flow(groups: Groups) -> GroupFlow:
    """State of groups before anything is known of them."""
    if groups == NO_GROUPS:
        return NO_GROUP_FLOW
    count, widest = groups.section.shape
    return GroupFlow(
        conductors=Conductor.blank(widest),
        sensitivity=np.zeros((2, widest, 2 * widest, 2), dtype=complex),
        rows=np.zeros((count, widest, 3 * widest, 2), dtype=complex),
        lost_w=np.zeros(count),
    )
