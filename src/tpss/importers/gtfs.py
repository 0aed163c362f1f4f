"""Routes of a GTFS feed as lines of stations and a timetable."""

from collections import Counter
from collections.abc import Iterable, Mapping
from datetime import date
from itertools import pairwise
from math import ceil
from pathlib import Path

from tpss.errors import Finding, ScenarioError
from tpss.importers.gtfs_feed import Feed
from tpss.importers.gtfs_shapes import with_shape_distances
from tpss.importers.gtfs_stations import Distances, Stations, lines_of
from tpss.importers.gtfs_trips import Calendar, StopTime, Trip, chosen_routes, trips_of
from tpss.importers.network import ImportedNetwork, NetworkLine, own_name, plain_name
from tpss.importers.quantities import DIGITS
from tpss.importers.timetable import Call, Service, Train, Window, ends_told
from tpss.importers.ways import with_passes

DWELL_S = 30.0
"""Where a feed has the same time of arrival and of departure, or none. [s]"""

LEAST_LIMIT_KMH, LARGEST_LIMIT_KMH = 80.0, 500.0
LIMIT_OVER_MEAN = 2.0
"""The speed limit that is assumed, over the highest mean speed of a trip."""

TABLES_LEFT_OUT = {
    "shapes.txt": "the course of trips, but for its length between stations",
    "transfers.txt": "trains do not wait for others",
    "fare_attributes.txt": "fares",
    "fare_rules.txt": "fares",
    "pathways.txt": "ways within stations",
}


def read(path: Path, routes: list[str], day: date | None = None) -> ImportedNetwork:
    """Lines and trains of some routes on one day, by default the first one with the most trips.

    Raises
    ------
    ScenarioError
        The feed cannot be read, has faults, or no such route or trips.
    """
    feed = Feed(path)
    names = chosen_routes(feed, routes)
    chosen, trips = _trips_on(feed, names, day)
    stations = Stations(feed, {stop.stop for trip in trips for stop in trip.stops})
    usable = [trip for trip in trips if _is_usable(trip, stations)]
    distances = Distances(with_shape_distances(feed, usable, stations.place_of_stop), stations)
    patterns = {_pattern(trip, stations) for trip in usable}
    km = lines_of(patterns, distances, stations.places)
    limit_kmh = _limit_kmh(usable, stations, km)
    network = ImportedNetwork(
        plain_name("_".join(names.values())),
        (path,),
        "GTFS",
        _lines(km, plain_name(next(iter(names.values()))), limit_kmh),
        taken=[
            f"day: {chosen.isoformat()}" + ("" if day else ", the first one with the most trips")
        ],
        left_out=[f"{name}: {why}" for name, why in TABLES_LEFT_OUT.items() if name in feed],
        assumed=_assumed(distances, limit_kmh),
    )
    _add_trains(network, usable, names, stations)
    trains = [*network.trains, *(service.train for service in network.services)]
    if any(call.min_dwell_s == DWELL_S for train in trains for call in train.calls):
        network.assumed.append(f"stops of {DWELL_S:g} s where a feed has no duration")
    if len(usable) < len(trips):
        network.left_out.append(
            "trips of fewer than two stations, or without times at their ends: "
            f"{len(trips) - len(usable)}"
        )
    return network


def _trips_on(feed: Feed, routes: Mapping[str, str], day: date | None) -> tuple[date, list[Trip]]:
    """A day, the first one with the most trips if none is given, and the trips that run on it."""
    every = trips_of(feed, routes)
    calendar = Calendar(feed, {trip.service for trip in every})
    chosen = day or calendar.busiest(Counter(trip.service for trip in every))
    running = calendar.services_on(chosen)
    trips = [trip for trip in every if trip.service in running]
    if not trips:
        place = (str(feed.path), "--date", chosen.isoformat())
        problem, remedy = "no trip of the routes runs on that day", "give another --date"
        raise ScenarioError([Finding(*place, problem, remedy)])
    return chosen, trips


def _pattern(trip: Trip, stations: Stations) -> tuple[str, ...]:
    """Stations of a trip, in order."""
    names = [stations.name_of[stop.stop] for stop in trip.stops]
    return tuple(name for i, name in enumerate(names) if i == 0 or names[i - 1] != name)


def _is_usable(trip: Trip, stations: Stations) -> bool:
    if len(_pattern(trip, stations)) < 2:
        return False
    first, last = trip.stops[0], trip.stops[-1]
    return first.departure_s is not None and (
        bool(trip.windows) or last.arrival_s is not None or last.departure_s is not None
    )


def _lines(
    positions_km: Iterable[Mapping[str, float]], name: str, limit_kmh: float
) -> list[NetworkLine]:
    lines: list[NetworkLine] = []
    for stations in positions_km:
        rounded = {station: round(km, DIGITS) for station, km in stations.items()}
        lines.append(
            NetworkLine(
                own_name(name, [line.name for line in lines]),
                max(rounded.values()),
                rounded,
                [(0.0, 0.0)],
                [(0.0, limit_kmh)],
            )
        )
    return lines


def _limit_kmh(
    trips: Iterable[Trip], stations: Stations, lines: Iterable[Mapping[str, float]]
) -> float:
    """A speed limit at which the trips can keep their times, as a rule. [km/h]"""
    lines = list(lines)
    fastest = 0.0
    for trip in trips:
        begin_s, end_s = trip.stops[0].departure_s, trip.stops[-1].arrival_s
        if begin_s is None or end_s is None or end_s <= begin_s:
            continue
        length_km = 0.0
        for one, other in pairwise(_pattern(trip, stations)):
            both = [abs(line[other] - line[one]) for line in lines if one in line and other in line]
            length_km += min(both, default=0.0)
        fastest = max(fastest, 3600.0 * length_km / (end_s - begin_s))
    rounded = 10.0 * ceil(LIMIT_OVER_MEAN * fastest / 10.0)
    return min(max(rounded, LEAST_LIMIT_KMH), LARGEST_LIMIT_KMH)


def _add_trains(
    network: ImportedNetwork, trips: Iterable[Trip], routes: Mapping[str, str], stations: Stations
) -> None:
    trains: list[Train] = []
    services: list[tuple[Train, Trip]] = []
    taken: set[str] = set()
    for trip in trips:
        name = own_name(" ".join(trip.name.split()), taken)
        taken.add(name)
        train = Train(name, plain_name(routes[trip.route], "train"), _calls(trip, stations))
        if _windows(trip):
            services.append((_from_departure(train), trip))
        elif not trip.windows:
            trains.append(train)
    found, lost = with_passes(trains, network.stations)
    network.trains.extend(found)
    running, lost_services = with_passes([train for train, _ in services], network.stations)
    windows = {train.name: _windows(trip) for train, trip in services}
    network.services.extend(Service(train, windows[train.name]) for train in running)
    if found:
        network.taken.append(f"trips: {len(found)}, as trains of the timetable")
    if running:
        network.taken.append(f"trips with frequencies: {len(running)}, as services")
    if lost or lost_services:
        network.left_out.append(f"trips without a way over the lines: {lost + lost_services}")


def _windows(trip: Trip) -> tuple[Window, ...]:
    """Times when a trip runs again and again; the end of each is not one of a departure."""
    windows = []
    for begin_s, end_s, headway_s in trip.windows:
        count = ceil((end_s - begin_s) / headway_s)
        if count > 0:
            windows.append(Window(begin_s, begin_s + (count - 1) * headway_s, headway_s))
    return tuple(windows)


def _calls(trip: Trip, stations: Stations) -> tuple[Call, ...]:
    calls: list[Call] = []
    for stop in trip.stops:
        station = stations.name_of[stop.stop]
        if not calls or calls[-1].station != station:
            calls.append(_call(station, stop))
    return ends_told(calls)


def _call(station: str, stop: StopTime) -> Call:
    arrival_s = stop.arrival_s if stop.arrival_s is not None else stop.departure_s
    departure_s = stop.departure_s if stop.departure_s is not None else stop.arrival_s
    if stop.passes:
        return Call(station, "pass", arrival_s=arrival_s)
    stands_s = departure_s - arrival_s if arrival_s is not None and departure_s is not None else 0.0
    return Call(station, "stop", arrival_s, departure_s, stands_s or DWELL_S)


def _from_departure(train: Train) -> Train:
    """A train whose times count from its departure."""
    start_s = train.departure_s
    calls = [
        Call(
            call.station,
            call.kind,
            None if call.arrival_s is None else call.arrival_s - start_s,
            None if call.departure_s is None else call.departure_s - start_s,
            call.min_dwell_s,
        )
        for call in train.calls
    ]
    return Train(train.name, train.train_type, tuple(calls))


def _assumed(distances: Distances, limit_kmh: float) -> list[str]:
    told = []
    if distances.along:
        told.append(
            f"kilometres: {distances.along} distances along the shapes of trips, in {distances.unit} "
            "(the unit that fits the coordinates)"
        )
    if distances.straight:
        told.append(
            f"kilometres: {distances.straight} distances straight between the coordinates of stations, "
            "an estimate that is too short: tracks curve"
        )
    if distances.too_close:
        told.append(
            f"kilometres: {distances.too_close} stations less than 100 m apart are put at 100 m"
        )
    return [
        *told,
        "level track, and no curves: a feed has none",
        f"a speed limit of {limit_kmh:g} km/h: a feed has none; twice the highest mean speed of a trip",
    ]
