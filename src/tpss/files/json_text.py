"""JSON of others: a key that is there twice, or lists nested beyond all use, are refused."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tpss.files.read import MEGABYTE, read_bytes

DEEPEST = 64
"""Tables and lists within each other; no file of ours or of formats that are imported has as many."""


MOST_OWN = 500 * MEGABYTE
"""Longest document of our own that is read. [byte]"""


def read_json_file(path: Path) -> Any:
    """Document of a file of our own.

    Raises
    ------
    OSError
        It cannot be read, is no file, or too long.
    ValueError
        As `parse_json`.
    """
    return parse_json(read_bytes(path, MOST_OWN))


def parse_json(text: str | bytes) -> Any:
    """Document of a JSON text.

    Raises
    ------
    ValueError
        It is not JSON, has a key twice in a table, or is nested too deeply.
    """
    try:
        document = json.loads(text, object_pairs_hook=_each_once)
    except RecursionError:
        raise ValueError(_TOO_DEEP) from None
    demand_depth(document)
    return document


def demand_depth(document: Any) -> None:
    """Refuse a document whose tables and lists are nested too deeply.

    Raises
    ------
    ValueError
    """
    level, depth = [document], 0
    while level:
        depth += 1
        if depth > DEEPEST:
            raise ValueError(_TOO_DEEP)
        level = [inside for each in level for inside in _inside(each)]


_TOO_DEEP = f"more than {DEEPEST} tables or lists within each other"


def _inside(container: Any) -> Iterator[Any]:
    """Tables and lists in a table or a list."""
    if not isinstance(container, dict | list):
        return  # a document of a single value
    values = container.values() if isinstance(container, dict) else container
    yield from (each for each in values if isinstance(each, dict | list))


def _each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        seen: set[str] = set()
        for key, _ in pairs:
            if key in seen:
                raise ValueError(f"the key {key!r} is there twice in one table")
            seen.add(key)
    return table
