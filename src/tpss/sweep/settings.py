"""Values by key paths in a scenario's document, each in all the places that match its path."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.scenario.fields import LINE
from tpss.scenario.override import copy_of, put_in
from tpss.scenario.paths import ONE_MORE, NoSuchPlaceError, places_of
from tpss.scenario.raw import lines_of
from tpss.scenario.traffic import DEPARTURES
from tpss.sweep.lengths import is_length, put_length

Settings = dict[str, Any]
"""Values by the key paths of a scenario, see `tpss.scenario.paths`."""

LEFT_OUT = "none"
"""Marks a key of the scenario as left out; TOML has no null."""

INSTEAD_OF = {
    "transformers": ("transformers_km",),
    "transformers_km": ("transformers",),
    **{key: tuple(other for other in DEPARTURES if other != key) for key in DEPARTURES},
    "duration_min": ("until",),
    "until": ("duration_min",),
    "gradients": ("gradients_file", "gradients_smoothed_over_km"),
    "speed_limits": ("speed_limits_file",),
    "speed_limits_down": ("speed_limits_down_file",),
    "stations": ("stations_file",),
}
"""Keys that replace others."""


def apply(document: dict[str, Any], settings: Mapping[str, Any], source: Path) -> None:
    """Put values into a document; new lengths of lines come first, positions after them.

    Raises
    ------
    ScenarioError
        Paths lead to no place; the findings name `source`.
    """
    values = {
        path: None if isinstance(value, str) and value == LEFT_OUT else copy_of(value)
        for path, value in settings.items()
    }
    findings: list[Finding] = []
    # One after the other: a path may lead into what another one has put in.
    for path, value in sorted(values.items(), key=lambda item: not is_length(item[0])):
        try:
            _put(document, path, value, source)
        except ScenarioError as error:
            findings += error.findings
    if findings:
        raise ScenarioError(findings)


def _put(document: dict[str, Any], path: str, value: Any, source: Path) -> None:
    """Put a value of a document in all the places that match its path."""
    places = _places(document, path, value, source)
    if is_length(path):
        for place in places:
            put_length(document, place, value)
        return
    if ONE_MORE in path.split("."):
        if value is not None:  # otherwise nothing is added
            put_in(document, {path: value}, source)
        return
    changes: dict[str, Any] = {}
    for place in places:
        above, _, key = place.rpartition(".")
        if value is not None:
            changes |= {f"{above}.{other}": None for other in INSTEAD_OF.get(key, ())}
        changes[place] = value
    put_in(document, changes, source)


def _places(document: dict[str, Any], path: str, value: Any, source: Path) -> list[str]:
    """Places that match a path.

    Raises
    ------
    ScenarioError
        There are none.
    """
    try:
        places, remedy = places_of(document, path), "name tables by their keys"
    except NoSuchPlaceError as error:
        places, remedy = [], str(error)
    lines = [key for key, _ in lines_of(document).values()]
    if places and not all(_is_on_a_line(place, lines) for place in places):
        places, remedy = [], f"name one of {', '.join(lines)}"
    if not places:
        problem = "there is no such place in the base scenario"
        raise ScenarioError([Finding(str(source), path, repr(value), problem, remedy)])
    return places


def _is_on_a_line(place: str, lines: list[str]) -> bool:
    """Whether a place is not one of a line that there is not."""
    key, *below = place.split(".")
    if key not in (LINE, "lines") or not below:
        return True
    return (key if key == LINE else f"{key}.{below[0]}") in lines or (key != LINE and not below[1:])
