"""Legs of the routes: on which line and track trains are, and which sections are above them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from tpss.model.contact_line import Run
from tpss.model.routes import Course, Route
from tpss.record import Records
from tpss.scenario.line import Line
from tpss.scenario.routes import Hop
from tpss.track.leg import Leg


class _Part(NamedTuple):
    """A part of a course on one track, below the sections of one range."""

    from_m: float
    track: int
    sections: tuple[int, int]


def build_legs(
    routes: Sequence[Route], lines: Mapping[str, Line], runs: Sequence[Sequence[Run]]
) -> Records[Leg]:
    """Legs, one row a route; what is left of a row begins nowhere.

    Parameters
    ----------
    routes : sequence of Route
    lines : mapping of str to Line
        All lines by their names.
    runs : sequence of sequences of Run
        Of the contact line of each.
    """
    names, known = list(lines), dict[Route, list[tuple[Any, ...]]]()
    for route in routes:
        if route not in known:
            known[route] = [
                (part.from_m, course.sign, course.offset_m, number, part.track, *part.sections)
                for course, hop in zip(route.courses, route.way.stretches, strict=True)
                for number in [names.index(course.line)]
                for part in _parts(course, hop, lines[course.line], runs[number])
            ]
    rows: Any = Leg.blank(len(routes), max(map(len, known.values())))
    rows["from_m"] = math.inf
    for i, route in enumerate(routes):
        for k, leg in enumerate(known[route]):
            rows[i, k] = leg
    legs: Records[Leg] = rows
    return legs


def _parts(course: Course, hop: Hop, line: Line, runs: Sequence[Run]) -> Iterator[_Part]:
    """Parts of a course in the order of travel, of which neighbours differ."""
    low, high = sorted((hop.begin_km, hop.end_km))
    counts = line.tracks_by_stretch
    borders = {km for piece in (*counts, *runs) for km in piece[:2] if low < km < high}
    pieces = list(pairwise(sorted({low, high, *borders})))
    before: _Part | None = None
    for begin_km, end_km in pieces if course.sign > 0.0 else pieces[::-1]:
        count = next(int(n) for begin, end, n in counts if begin <= begin_km < end)
        track = track_of(course.sign, count, line.left_hand_running)
        run = next(each for each in runs if each.begin_km <= begin_km < each.end_km)
        entered_km = begin_km if course.sign > 0.0 else end_km
        from_m = course.from_m if before is None else course.position_m(1e3 * entered_km)
        part = _Part(from_m, track, run.above(track))
        if before is None or part[1:] != before[1:]:
            yield part
        before = part


def track_of(sign: float, count: int, left_hand: bool) -> int:
    """Track that trains take in a direction; tracks count from the left, seen in rising kilometres."""
    return 1 if (sign > 0.0) == left_hand else count
