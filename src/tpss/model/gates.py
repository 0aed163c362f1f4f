"""Gates of the routes: before single tracks between crossing places, and where routes come together.

A single track ends at a station of several tracks, where there are several tracks along the line, or
where the line ends.  Where a route comes to tracks of its direction on which others are already, from
another line, from its origin or from a turn, all of them have gates.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tpss.model.routes import Course, Route
from tpss.record import Records
from tpss.scenario.line import CLOSEST_KM, Line, Station
from tpss.scenario.routes import Hop
from tpss.step.turns import Gates
from tpss.track.gate import Gate


class SingleTrack(NamedTuple):
    """A single track between places where trains may cross."""

    line: str
    begin_km: float
    end_km: float


class _Gate(NamedTuple):
    """A gate of a route, before its stretch has a number."""

    from_m: float
    until_m: float
    clears_whole: bool
    stretch: object
    direction: int
    station: Station | None
    """At the end of a single track."""
    aside: bool


def single_tracks(name: str, line: Line) -> list[SingleTrack]:
    """Single tracks of a line, in ascending order."""
    found: list[SingleTrack] = []
    for begin_km, end_km, count in line.tracks_by_stretch:
        if count > 1:
            continue
        inside = [
            s.position_km for s in line.stations if s.tracks > 1 and _lies(s, begin_km, end_km)
        ]
        ends = [km for km in (begin_km, end_km) if all(abs(km - s) > CLOSEST_KM for s in inside)]
        found += [SingleTrack(name, *pair) for pair in pairwise(sorted([*inside, *ends]))]
    return found


def _lies(station: Station, begin_km: float, end_km: float) -> bool:
    return begin_km - CLOSEST_KM < station.position_km < end_km + CLOSEST_KM


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
    singles = {name: single_tracks(name, line) for name, line in lines.items()}
    entries = _entries(routes, singles)
    rows = []
    for route in routes:
        own = [
            *_before_singles(route, singles, lines),
            *_at_entries(route, entries, margin_m, lines),
        ]
        rows.append(sorted(own, key=lambda gate: gate.from_m))
    stretches = _numbered(gate.stretch for row in rows for gate in row)
    places: dict[str, int] = {}
    gates: Any = _blank(len(routes), max(map(len, rows), default=0) + 1)
    for i, row in enumerate(rows):
        for k, gate in enumerate(row):
            place = -1
            if _meets_there(gate, row[k + 1 :]):
                assert gate.station is not None
                place = places.setdefault(gate.station.name, len(places))
            gates[i, k] = (*gate[:3], stretches[gate.stretch], gate.direction, place, gate.aside)
    tracks = [_most_tracks(name, lines) for name in places]
    return Gates(gates, np.array(tracks, dtype=np.int64))


def _most_tracks(station: str, lines: Mapping[str, Line]) -> int:
    """Number of tracks of a station, that of the line which says most."""
    return max(s.tracks for line in lines.values() for s in line.stations if s.name == station)


def no_gates(routes: int) -> Gates:
    """Rules of routes on which nobody waits."""
    return Gates(_blank(routes, 1), np.array([], dtype=np.int64))


def _blank(routes: int, gates: int) -> Records[Gate]:
    """Gates that are infinitely far."""
    blank = Gate.blank(routes, gates)
    blank["from_m"] = math.inf
    blank["stretch"] = blank["place"] = -1
    return blank


def crossing_places(route: Route, lines: Mapping[str, Line]) -> list[Station]:
    """Stations at which trains of a route may have to wait between two single tracks."""
    singles = {name: single_tracks(name, line) for name, line in lines.items()}
    row = sorted(_before_singles(route, singles, lines), key=lambda gate: gate.from_m)
    return [
        gate.station
        for k, gate in enumerate(row)
        if gate.station is not None and gate.station.tracks > 1 and _meets_there(gate, row[k + 1 :])
    ]


def _numbered(names: Iterator[object]) -> dict[object, int]:
    numbers: dict[object, int] = {}
    for name in names:
        numbers.setdefault(name, len(numbers))
    return numbers


def _meets_there(gate: _Gate, following: Sequence[_Gate]) -> bool:
    """Whether trains that come from a stretch may have to wait at the station at its end."""
    if gate.station is None or not following:
        return False
    after = following[0]
    there = abs(after.from_m - gate.until_m) <= 1e3 * CLOSEST_KM
    return there and isinstance(after.stretch, SingleTrack)


def _courses(route: Route) -> Iterator[tuple[Course, Hop]]:
    yield from zip(route.courses, route.way.stretches, strict=True)


def _before_singles(
    route: Route, singles: Mapping[str, Sequence[SingleTrack]], lines: Mapping[str, Line]
) -> Iterator[_Gate]:
    """Gates before the single tracks of a route."""
    for course, hop in _courses(route):
        low_km, high_km = sorted((hop.begin_km, hop.end_km))
        for single in singles[course.line]:
            begin_km, end_km = max(low_km, single.begin_km), min(high_km, single.end_km)
            if end_km - begin_km <= CLOSEST_KM:
                continue
            up = course.sign > 0.0
            first_km, last_km = (begin_km, end_km) if up else (end_km, begin_km)
            station = _station_at(last_km, lines[course.line])
            from_m = max(course.position_m(1e3 * first_km), route.start_m)
            until_m = course.position_m(1e3 * last_km)
            crosses = station is not None and station.tracks > 1
            whole = not crosses and until_m not in _turns_m(route)
            aside = from_m == route.start_m or _has_tracks(lines[course.line], first_km)
            yield _Gate(from_m, until_m, whole, single, 0 if up else 1, station, aside)


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
    """A place where routes come to the tracks of a line in one direction."""

    line: str
    sign: float
    place_km: float


def _entries(routes: Sequence[Route], singles: Mapping[str, Sequence[SingleTrack]]) -> list[_Entry]:
    """Places where routes come together on several tracks, each on that of its direction."""
    comes_from: dict[_Entry, set[str]] = {}
    for route in routes:
        before = ""
        for course, hop in _courses(route):
            entry = _Entry(course.line, course.sign, hop.begin_km)
            comes_from.setdefault(entry, set()).add(before)
            before = course.line
    for route in routes:
        for course, hop in _courses(route):
            for entry, ways in comes_from.items():
                if _runs_through(entry, course, hop):
                    ways.add("through")
    return [
        entry
        for entry, ways in comes_from.items()
        if len(ways) > 1 and not _is_single(entry, singles[entry.line])
    ]


def _runs_through(entry: _Entry, course: Course, hop: Hop) -> bool:
    """Whether a route runs over a place in its direction, neither from there nor to there."""
    if (course.line, course.sign) != (entry.line, entry.sign):
        return False
    begin, here, end = (course.sign * km for km in (hop.begin_km, entry.place_km, hop.end_km))
    return begin + CLOSEST_KM < here < end - CLOSEST_KM


def _is_single(entry: _Entry, singles: Sequence[SingleTrack]) -> bool:
    """Whether there is a single track behind a place."""
    ahead_km = entry.place_km + entry.sign * CLOSEST_KM
    return any(single.begin_km <= ahead_km <= single.end_km for single in singles)


def _at_entries(
    route: Route, entries: Sequence[_Entry], margin_m: float, lines: Mapping[str, Line]
) -> Iterator[_Gate]:
    """Gates of a route where routes come together."""
    for course, hop in _courses(route):
        for entry in entries:
            starts = (course.line, course.sign) == (entry.line, entry.sign) and abs(
                hop.begin_km - entry.place_km
            ) <= CLOSEST_KM
            if starts or _runs_through(entry, course, hop):
                from_m = course.position_m(1e3 * entry.place_km)
                aside = from_m == route.start_m or _has_tracks(lines[course.line], entry.place_km)
                yield _Gate(from_m, from_m + margin_m, True, entry, 0, None, aside)
