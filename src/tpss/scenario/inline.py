"""Put the files that a scenario names in place of their names.

A name that ends in ``.toml`` stands for the table in that file, next to the scenario: of a train's
model, of the line, of anything that the library has entries for.  So does the name of an entry of a
library of one's own.  ``gradients_file``,
``speed_limits_file``, ``stations_file`` and ``curve_file`` stand for tables in CSV or in a workbook, and
``timetables`` for entries of the traffic.  A scenario then holds everything that it says, and its faults
are traced back to the files that contain them.
"""

import marshal
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from tpss import library
from tpss.errors import Finding, ScenarioError
from tpss.scenario.clock import start_of
from tpss.scenario.completed import completed
from tpss.scenario.curve_files import CurveOfFile, braking_from, effort_from
from tpss.scenario.files import read_toml
from tpss.scenario.given_path import from_here
from tpss.scenario.inlined import Inlined, Location
from tpss.scenario.override import copy_of
from tpss.scenario.own_library import SUFFIX, Entries, own_entries
from tpss.scenario.profiles import (
    Profile,
    gradients_from,
    limits_from,
    losses_from,
    stations_from,
)
from tpss.scenario.timetable import Defaults, read_timetable
from tpss.scenario.timetable_density import at_density, density_of
from tpss.tables.kinds import BRAKING, EFFORT, GRADIENTS, LOSSES, SPEED_LIMITS, STATIONS
from tpss.tables.read import reading

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

LOSSES_OF = (
    ("supply", "converter_types", "*", "losses"),
    ("supply", "converter_stations", "*", "type", "losses"),
    ("supply", "mixed_stations", "*", "units", "*", "type", "losses"),
)
"""Where losses may name a CSV file with their curve."""

CURVES: Mapping[str, Callable[[Path, str], CurveOfFile]] = {
    "tractive_effort": reading(EFFORT, effort_from),
    "max_retardation_m_s2": reading(BRAKING, braking_from),
}
"""Keys of a train whose tables may name a file with their curve, and what reads it."""

OF_TRAINS = (("trains", "*"), ("trains", "*", "by_system", "*"))
"""Where these keys stand."""

CURVE_FILE = "curve_file"
SMOOTHED = "gradients_smoothed_over_km"

LEVEL = ({"from_km": 0.0, "permille": 0.0},)
SLOW = ({"from_km": 0.0, "speed_kmh": 1.0},)
NOWHERE = ()
LOSSLESS = ({"load_percent": 0.0, "loss_kw": 0.0}, {"load_percent": 100.0, "loss_kw": 0.0})
"""Rows that allow the rest of a document to be checked, in place of those that cannot be read."""

OF_LINES: Mapping[str, tuple[Callable[[Path, str], Profile], Sequence[dict[str, float]]]] = {
    "speed_limits": (reading(SPEED_LIMITS, limits_from), SLOW),
    "speed_limits_down": (reading(SPEED_LIMITS, limits_from), SLOW),
    "stations": (reading(STATIONS, stations_from), NOWHERE),
}
"""Lists of a line that may stand in files, what reads them, and what stands for those with faults."""


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
    for location, line in lines_of(document).items():
        smoothed = line.pop(SMOOTHED, None) if "gradients_file" in line else None
        gradients = _reader_of_gradients(smoothed, location, inlined)
        _insert_rows(line, location, "gradients", gradients, LEVEL, inlined)
        for name, (reader, instead) in OF_LINES.items():
            _insert_rows(line, location, name, reader, instead, inlined)
    for location, losses in _tables_at(document, LOSSES_OF).items():
        _insert_rows(losses, location, "curve", reading(LOSSES, losses_from), LOSSLESS, inlined)
    for location, train in _tables_at(document, OF_TRAINS).items():
        for name in CURVES:
            _insert_curve(train, location, name, inlined)
    _insert_timetables(inlined)
    return inlined


def with_timetables(
    document: dict[str, Any], source: Path, texts: Mapping[str, str]
) -> dict[str, Any]:
    """Put the trains of a document's timetables into its traffic, in place; it then names none.

    Parameters
    ----------
    document : dict
    source : Path
        File to name in errors.
    texts : mapping of str to str
        What the files hold, by the names that the document gives them; others are read.

    Raises
    ------
    ScenarioError
        A timetable has faults.
    """
    inlined = Inlined(document, source)
    _insert_timetables(inlined, texts)
    if inlined.findings:
        raise ScenarioError(inlined.findings)
    document.pop("timetables", None)
    return document


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
    of_lines = {f"{name}_file" for name in ("gradients", *OF_LINES)}
    return (
        any(of_lines & line.keys() for line in lines_of(document).values())
        or any(CURVE_FILE in losses for losses in _tables_at(document, LOSSES_OF).values())
        or any(
            isinstance(train.get(name), dict) and CURVE_FILE in train[name]
            for train in _tables_at(document, OF_TRAINS).values()
            for name in CURVES
        )
        or bool(document.get("timetables"))
        or any(
            True
            for place, kind in PLACES.items()
            for _ in _named_files(document, place, (), _own_names(document, kind, entries))
        )
    )


def _named_files(
    container: Any, place: tuple[str, ...], above: Location, own: Container[str]
) -> Iterator[tuple[Any, Any, Location]]:
    """Containers and keys at a place whose value is the name of a file, or one of one's own library."""
    for found, name, location in _items_at(container, place, above):
        value = found[name]
        if isinstance(value, str) and (value.endswith(SUFFIX) or value in own):
            yield found, name, location


def _items_at(
    container: Any, place: tuple[str, ...], above: Location
) -> Iterator[tuple[Any, Any, Location]]:
    """Containers and keys at a place, and where these are."""
    below = place[1:]
    for name in _keys_at(container, place[0]):
        if below:
            yield from _items_at(container[name], below, (*above, name))
        else:
            yield container, name, (*above, name)


def _keys_at(container: Any, key: str) -> list[Any]:
    """Keys or indices of a container's items that match a key, or ``*``."""
    if isinstance(container, dict):
        return [name for name in container if key in ("*", name)]
    return list(range(len(container))) if key == "*" and isinstance(container, list | tuple) else []


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


def lines_of(document: Mapping[str, Any]) -> dict[Location, dict[str, Any]]:
    """The tables of all lines of a document, by their places."""
    lines = document.get("lines")
    tables: dict[Location, Any] = {("line",): document.get("line")}
    if isinstance(lines, dict):
        tables |= {("lines", name): line for name, line in lines.items()}
    return {place: line for place, line in tables.items() if isinstance(line, dict)}


def _tables_at(
    document: Mapping[str, Any], places: Sequence[tuple[str, ...]]
) -> dict[Location, dict[str, Any]]:
    """The tables of a document at some places."""
    return {
        location: container[key]
        for place in places
        for container, key, location in _items_at(document, place, ())
        if isinstance(container[key], dict)
    }


def _reader_of_gradients(
    smoothed_over_km: object, line: Location, inlined: Inlined
) -> Callable[[Path, str], Profile]:
    """What reads the gradients of a line, their altitudes averaged over a length if one is given."""
    plain = reading(GRADIENTS, gradients_from)
    if smoothed_over_km is None:
        return plain
    is_number = isinstance(smoothed_over_km, int | float) and not isinstance(smoothed_over_km, bool)
    if is_number and 0.01 <= smoothed_over_km <= 100.0:  # type: ignore[operator]
        over_km = float(smoothed_over_km)  # type: ignore[arg-type]
        return reading(GRADIENTS, partial(gradients_from, smoothed_over_km=over_km))
    file, place = inlined.origin((*line, SMOOTHED))
    key = ".".join(str(part) for part in place)
    problem, remedy = "not a length from 0.01 to 100 km", "write a number in km, or leave it out"
    inlined.findings.append(Finding(str(file), key, repr(smoothed_over_km), problem, remedy))
    return plain


def _insert_rows(
    table: dict[str, Any],
    place: Location,
    name: str,
    reader: Callable[[Path, str], Profile],
    instead: Sequence[dict[str, float]],
    inlined: Inlined,
) -> None:
    """Read the file that a table names as ``<name>_file`` into its list of that name.

    Parameters
    ----------
    table : dict
    place : tuple
        Where the table is.
    name : str
        Of the list.
    reader : callable
        Reads the file.
    instead : sequence of dict
        Rows that are put in if those of the file have faults.
    inlined : Inlined
    """
    of_file = f"{name}_file"
    if not isinstance(table.get(of_file), str):
        return
    file, location = inlined.origin((*place, of_file))
    key, value = ".".join(str(part) for part in location), table[of_file]
    if name in table:
        problem = (
            f"{name} {'are' if name.endswith('s') else 'is'} given twice, as a file and as a list"
        )
        remedy = f"leave out {of_file} or {name}"
        inlined.findings.append(Finding(str(file), key, repr(value), problem, remedy))
        return
    del table[of_file]
    try:
        rows = reader(file.parent / value, ".".join(map(str, (*place, of_file))))
        inlined.profiles[*place, name] = rows
        inlined.notes += rows.notes
        table[name] = rows.rows
    except ScenarioError as error:
        table[name] = list(instead)
        if name in OF_LINES:  # what else depends on them cannot be judged
            inlined.unread.add((*place, name))
        inlined.findings += error.findings


def _insert_curve(train: dict[str, Any], place: Location, name: str, inlined: Inlined) -> None:
    """Read the file with the curve that a train's table of a name gives in place of its lists."""
    table = train.get(name)
    if not isinstance(table, dict) or not isinstance(table.get(CURVE_FILE), str):
        return
    location = (*place, name)
    file, at = inlined.origin((*location, CURVE_FILE))
    value = table[CURVE_FILE]
    if others := [key for key in table if key != CURVE_FILE]:
        key = ".".join(str(part) for part in at)
        problem = f"the curve is given twice, as a file and by {', '.join(others)}"
        remedy = f"leave out {CURVE_FILE}, or the others"
        inlined.findings.append(Finding(str(file), key, repr(value), problem, remedy))
        inlined.unread.add(location)
        return
    try:
        curve = CURVES[name](file.parent / value, ".".join(map(str, (*location, CURVE_FILE))))
    except ScenarioError as error:
        inlined.findings += error.findings
        inlined.unread.add(location)
        return
    inlined.curves[location] = curve
    inlined.notes += curve.notes
    train[name] = dict(curve.lists)


def _insert_timetables(inlined: Inlined, texts: Mapping[str, str] | None = None) -> None:
    """Add the trains of timetables to the traffic, behind its own entries.

    Files whose texts are given by their names are not read.
    """
    document, source = inlined.document, inlined.source
    own = document.get("traffic", [])
    if "timetables" not in document or not isinstance(own, list | tuple):
        return
    document["traffic"] = traffic = list(own)
    names = {entry.get("name") for entry in own if isinstance(entry, dict)}
    for i, table in _tables(document["timetables"]):
        if not isinstance(table.get("file"), str):
            continue
        path, defaults = source.parent / table["file"], Defaults.of(i, table)
        text = (texts or {}).get(table["file"])
        try:
            trains, notes = read_timetable(
                path, start_of(document), defaults, inlined.findings, text
            )
        except ScenarioError as error:
            inlined.findings += error.findings
            continue
        inlined.notes += notes
        for train in at_density(trains, density_of(table)):
            if train.entry["name"] in names:
                inlined.findings.append(train.named_twice)
                continue
            names.add(train.entry["name"])
            inlined.timetabled[len(traffic)] = train
            traffic.append(train.entry)


def _tables(value: Any) -> list[tuple[int, dict[str, Any]]]:
    items = value if isinstance(value, list | tuple) else []
    return [(i, item) for i, item in enumerate(items) if isinstance(item, dict)]
