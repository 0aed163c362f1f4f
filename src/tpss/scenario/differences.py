"""What differs between scenarios: the key paths whose values are not the same in all of them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tpss.scenario.scenario import Scenario

APART = ("name", "description", "variants", "format")
"""Keys that say what a scenario is called, not what it is."""


def differences(scenarios: Sequence[Scenario]) -> dict[str, list[Any]]:
    """Values by key path, one a scenario, where not all are alike; None where there is none.

    Items of a list are told by their names, where all have one, so that one more or less moves no other.
    """
    flat = [
        dict(
            _leaves({key: part for key, part in scenario.as_document().items() if key not in APART})
        )
        for scenario in scenarios
    ]
    paths = dict.fromkeys(path for leaves in flat for path in leaves)
    rows = {path: [leaves.get(path) for leaves in flat] for path in paths}
    return {path: values for path, values in rows.items() if any(v != values[0] for v in values)}


def _leaves(part: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Paths and values of all that is no table or list."""
    if isinstance(part, Mapping):
        items: list[tuple[str, Any]] = list(part.items())
    elif isinstance(part, list) and any(isinstance(item, list | Mapping) for item in part):
        items = list(zip(_keys(part), part, strict=True))
    else:
        yield path, part
        return
    for key, inside in items:
        yield from _leaves(inside, f"{path}.{key}" if path else key)


def _keys(items: list[Any]) -> list[str]:
    names = [item.get("name") if isinstance(item, Mapping) else None for item in items]
    if None in names or len(set(names)) < len(names):
        return [str(number) for number in range(len(items))]
    return [str(name) for name in names]
