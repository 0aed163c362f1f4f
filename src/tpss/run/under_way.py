"""Trains on their way through their gates, and whether all of them could come to their ends.

As in the banker's algorithm [Dijkstra1965]_: one after another, each of them as far as its end, if there
is an order in which each finds its way free that is left by those before.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple


class Passage(NamedTuple):
    """What a train has planned at a gate."""

    stretch: int
    direction: int
    place: int
    """Crossing place behind the stretch, or -1."""
    ready_s: float
    """Time at which it comes to the gate and would go on; minus infinity: it has passed it. [s]"""
    clear_s: float
    """Time at which it has left the stretch. [s]"""
    waits_on: int = -1
    """Place on a track where it waits at the gate, with others behind it; -1: on a track of its own."""
    entry_m: float = 0.0
    """Where it comes to the stretch. [m]"""


@dataclass
class OnTheWay:
    """A train on its way through its gates."""

    passages: list[Passage]
    late_s: float = 0.0
    next: int = 0
    """Next gate."""
    on: dict[int, int] = field(default_factory=dict)
    """Stretches on which it is, by the numbers of their gates."""
    leaves: set[int] = field(default_factory=set)
    """Numbers of gates for which it is planned when it leaves the stretch."""
    place: int = -1
    """Crossing place at which it has a track, or to which it has been let."""
    lined_up: bool = False
    """Whether it has come to its next gate on a track that it shares with others."""

    def waits_on(self, gate: int) -> int:
        """Place on a track where it waits at a gate; -1: on one of its own, or there is no such gate."""
        return self.passages[gate].waits_on if gate < len(self.passages) else -1

    @property
    def last_gate(self) -> object:
        """The gate that it has passed last; one that has passed none shares it with nobody."""
        if self.next == 0:
            return id(self)
        last = self.passages[self.next - 1]
        return last.stretch, last.direction


def all_come_through(
    i: int, under_way: Iterable[int], trains: Sequence[OnTheWay], coming: Mapping[int, list[int]],
    tracks: Sequence[int],
) -> bool:  # fmt: skip
    """Whether all trains under way could come to their ends after a train has passed its gate.

    Each can come as far as the crossing place to which it has been let, or behind those that wait on its
    track; from there on it needs a free track at the places on its way, and nobody who waits on its way,
    one after another.

    Parameters
    ----------
    i : int
        The train.
    under_way : iterable of int
    trains : sequence of OnTheWay
    coming : mapping
        Trains on their way to a place where they wait on one track, in their order.
    tracks : sequence of int
        Number of tracks of the crossing places.
    """
    left = {j: trains[j].next + (j == i) for j in {*under_way, i}}
    at = {j: trains[j].place for j in left}
    at[i] = trains[i].passages[trains[i].next].place
    waits_on = {j: trains[j].waits_on(gate) for j, gate in left.items()}
    left = {j: gate for j, gate in left.items() if at[j] >= 0 or waits_on[j] >= 0}
    taken = Counter(at[j] for j in left)
    lines: dict[int, list[int]] = {}
    come_up = [(*_comes_s(j, left[j], trains[j], coming), j) for j in left if waits_on[j] >= 0]
    for *_, j in sorted(come_up):
        lines.setdefault(waits_on[j], []).append(j)
    found = True
    while left and found:
        found = False
        for j, gate in list(left.items()):
            taken[at[j]] -= 1
            if _finds_way(j, trains[j].passages[gate:], taken, lines, tracks):
                del left[j]
                if waits_on[j] >= 0:
                    lines[waits_on[j]].remove(j)
                found = True
            else:
                taken[at[j]] += 1
    return not left


def _comes_s(
    j: int, gate: int, train: OnTheWay, coming: Mapping[int, list[int]]
) -> tuple[bool, float]:
    """When a train comes to a gate; first those that have lined up there, in their order."""
    here = train.passages[gate]
    if train.lined_up and gate == train.next:
        return False, coming[here.waits_on].index(j)
    return True, here.ready_s + train.late_s


def _finds_way(
    j: int, passages: Sequence[Passage], taken: Mapping[int, int], lines: Mapping[int, list[int]],
    tracks: Sequence[int],
) -> bool:  # fmt: skip
    """Whether a train finds its way free past some gates, as places are taken and others wait."""
    for k, each in enumerate(passages):
        if each.place >= 0 and taken[each.place] >= tracks[each.place]:
            return False
        if each.waits_on >= 0:
            ahead = lines.get(each.waits_on, ())
            if ahead and not (k == 0 and ahead[0] == j):
                return False
    return True
