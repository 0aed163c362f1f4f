r"""The contact line along a line of one or more tracks, as sections between nodes.

Where the contact lines of n like tracks are tied everywhere they are one, of impedance and capacitance

.. math:: z = \frac{z_s + (n - 1) z_m}{n}, \qquad c = n c_s,

with what each has by itself and what two of them have in common.  Elsewhere each track has sections of
its own between the places where they are tied, side by side and coupled by what they have in common.
"""

import math
from collections.abc import Callable, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

from tpss.model.parting import Joint, Parting, joined_over, set_apart
from tpss.powerflow.assembly import SectionPart
from tpss.scenario.line import DECIMALS
from tpss.scenario.outages import OutSection
from tpss.scenario.supply import Catenary, Conductors, Post, Supply
from tpss.scenario.supply.contact_line import WithoutContactLine
from tpss.units import kilometres, si

OUT = ", out"
"""Ends the words of nodes of sections that are out."""

BARE = ", without contact line"
"""Ends the words of nodes of stretches that have none."""


class LineLayout(NamedTuple):
    """What the supply has to know of a line."""

    name: str
    number: int
    begin_km: float
    end_km: float
    junctions: tuple[tuple[float, str], ...]
    """Positions and names of the stations where it meets others."""
    tracks: tuple[tuple[float, float, float], ...]
    """Beginning and end of stretches [km], and their number of tracks."""
    alone: bool
    """Whether there is no other line."""

    @property
    def prefix(self) -> str:
        """What stands before positions on it: its name, if there are several."""
        return "" if self.alone else f"{self.name} "

    def holds(self, line: str | None) -> bool:
        """Whether something with the name of a line stands on it."""
        return self.alone or line == self.name


class Stretch(NamedTuple):
    """A stretch of a line with one make of contact line."""

    begin_km: float
    end_km: float
    catenary: Catenary
    conductors: int
    """One for all tracks that are tied everywhere, otherwise one a track."""
    tracks: int
    ties_at_posts: bool

    def impedance_ohm_per_m(self) -> complex:
        """Series impedance of a conductor. [Ω/m]"""
        own = complex(si(self.catenary, "r_ohm_per_km"), si(self.catenary, "x_ohm_per_km"))
        if self.conductors == self.tracks:
            return own
        return (own + (self.tracks - 1) * self._common_ohm_per_m()) / self.tracks

    def mutual_ohm_per_m(self) -> complex:
        """What two conductors have in common. [Ω/m]"""
        return self._common_ohm_per_m() if self.conductors > 1 else 0j

    def _common_ohm_per_m(self) -> complex:
        """What the contact lines of two tracks have in common. [Ω/m]"""
        return complex(
            si(self.catenary, "mutual_r_ohm_per_km"), si(self.catenary, "mutual_x_ohm_per_km")
        )

    def susceptance_s_per_m(self, frequency_hz: float) -> float:
        """Shunt susceptance of a conductor. [S/m]"""
        own = 2 * math.pi * frequency_hz * si(self.catenary, "capacitance_nf_per_km")
        return own if self.conductors == self.tracks else self.tracks * own


class Run(NamedTuple):
    """A part of a line in which each track has the sections of one range above it."""

    begin_km: float
    end_km: float
    sections: tuple[tuple[int, int], ...]
    """Bounds of the sections of each conductor."""

    def above(self, track: int) -> tuple[int, int]:
        """Bounds of the sections above a track, counted from 1."""
        return self.sections[0 if len(self.sections) == 1 else track - 1]


def stretches_of(line: LineLayout, supply: Supply) -> list[Stretch]:
    """Stretches of a line, in ascending order."""
    others = [each for each in supply.contact_lines if line.holds(each.line)]
    ends = {line.begin_km, line.end_km, *(km for piece in line.tracks for km in piece[:2])}
    for each in others:
        ends |= {km for km in (each.from_km, each.to_km) if km is not None}
    return [_stretch(begin, end, line, supply) for begin, end in pairwise(sorted(ends))]


def _stretch(begin_km: float, end_km: float, line: LineLayout, supply: Supply) -> Stretch:
    catenary, tied = supply.catenary, supply.tracks_tied
    for each in supply.contact_lines:
        first = line.begin_km if each.from_km is None else each.from_km
        last = line.end_km if each.to_km is None else each.to_km
        if line.holds(each.line) and first <= begin_km and end_km <= last:
            catenary, tied = each.catenary or catenary, each.tracks_tied or tied
    tracks = int(next(count for begin, end, count in line.tracks if begin <= begin_km < end))
    conductors = 1 if tied == "everywhere" else tracks
    return Stretch(begin_km, end_km, catenary, conductors, tracks, tied == "posts")


def catenary_at(place_km: float, line: LineLayout, supply: Supply) -> Catenary:
    """Contact line at a place; that behind it where it changes. [km]"""
    stretches = stretches_of(line, supply)
    here = [each for each in stretches if each.begin_km <= place_km < each.end_km]
    return (here or stretches[-1:])[0].catenary


class Laid(NamedTuple):
    """The contact line of a line."""

    node: dict[float, int]
    """Nodes where all conductors are tied, by their places. [km]"""
    sections: list[SectionPart]
    names: list[str]
    """Of the sections."""
    runs: list[Run]
    joints: list[Joint]
    """Pairs of nodes that are one where nothing is parted."""
    guards: list[Joint]
    """Likewise nodes, and those of the ends of sections that may trip."""

    def coupled(self, first_section: int) -> list[tuple[int, ...]]:
        """Numbers of sections side by side that have an impedance in common, from a first number on."""
        return [
            side_by_side
            for run in self.runs
            for side_by_side in zip(*(range(*bounds) for bounds in run.sections), strict=True)
            if self.sections[side_by_side[0] - first_section].mutual_ohm_per_m != 0.0
        ]


def lay_contact_line(
    line: LineLayout,
    supply: Supply,
    feeding_km: set[float],
    make_node: Callable[[float, str], int],
    first_section: int,
    parting: Parting,
) -> Laid:
    """Lay out the contact line of a line.

    Parameters
    ----------
    line : LineLayout
    supply : Supply
    feeding_km : set of float
        Places where it is fed or meets other lines. [km]
    make_node : callable
        Gives the node at a place [km] its index; its second argument is what its name says beside the
        place.
    first_section : int
        Index of the first section.
    parting : Parting
        What is parted here that is not parted otherwise.
    """
    stretches = stretches_of(line, supply)
    marks = _marks_of(line, stretches, supply, feeding_km, parting)
    points = marks.points_km
    pieces = [_piece(*ends, stretches) for ends in pairwise(points)]
    node: dict[float, int] = {}
    starts: list[list[int]] = []
    stops: list[list[int]] = []
    joints: list[Joint] = []
    guards: list[Joint] = []
    for km, before, behind in zip(points, [None, *pieces], [*pieces, None], strict=True):
        sides = [each for each in (before, behind) if each is not None]
        words, parted = _words_at(km, sides, marks)
        tied = len({each for side in words for each in side}) == 1
        guarded: list[tuple[str, str]] = []
        if marks.out or marks.guarded or marks.bare:
            apart = [[marks.words_of(each, k) for k in range(each.conductors)] for each in sides]
            words, more = set_apart(words, apart, km in feeding_km)
            parted += [pair for pair in more if pair[0].endswith(OUT)]
            guarded = [(other, own) for own, other in more if not own.endswith((OUT, BARE))]
        # In the order of the words: what is drawn along the line goes from one to the next.
        known = [each for side in words for each in side]
        known += [each for pair in (*parted, *guarded) for each in pair]
        known += [""] * tied
        named = {each: make_node(km, each) for each in dict.fromkeys(known)}
        if tied:
            node[km] = named[""]
        joints += [(named[one], named[other]) for one, other in parted]
        guards += [(named[one], named[other]) for one, other in guarded]
        made = [[named[each] for each in side] for side in words]
        if before is not None:
            stops.append(made[0])
        if behind is not None:
            starts.append(made[-1])
    between = list(zip(pieces, starts, stops, strict=True))
    return Laid(node, *_sections(line, supply, between, first_section), joints, guards)


class _Marks(NamedTuple):
    """What there is along a line, beside its stretches, that makes nodes."""

    points_km: list[float]
    """All places with nodes, in order. [km]"""
    ties_km: set[float]
    """Where all conductors are tied. [km]"""
    posts_km: set[float]
    """Where they are tied for a part of the run only. [km]"""
    breaks: dict[float, str]
    """Names of the open breaks, and the neutral sections, by their places. [km]"""
    closing: frozenset[str]
    """Names of those breaks that are open for a part of the run only."""
    out: list[OutSection]
    """Sections that are out."""
    guarded: bool
    """Whether pieces may trip."""
    bare: list[WithoutContactLine]
    """Stretches without contact line."""

    def words_of(self, piece: "_Piece", conductor: int) -> str:
        """What tells the nodes of a conductor of a piece that is out, or may trip; otherwise nothing."""
        stretch = piece.stretch
        track = None if stretch.conductors < stretch.tracks else conductor + 1
        if any(s.from_km <= piece.begin_km and piece.end_km <= s.to_km for s in self.bare):
            return BARE
        if any(each.covers(piece.begin_km, piece.end_km, track) for each in self.out):
            return OUT
        if not (self.guarded and bears_overloads(stretch.catenary)):
            return ""
        return f", of {kilometres(piece.begin_km)}-{kilometres(piece.end_km)} km"


def _marks_of(
    line: LineLayout,
    stretches: Sequence[Stretch],
    supply: Supply,
    feeding_km: set[float],
    parting: Parting,
) -> _Marks:
    closed = [post for post in supply.posts if post.closed]
    closing = [post for post in supply.posts if post.name in parting.switches]
    ties_km = feeding_km | _posts_km(line, stretches, closed)
    posts_km = _posts_km(line, stretches, closing)
    breaks = {
        each.position_km: each.name
        for each in supply.section_breaks
        if not each.closed and line.holds(each.line)
    }
    breaks |= {
        each.middle_km: "neutral section"
        for each in supply.neutral_sections
        if line.holds(each.line)
    }
    out = [each for each in parting.sections if line.holds(each.line)]
    ends_km = {km for each in stretches for km in (each.begin_km, each.end_km)}
    ends_km |= {km for each in out for km in each.ends_km(line.begin_km, line.end_km)}
    bare = [each for each in supply.without_contact_line if line.holds(each.line)]
    ends_km |= {km for each in bare for km in (each.from_km, each.to_km)}
    points_km = sorted({*ends_km, *ties_km, *posts_km, *breaks})
    points_km = sorted({*points_km, *nodes_between_km(points_km, supply.conductors)})
    return _Marks(
        points_km, ties_km, posts_km, breaks, parting.switches, out, parting.guarded, bare
    )


def nodes_between_km(points_km: Sequence[float], conductors: Conductors | None) -> list[float]:
    """Further places of nodes, so that no piece of line is longer than is asked for. [km]"""
    if conductors is None:
        return []
    found = []
    for begin_km, end_km in pairwise(points_km):
        pieces = math.ceil((end_km - begin_km) / conductors.nodes_every_km - 1e-9)
        found += [
            round(begin_km + (end_km - begin_km) * k / pieces, DECIMALS) for k in range(1, pieces)
        ]
    return found


def bears_overloads(catenary: Catenary) -> bool:
    """Whether the rating of a contact line says which overloads it bears, and for how long."""
    return catenary.rating is not None and bool(catenary.rating.overloads)


def _words_at(
    km: float, sides: Sequence["_Piece"], marks: _Marks
) -> tuple[list[list[str]], list[tuple[str, str]]]:
    """What tells the nodes of the conductors before a place and behind it; those that a switch joins.

    Conductors of the same words have one node; without any words it is that of the whole place. [km]
    """
    counts = [each.conductors for each in sides]
    if km in marks.breaks and len(sides) == 2:
        name = marks.breaks[km]
        before, behind = (
            _words(count, f", {side} {name}")
            for side, count in zip(("before", "behind"), counts, strict=True)
        )
        return [before, behind], joined_over(before, behind) if name in marks.closing else []
    if km in marks.ties_km or min(counts) == 1 or counts[0] != counts[-1]:
        return [[""] * count for count in counts], []
    words = _words(counts[0], "")
    joints = [(words[0], each) for each in words[1:]] if km in marks.posts_km else []
    return [words] * len(sides), joints


class _Piece(NamedTuple):
    """A part of a stretch between neighbouring points."""

    begin_km: float
    end_km: float
    stretch: Stretch

    @property
    def conductors(self) -> int:
        """How many hang there."""
        return self.stretch.conductors


def _piece(begin_km: float, end_km: float, stretches: Sequence[Stretch]) -> _Piece:
    stretch = next(each for each in stretches if each.begin_km <= begin_km < each.end_km)
    return _Piece(begin_km, end_km, stretch)


def _posts_km(line: LineLayout, stretches: Sequence[Stretch], posts: Sequence[Post]) -> set[float]:
    """Places of posts where they have tracks to tie. [km]"""
    return {
        post.position_km
        for post in posts
        if line.holds(post.line)
        and any(
            each.begin_km <= post.position_km <= each.end_km
            and each.conductors > 1
            and each.ties_at_posts
            for each in stretches
        )
    }


def _words(count: int, more: str) -> list[str]:
    """What tells a node for each of so many conductors."""
    return [more] if count == 1 else [f", track {k + 1}{more}" for k in range(count)]


def _sections(
    line: LineLayout,
    supply: Supply,
    pieces: Sequence[tuple[_Piece, list[int], list[int]]],
    first: int,
) -> tuple[list[SectionPart], list[str], list[Run]]:
    """Sections of pieces between their nodes; those of a conductor follow each other in a run."""
    sections: list[SectionPart] = []
    names: list[str] = []
    runs: list[Run] = []
    for conductors, group in groupby(pieces, key=lambda each: each[0].stretch.conductors):
        run, bounds = list(group), []
        for k in range(conductors):
            begin = first + len(sections)
            for piece, starts, stops in run:
                stretch = piece.stretch
                sections.append(
                    SectionPart(
                        starts[k],
                        stops[k],
                        piece.begin_km * 1e3,
                        piece.end_km * 1e3,
                        stretch.impedance_ohm_per_m(),
                        stretch.susceptance_s_per_m(supply.frequency_hz),
                        stretch.mutual_ohm_per_m(),
                    )
                )
                place = f"{line.prefix}{kilometres(piece.begin_km)}-{kilometres(piece.end_km)} km"
                names.append(place if conductors == 1 else f"{place}, track {k + 1}")
            bounds.append((begin, first + len(sections)))
        runs.append(Run(run[0][0].begin_km, run[-1][0].end_km, tuple(bounds)))
    return sections, names, runs
