"""Places in a document, as it is read and before anything of it is checked."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tpss.scenario.inlined import Location


def lines_of(document: Mapping[str, Any]) -> dict[Location, dict[str, Any]]:
    """The tables of all lines of a document, by their places."""
    lines = document.get("lines")
    tables: dict[Location, Any] = {("line",): document.get("line")}
    if isinstance(lines, dict):
        tables |= {("lines", name): line for name, line in lines.items()}
    return {place: line for place, line in tables.items() if isinstance(line, dict)}


def items_at(
    container: Any, place: tuple[str, ...], above: Location
) -> Iterator[tuple[Any, Any, Location]]:
    """Containers and keys at a place, and where these are."""
    below = place[1:]
    for name in _keys_at(container, place[0]):
        if below:
            yield from items_at(container[name], below, (*above, name))
        else:
            yield container, name, (*above, name)


def _keys_at(container: Any, key: str) -> list[Any]:
    """Keys or indices of a container's items that match a key, or ``*``."""
    if isinstance(container, dict):
        return [name for name in container if key in ("*", name)]
    return list(range(len(container))) if key == "*" and isinstance(container, list | tuple) else []


def tables_at(
    document: Mapping[str, Any], places: Sequence[tuple[str, ...]]
) -> dict[Location, dict[str, Any]]:
    """The tables of a document at some places."""
    return {
        location: container[key]
        for place in places
        for container, key, location in items_at(document, place, ())
        if isinstance(container[key], dict)
    }
