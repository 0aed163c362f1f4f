"""Legs of the routes: on which line and track trains are, and which sections are above them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from tpss.model.contact_line import Run
from tpss.model.routes import Course, Route
from tpss.model.tracks import Piece, pieces_of
from tpss.record import Records
from tpss.scenario.line import Line
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
                for course, pieces in zip(route.courses, pieces_of(route, lines), strict=True)
                for number in [names.index(course.line)]
                for part in _parts(course, pieces, runs[number])
            ]
    rows: Any = Leg.blank(len(routes), max(map(len, known.values())))
    rows["from_m"] = math.inf
    for i, route in enumerate(routes):
        for k, leg in enumerate(known[route]):
            rows[i, k] = leg
    legs: Records[Leg] = rows
    return legs


def _parts(course: Course, pieces: Sequence[Piece], runs: Sequence[Run]) -> Iterator[_Part]:
    """Parts of a course in the order of travel, of which neighbours differ."""
    before: _Part | None = None
    for piece in (part for whole in pieces for part in _below_runs(whole, course.sign, runs)):
        run = next(each for each in runs if each.begin_km <= piece.begin_km < each.end_km)
        entered_m = course.position_m(1e3 * piece.entered_km(course.sign))
        from_m = course.from_m if before is None else entered_m
        part = _Part(from_m, piece.track, run.above(piece.track))
        if before is None or part[1:] != before[1:]:
            yield part
        before = part


def _below_runs(piece: Piece, sign: float, runs: Sequence[Run]) -> list[Piece]:
    """Parts of a piece of track, each below one range of the contact line, in the order of travel."""
    begin_km, end_km, track = piece
    borders = {km for run in runs for km in run[:2] if begin_km < km < end_km}
    parts = [Piece(*ends, track) for ends in pairwise(sorted({begin_km, end_km, *borders}))]
    return parts if sign > 0.0 else parts[::-1]
