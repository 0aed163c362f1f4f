"""Change single values of a scenario document by their key paths."""

import tomllib
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.printable import document_in_nfc
from tpss.scenario.paths import NoSuchPlaceError, places_of

_LEAVES = frozenset((float, int, str, bool, type(None)))


def copy_of(value: Any) -> Any:
    """Copy of a document or a part of it: new tables and lists, the same values.

    `copy.deepcopy` does the same ten times slower.
    """
    if isinstance(value, dict | Mapping):
        return {k: v if type(v) in _LEAVES else copy_of(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return type(value)([v if type(v) in _LEAVES else copy_of(v) for v in value])
    return value


def override(
    document: Mapping[str, Any], changes: Mapping[str, Any], source: Path
) -> dict[str, Any]:
    """Copy of a document with values set by key path (``traffic.0.headway_min``, `paths`); None removes.

    Raises
    ------
    ScenarioError
        A path leads through something that is not there.
    """
    changed: dict[str, Any] = copy_of(document)
    put_in(changed, changes, source)
    return changed


def put_in(document: dict[str, Any], changes: Mapping[str, Any], source: Path) -> None:
    """Set values of a document itself, as `override` does in a copy."""
    findings = []
    for path, value in document_in_nfc(changes).items():
        try:
            places, remedy = places_of(document, path), "name tables by their keys"
        except NoSuchPlaceError as error:
            places, remedy = [], str(error)
        if not places:
            problem = "no such place in the scenario"
            findings.append(Finding(str(source), path, repr(value), problem, remedy))
        for place in reversed(places):  # what is removed from a list moves what is behind it
            # A copy: a later path may lead into it, and the caller's own must stay as it is.
            _set(document, place.split("."), copy_of(value))
    if findings:
        raise ScenarioError(findings)


def _set(container: Any, keys: list[str], value: Any) -> None:
    """Set a value at a place; what is missing on the way is made."""
    for key, following in pairwise(keys):
        inside: Any = [] if following == "0" and not _has(container, key) else {}
        if isinstance(container, dict):
            container = container.setdefault(key, inside)
        else:
            if int(key) == len(container):
                container.append(inside)
            container = container[int(key)]
    last = keys[-1]
    if isinstance(container, dict) and value is None:
        container.pop(last, None)
    elif isinstance(container, dict):
        container[last] = value
    elif value is None:
        del container[int(last)]
    elif int(last) == len(container):
        container.append(value)
    else:
        container[int(last)] = value


def _has(container: Any, key: str) -> bool:
    return isinstance(container, dict) and key in container


def parse_assignment(text: str) -> tuple[str, Any]:
    """Key path and value of ``path=value``; the value is read as TOML, else as plain text.

    Without a value it is None, which removes what is at the path.

    Raises
    ------
    ScenarioError
        There is no ``=`` in the text.
    """
    path, equals, raw = text.partition("=")
    if not equals or not path.strip():
        remedy = "write --set simulation.time_step_min=0.1"
        raise ScenarioError([Finding("--set", text, "", "not of the form KEY=VALUE", remedy)])
    if not raw.strip():
        return path.strip(), None
    try:
        value = tomllib.loads(f"value = {raw}")["value"]
    except (ValueError, RecursionError):
        value = raw.strip()
    return path.strip(), value
