r"""Routes of the services as coordinates that grow along them.

A train's position x is a coordinate along its own route, so that drivers and brakes know one direction
and one line.  On each course of a route, a stretch of one line in one direction σ, the place on the
line is

.. math:: p = \sigma x + x_0.

The first course has no offset: where a route stays on one line, x is the kilometre, or minus it.  Each
further course begins where the one before ends, at the same x.

A train turns round on the spot: of the train that came, what was its tail is its head then, at the same
place.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from tpss.scenario.rolling_stock import Train
from tpss.scenario.routes import Hop, Way, calls_on, find_way, hops_of
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic
from tpss.units import kilometres


class Course(NamedTuple):
    """A stretch of a route on one line, in one direction."""

    line: str
    sign: float
    """1.0 towards rising kilometres, -1.0 towards falling ones."""
    offset_m: float
    """Place on the line where the position is 0. [m]"""
    from_m: float
    """Position at which it begins; that of the first one has no beginning. [m]"""

    def position_m(self, place_m: float) -> float:
        """Position along the route of a place on the line. [m]"""
        return self.sign * (place_m - self.offset_m)


class Route(NamedTuple):
    """The route of a service."""

    courses: tuple[Course, ...]
    start_m: float
    """Position where it begins. [m]"""
    stops_m: tuple[float, ...]
    """Positions of its stops, the destination last. [m]"""
    way: Way
    tracks: tuple[int | None, ...] = ()
    """Track that is given for each hop of the way; None: trains take that of their direction."""

    def position_m(self, line: str, place_km: float) -> float:
        """Position of a place on the way, the first one if the way leads there twice. [m]"""
        hop = self.way.place(line, place_km)
        assert hop is not None, "the scenario was checked"
        return self.course_of(hop).position_m(1e3 * place_km)

    def post(self, position_m: float) -> str:
        """Kilometre of a position, on the line to which that belongs. [m]"""
        course = next(c for c in reversed(self.courses) if c.from_m <= position_m)
        return kilometres((course.sign * position_m + course.offset_m) / 1e3)

    def course_of(self, hop: int) -> Course:
        """Course to which a hop of the way belongs."""
        changes = sum(not _goes_on(*pair) for pair in pairwise(self.way.hops[: hop + 1]))
        return self.courses[changes]


class Running(NamedTuple):
    """A train of the scenario on the courses of a route."""

    train: Train
    courses: tuple[Course, ...] = ()
    name: str = ""


def routes_of(scenario: Scenario) -> list[Route]:
    """Routes of the services, in their order."""
    stations = {
        name: {station.name: station.position_km for station in line.stations}
        for name, line in scenario.lines_by_name.items()
    }
    hops, known = hops_of(stations), dict[tuple[object, ...], Route]()
    routes = []
    for entry in scenario.traffic:
        key = _calls(entry), _given_tracks(entry)
        if key not in known:
            way = find_way(hops, *_calls(entry))
            known[key] = _route(way, _tracks_on(way, entry))
        routes.append(known[key])
    return routes


def _calls(entry: Traffic) -> tuple[str, tuple[str, ...], str, tuple[str, ...]]:
    return entry.origin, tuple(stop.station for stop in entry.stops), entry.destination, entry.via


def _given_tracks(entry: Traffic) -> tuple[object, ...]:
    """Tracks that a service gives, and where."""
    stops = tuple(stop.track for stop in entry.stops)
    passes = tuple((each.station, each.track) for each in entry.passes if each.track is not None)
    return entry.track, stops, passes


def _tracks_on(way: Way, entry: Traffic) -> tuple[int | None, ...]:
    """Track that a service gives for each hop of its way, if it gives one."""
    passed = calls_on(way.hops, [each.station for each in entry.passes], "passes")
    given = {-1: entry.track}
    given |= {hop: each.track for hop, each in zip(passed, entry.passes, strict=True)}
    stops = zip(way.stops, entry.stops, strict=True)
    given |= {hop: stop.track for hop, stop in stops if stop.track is not None}
    return way.tracks({hop: track for hop, track in given.items() if track is not None})


def _route(way: Way, tracks: tuple[int | None, ...]) -> Route:
    courses: list[Course] = []
    reached_m: list[float] = []
    for i, hop in enumerate(way.hops):
        if i == 0:
            courses.append(Course(hop.line, hop.sign, 0.0, -math.inf))
        elif not _goes_on(way.hops[i - 1], hop):
            here_m, place_m = reached_m[-1], 1e3 * hop.begin_km
            courses.append(Course(hop.line, hop.sign, place_m - hop.sign * here_m, here_m))
        reached_m.append(courses[-1].position_m(1e3 * hop.end_km))
    start_m = courses[0].position_m(1e3 * way.hops[0].begin_km)
    stops_m = tuple(reached_m[i] for i in (*way.stops, -1))
    return Route(tuple(courses), start_m, stops_m, way, tracks)


def _goes_on(before: Hop, after: Hop) -> bool:
    """Whether a hop continues the course of the one before it."""
    return (before.line, before.sign) == (after.line, after.sign)


def running_trains(scenario: Scenario, routes: Sequence[Route]) -> list[Running]:
    """All trains up the first line, used or not, then those that run otherwise too."""
    first = next(iter(scenario.lines_by_name))
    up: tuple[Course, ...] = (Course(first, 1.0, 0.0, -math.inf),)
    every = dict.fromkeys((name, up) for name in scenario.trains)
    every |= dict.fromkeys(
        (entry.train, route.courses) for entry, route in zip(scenario.traffic, routes, strict=True)
    )
    return [Running(scenario.trains[name], courses, name) for name, courses in every]


def index_of(entry: Traffic, route: Route, running: Sequence[Running]) -> int:
    """Index of the trains of a service among all."""
    wanted = entry.train, route.courses
    return next(i for i, each in enumerate(running) if (each.name, each.courses) == wanted)
