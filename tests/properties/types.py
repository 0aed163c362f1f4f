"""Types of a scenario's converters and catenaries, as tables of its own, so that keys can be added."""

from collections.abc import Iterator
from typing import Any

from tpss import library

Document = dict[str, Any]


def converter_types(document: Document) -> Iterator[Document]:
    """Tables of the types of all converters, in place of their names."""
    supply = document["supply"]
    units = [each for station in supply.get("mixed_stations", ()) for each in station["units"]]
    for owner in (*supply.get("converter_stations", ()), *units):
        yield own_table(owner, "type", "converters")


def own_table(owner: Document, key: str, kind: str) -> Document:
    """The table at a key, in place of the name of an entry of the library."""
    given = owner[key]
    owner[key] = dict(library.values(kind, given) if isinstance(given, str) else given)
    return owner[key]
