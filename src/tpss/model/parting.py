"""What an outage parts of a supply: pairs of nodes that are one where nothing is parted.

A layout has the parted state: an open switch has a node on either side, and a section of contact line
that is out has nodes of its own.  In the whole state, before and after an outage, such nodes are joined.
So are those of a section that may trip, until it does.
"""

from collections.abc import Iterable, Sequence
from itertools import product
from typing import NamedTuple, TypeVar

from tpss.powerflow.assembly import BranchPart, SectionPart
from tpss.scenario.outages import Outage, OutSection
from tpss.scenario.supply import Supply

Joint = tuple[int, int]
"""Two nodes that are one in the whole state."""


_Part = TypeVar("_Part", SectionPart, BranchPart)


class Parting(NamedTuple):
    """What is parted in a layout, beside switches that a supply has open."""

    feeds: frozenset[str] = frozenset()
    """Names of feeds."""
    switches: frozenset[str] = frozenset()
    """Names of posts and section breaks that are open for a part of the run only."""
    sections: tuple[OutSection, ...] = ()
    """Sections of the contact line that are out."""
    guarded: bool = False
    """Whether each section whose rating has overloads has nodes of its own, as it may trip."""


def parting_of(outage: Outage | None, supply: Supply, guarded: bool) -> Parting:
    """What an outage of a supply parts, and what may trip."""
    if outage is None:
        return Parting(guarded=guarded)
    listed = {post.name: post.closed for post in supply.posts}
    listed |= {each.name: each.closed for each in supply.section_breaks}
    closed = {name for name in outage.opens if listed.get(name, False)}
    return Parting(
        feeds=frozenset(name for name in outage.opens if name not in listed),
        switches=frozenset() if outage.is_throughout else frozenset(closed),
        sections=outage.sections,
        guarded=guarded,
    )


def joined_over(before: Sequence[str], behind: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of conductors before a break and behind it; all with all where they differ."""
    if len(before) == len(behind):
        return list(zip(before, behind, strict=True))
    return [(before[0], each) for each in (*before[1:], *behind)]


def set_apart(
    words: Sequence[Sequence[str]], apart: Sequence[Sequence[str]], anchored: bool
) -> tuple[list[list[str]], list[tuple[str, str]]]:
    """Give conductors nodes of their own at a place, where they share one with others.

    Parameters
    ----------
    words : sequence of sequences of str
        What tells the nodes of the conductors before the place and behind it.
    apart : sequence of sequences of str
        What tells the node of its own of each conductor on that side; empty: it needs none.  Conductors
        of the same words stay together.
    anchored : bool
        Whether the line is fed there, or meets others.

    Returns
    -------
    list of lists of str, list of pairs of str
        As `words`, and pairs of new ones with those that they take the place of.
    """
    sides = [list(zip(*side, strict=True)) for side in zip(words, apart, strict=True)]
    users: dict[str, set[str]] = {}
    for each, more in (conductor for side in sides for conductor in side):
        users.setdefault(each, set()).add(more)
    pairs: dict[str, str] = {}
    found = []
    for side in sides:
        row = []
        for k, (each, more) in enumerate(side):
            own = each
            if more and (anchored or len(users[each]) > 1):
                own = f", track {k + 1}{more}" if len(side) > 1 else more
                pairs[own] = each
            row.append(own)
        found.append(row)
    return found, list(pairs.items())


def representatives(nodes: int, joints: Iterable[Joint], sources: Iterable[int]) -> list[int]:
    """The node that each node is one with in the whole state: that of a source, if one is among them.

    Parameters
    ----------
    nodes : int
        How many there are.
    joints : iterable of Joint
    sources : iterable of int
        Nodes of the sources.
    """
    one_with = list(range(nodes))
    stay = set(sources)
    for a, b in joints:
        kept, given_up = one_with[a], one_with[b]
        if given_up in stay:
            kept, given_up = given_up, kept
        one_with = [kept if node == given_up else node for node in one_with]
    return one_with


def renamed(parts: Sequence[_Part], node: Sequence[int]) -> list[_Part]:
    """Sections or branches between the nodes that theirs are one with."""
    return [
        part._replace(start_node=node[part.start_node], end_node=node[part.end_node])
        for part in parts
    ]


def edges_of_both(edges: Sequence[Joint], node: Sequence[int]) -> list[Joint]:
    """Nodes that are coupled in the parted state or in the whole one, for which both have room.

    Parameters
    ----------
    edges : sequence of pairs of nodes
        That are coupled in the parted state.
    node : sequence of int
        The node that each node is one with in the whole state.
    """
    pairs = [(n, other) for n, other in enumerate(node) if n != other]
    if not pairs:
        return []
    in_whole = [(node[a], node[b]) for a, b in edges]
    return [*edges, *((a, b) for a, b in in_whole if a != b), *pairs]


def edges_of_any(edges: Sequence[Joint], states: Sequence[Sequence[int]]) -> list[Joint]:
    """Nodes that are coupled in any mixture of states, for which all have room.

    Parameters
    ----------
    edges : sequence of pairs of nodes
        That are coupled in the parted state.
    states : sequence of sequences of int
        The node that each node is one with in each of the states.
    """
    names = [{n, *(state[n] for state in states)} for n in range(len(states[0]))]
    coupled = {
        (min(a, b), max(a, b))
        for start, end in edges
        for a, b in product(names[start], names[end])
        if a != b
    }
    coupled |= {(min(n, a), max(n, a)) for n, own in enumerate(names) for a in own if a != n}
    return sorted(coupled)
