"""The route of the studied train as one line, so that a network is described by the same numbers."""

from typing import NamedTuple

from tpss.scenario.line import Gradient, Line, Piece, SpeedLimit
from tpss.scenario.routes import Hop, Way, find_way, hops_of
from tpss.scenario.scenario import Scenario

SAME_KM = 1e-6
"""Stations no further apart are the same one, where a route changes lines. [km]"""


class Route(NamedTuple):
    """The studied train's route on a line, in the direction in which positions grow."""

    line: Line
    """The line as the train sees it; the route itself if that leads over several, or turns."""
    begin_km: float
    end_km: float
    stations_km: list[float]
    """Positions of the feeding stations on it, ascending. [km]"""


def route_of(scenario: Scenario) -> Route:
    """Route of the trains of the first traffic entry."""
    lines, first = scenario.lines_by_name, scenario.traffic[0]
    turns = any(stop.turn_min is not None for stop in first.stops)
    if len(lines) > 1 or turns:
        return _along_way(scenario)
    (line,) = lines.values()
    places_km = {station.name: station.position_km for station in line.stations}
    begin_km, end_km = places_km[first.origin], places_km[first.destination]
    stations_km = sorted(station.position_km for station in scenario.supply.stations)
    if begin_km < end_km:
        return Route(line, begin_km, end_km, stations_km)
    return Route(line.mirrored(), -begin_km, -end_km, [-km for km in reversed(stations_km)])


def _along_way(scenario: Scenario) -> Route:
    """The route as a line of its own from 0 on, with what stands on it."""
    gradients: list[Piece] = []
    limits: list[Piece] = []
    stations_km: list[float] = []
    at_km = 0.0
    for stretch in _way_of(scenario).stretches:
        line = scenario.lines_by_name[stretch.line]
        seen = line if stretch.sign > 0.0 else line.mirrored()
        begin_km, end_km = stretch.sign * stretch.begin_km, stretch.sign * stretch.end_km
        moved_km = at_km - begin_km
        gradients += _moved(seen.gradients_between(begin_km, end_km), moved_km)
        limits += _moved(seen.speed_limits_between(begin_km, end_km), moved_km)
        for km in _stations_on(scenario, stretch):
            if not stations_km or km + moved_km > stations_km[-1] + SAME_KM:
                stations_km.append(km + moved_km)
        at_km += stretch.length_km
    whole = Line.model_construct(
        begins_at_km=0.0,
        length_km=at_km,
        gradients=tuple(Gradient(from_km=km, permille=value) for km, _, value in gradients),
        speed_limits=tuple(SpeedLimit(from_km=km, speed_kmh=value) for km, _, value in limits),
        stations=(),
    )
    return Route(whole, 0.0, at_km, stations_km)


def _way_of(scenario: Scenario) -> Way:
    places_km = {
        name: {station.name: station.position_km for station in line.stations}
        for name, line in scenario.lines_by_name.items()
    }
    first = scenario.traffic[0]
    stops = [stop.station for stop in first.stops]
    return find_way(hops_of(places_km), first.origin, stops, first.destination, first.via)


def _moved(pieces: list[Piece], by_km: float) -> list[Piece]:
    return [(begin + by_km, end + by_km, value) for begin, end, value in pieces]


def _stations_on(scenario: Scenario, stretch: Hop) -> list[float]:
    """Positions of the feeding stations on a stretch, as its trains see them, ascending. [km]"""
    low, high = sorted((stretch.begin_km, stretch.end_km))
    return sorted(
        stretch.sign * station.position_km
        for station in scenario.supply.stations
        if scenario.line_of(station) == stretch.line and low <= station.position_km <= high
    )
