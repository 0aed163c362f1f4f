"""Put the files that a scenario names in place of their names.

A name that ends in ``.toml`` stands for the table in that file, next to the scenario: of a train's
model, of the line, of anything that the library has entries for.  So does the name of an entry of a
library of one's own.  Tables in CSV or in a workbook follow, see `tpss.scenario.inline_tables`.  A
scenario then holds everything that it says, and its faults are traced back to the files that contain
them.
"""

import marshal
from collections.abc import Container, Iterator, Mapping
from pathlib import Path
from typing import Any

from tpss import library
from tpss.errors import Finding, ScenarioError
from tpss.scenario.completed import completed
from tpss.scenario.document_places import items_at
from tpss.scenario.files import read_toml
from tpss.scenario.given_path import from_here
from tpss.scenario.inline_tables import insert_tables, names_tables
from tpss.scenario.inlined import Inlined, Location
from tpss.scenario.override import copy_of
from tpss.scenario.own_library import SUFFIX, Entries, own_entries

PLACES: Mapping[tuple[str, ...], str] = {
    ("line",): "",
    ("lines", "*"): "",
    ("supply", "catenary"): "catenaries",
    ("supply", "catenary", "contact_line"): "contact_lines",
    ("supply", "catenary", "rails"): "rails",
    ("supply", "contact_lines", "*", "catenary"): "catenaries",
    ("supply", "contact_lines", "*", "catenary", "contact_line"): "contact_lines",
    ("supply", "contact_lines", "*", "catenary", "rails"): "rails",
    ("supply", "high_voltage_line", "type"): "high_voltage_lines",
    ("supply", "high_voltage_line", "line_transformer"): "transformers",
    ("supply", "high_voltage_line", "station_transformer"): "transformers",
    ("supply", "converter_stations", "*", "type"): "converters",
    ("supply", "transformer_stations", "*", "transformer"): "station_transformers",
    ("supply", "converter_types", "*"): "converters",
    ("supply", "mixed_stations", "*", "units", "*", "type"): "converters",
    ("supply", "rectifier_stations", "*", "type"): "rectifiers",
    ("supply", "rectifier_types", "*"): "rectifiers",
    ("trains", "*", "model"): "locomotives",
    ("standards", "rails"): "",
    ("conductors", "*", "wire"): "wires",
}
"""Where a file may be named, the last one in a geometry, and the kind of the library's entries that may
be named there too, if entries may be added to it; ``*`` is any item or key."""

OWN_TYPES = {"converters": "converter_types", "rectifiers": "rectifier_types"}
"""Keys of the supply whose tables have names that come before those of a library."""


def inline_files(document: dict[str, Any], source: Path) -> Inlined:
    """Replace the names of files by what they hold: in a copy of the document if it names any."""
    entries = own_entries()
    if not _names_files(document, entries):
        return Inlined(document, source)
    document = copy_of(document)
    inlined = Inlined(document, source, entries)
    for place, kind in PLACES.items():
        names = _own_names(document, kind, entries)
        for container, key, location in _named_files(document, place, (), names):
            if place[0] == "trains":
                _merge_model(container, location[:-1], inlined)
            else:
                _insert_table(container, key, location, kind, inlined)
    insert_tables(inlined)
    return inlined


_NAMES = (SUFFIX.encode(), b"_file", b"timetables")
"""What stands in a document that names files: ends of their names, and keys."""


def _own_names(document: dict[str, Any], kind: str, entries: Entries) -> set[str]:
    """Names that stand for entries of a library of one's own, and not for types of the document."""
    types = _at(document, "supply", OWN_TYPES[kind]) if kind in OWN_TYPES else {}
    return {*entries.get(kind, ())} - {*types}


def _at(document: dict[str, Any], *path: str) -> dict[str, Any]:
    """The table at a key path; an empty one if there is none."""
    for key in path:
        below = document.get(key)
        document = below if isinstance(below, dict) else {}
    return document


def _names_files(document: dict[str, Any], entries: Entries) -> bool:
    try:
        whole = marshal.dumps(document)
    except ValueError:  # it holds what no file does, such as a time
        whole = b"".join(_NAMES)
    # Of many cases none does: to look through all their text takes a tenth of a look at the places.
    own = {name.encode() for names in entries.values() for name in names}
    if not any(name in whole for name in (*_NAMES, *own)):
        return False
    return names_tables(document) or any(
        True
        for place, kind in PLACES.items()
        for _ in _named_files(document, place, (), _own_names(document, kind, entries))
    )


def _named_files(
    container: Any, place: tuple[str, ...], above: Location, own: Container[str]
) -> Iterator[tuple[Any, Any, Location]]:
    """Containers and keys at a place whose value is the name of a file, or one of one's own library."""
    for found, name, location in items_at(container, place, above):
        value = found[name]
        if isinstance(value, str) and (value.endswith(SUFFIX) or value in own):
            yield found, name, location


def _read(name: str, location: Location, inlined: Inlined) -> dict[str, Any] | None:
    """Table in a file, without its source; None, with a finding, if it cannot be read."""
    key = ".".join(str(part) for part in location)
    try:
        table = read_toml(inlined.source.parent / name, key)
    except ScenarioError as error:
        inlined.findings += error.findings
        return None
    table.pop("source", None)
    return table


def _insert_table(
    container: Any, key: Any, location: Location, kind: str, inlined: Inlined
) -> None:
    name = container[key]
    if not name.endswith(SUFFIX):
        container[key] = _of_own_library(kind, name, location, inlined)
        inlined.own[location] = set()
        return
    table = _read(name, location, inlined)
    if table is None:
        inlined.unread.add(location)
        return
    container[key] = table
    inlined.files[location] = inlined.source.parent / name
    inlined.own[location] = set()


def _of_own_library(kind: str, name: str, location: Location, inlined: Inlined) -> dict[str, Any]:
    """Values of an entry of a library of one's own; that it takes the place of a shipped one is told."""
    entry = inlined.entries[kind][name]
    file = from_here(entry.file)
    inlined.files[location], inlined.names[location] = Path(file), name
    if name in library.entries(kind):
        key = ".".join(map(str, location))
        inlined.notes.append(f"{key}: {name} is that of {file}, not the shipped one")
    values: dict[str, Any] = copy_of(entry.values)
    return values


def _merge_model(train: dict[str, Any], location: Location, inlined: Inlined) -> None:
    """Complete a train with the values of its file; the train then has no model."""
    name = train.pop("model")
    if not name.endswith(SUFFIX):
        inlined.own[location] = set(train)
        train.update(completed(train, _of_own_library("locomotives", name, location, inlined)))
        return
    table = _read(name, (*location, "model"), inlined)
    if table is None:
        # Any values allow what the scenario itself says to be checked.
        train["model"] = next(iter(library.entries("locomotives")))
        return
    path = inlined.source.parent / name
    if "model" in table:
        problem = "a model file must give all values itself"
        remedy = "write the values of that model into this file"
        inlined.findings.append(
            Finding(str(path), "model", repr(table.pop("model")), problem, remedy)
        )
    inlined.files[location], inlined.own[location] = path, set(train)
    train.update(completed(train, table))
