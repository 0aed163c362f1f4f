"""Values by key paths in a scenario's document, each in all the places that match its path."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.scenario import Scenario
from tpss.scenario.fields import AlongLine, marked
from tpss.scenario.line import end_of_line
from tpss.scenario.override import copy_of, put_in
from tpss.scenario.paths import NoSuchPlaceError, places_of
from tpss.scenario.traffic import DEPARTURES

Settings = dict[str, Any]
"""Values by the key paths of a scenario, see `tpss.scenario.paths`."""

LEFT_OUT = "none"
"""Marks a key of the scenario as left out; TOML has no null."""

LENGTH = "line.length_km"

PLACES = tuple(place for place in marked(Scenario, AlongLine) if not place.startswith("lines."))
"""Positions whose distances from its beginning scale with the length of the line; gradients do not."""

INSTEAD_OF = {
    "transformers": ("transformers_km",),
    "transformers_km": ("transformers",),
    **{key: tuple(other for other in DEPARTURES if other != key) for key in DEPARTURES},
    "duration_min": ("until",),
    "until": ("duration_min",),
    "gradients": ("gradients_file",),
}
"""Keys that replace others."""


def apply(document: dict[str, Any], settings: Mapping[str, Any], source: Path) -> None:
    """Put values into a document; a new length of the line comes first, positions after it.

    Raises
    ------
    ScenarioError
        A path leads to no place; the finding names `source`.
    """
    values = {
        path: None if isinstance(value, str) and value == LEFT_OUT else copy_of(value)
        for path, value in settings.items()
    }
    length_km = values.pop(LENGTH, None)
    if length_km is not None:
        _move_places(document, length_km)
    _put(document, values, source)


def _put(document: dict[str, Any], settings: Settings, source: Path) -> None:
    """Put values of a document in all the places that match their paths."""
    # One after the other: a path may lead into what another one has put in.
    for path, value in settings.items():
        try:
            places, remedy = places_of(document, path), "name tables by their keys"
        except NoSuchPlaceError as error:
            places, remedy = [], str(error)
        if not places:
            problem = "there is no such place in the base scenario"
            raise ScenarioError([Finding(str(source), path, repr(value), problem, remedy)])
        changes: dict[str, Any] = {}
        for place in places:
            above, _, key = place.rpartition(".")
            if value is not None:
                changes |= {f"{above}.{other}": None for other in INSTEAD_OF.get(key, ())}
            changes[place] = value
        put_in(document, changes, source)


def _item(container: Any, key: str) -> Any:
    """An item of a table or list; None if there is none."""
    if isinstance(container, Mapping):
        return container.get(key)
    is_there = isinstance(container, list | tuple) and key.isdigit() and int(key) < len(container)
    return container[int(key)] if is_there else None


def _move_places(document: dict[str, Any], length_km: float) -> None:
    """Change the length of a line; the distances of positions from its beginning scale with it."""
    line = _item(document, "line")
    begin_km, before_km = _item(line, "begins_at_km") or 0.0, _item(line, "length_km")
    if _are_numbers(begin_km, before_km, length_km) and before_km > 0:
        for place in (place for pattern in PLACES for place in places_of(document, pattern)):
            *above, last = place.split(".")
            container: Any = document
            for key in above:
                container = _item(container, key)
            position = _item(container, last)
            if isinstance(position, int | float):
                key_or_number: Any = int(last) if isinstance(container, list) else last
                container[key_or_number] = _moved(position, begin_km, before_km, length_km)
    document["line"]["length_km"] = length_km


def _are_numbers(*values: Any) -> bool:
    return all(isinstance(value, int | float) for value in values)


def _moved(position_km: float, begin_km: float, before_km: float, length_km: float) -> float:
    """A position on a line whose length has changed; one at the end stays exactly there."""
    if position_km == end_of_line(begin_km, before_km):
        return end_of_line(begin_km, length_km)
    return begin_km + (position_km - begin_km) * length_km / before_km
