"""Read a document as it was written, not validated: what is missing or of another type is skipped."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from tpss.scenario.fields import LINE
from tpss.scenario.line import FARTHEST_KM, end_of_line

Fault = tuple[str, str, str, str]
"""Key path, value, problem and remedy."""

Ends = tuple[float, float]
"""Beginning and end of a line. [km]"""

CALLS = ("stops", "passes")
"""Lists of a service's stations on its way."""

TABLES = (dict, Mapping)
"""What a table is, the usual one first: to ask for others takes ten times as long."""

LARGEST = 1e300
"""Larger numbers count as this one: an integer in a file has any number of digits."""


def table(document: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """The table of a key; an empty one if there is none."""
    value = document.get(key)
    return value if isinstance(value, TABLES) else {}


def items(document: Mapping[str, Any], key: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Numbers and tables of a list."""
    value = document.get(key)
    for i, item in enumerate(value if isinstance(value, list | tuple) else []):
        if isinstance(item, TABLES):
            yield i, item


def number(table: Mapping[str, Any], key: str) -> float | None:
    """A finite number; None if there is none."""
    value = table.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if not -math.inf < value < math.inf:
        return None
    return float(max(-LARGEST, min(value, LARGEST)))


def lines_of(document: Mapping[str, Any]) -> dict[str, tuple[str, Mapping[str, Any]]]:
    """Key path and table of every line, by its name."""
    lines = {LINE: (LINE, table(document, LINE))} if LINE in document else {}
    named = table(document, "lines")
    return lines | {str(name): (f"lines.{name}", table(named, name)) for name in named}


def places_of(line: Mapping[str, Any]) -> dict[str, float]:
    """Positions of a line's stations by name. [km]"""
    return {
        station["name"]: position
        for _, station in items(line, "stations")
        if isinstance(station.get("name"), str)
        and (position := number(station, "position_km")) is not None
    }


def beginning(line: Mapping[str, Any]) -> float | None:
    """Position where a line begins; None if that has a fault of its own. [km]"""
    begin = number(line, "begins_at_km") if "begins_at_km" in line else 0.0
    return begin if begin is not None and abs(begin) <= FARTHEST_KM else None


def ends_of(line: Mapping[str, Any]) -> Ends | None:
    """Ends of a line; None if they are at fault, and nothing can be measured against them. [km]"""
    begin, length = beginning(line), number(line, "length_km")
    if begin is None or length is None or length <= 0.0:
        return None
    return begin, end_of_line(begin, length)


def tracks_by_stretch(line: Mapping[str, Any], ends: Ends) -> list[tuple[float, float, int]]:
    """Stretches of a line with the same number of tracks: their ends [km], and that number."""
    given = line.get("tracks", 1)
    if isinstance(given, int):
        return [(*ends, given)]
    rows = [
        (km, int(count))
        for _, each in items(line, "tracks")
        if (km := number(each, "from_km")) is not None
        and (count := number(each, "count")) is not None
    ]
    begins = [ends[0], *(km for km, _ in rows[1:])]
    return [
        (begin, end, count)
        for begin, end, (_, count) in zip(begins, [*begins[1:], ends[1]], rows, strict=False)
    ]


def column(line: Mapping[str, Any], profile: str) -> list[float]:
    """Positions of a profile's items, in their order. [km]"""
    numbers = (number(item, "from_km") for _, item in items(line, profile))
    return [km for km in numbers if km is not None]
