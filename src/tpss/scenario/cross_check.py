"""Checks between the parts of a scenario.

They read the document as it was written, not the validated parts, and skip what is missing or of
the wrong type, so that their faults are reported together with those of single fields.
"""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from tpss import library
from tpss.errors import Finding, closest
from tpss.scenario.machine import CurrentLimitation
from tpss.scenario.supply.supply import STATIONS
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named


def cross_check(document: Mapping[str, Any], file: str) -> list[Finding]:
    """All faults between the parts of a document."""
    line, supply = _table(document, "line"), _table(document, "supply")
    length = _number(line, "length_km")
    if length is not None and length <= 0.0:
        length = None  # a fault of its own; nothing can be measured against it
    findings = [*_line(line, length), *_supply(supply, length)]
    findings += _driver(_table(document, "simulation"))
    findings += _other_systems(document, supply.get("system", DEFAULT_SYSTEM))
    for i, zone in _items(_table(document, "standards"), "zones"):
        findings += _outside(f"standards.zones.{i}.to_km", _number(zone, "to_km"), length)
    places = {
        station["name"]: position
        for _, station in _items(line, "stations")
        if isinstance(station.get("name"), str)
        and (position := _number(station, "position_km")) is not None
    }
    trains = list(_table(document, "trains"))
    findings += _service_names(document)
    for i, entry in _items(document, "traffic"):
        findings += _traffic(f"traffic.{i}", entry, trains, places)
    return [Finding(file, *finding) for finding in findings]


_Fault = tuple[str, str, str, str]

LONGEST_AGGRESSIVE_STEP_MIN = 1.0
"""Longest step with the aggressive driver, and the longest in the thesis. [min]"""

CLOSEST_KM = 0.001 - 1e-9
"""Least distance between two feeding points, less a margin for rounding. [km]"""

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


def _outside(key: str, position: float | None, length: float | None) -> Iterator[_Fault]:
    if position is not None and length is not None and position > length:
        problem = f"outside the line, which ends at {length:g} km"
        yield key, f"{position:g}", problem, f"place it between 0 and {length:g} km"


def _line(line: Mapping[str, Any], length: float | None) -> Iterator[_Fault]:
    for i, station in _items(line, "stations"):
        yield from _outside(
            f"line.stations.{i}.position_km", _number(station, "position_km"), length
        )
    for i, curve in _items(line, "curves"):
        yield from _outside(f"line.curves.{i}.to_km", _number(curve, "to_km"), length)
    first = next((limit for _, limit in _items(line, "speed_limits")), {})
    begin = _number(first, "from_km")
    if begin is not None and begin > 0.0:
        problem = "no speed limit applies at the beginning of the line"
        remedy = "make the first limit begin at 0"
        yield "line.speed_limits.0.from_km", f"{begin:g}", problem, remedy


def _driver(simulation: Mapping[str, Any]) -> Iterator[_Fault]:
    step_min = _number(simulation, "time_step_min")
    if simulation.get("driver") != "aggressive" or step_min is None:
        return
    if step_min > LONGEST_AGGRESSIVE_STEP_MIN:
        problem = "too long for the aggressive driver, who checks the speed only once per step"
        remedy = f'use {LONGEST_AGGRESSIVE_STEP_MIN:g} min or less, or driver = "regulated"'
        yield "simulation.time_step_min", f"{step_min:g}", problem, remedy


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


def _supply(supply: Mapping[str, Any], length: float | None) -> Iterator[_Fault]:
    stations: list[float] = []
    listed = [(kind, i, each) for kind in STATIONS for i, each in _items(supply, kind)]
    for kind, i, station in listed:
        key = f"supply.{kind}.{i}.position_km"
        position = _number(station, "position_km")
        yield from _outside(key, position, length)
        if position is not None:
            yield from _too_close(key, position, [s for s in stations if s != position])
            stations.append(position)
    high_voltage = _table(supply, "high_voltage_line")
    yield from _placed_transformers(high_voltage, stations, length)
    yield from _spaced_transformers(high_voltage, sorted(stations))


def _too_close(key: str, position: float, others: list[float]) -> Iterator[_Fault]:
    """Two feeding points closer than a metre count as one: rounding may not separate them."""
    if any(abs(position - other) < CLOSEST_KM for other in others):
        problem = "closer than a metre to another converter station or transformer"
        yield key, f"{position:.17g}", problem, "leave one of them out, or place it elsewhere"


def _placed_transformers(
    high_voltage: Mapping[str, Any], stations: list[float], length: float | None
) -> Iterator[_Fault]:
    given = high_voltage.get("transformers_km")
    before: list[float] = []
    for i, position in enumerate(given if isinstance(given, list | tuple) else []):
        key = f"supply.high_voltage_line.transformers_km.{i}"
        number = _number({"position": position}, "position")
        yield from _outside(key, number, length)
        if number is None:
            continue
        if number < 0.0:
            yield key, f"{number:g}", "before the beginning of the line", "place it at 0 or beyond"
        if number in stations:
            problem = "a converter station is here, which has its own transformer"
            yield key, f"{number:g}", problem, "leave it out, or place it elsewhere"
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


def _traffic(
    key: str, entry: Mapping[str, Any], trains: list[str], places: dict[str, float]
) -> Iterator[_Fault]:
    yield from _unknown(f"{key}.train", entry.get("train"), trains, "train")
    begin = entry.get("from", entry.get("origin"))
    end = entry.get("to", entry.get("destination"))
    yield from _unknown(f"{key}.from", begin, list(places), "station")
    yield from _unknown(f"{key}.to", end, list(places), "station")
    for i, stop in _items(entry, "stops"):
        yield from _unknown(
            f"{key}.stops.{i}.station", stop.get("station"), list(places), "station"
        )
    if not (isinstance(begin, str) and isinstance(end, str)):
        return
    if begin not in places or end not in places:
        return
    start_km, end_km = places[begin], places[end]
    if end_km <= start_km:
        problem = f"{end} ({end_km:g} km) does not lie beyond {begin} ({start_km:g} km)"
        remedy = "trains run towards increasing positions: swap the two, or mirror the line"
        yield f"{key}.to", repr(end), problem, remedy
        return
    yield from _stops(key, entry, places, start_km, end_km)
    for i, train in _items(entry, "initial_trains"):
        position = _number(train, "position_km")
        if position is not None and position >= 0.0 and not start_km <= position < end_km:
            problem = f"not between {begin} ({start_km:g} km) and {end} ({end_km:g} km)"
            place = f"{key}.initial_trains.{i}.position_km"
            yield place, f"{position:g}", problem, "place it on the route of its trains"


def _stops(
    key: str, entry: Mapping[str, Any], places: dict[str, float], start_km: float, end_km: float
) -> Iterator[_Fault]:
    before_km = start_km
    for i, stop in _items(entry, "stops"):
        name = stop.get("station")
        if not isinstance(name, str) or name not in places:
            continue
        if not before_km < places[name] < end_km:
            problem = f"at {places[name]:g} km, not between {before_km:g} and {end_km:g} km"
            remedy = "list the stops in the order of travel, without the first and last station"
            yield f"{key}.stops.{i}.station", repr(name), problem, remedy
        before_km = max(before_km, places[name])
