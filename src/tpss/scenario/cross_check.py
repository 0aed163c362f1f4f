"""Checks between the parts of a scenario.

They read the document as it was written, not the validated parts, and skip what is missing or of
the wrong type, so that their faults are reported together with those of single fields.
"""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise, takewhile
from operator import gt
from typing import Any

from tpss import library
from tpss.errors import Finding, closest
from tpss.scenario.line import FARTHEST_KM, end_of_line
from tpss.scenario.machine import CurrentLimitation
from tpss.scenario.simulation import made_of_stepped_motion
from tpss.scenario.supply.supply import STATIONS
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named
from tpss.units import kilometres


def cross_check(document: Mapping[str, Any], file: str) -> list[Finding]:
    """All faults between the parts of a document."""
    line, supply = _table(document, "line"), _table(document, "supply")
    simulation = _table(document, "simulation")
    findings = [*_kilometres(document), *_stations_apart(supply)]
    findings += [*_open_step(simulation), *_driver(simulation), *_bands(document, simulation)]
    findings += _other_systems(document, supply.get("system", DEFAULT_SYSTEM))
    trains, falls = list(_table(document, "trains")), kilometres_fall(document)
    places = _places(line)
    findings += _service_names(document)
    for i, entry in _items(document, "traffic"):
        findings += _names(f"traffic.{i}", entry, trains, places)
        findings += [] if falls else _route(f"traffic.{i}", entry, places)
    return [Finding(file, *finding) for finding in findings]


_Fault = tuple[str, str, str, str]

_Ends = tuple[float, float]
"""Beginning and end of a line. [km]"""

LONGEST_AGGRESSIVE_STEP_MIN = 1.0
"""Longest step with the aggressive driver, and the longest in the thesis. [min]"""

CLOSEST_KM = 0.001 - 1e-9
"""Least distance between two feeding points, less a margin for rounding. [km]"""

ROUNDING = 1e-9
"""Share of a line's length by which rounding may lengthen it. [1]"""

PROFILES = ("gradients", "speed_limits")

SPEED_LIMITS = ("speed_limits", "speed_limits_down")

LARGEST = 1e300
"""Larger numbers count as this one: an integer in a file has any number of digits."""


def _table(document: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = document.get(key)
    return value if isinstance(value, Mapping) else {}


def _items(document: Mapping[str, Any], key: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    value = document.get(key)
    for i, item in enumerate(value if isinstance(value, list | tuple) else []):
        if isinstance(item, Mapping):
            yield i, item


def _number(table: Mapping[str, Any], key: str) -> float | None:
    value = table.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if not -math.inf < value < math.inf:
        return None
    return float(max(-LARGEST, min(value, LARGEST)))


def _places(line: Mapping[str, Any]) -> dict[str, float]:
    """Positions of a line's stations by name. [km]"""
    return {
        station["name"]: position
        for _, station in _items(line, "stations")
        if isinstance(station.get("name"), str)
        and (position := _number(station, "position_km")) is not None
    }


def kilometres_fall(document: Mapping[str, Any]) -> bool:
    """Whether trains run towards falling kilometres, and the profiles are in that order too."""
    line = _table(document, "line")
    places = _places(line)
    routes = [_route_km(entry, places) for _, entry in _items(document, "traffic")]
    known = [route for route in routes if route is not None]
    if not known or not all(end < start for start, end in known):
        return False
    profiles = [_column(line, key) for key in PROFILES]
    return max(map(len, profiles)) > 1 and all(all(map(gt, km, km[1:])) for km in profiles)


def _column(line: Mapping[str, Any], profile: str) -> list[float]:
    """Positions of a profile's items, in their order. [km]"""
    numbers = (_number(item, "from_km") for _, item in _items(line, profile))
    return [km for km in numbers if km is not None]


def _kilometres(document: Mapping[str, Any]) -> Iterator[_Fault]:
    """Faults of positions, or of what all of them have in common."""
    line = _table(document, "line")
    begin, ends = _beginning(line), _ends(line)
    if kilometres_fall(document):
        yield _falling(line, ends)
    elif ends is not None and (fault := _begins_elsewhere(document, ends)) is not None:
        yield fault
    else:
        if ends is not None:
            yield from (f for place in _positions(document) for f in _outside(*place, ends))
            yield from _profiles_outside(line, ends)
        if begin is not None:
            yield from _without_limit(line, begin)


def _beginning(line: Mapping[str, Any]) -> float | None:
    """Position where a line begins; None if that has a fault of its own. [km]"""
    begin = _number(line, "begins_at_km") if "begins_at_km" in line else 0.0
    return begin if begin is not None and abs(begin) <= FARTHEST_KM else None


def _ends(line: Mapping[str, Any]) -> _Ends | None:
    """Ends of a line; None if they are at fault, and nothing can be measured against them. [km]"""
    begin, length = _beginning(line), _number(line, "length_km")
    if begin is None or length is None or length <= 0.0:
        return None
    return begin, end_of_line(begin, length)


def _falling(line: Mapping[str, Any], ends: _Ends | None) -> _Fault:
    key = next(key for key in PROFILES if len(_column(line, key)) > 1)
    first, second = _column(line, key)[:2]
    problem = f"kilometres fall in the direction of travel: {second:g} follows {first:g}"
    begin = f"{-ends[1]:.12g}" if ends else "minus the kilometre where the line ends"
    remedy = (
        "profiles are given in rising kilometres: turn their order, and the sign of gradients; or write "
        "a minus sign before every position of the scenario, and line.begins_at_km = "
        f"{begin}; the order and all gradients stay as they are then"
    )
    return f"line.{key}.1.from_km", f"{second:g}", problem, remedy


def _positions(document: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Key paths and positions of all that stands on a line, initial trains left out. [km]"""
    line, supply = _table(document, "line"), _table(document, "supply")
    standing = [(f"line.stations.{i}.position_km", each) for i, each in _items(line, "stations")]
    for kind in STATIONS:
        items = _items(supply, kind)
        standing += [(f"supply.{kind}.{i}.position_km", station) for i, station in items]
    for i, curve in _items(line, "curves"):
        standing += [(f"line.curves.{i}.{key}", curve) for key in ("from_km", "to_km")]
    for i, zone in _items(_table(document, "standards"), "zones"):
        standing += [(f"standards.zones.{i}.{key}", zone) for key in ("from_km", "to_km")]
    placed = _table(supply, "high_voltage_line").get("transformers_km")
    for i, position in enumerate(placed if isinstance(placed, list | tuple) else []):
        key = f"supply.high_voltage_line.transformers_km.{i}"
        standing.append((key, {str(i): position}))
    for key, table in standing:
        number = _number(table, key.rpartition(".")[2])
        if number is not None:
            yield key, number


def _begins_elsewhere(document: Mapping[str, Any], ends: _Ends) -> _Fault | None:
    """The fault that a line begins elsewhere, where it would hold all of its positions."""
    line = _table(document, "line")
    positions = [position for _, position in _positions(document)]
    positions += [km for key in SPEED_LIMITS for km in _column(line, key)]
    low, high = min(positions, default=ends[0]), max(positions, default=ends[0])
    fits = high - low <= (ends[1] - ends[0]) * (1.0 + ROUNDING)
    if "begins_at_km" in line or not fits or (ends[0] <= low and high <= ends[1]):
        return None
    problem = (
        f"it is missing: without it the line runs from 0 to {kilometres(ends[1])} km, but its "
        f"positions lie between {kilometres(low)} and {kilometres(high)} km"
    )
    return "line.begins_at_km", "", problem, f"add begins_at_km = {low:.12g}"


def _outside(key: str, position: float, ends: _Ends) -> Iterator[_Fault]:
    begin, end = map(kilometres, ends)
    if not ends[0] <= position <= ends[1]:
        shown = kilometres(position)
        shown = f"{position:.17g}" if shown in (begin, end) else shown
        problem = f"outside the line, which runs from {begin} to {end} km"
        yield key, shown, problem, f"place it between {begin} and {end} km"


def _profiles_outside(line: Mapping[str, Any], ends: _Ends) -> Iterator[_Fault]:
    """Limits before the line, and gradients of which none begins on it.

    What continues beyond a line that was cut or shortened is noted by `tpss.cli.notes`.
    """
    for key in SPEED_LIMITS:
        for i, limit in _items(line, key):
            position = _number(limit, "from_km")
            if position is not None and position < ends[0]:
                yield from _outside(f"line.{key}.{i}.from_km", position, ends)
    gradients = (_number(item, "from_km") for _, item in _items(line, "gradients"))
    away = list(takewhile(lambda km: km is not None and not ends[0] <= km <= ends[1], gradients))
    if len(away) > 1 and len(away) == len(line["gradients"]):
        first, last = (kilometres(km or 0.0) for km in (away[0], away[-1]))
        begin, end = map(kilometres, ends)
        problem = (
            f"none of the gradients, from {first} to {last} km, begins on the line, which runs "
            f"from {begin} to {end} km"
        )
        remedy = "give them in the kilometres of the line, or correct line.begins_at_km"
        yield "line.gradients.0.from_km", first, problem, remedy


def _without_limit(line: Mapping[str, Any], begin_km: float) -> Iterator[_Fault]:
    for key in SPEED_LIMITS:
        first = next((limit for _, limit in _items(line, key)), {})
        position = _number(first, "from_km")
        if position is not None and position > begin_km:
            problem = "no speed limit applies at the beginning of the line"
            remedy = f"make the first limit begin at {kilometres(begin_km)}"
            yield f"line.{key}.0.from_km", kilometres(position), problem, remedy


def _open_step(simulation: Mapping[str, Any]) -> Iterator[_Fault]:
    """Least squares without a step: the runs that choose one would take too long."""
    if simulation.get("load_flow") == "least-squares" and "time_step_min" not in simulation:
        problem = "it is missing; least squares take too long for a step to be chosen"
        yield "simulation.time_step_min", "", problem, "add it"


def _driver(simulation: Mapping[str, Any]) -> Iterator[_Fault]:
    step_min = _number(simulation, "time_step_min")
    if simulation.get("driver") != "aggressive" or step_min is None:
        return
    if step_min > LONGEST_AGGRESSIVE_STEP_MIN:
        problem = "too long for the aggressive driver, who checks the speed only once per step"
        remedy = f'use {LONGEST_AGGRESSIVE_STEP_MIN:g} min or less, or driver = "regulated"'
        yield "simulation.time_step_min", f"{step_min:g}", problem, remedy


def _bands(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[_Fault]:
    """Retardations that depend on the speed, with stepped motion, whose plans know a single one."""
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    for name, train in _table(document, "trains").items():
        if choices and isinstance(train, Mapping) and _table(train, "max_retardation_m_s2"):
            problem = f"one for each band of speeds, which {choices[0]} does not know"
            remedy = f"give a number, or leave {choices[0]} out"
            yield f"trains.{name}.max_retardation_m_s2", "", problem, remedy


def _other_systems(document: Mapping[str, Any], system: object) -> Iterator[_Fault]:
    """Limits of another system than that of the supply."""
    if not isinstance(system, str) or system not in library.entries(SYSTEMS):
        return  # a fault of its own
    limits = _table(_table(document, "standards"), "voltage_limits")
    named = limits.get("system", system)
    if isinstance(named, str) and named != system and named in library.entries("voltage_limits"):
        problem = f"the limits of another system than that of the supply, {system}"
        remedy = "leave it out, or choose supply.system; single limits can be overridden next to it"
        yield "standards.voltage_limits.system", repr(named), problem, remedy
    nominal_kv = system_named(system).nominal_kv
    for name, train in _table(document, "trains").items():
        limitation = _table(train, "current_limitation") if isinstance(train, Mapping) else {}
        un_kv = _number(limitation, "un_kv") or CurrentLimitation.model_fields["un_kv"].default
        if limitation and un_kv != nominal_kv:
            problem = f"not the nominal voltage of the system {system}, {nominal_kv:g} kV"
            remedy = (
                f"write un_kv = {nominal_kv:g}, and umin2_kv and max_current_a that belong to it"
            )
            yield f"trains.{name}.current_limitation.un_kv", f"{un_kv:g}", problem, remedy


def _stations_apart(supply: Mapping[str, Any]) -> Iterator[_Fault]:
    """Feeding points that are too close to each other."""
    stations: list[float] = []
    listed = [(kind, i, each) for kind in STATIONS for i, each in _items(supply, kind)]
    for kind, i, station in listed:
        key = f"supply.{kind}.{i}.position_km"
        position = _number(station, "position_km")
        if position is not None:
            yield from _too_close(key, position, [s for s in stations if s != position])
            stations.append(position)
    high_voltage = _table(supply, "high_voltage_line")
    yield from _placed_transformers(high_voltage, stations)
    yield from _spaced_transformers(high_voltage, sorted(stations))


def _too_close(key: str, position: float, others: list[float]) -> Iterator[_Fault]:
    """Two feeding points closer than a metre count as one: rounding may not separate them."""
    if any(abs(position - other) < CLOSEST_KM for other in others):
        problem = "closer than a metre to another converter station or transformer"
        yield key, f"{position:.17g}", problem, "leave one of them out, or place it elsewhere"


def _placed_transformers(
    high_voltage: Mapping[str, Any], stations: list[float]
) -> Iterator[_Fault]:
    given = high_voltage.get("transformers_km")
    before: list[float] = []
    for i, position in enumerate(given if isinstance(given, list | tuple) else []):
        key = f"supply.high_voltage_line.transformers_km.{i}"
        number = _number({"position": position}, "position")
        if number is None:
            continue
        if number in stations:
            problem = "a converter station is here, which has its own transformer"
            yield key, kilometres(number), problem, "leave it out, or place it elsewhere"
        else:
            yield from _too_close(key, number, [*stations, *(km for km in before if km != number)])
        before.append(number)


def _spaced_transformers(
    high_voltage: Mapping[str, Any], stations: list[float]
) -> Iterator[_Fault]:
    count = _number(high_voltage, "transformers")
    if count is None or count <= 0.0:
        return
    key, shown = "supply.high_voltage_line.transformers", str(high_voltage["transformers"])
    if len(stations) < 2:
        problem = "there are no two converter stations between which to space them"
        yield key, shown, problem, "give transformers_km instead"
    elif min(b - a for a, b in pairwise(stations)) / (count + 1.0) < CLOSEST_KM:
        problem = "closer than a metre to each other between neighbouring converter stations"
        yield key, shown, problem, "use fewer, or give transformers_km instead"


def _service_names(document: Mapping[str, Any]) -> Iterator[_Fault]:
    """The n-th train of a service is called "<service> n" or "<service> initial n"."""
    entries = [(i, entry.get("name")) for i, entry in _items(document, "traffic")]
    names = {i: name for i, name in entries if isinstance(name, str)}
    for i, name in names.items():
        if name.endswith(" initial") and name.removesuffix(" initial") in names.values():
            problem = "its trains would have the names of another service's initial trains"
            yield f"traffic.{i}.name", repr(name), problem, "give it another name"


def _unknown(key: str, name: object, known: list[str], kind: str) -> Iterator[_Fault]:
    if isinstance(name, str) and name not in known:
        hint = f"did you mean {close}? " if (close := closest(name, known)) else ""
        listed = ", ".join(known) or "none"
        yield key, repr(name), f"there is no such {kind}", f"{hint}{kind}s: {listed}"


def _names(
    key: str, entry: Mapping[str, Any], trains: list[str], places: dict[str, float]
) -> Iterator[_Fault]:
    """Names of trains and stations that there are not."""
    yield from _unknown(f"{key}.train", entry.get("train"), trains, "train")
    begin, end = _ends_of(entry)
    yield from _unknown(f"{key}.from", begin, list(places), "station")
    yield from _unknown(f"{key}.to", end, list(places), "station")
    for i, stop in _items(entry, "stops"):
        yield from _unknown(
            f"{key}.stops.{i}.station", stop.get("station"), list(places), "station"
        )


def _ends_of(entry: Mapping[str, Any]) -> tuple[object, object]:
    """Names of the stations where the trains of a service begin and end."""
    return entry.get("from", entry.get("origin")), entry.get("to", entry.get("destination"))


def _route_km(entry: Mapping[str, Any], places: dict[str, float]) -> _Ends | None:
    """Ends of a service's route, if both are known. [km]"""
    begin, end = _ends_of(entry)
    if not (isinstance(begin, str) and isinstance(end, str)):
        return None
    return (places[begin], places[end]) if begin in places and end in places else None


def _route(key: str, entry: Mapping[str, Any], places: dict[str, float]) -> Iterator[_Fault]:
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
    yield from _stops(key, entry, places, route)
    for i, train in _items(entry, "initial_trains"):
        position = _number(train, "position_km")
        if position is not None and not sign * start_km <= sign * position < sign * end_km:
            problem = f"not between {words[1]} and {words[0]}"
            place = f"{key}.initial_trains.{i}.position_km"
            yield place, kilometres(position), problem, "place it on the route of its trains"


def _stops(
    key: str, entry: Mapping[str, Any], places: dict[str, float], route: _Ends
) -> Iterator[_Fault]:
    before_km, end_km = route
    sign = 1.0 if end_km > before_km else -1.0
    for i, stop in _items(entry, "stops"):
        name = stop.get("station")
        if not isinstance(name, str) or name not in places:
            continue
        if not sign * before_km < sign * places[name] < sign * end_km:
            here, before, end = map(kilometres, (places[name], before_km, end_km))
            problem = f"at {here} km, not between {before} and {end} km"
            remedy = "list the stops in the order of travel, without the first and last station"
            yield f"{key}.stops.{i}.station", repr(name), problem, remedy
        before_km = sign * max(sign * before_km, sign * places[name])
