"""Tracks that trains use in both directions, on which they cannot pass each other.

These are all single tracks, and of several tracks beside each other those stretches of one that the
routes use both ways, as services may give the tracks of their trains.  They end at stations of several
tracks, where trains may cross, where another number of tracks begins, and where the line ends; one of
several tracks ends where only one direction goes on on it.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from tpss.model.routes import Route
from tpss.model.tracks import pieces_of
from tpss.scenario.line import CLOSEST_KM, Line, Station

Span = tuple[float, float]
"""Ends of a stretch, in ascending order. [km]"""


class TwoWayTrack(NamedTuple):
    """A track that trains use in both directions, between places where they may cross."""

    line: str
    begin_km: float
    end_km: float
    track: int = 1


def single_tracks(name: str, line: Line) -> list[TwoWayTrack]:
    """Single tracks of a line, in ascending order."""
    return [
        TwoWayTrack(name, *ends)
        for begin_km, end_km, count in line.tracks_by_stretch
        if count == 1
        for ends in _between_crossings((begin_km, end_km), line)
    ]


def two_way_tracks(
    routes: Iterable[Route], lines: Mapping[str, Line]
) -> dict[str, list[TwoWayTrack]]:
    """Tracks that routes may use both ways, of each line: single ones, then those among several."""
    used: dict[tuple[str, int], tuple[set[Span], set[Span]]] = {}
    for route in dict.fromkeys(routes):
        for course, pieces in zip(route.courses, pieces_of(route, lines), strict=True):
            for piece in pieces:
                ways = used.setdefault((course.line, piece.track), (set(), set()))
                ways[course.sign < 0.0].add((piece.begin_km, piece.end_km))
    found = {name: single_tracks(name, line) for name, line in lines.items()}
    for (name, track), ways in sorted(used.items()):
        found[name] += [
            TwoWayTrack(name, *ends, track)
            for span in _used_both_ways(*ways, lines[name])
            for ends in _between_crossings(span, lines[name])
        ]
    return found


def _used_both_ways(up: Iterable[Span], down: Iterable[Span], line: Line) -> list[Span]:
    """Stretches of several tracks on which both directions use one of them. [km]"""
    several = [(begin, end) for begin, end, count in line.tracks_by_stretch if count > 1]
    needed = [list(up), list(down), several]
    borders = sorted({km for spans in needed for span in spans for km in span})
    found: list[Span] = []
    for begin_km, end_km in pairwise(borders):
        if not all(_cover(spans, begin_km, end_km) for spans in needed):
            continue
        if found and found[-1][1] == begin_km:
            begin_km = found.pop()[0]
        found.append((begin_km, end_km))
    return [(begin_km, end_km) for begin_km, end_km in found if end_km - begin_km > CLOSEST_KM]


def _cover(spans: Sequence[Span], begin_km: float, end_km: float) -> bool:
    return any(begin <= begin_km and end_km <= end for begin, end in spans)


def _between_crossings(span: Span, line: Line) -> list[Span]:
    """Parts of a stretch between stations of several tracks, and its ends. [km]"""
    begin_km, end_km = span
    inside = [s.position_km for s in line.stations if s.tracks > 1 and _lies(s, begin_km, end_km)]
    ends = [km for km in span if all(abs(km - s) > CLOSEST_KM for s in inside)]
    return list(pairwise(sorted([*inside, *ends])))


def _lies(station: Station, begin_km: float, end_km: float) -> bool:
    return begin_km - CLOSEST_KM < station.position_km < end_km + CLOSEST_KM
