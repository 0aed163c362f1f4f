"""Checks of the traffic: names of trains and stations, and the routes of the services.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from tpss.errors import no_such
from tpss.scenario.given_tracks import check_tracks, gives_tracks
from tpss.scenario.raw import CALLS, Ends, Fault, items, lines_of, number, places_of, table
from tpss.scenario.routes import (
    Hop,
    NoWayError,
    Way,
    calls_on,
    find_way,
    hops_of,
)
from tpss.units import kilometres


def check_traffic(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Faults of services: of names, and of routes that cannot be run."""
    trains = list(table(document, "trains"))
    lines = {name: line for name, (_, line) in lines_of(document).items()}
    stations = {name: places_of(line) for name, line in lines.items()}
    yield from _service_names(document)
    network = hops_of(stations)
    names = list(network)
    if not names:
        return  # lines without stations have faults of their own
    ways: list[Fault] = []
    tracks: list[Fault] = []
    for i, entry in items(document, "traffic"):
        key = f"traffic.{i}"
        yield from _names(key, entry, trains, names)
        known = all(isinstance(name, str) and name in network for name in _calls(entry))
        if len(stations) == 1 and not _turns_or_chooses(entry):
            (places,) = stations.values()
            faults = list(_along_line(key, entry, places))
            yield from faults
        else:
            faults = list(_over_network(key, entry, network, list(stations))) if known else []
            ways += faults
        if known and not faults and gives_tracks(entry):
            tracks += _tracks(key, entry, network, lines)
    yield from _each_once([*ways, *tracks])


def _each_once(faults: Iterable[Fault]) -> Iterator[Fault]:
    """Faults of many services that are the same, told once each, with how many there are."""
    alike: dict[str, list[Fault]] = {}
    for fault in faults:
        alike.setdefault(fault[2], []).append(fault)
    for (key, value, problem, remedy), *others in alike.values():
        more = f"; and {len(others)} more like it" if others else ""
        yield key, value, problem + more, remedy


def _service_names(document: Mapping[str, Any]) -> Iterator[Fault]:
    """The n-th train of a service is called "<service> n" or "<service> initial n".

    A single train has the name of its service.
    """
    entries = list(items(document, "traffic"))
    names = {i: entry["name"] for i, entry in entries if isinstance(entry.get("name"), str)}
    known = set(names.values())
    single = {i for i, entry in entries if "departure_min" in entry}
    for i, name in names.items():
        service, _, which = name.rpartition(" ")
        if which == "initial" and service in known:
            problem = "its trains would have the names of another service's initial trains"
            yield f"traffic.{i}.name", repr(name), problem, "give it another name"
        if i in single and which.isdecimal() and service.removesuffix(" initial") in known:
            problem = "a single train, whose name a train of another service has"
            yield f"traffic.{i}.name", repr(name), problem, "give it another name"


def _unknown(key: str, name: object, known: list[str], kind: str) -> Iterator[Fault]:
    if isinstance(name, str) and name not in known:
        yield key, repr(name), *no_such(kind, name, known)


def _names(
    key: str, entry: Mapping[str, Any], trains: list[str], stations: list[str]
) -> Iterator[Fault]:
    """Names of trains and stations that there are not."""
    yield from _unknown(f"{key}.train", entry.get("train"), trains, "train")
    begin, end = _ends_of(entry)
    yield from _unknown(f"{key}.from", begin, stations, "station")
    yield from _unknown(f"{key}.to", end, stations, "station")
    for calls in CALLS:
        for i, call in items(entry, calls):
            place = f"{key}.{calls}.{i}.station"
            yield from _unknown(place, call.get("station"), stations, "station")
    for i, name in enumerate(_via(entry)):
        yield from _unknown(f"{key}.via.{i}", name, stations, "station")


def _ends_of(entry: Mapping[str, Any]) -> tuple[object, object]:
    """Names of the stations where the trains of a service begin and end."""
    return entry.get("from", entry.get("origin")), entry.get("to", entry.get("destination"))


def _via(entry: Mapping[str, Any]) -> list[object]:
    given = entry.get("via")
    return list(given) if isinstance(given, list | tuple) else []


def _calls(entry: Mapping[str, Any]) -> list[object]:
    """Names of all stations that a service names."""
    return [
        *_ends_of(entry),
        *(call.get("station") for calls in CALLS for _, call in items(entry, calls)),
        *_via(entry),
    ]


def _turns_or_chooses(entry: Mapping[str, Any]) -> bool:
    """Whether a service turns round on its way, or says which way it takes."""
    return bool(_via(entry)) or any("turn_min" in stop for _, stop in items(entry, "stops"))


def _way_of(entry: Mapping[str, Any], network: Mapping[str, list[Hop]]) -> Way:
    """Way of the trains of a service.

    Raises
    ------
    NoWayError
        There is none, or two of the same length.
    """
    (begin, end), via = _ends_of(entry), [str(name) for name in _via(entry)]
    stops = [str(stop["station"]) for _, stop in items(entry, "stops")]
    return find_way(network, str(begin), stops, str(end), via)


def _over_network(
    key: str, entry: Mapping[str, Any], network: Mapping[str, list[Hop]], lines: list[str]
) -> Iterator[Fault]:
    """Faults of the way of a service over the lines, of its turns and of its trains on the way."""
    stops = [stop for _, stop in items(entry, "stops")]
    try:
        way = _way_of(entry, network)
        calls_on(way.hops, [str(each["station"]) for _, each in items(entry, "passes")], "passes")
    except NoWayError as error:
        yield f"{key}.{error.key}", repr(error.name), str(error), error.remedy
        return
    yield from _turns(key, stops, way)
    for i, train in items(entry, "initial_trains"):
        position = number(train, "position_km")
        line = train.get("line", lines[0] if len(lines) == 1 else None)
        if position is not None and line in lines and way.place(str(line), position) is None:
            problem = f"on {line}, but not on the way of its trains"
            place = f"{key}.initial_trains.{i}.position_km"
            yield place, kilometres(position), problem, "place it on the way of its trains"


def _tracks(
    key: str,
    entry: Mapping[str, Any],
    network: Mapping[str, list[Hop]],
    lines: Mapping[str, Mapping[str, Any]],
) -> Iterator[Fault]:
    """Faults of the tracks that a service gives."""
    try:
        way = _way_of(entry, network)
    except NoWayError:  # of stations at one place, which is a fault of its own
        return
    yield from check_tracks(key, entry, way, lines)


def _turns(key: str, stops: list[Mapping[str, Any]], way: Way) -> Iterator[Fault]:
    """Stops at which a train turns round without the time for it, or has time to turn and does not."""
    for hop in way.turns:
        if hop not in way.stops:
            station = way.hops[hop].end
            problem = f"its trains would turn round at {station}, without a stop there"
            remedy = f"add a stop at {station} with turn_min, or name other stations in via"
            yield f"{key}.stops", "", problem, remedy
    for i, (stop, hop) in enumerate(zip(stops, way.stops, strict=True)):
        station = way.hops[hop].end
        if hop in way.turns and "turn_min" not in stop:
            problem = f"it is missing: its trains turn round at {station}"
            yield f"{key}.stops.{i}.turn_min", "", problem, "add the time that it takes"
        elif hop not in way.turns and "turn_min" in stop:
            problem = f"its trains do not turn round at {station}"
            yield f"{key}.stops.{i}.turn_min", f"{stop['turn_min']}", problem, "leave it out"


def _route_km(entry: Mapping[str, Any], places: dict[str, float]) -> Ends | None:
    """Ends of a service's route, if both are known. [km]"""
    begin, end = _ends_of(entry)
    if not (isinstance(begin, str) and isinstance(end, str)):
        return None
    return (places[begin], places[end]) if begin in places and end in places else None


def _along_line(key: str, entry: Mapping[str, Any], places: dict[str, float]) -> Iterator[Fault]:
    """Faults of the direction of a service, of its stops and of its trains on the line."""
    route = _route_km(entry, places)
    if route is None:
        return
    (begin, end), (start_km, end_km) = _ends_of(entry), route
    words = f"{end} ({kilometres(end_km)} km)", f"{begin} ({kilometres(start_km)} km)"
    if end_km == start_km:
        problem = f"trains would begin and end at the same place, {kilometres(end_km)} km"
        yield f"{key}.to", repr(end), problem, "name another station"
        return
    sign = 1.0 if end_km > start_km else -1.0
    for calls in CALLS:
        yield from _in_order(f"{key}.{calls}", items(entry, calls), places, route)
    for i, train in items(entry, "initial_trains"):
        position = number(train, "position_km")
        if position is not None and not sign * start_km <= sign * position < sign * end_km:
            problem = f"not between {words[1]} and {words[0]}"
            place = f"{key}.initial_trains.{i}.position_km"
            yield place, kilometres(position), problem, "place it on the route of its trains"


def _in_order(
    key: str, calls: Iterator[tuple[int, Mapping[str, Any]]], places: dict[str, float], route: Ends
) -> Iterator[Fault]:
    before_km, end_km = route
    sign = 1.0 if end_km > before_km else -1.0
    for i, call in calls:
        name = call.get("station")
        if not isinstance(name, str) or name not in places:
            continue
        if not sign * before_km < sign * places[name] < sign * end_km:
            here, before, end = map(kilometres, (places[name], before_km, end_km))
            problem = f"at {here} km, not between {before} and {end} km"
            remedy = "list them in the order of travel, without the first and last station"
            yield f"{key}.{i}.station", repr(name), problem, remedy
        before_km = sign * max(sign * before_km, sign * places[name])
