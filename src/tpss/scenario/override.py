"""Change single values of a scenario document by their key paths."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError

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
    """Copy of a document with values set by key path (``traffic.0.headway_min``); None removes.

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
    for path, value in changes.items():
        try:
            # A copy: a later path may lead into it, and the caller's own must stay as it is.
            _set(document, path.split("."), copy_of(value))
        except (KeyError, IndexError, ValueError, TypeError):
            problem = "no such place in the scenario"
            remedy = "name tables by their keys and list items by their number from 0"
            findings.append(Finding(str(source), path, repr(value), problem, remedy))
    if findings:
        raise ScenarioError(findings)


def _set(container: Any, keys: list[str], value: Any) -> None:
    for key in keys[:-1]:
        if isinstance(container, dict):
            container = container.setdefault(key, {})
        else:
            container = container[_index(key, container)]
    last = keys[-1]
    if isinstance(container, list):
        container[_index(last, container)] = value
    elif value is None:
        container.pop(last, None)
    else:
        container[last] = value


def _index(key: str, items: list[Any]) -> int:
    index = int(key)
    if not 0 <= index < len(items):
        raise IndexError(key)
    return index


def parse_assignment(text: str) -> tuple[str, Any]:
    """Key path and value of ``path=value``; the value is read as TOML, else as plain text.

    Raises
    ------
    ScenarioError
        There is no ``=`` in the text.
    """
    path, equals, raw = text.partition("=")
    if not equals or not path.strip():
        remedy = "write --set simulation.time_step_min=0.1"
        raise ScenarioError([Finding("--set", text, "", "not of the form KEY=VALUE", remedy)])
    try:
        value = tomllib.loads(f"value = {raw}")["value"]
    except (ValueError, RecursionError):
        value = raw.strip()
    return path.strip(), value
