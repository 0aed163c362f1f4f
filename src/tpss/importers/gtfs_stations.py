"""Stations of a GTFS feed, and the lines that its trips make of them.

The trip with the most stations is a line; what others serve besides becomes further lines, which begin
and end at stations of those that are there.  A feed knows no track: kilometres are those along the
shapes of its trips, or straight from station to station.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from tpss.errors import Finding, ScenarioError
from tpss.importers.gtfs_feed import REMEDY, Feed, Row
from tpss.importers.gtfs_trips import Trip
from tpss.importers.network import own_name

EARTH_KM = 6371.0
SAME_PLACE_KM = 2.0
"""Stops of one name that are no farther apart are one station. [km]"""

SHORTEST_KM = 0.1
"""Stations are at least so far apart: stops at one place are brought apart. [km]"""

DETOUR, DETOUR_KM = 2.0, 1.0
"""A trip runs along a line if that is not longer than twice the straight way and a kilometre."""

UNITS_KM = {"m": 1e-3, "km": 1.0, "mi": 1.609344, "ft": 3.048e-4}
"""What distances along shapes may be measured in."""

LIKELY_RATIOS = (0.95, 2.0)
"""Way along a shape over the straight way."""


class Place(NamedTuple):
    """Coordinates. [deg]"""

    latitude: float
    longitude: float


def straight_km(one: Place, other: Place) -> float:
    """Distance on the surface of the Earth. [km]"""
    a, b = math.radians(one.latitude), math.radians(other.latitude)
    across = math.radians(other.longitude - one.longitude)
    half = math.sin((b - a) / 2.0) ** 2 + math.cos(a) * math.cos(b) * math.sin(across / 2.0) ** 2
    return 2.0 * EARTH_KM * math.asin(min(1.0, math.sqrt(half)))


class Stations:
    """Stations by the stops of a feed: those of a parent station, or of one name, are one."""

    def __init__(self, feed: Feed, stops: set[str]) -> None:
        rows = {row["stop_id"]: row for row in feed.rows("stops.txt", "stop_id", "stop_name")}
        self.name_of: dict[str, str] = {}
        self.places: dict[str, Place] = {}
        self.place_of_stop: dict[str, Place] = {}
        if unknown := sorted(stops - set(rows)):
            table = str(feed.path / "stops.txt")
            problem = "stop_times.txt has a stop that is not there"
            raise ScenarioError([Finding(table, "stop_id", unknown[0], problem, REMEDY)])
        wanted: dict[str, str] = {}
        for stop in sorted(stops):
            row = rows.get(rows[stop]["parent_station"], rows[stop])
            place = _place(row)
            self.place_of_stop[stop] = _place(rows[stop])
            name = " ".join(row["stop_name"].split()) or stop
            near = (
                each
                for each, its_name in wanted.items()
                if its_name == name and straight_km(self.places[each], place) <= SAME_PLACE_KM
            )
            station = next(near, None) or own_name(name, self.places)
            wanted[station] = name
            self.name_of[stop] = station
            self.places.setdefault(station, place)


def _place(row: Row) -> Place:
    place = Place(row.number("stop_lat"), row.number("stop_lon"))
    if abs(place.latitude) > 90.0 or abs(place.longitude) > 360.0:
        column = "stop_lat" if abs(place.latitude) > 90.0 else "stop_lon"
        raise ScenarioError([row.finding(column, "not a coordinate in degrees")])
    return place


class Distances:
    """Distances between neighbouring stations, along shapes where the feed has them. [km]"""

    def __init__(self, trips: Iterable[Trip], stations: Stations) -> None:
        self._places = stations.places
        given: dict[frozenset[str], list[tuple[float, float]]] = defaultdict(list)
        for trip in trips:
            for a, b in pairwise(trip.stops):
                one, other = (stations.name_of[each.stop] for each in (a, b))
                if a.distance is None or b.distance is None:
                    continue
                straight = straight_km(self._places[one], self._places[other])
                if one != other and b.distance > a.distance and straight > 0.0:
                    given[frozenset((one, other))].append((b.distance - a.distance, straight))
        self.unit = _unit([pair for pairs in given.values() for pair in pairs])
        scale_km = UNITS_KM.get(self.unit, 0.0)
        self._along = {ends: scale_km * pairs[0][0] for ends, pairs in given.items() if self.unit}
        self.along, self.straight, self.too_close = 0, 0, 0
        """Numbers of the distances that were taken along shapes, straight, and as the least one."""

    def between(self, one: str, other: str) -> float:
        """Distance of two neighbouring stations. [km]"""
        along_km = self._along.get(frozenset((one, other)))
        if along_km is None:
            self.straight += 1
            along_km = straight_km(self._places[one], self._places[other])
        else:
            self.along += 1
        self.too_close += along_km < SHORTEST_KM
        return max(along_km, SHORTEST_KM)


def _unit(pairs: Sequence[tuple[float, float]]) -> str:
    """Unit of the distances along shapes, by which they are a little longer than the straight ways."""
    way, straight = (sum(column) for column in zip(*pairs, strict=True)) if pairs else (0.0, 0.0)
    if not straight:
        return ""
    ratios = {unit: way * km / straight for unit, km in UNITS_KM.items()}
    likely = {
        unit: ratio
        for unit, ratio in ratios.items()
        if LIKELY_RATIOS[0] <= ratio <= LIKELY_RATIOS[1]
    }
    return min(likely, key=lambda unit: likely[unit]) if likely else ""


def lines_of(
    patterns: Iterable[tuple[str, ...]], distances: Distances, places: Mapping[str, Place]
) -> list[dict[str, float]]:
    """Positions of the stations of lines over which all patterns lead. [km]

    Parameters
    ----------
    patterns : iterable of tuple
        Stations of trips, in order.
    distances : Distances
    places : mapping
        Coordinates of the stations.
    """
    lines: list[dict[str, float]] = []
    for pattern in sorted(set(patterns), key=lambda each: (-len(each), each)):
        for stretch in _uncovered(pattern, lines, places):
            lines += _cut(stretch, distances)
    return lines


def _uncovered(
    pattern: tuple[str, ...], lines: Sequence[Mapping[str, float]], places: Mapping[str, Place]
) -> list[list[str]]:
    """Stretches of a pattern that run along no line yet."""
    stretches: list[list[str]] = []
    known = {name for line in lines for name in line}
    for one, other in pairwise(pattern):
        longest_km = DETOUR * straight_km(places[one], places[other]) + DETOUR_KM
        covered = any(
            one in line and other in line and abs(line[other] - line[one]) <= longest_km
            for line in lines
        )
        if covered:
            continue
        if stretches and stretches[-1][-1] == one and one not in known:
            stretches[-1].append(other)
        else:
            stretches.append([one, other])
    return stretches


def _cut(stretch: Sequence[str], distances: Distances) -> list[dict[str, float]]:
    """Lines of a stretch, which is cut where it comes to a station again."""
    lines = [{stretch[0]: 0.0}]
    for one, other in pairwise(stretch):
        if other in lines[-1]:
            lines.append({one: 0.0})
        lines[-1][other] = lines[-1][one] + distances.between(one, other)
    return lines
