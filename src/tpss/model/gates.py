"""Gates of the routes: before two-way tracks, and where routes come together.

Where a route comes to a track of one direction on which others are already, from another line, from its
origin, from a turn or from a track beside it, all of them have gates.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tpss.model.routes import Course, Route
from tpss.model.tracks import Piece, pieces_of
from tpss.model.two_way_tracks import TwoWayTrack, two_way_tracks
from tpss.record import Records
from tpss.scenario.line import CLOSEST_KM, Line, Station
from tpss.step.turns import Gates
from tpss.track.gate import Gate

ROUNDING_M = 1e-6
"""Positions along a route that differ by less are one. [m]"""


class _Gate(NamedTuple):
    """A gate of a route, before its stretch has a number."""

    from_m: float
    until_m: float
    clears_whole: bool
    stretch: object
    direction: int
    end_km: float
    """Where a two-way track ends for it."""
    station: Station | None
    """At that end."""
    aside: bool


def build_gates(routes: Sequence[Route], lines: Mapping[str, Line], margin_m: float) -> Gates:
    """Gates of routes, one row a route, the last one of each infinite.

    Parameters
    ----------
    routes : sequence of Route
    lines : mapping of str to Line
        All lines by their names.
    margin_m : float
        Distance that is kept from a train ahead. [m]
    """
    two_way = two_way_tracks(routes, lines)
    entries = _entries(routes, two_way, lines)
    rows = []
    for route in routes:
        own = [
            *_before_two_way(route, two_way, lines),
            *_at_entries(route, entries, margin_m, lines),
        ]
        rows.append(
            sorted((_not_before_a_stop(g, route) for g in own), key=lambda gate: gate.from_m)
        )
    behind = [[_place_behind(gate, row[k + 1 :]) for k, gate in enumerate(row)] for row in rows]
    stretches = _numbered(gate.stretch for row in rows for gate in row)
    places = _numbered(place for names in behind for place in names if place is not None)
    gates: Any = _blank(len(routes), max(map(len, rows), default=0) + 1)
    for i, (row, names) in enumerate(zip(rows, behind, strict=True)):
        for k, (gate, name) in enumerate(zip(row, names, strict=True)):
            place = -1 if name is None else places[name]
            gates[i, k] = (*gate[:3], stretches[gate.stretch], gate.direction, place, gate.aside)
    tracks = [_tracks_at(name, lines) for name in places]
    return Gates(gates, np.array(tracks, dtype=np.int64))


def _not_before_a_stop(gate: _Gate, route: Route) -> _Gate:
    """A gate that lies just before a stop by rounding: at the stop, which trains have to reach."""
    near = (stop_m for stop_m in route.stops_m if 0.0 < stop_m - gate.from_m <= ROUNDING_M)
    return gate._replace(from_m=next(near, gate.from_m))


def _place_behind(gate: _Gate, following: Sequence[_Gate]) -> object | None:
    """Name of the crossing place behind a two-way track: a station, or line and kilometre."""
    if not (_meets_another(gate, following) and isinstance(gate.stretch, TwoWayTrack)):
        return None
    return (gate.stretch.line, gate.end_km) if gate.station is None else gate.station.name


def _tracks_at(place: object, lines: Mapping[str, Line]) -> int:
    """Number of tracks of a crossing place: at a station, of the line which says most; elsewhere one."""
    stations = (station for line in lines.values() for station in line.stations)
    return max((s.tracks for s in stations if s.name == place), default=1)


def no_gates(routes: int) -> Gates:
    """Rules of routes on which nobody waits."""
    return Gates(_blank(routes, 1), np.array([], dtype=np.int64))


def _blank(routes: int, gates: int) -> Records[Gate]:
    """Gates that are infinitely far."""
    blank = Gate.blank(routes, gates)
    blank["from_m"] = math.inf
    blank["stretch"] = blank["place"] = -1
    return blank


def crossing_places(
    route: Route, two_way: Mapping[str, Sequence[TwoWayTrack]], lines: Mapping[str, Line]
) -> list[Station]:
    """Stations at which trains of a route may have to wait between two two-way tracks."""
    row = sorted(_before_two_way(route, two_way, lines), key=lambda gate: gate.from_m)
    return [
        gate.station
        for k, gate in enumerate(row)
        if gate.station is not None
        and gate.station.tracks > 1
        and _meets_another(gate, row[k + 1 :])
    ]


def _numbered(names: Iterator[object]) -> dict[object, int]:
    numbers: dict[object, int] = {}
    for name in names:
        numbers.setdefault(name, len(numbers))
    return numbers


def _meets_another(gate: _Gate, following: Sequence[_Gate]) -> bool:
    """Whether trains come from one two-way track to the next at once, and may have to wait between."""
    if not isinstance(gate.stretch, TwoWayTrack) or not following:
        return False
    after = following[0]
    there = abs(after.from_m - gate.until_m) <= 1e3 * CLOSEST_KM
    return there and isinstance(after.stretch, TwoWayTrack)


def _pieces(route: Route, lines: Mapping[str, Line]) -> Iterator[tuple[Course, Piece]]:
    """Pieces of track that a route uses, in the order of travel."""
    for course, pieces in zip(route.courses, pieces_of(route, lines), strict=True):
        for piece in pieces:
            yield course, piece


def _before_two_way(
    route: Route, two_way: Mapping[str, Sequence[TwoWayTrack]], lines: Mapping[str, Line]
) -> Iterator[_Gate]:
    """Gates before the two-way tracks of a route."""
    for course, piece in _pieces(route, lines):
        for track in two_way[course.line]:
            begin_km = max(piece.begin_km, track.begin_km)
            end_km = min(piece.end_km, track.end_km)
            if piece.track != track.track or end_km - begin_km <= CLOSEST_KM:
                continue
            up = course.sign > 0.0
            first_km, last_km = (begin_km, end_km) if up else (end_km, begin_km)
            station = _station_at(last_km, lines[course.line])
            from_m = max(course.position_m(1e3 * first_km), route.start_m)
            until_m = course.position_m(1e3 * last_km)
            crosses = station is not None and station.tracks > 1
            whole = not crosses and until_m not in _turns_m(route)
            aside = from_m == route.start_m or _has_tracks(lines[course.line], first_km)
            direction = 0 if up else 1
            yield _Gate(from_m, until_m, whole, track, direction, last_km, station, aside)


def _turns_m(route: Route) -> list[float]:
    """Positions at which a route turns round."""
    return [after.from_m for before, after in pairwise(route.courses) if before.line == after.line]


def _station_at(place_km: float, line: Line) -> Station | None:
    return next((s for s in line.stations if abs(s.position_km - place_km) <= CLOSEST_KM), None)


def _has_tracks(line: Line, place_km: float) -> bool:
    """Whether there is a station of several tracks."""
    station = _station_at(place_km, line)
    return station is not None and station.tracks > 1


class _Entry(NamedTuple):
    """A place where routes come to a track of a line in one direction."""

    line: str
    sign: float
    place_km: float
    track: int


def _entries(
    routes: Iterable[Route], two_way: Mapping[str, Sequence[TwoWayTrack]], lines: Mapping[str, Line]
) -> list[_Entry]:
    """Places where routes come together on a track that only one direction uses."""
    comes_from: dict[_Entry, set[str | int]] = {}
    ways = [list(_pieces(route, lines)) for route in dict.fromkeys(routes)]
    for way in ways:
        came: tuple[Course, Piece] | None = None
        for course, piece in way:
            entry = _Entry(course.line, course.sign, piece.entered_km(course.sign), piece.track)
            comes_from.setdefault(entry, set()).add(_origin(came, course))
            came = course, piece
    for course, piece in (each for way in ways for each in way):
        for entry, origins in comes_from.items():
            if _runs_through(entry, course, piece):
                origins.add(entry.track)
    return [
        entry
        for entry, origins in comes_from.items()
        if len(origins) > 1 and not _is_two_way(entry, two_way[entry.line])
    ]


def _origin(came: tuple[Course, Piece] | None, course: Course) -> str | int:
    """Where trains come from to a piece of track: their origin (empty), a line, or a track beside it."""
    if came is None:
        return ""
    before, piece = came
    return piece.track if before == course else before.line


def _runs_through(entry: _Entry, course: Course, piece: Piece) -> bool:
    """Whether a route runs over a place on its track and in its direction, neither from nor to there."""
    if (course.line, course.sign, piece.track) != (entry.line, entry.sign, entry.track):
        return False
    return piece.begin_km + CLOSEST_KM < entry.place_km < piece.end_km - CLOSEST_KM


def _is_two_way(entry: _Entry, tracks: Sequence[TwoWayTrack]) -> bool:
    """Whether the track behind a place is used in both directions."""
    ahead_km = entry.place_km + entry.sign * CLOSEST_KM
    return any(
        each.track == entry.track and each.begin_km <= ahead_km <= each.end_km for each in tracks
    )


def _at_entries(
    route: Route, entries: Sequence[_Entry], margin_m: float, lines: Mapping[str, Line]
) -> Iterator[_Gate]:
    """Gates of a route where routes come together."""
    for course, piece in _pieces(route, lines):
        for entry in entries:
            same = (course.line, course.sign, piece.track) == (entry.line, entry.sign, entry.track)
            starts = same and abs(piece.entered_km(course.sign) - entry.place_km) <= CLOSEST_KM
            if starts or _runs_through(entry, course, piece):
                from_m = course.position_m(1e3 * entry.place_km)
                aside = from_m == route.start_m or _has_tracks(lines[course.line], entry.place_km)
                end_km = entry.place_km
                yield _Gate(from_m, from_m + margin_m, True, entry, 0, end_km, None, aside)
