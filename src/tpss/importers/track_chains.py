"""Track sections in a row: which of them make a line.

Sections of one line, or of one line and track, of a register follow each other, and those of none follow
any; without a register the maximal chains do.  Over a switch a chain goes on along one of its ways only:
where sections of the same name meet, else along the way that is listed first.
"""

from collections import defaultdict
from typing import NamedTuple

from tpss.importers.tracks import OTHER_END, End, Section, Tracks


class Link(NamedTuple):
    """A track section in a chain."""

    section: Section
    sign: int
    """1 from its beginning to its end, -1 the other way."""
    start_m: float
    """Where it begins in the chain."""

    @property
    def end_m(self) -> float:
        """Where it ends in the chain. [m]"""
        return self.start_m + self.section.length_m

    def place_m(self, position_m: float) -> float:
        """Position in the chain of a position on the section. [m]"""
        if self.sign > 0:
            return self.start_m + position_m
        return self.end_m - position_m


Chain = list[Link]


class Spot(NamedTuple):
    """A place in a chain."""

    chain: int
    place_m: float


class Layout:
    """Chains, and where in them the places of track sections are."""

    def __init__(self, chains: list[Chain]) -> None:
        self.chains = chains
        self._links = {
            link.section.id: (i, link) for i, chain in enumerate(chains) for link in chain
        }

    def link(self, track: str) -> tuple[int, Link]:
        """Number of the chain of a track section, and its place in it."""
        return self._links[track]

    def spot(self, track: str, position_m: float) -> Spot:
        """Place of a position on a track section, of its nearer end if it lies beyond."""
        i, link = self._links[track]
        return Spot(i, link.place_m(min(max(position_m, 0.0), link.section.length_m)))

    def end(self, end: End) -> Spot:
        """Place of an end of a track section."""
        track, name = end
        return self.spot(track, 0.0 if name == "BEGIN" else self._links[track][1].section.length_m)

    def length_m(self, chain: int) -> float:
        """Length of a chain. [m]"""
        return self.chains[chain][-1].end_m


def joins_of(tracks: Tracks) -> dict[End, End]:
    """Ends of sections that follow each other in a chain, both ways."""
    candidates = []
    for number, joint in enumerate(tracks.joints):
        for order, (a, b) in enumerate(joint.pairs):
            one, other = (tracks.sections[end[0]].joins_as for end in (a, b))
            if one == other or not one or not other:
                candidates.append((not joint.is_link, one != other, order, number, a, b))
    joins: dict[End, End] = {}
    for *_, a, b in sorted(candidates):
        if a not in joins and b not in joins and a != b:
            joins |= {a: b, b: a}
    return joins


def chains_of(tracks: Tracks, joins: dict[End, End]) -> list[Chain]:
    """Chains of all the track sections, in the order of the file.

    Each runs towards rising kilometres, as most of it does; without any as most of it does.
    """
    sections = tracks.sections
    seen: set[str] = set()
    chains: list[Chain] = []
    for track in sections:
        if track in seen:
            continue
        walk = _walk((track, "END"), joins)
        last, sign = walk[-1]
        if joins.get((last, "END" if sign > 0 else "BEGIN")) != (track, "BEGIN"):
            back = _walk((track, "BEGIN"), joins)
            walk = [(name, -sign) for name, sign in back[:0:-1]] + walk
        seen |= {name for name, _ in walk}
        chains.append(_chain([(sections[name], sign) for name, sign in walk]))
    return chains


def _walk(end: End, joins: dict[End, End]) -> list[tuple[str, int]]:
    """Sections from one on, which is left at an end, with their signs in this direction."""
    first = end[0]
    walk = [(first, 1 if end[1] == "END" else -1)]
    while end in joins:
        track, entered = joins[end]
        if track == first:
            break
        walk.append((track, 1 if entered == "BEGIN" else -1))
        end = (track, OTHER_END[entered])
    return walk


def _chain(walk: list[tuple[Section, int]]) -> Chain:
    lengths: dict[int, float] = defaultdict(float)
    for section, sign in walk:
        lengths[sign * section.rises] += section.length_m
    if lengths[-1] > lengths[1]:
        walk = [(section, -sign) for section, sign in reversed(walk)]
    chain: Chain = []
    start_m = 0.0
    for section, sign in walk:
        chain.append(Link(section, sign, start_m))
        start_m = chain[-1].end_m
    return chain
