"""The way of a service in coordinates that grow along it: its stops, and the speed limits on it."""

import math
from typing import Any, NamedTuple

import tpss
from tpss.scenario.routes import Hop, find_way, hops_of


class Along(NamedTuple):
    """Places along a way. [m]"""

    stops_m: list[float]
    end_m: float
    limits: list[tuple[float, float]]
    """Where limits begin, and these in km/h; the first one has no beginning."""


def along_way(scenario: tpss.Scenario, entry: Any) -> Along:
    """The way of a service: from its first station it counts as the kilometres there, or minus these."""
    lines = scenario.lines_by_name
    stations = {
        name: {station.name: station.position_km for station in line.stations}
        for name, line in lines.items()
    }
    calls = [stop.station for stop in entry.stops]
    way = find_way(hops_of(stations), entry.origin, calls, entry.destination, entry.via)
    reached_m: list[float] = []
    limits: list[tuple[float, float]] = []
    shift_m = 0.0
    for i, hop in enumerate(way.hops):
        begin_m = reached_m[-1] if i else hop.sign * 1e3 * hop.begin_km
        if i == 0 or (way.hops[i - 1].line, way.hops[i - 1].sign) != (hop.line, hop.sign):
            shift_m = begin_m - hop.sign * 1e3 * hop.begin_km
        end_m = hop.sign * 1e3 * hop.end_km + shift_m
        reached_m.append(end_m)
        seen = [(from_m + shift_m, limit) for from_m, limit in _seen(lines[hop.line], hop)]
        if i:  # of the first line, limits behind the first station may hold under a tail
            held = [limit for from_m, limit in seen if from_m <= begin_m][-1]
            limits.append((begin_m, held))
        limits += [each for each in seen if (i == 0 or begin_m < each[0]) and each[0] < end_m]
        if i + 1 == len(way.hops):
            limits += [each for each in seen if each[0] >= end_m]
    return Along([reached_m[i] for i in way.stops], reached_m[-1], limits)


def _seen(line: Any, hop: Hop) -> list[tuple[float, float]]:
    """Limits over plus or minus the kilometres of a line, in the direction of a hop."""
    given = (line.speed_limits_down if hop.sign < 0.0 else ()) or line.speed_limits
    begins_m = [-math.inf, *(1e3 * limit.from_km for limit in given[1:])]
    ends_m = [*begins_m[1:], math.inf]
    pieces = zip(begins_m, ends_m, (limit.speed_kmh for limit in given), strict=True)
    if hop.sign > 0.0:
        return [(begin, speed) for begin, _, speed in pieces]
    return [(-end, speed) for _, end, speed in pieces][::-1]
