"""Checks of positions: whether everything lies on its line, and the lines begin where they should.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from itertools import takewhile
from operator import gt
from typing import Any, NamedTuple

from tpss.errors import no_such
from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.raw import (
    Ends,
    Fault,
    beginning,
    column,
    ends_of,
    items,
    lines_of,
    number,
    places_of,
    table,
)
from tpss.scenario.supply.supply import STATIONS, STORAGE
from tpss.units import kilometres

ROUNDING = 1e-9
"""Share of a line's length by which rounding may lengthen it. [1]"""

PROFILES = ("gradients", "speed_limits")

SPEED_LIMITS = ("speed_limits", "speed_limits_down")


class Standing(NamedTuple):
    """Something that has a position."""

    key: str
    position_km: float
    line: str


def kilometres_fall(document: Mapping[str, Any]) -> bool:
    """Whether trains run towards falling kilometres, and the profiles are in that order too."""
    line = table(document, "line")
    places = places_of(line)
    routes = [_ends_km(entry, places) for _, entry in items(document, "traffic")]
    known = [route for route in routes if route is not None]
    if not known or not all(end < start for start, end in known):
        return False
    profiles = [column(line, key) for key in PROFILES]
    return max(map(len, profiles)) > 1 and all(all(map(gt, km, km[1:])) for km in profiles)


def _ends_km(entry: Mapping[str, Any], places: Mapping[str, float]) -> Ends | None:
    """Positions where the trains of a service begin and end, if both are known. [km]"""
    begin = entry.get("from", entry.get("origin"))
    end = entry.get("to", entry.get("destination"))
    if not (isinstance(begin, str) and isinstance(end, str)):
        return None
    return (places[begin], places[end]) if begin in places and end in places else None


def check_positions(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Faults of positions, or of what all of those of a line have in common."""
    lines = lines_of(document)
    if kilometres_fall(document):
        line = table(document, "line")
        yield _falling(line, ends_of(line))
        return
    yield from _named_lines(document, list(lines))
    standing = list(_positions(document, lines))
    for name, (key, line) in lines.items():
        own = [each for each in standing if each.line == name]
        begin, ends = beginning(line), ends_of(line)
        if ends is not None and (fault := _begins_elsewhere(key, line, own, ends)) is not None:
            yield fault
            continue
        if ends is not None:
            yield from (f for each in own for f in _outside(each.key, each.position_km, ends))
            yield from _profiles_outside(key, line, ends)
        if begin is not None:
            yield from _without_limit(key, line, begin)
    yield from _close_stations(lines)


def check_stations_named(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Stations at which something stands that are not there, or elsewhere than it says itself."""
    lines = {name: places_of(line) for name, (_, line) in lines_of(document).items()}
    known = list(dict.fromkeys(name for places in lines.values() for name in places))
    for key, part in _parts_on_lines(document):
        at, line, km = part.get("at"), part.get("line"), number(part, "position_km")
        if not isinstance(at, str):
            continue
        if at not in known:
            yield f"{key}.at", repr(at), *no_such("station", at, known)
        elif line in lines and at not in lines[str(line)]:
            yield f"{key}.at", repr(at), f"no station of {line}", "leave line out, or correct it"
        elif km is not None and km not in [p[at] for p in lines.values() if at in p]:
            yield f"{key}.position_km", kilometres(km), f"not where {at} is", "leave it out"


def _named_lines(document: Mapping[str, Any], names: list[str]) -> Iterator[Fault]:
    """What does not say on which of several lines it is, or on one that is not there."""
    for key, part in _parts_on_lines(document):
        given = part.get("line")
        if isinstance(given, str) and given not in names:
            yield f"{key}.line", repr(given), *no_such("line", given, names)
        elif given is None and len(names) > 1:
            remedy = f"add it; lines: {', '.join(names)}"
            yield f"{key}.line", "", "it is missing, and there are several lines", remedy


def _parts_on_lines(document: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Key paths and tables of all that names its line."""
    supply = table(document, "supply")
    for kind in (*STATIONS, STORAGE):
        yield from ((f"supply.{kind}.{i}", each) for i, each in items(supply, kind))
    for kind in (
        "contact_lines",
        "posts",
        "section_breaks",
        "neutral_sections",
        "without_contact_line",
        "autotransformers",
    ):
        yield from ((f"supply.{kind}.{i}", each) for i, each in items(supply, kind))
    if "high_voltage_line" in supply:
        yield "supply.high_voltage_line", table(supply, "high_voltage_line")
    for i, zone in items(table(document, "standards"), "zones"):
        yield f"standards.zones.{i}", zone
    for i, outage in items(document, "outages"):
        for kind in ("sections", "autotransformers"):
            yield from ((f"outages.{i}.{kind}.{k}", each) for k, each in items(outage, kind))
    for i, entry in items(document, "traffic"):
        for k, train in items(entry, "initial_trains"):
            yield f"traffic.{i}.initial_trains.{k}", train


def _positions(
    document: Mapping[str, Any], lines: Mapping[str, tuple[str, Mapping[str, Any]]]
) -> Iterator[Standing]:
    """All that stands on a line, initial trains left out."""
    only = next(iter(lines)) if len(lines) == 1 else ""
    for name, (key, line) in lines.items():
        for i, each in items(line, "stations"):
            yield from _standing(f"{key}.stations.{i}", each, ["position_km"], name)
        for i, curve in items(line, "curves"):
            yield from _standing(f"{key}.curves.{i}", curve, ["from_km", "to_km"], name)
    for key, part in _parts_on_lines(document):
        if ".initial_trains." not in key:
            line_of_it = part.get("line", only)
            yield from _standing(key, part, ["position_km", "from_km", "to_km"], line_of_it)
    supply = table(document, "supply")
    high_voltage = table(supply, "high_voltage_line")
    line_of_it = high_voltage.get("line", only)
    yield from _listed("supply.high_voltage_line", high_voltage, "transformers_km", line_of_it)
    for k, each in items(supply, "autotransformers"):
        line_of_it = each.get("line", only)
        yield from _listed(f"supply.autotransformers.{k}", each, "positions_km", line_of_it)


def _listed(key: str, part: Mapping[str, Any], name: str, line: str) -> Iterator[Standing]:
    """What stands at each place of a list."""
    placed = part.get(name)
    for i, position in enumerate(placed if isinstance(placed, list | tuple) else []):
        if (km := number({"": position}, "")) is not None:
            yield Standing(f"{key}.{name}.{i}", km, line)


def _standing(key: str, part: Mapping[str, Any], names: list[str], line: str) -> Iterator[Standing]:
    for name in names:
        if (km := number(part, name)) is not None:
            yield Standing(f"{key}.{name}", km, line)


def _falling(line: Mapping[str, Any], ends: Ends | None) -> Fault:
    key = next(key for key in PROFILES if len(column(line, key)) > 1)
    first, second = column(line, key)[:2]
    problem = f"kilometres fall in the direction of travel: {second:g} follows {first:g}"
    begin = f"{-ends[1]:.12g}" if ends else "minus the kilometre where the line ends"
    remedy = (
        "profiles are given in rising kilometres: turn their order, and the sign of gradients; or write "
        "a minus sign before every position of the scenario, and line.begins_at_km = "
        f"{begin}; the order and all gradients stay as they are then"
    )
    return f"line.{key}.1.from_km", f"{second:g}", problem, remedy


def _begins_elsewhere(
    key: str, line: Mapping[str, Any], standing: list[Standing], ends: Ends
) -> Fault | None:
    """The fault that a line begins elsewhere, where it would hold all of its positions."""
    positions = [each.position_km for each in standing]
    positions += [km for profile in SPEED_LIMITS for km in column(line, profile)]
    low, high = min(positions, default=ends[0]), max(positions, default=ends[0])
    fits = high - low <= (ends[1] - ends[0]) * (1.0 + ROUNDING)
    if "begins_at_km" in line or not fits or (ends[0] <= low and high <= ends[1]):
        return None
    problem = (
        f"it is missing: without it the line runs from 0 to {kilometres(ends[1])} km, but its "
        f"positions lie between {kilometres(low)} and {kilometres(high)} km"
    )
    return f"{key}.begins_at_km", "", problem, f"add begins_at_km = {low:.12g}"


def _outside(key: str, position: float, ends: Ends) -> Iterator[Fault]:
    begin, end = map(kilometres, ends)
    if not ends[0] <= position <= ends[1]:
        shown = kilometres(position)
        shown = f"{position:.17g}" if shown in (begin, end) else shown
        problem = f"outside the line, which runs from {begin} to {end} km"
        yield key, shown, problem, f"place it between {begin} and {end} km"


def _profiles_outside(key: str, line: Mapping[str, Any], ends: Ends) -> Iterator[Fault]:
    """Limits before the line, and gradients of which none begins on it.

    What continues beyond a line that was cut or shortened is noted by `tpss.cli.notes`.
    """
    for profile in SPEED_LIMITS:
        for i, limit in items(line, profile):
            position = number(limit, "from_km")
            if position is not None and position < ends[0]:
                yield from _outside(f"{key}.{profile}.{i}.from_km", position, ends)
    gradients = (number(item, "from_km") for _, item in items(line, "gradients"))
    away = list(takewhile(lambda km: km is not None and not ends[0] <= km <= ends[1], gradients))
    if len(away) > 1 and len(away) == len(line["gradients"]):
        first, last = (kilometres(km or 0.0) for km in (away[0], away[-1]))
        begin, end = map(kilometres, ends)
        problem = (
            f"none of the gradients, from {first} to {last} km, begins on the line, which runs "
            f"from {begin} to {end} km"
        )
        remedy = f"give them in the kilometres of the line, or correct {key}.begins_at_km"
        yield f"{key}.gradients.0.from_km", first, problem, remedy


def _without_limit(key: str, line: Mapping[str, Any], begin_km: float) -> Iterator[Fault]:
    for profile in SPEED_LIMITS:
        first = next((limit for _, limit in items(line, profile)), {})
        position = number(first, "from_km")
        if position is not None and position > begin_km:
            problem = "no speed limit applies at the beginning of the line"
            remedy = f"make the first limit begin at {kilometres(begin_km)}"
            yield f"{key}.{profile}.0.from_km", kilometres(position), problem, remedy


def _close_stations(lines: Mapping[str, tuple[str, Mapping[str, Any]]]) -> Iterator[Fault]:
    """Stations of a network that are so close to another that their order may be lost in rounding."""
    if len(lines) < 2:
        return
    for key, line in lines.values():
        before: list[float] = []
        for i, station in items(line, "stations"):
            km = number(station, "position_km")
            if km is None:
                continue
            if any(0.0 < abs(km - other) < CLOSEST_KM for other in before):
                problem = "closer than a metre to another station of the line"
                yield (
                    f"{key}.stations.{i}.position_km",
                    f"{km:.17g}",
                    problem,
                    "leave one of them out",
                )
            before.append(km)
