"""A new length of a line: what stands along it moves in proportion."""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss.scenario.fields import LINE, AlongLine, marked
from tpss.scenario.line import end_of_line
from tpss.scenario.paths import places_of
from tpss.scenario.raw import lines_of
from tpss.scenario.scenario import Scenario

LENGTH = "length_km"

PLACES = tuple(place for place in marked(Scenario, AlongLine) if not place.startswith("lines."))
"""Positions whose distances from its beginning scale with the length of the line; gradients do not."""


def is_length(place: str) -> bool:
    """Whether a place in a scenario's document is the length of a line."""
    table, _, key = place.rpartition(".")
    return key == LENGTH and (table == LINE or table.startswith("lines."))


def put_length(document: dict[str, Any], place: str, length_km: Any) -> None:
    """Change the length of a line; the distances of positions on it from its beginning scale with it."""
    key = place.rpartition(".")[0]
    line = _item_at(document, key.split("."))
    begin_km, before_km = line.get("begins_at_km", 0.0), line.get(LENGTH)
    if _are_numbers(begin_km, before_km, length_km) and before_km > 0:
        for container, last, position in _positions_on(document, key):
            container[last] = _moved(position, begin_km, before_km, length_km)
    line[LENGTH] = length_km


def _positions_on(document: dict[str, Any], key: str) -> Iterator[tuple[Any, Any, float]]:
    """Containers, keys and values of the positions on a line."""
    by_key = {place: name for name, (place, _) in lines_of(document).items()}
    first = next(iter(by_key))
    for pattern in PLACES:
        own = f"{LINE}."
        if pattern.startswith(own):
            pattern = f"{key}.{pattern.removeprefix(own)}"
        for place in places_of(document, pattern):
            way = place.split(".")
            container = _item_at(document, way[:-1])
            last: Any = int(way[-1]) if isinstance(container, list) else way[-1]
            position = container[last] if _has(container, last) else None
            on = by_key.get(key) if pattern.startswith(f"{key}.") else _line_of(document, way)
            is_here = (on or by_key[first]) == by_key[key]
            if is_here and isinstance(position, int | float):
                yield container, last, position


def _line_of(document: dict[str, Any], way: list[str]) -> str | None:
    """Name of the line on which a position stands, of the nearest table around it that says so.

    A transformer that is out belongs to the high-voltage line.
    """
    tables = [_item_at(document, way[:depth]) for depth in range(len(way) - 1, 0, -1)]
    if way[0] == "outages" and "transformers_km" in way:
        tables = [_item_at(document, ["supply", "high_voltage_line"])]
    named = (each.get("line") for each in tables if isinstance(each, Mapping))
    return next((name for name in named if isinstance(name, str)), None)


def _item_at(document: Any, way: list[str]) -> Any:
    """What is at a place; None if there is nothing."""
    for key in way:
        if isinstance(document, Mapping):
            document = document.get(key)
        elif isinstance(document, list | tuple):
            document = document[int(key)]
    return document


def _has(container: Any, key: Any) -> bool:
    return isinstance(container, list) or (isinstance(container, Mapping) and key in container)


def _are_numbers(*values: Any) -> bool:
    return all(isinstance(value, int | float) for value in values)


def _moved(position_km: float, begin_km: float, before_km: float, length_km: float) -> float:
    """A position on a line whose length has changed; one at the end stays exactly there."""
    if position_km == end_of_line(begin_km, before_km):
        return end_of_line(begin_km, length_km)
    return begin_km + (position_km - begin_km) * length_km / before_km
