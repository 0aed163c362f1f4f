"""What an outage parts of a supply: pairs of nodes that are one where nothing is parted.

A layout has the parted state: an open switch has a node on either side, and a section of contact line
that is out has nodes of its own.  In the whole state, before and after an outage, such nodes are joined.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeVar

from tpss.powerflow.network import BranchPart, SectionPart
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


def parting_of(outage: Outage, supply: Supply) -> Parting:
    """What an outage of a supply parts."""
    listed = {post.name: post.closed for post in supply.posts}
    listed |= {each.name: each.closed for each in supply.section_breaks}
    closed = {name for name in outage.opens if listed.get(name, False)}
    return Parting(
        feeds=frozenset(name for name in outage.opens if name not in listed),
        switches=frozenset() if outage.is_throughout else frozenset(closed),
        sections=outage.sections,
    )


def joined_over(before: Sequence[str], behind: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of conductors before a break and behind it; all with all where they differ."""
    if len(before) == len(behind):
        return list(zip(before, behind, strict=True))
    return [(before[0], each) for each in (*before[1:], *behind)]


def set_apart(
    words: Sequence[Sequence[str]], out: Sequence[Sequence[bool]], anchored: bool
) -> tuple[list[list[str]], list[tuple[str, str]]]:
    """Give conductors that are out nodes of their own at a place, where they share one with others.

    Parameters
    ----------
    words : sequence of sequences of str
        What tells the nodes of the conductors before the place and behind it.
    out : sequence of sequences of bool
        Whether each of these conductors is out on that side.
    anchored : bool
        Whether the line is fed there, or meets others.

    Returns
    -------
    list of lists of str, list of pairs of str
        As `words`, and pairs of new ones with those that they take the place of.
    """
    sides = [list(zip(*side, strict=True)) for side in zip(words, out, strict=True)]
    live = {each for side in sides for each, is_out in side if not is_out}
    pairs: dict[str, str] = {}
    found = []
    for side in sides:
        row = []
        for k, (each, is_out) in enumerate(side):
            own = each
            if is_out and (anchored or each in live):
                own = f", track {k + 1}, out" if len(side) > 1 else ", out"
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
