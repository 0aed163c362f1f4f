"""Put the files that a scenario names in place of their names.

A name that ends in ``.toml`` stands for the table in that file, next to the scenario: of a train's
model, of the line, of anything that the library has entries for.  ``gradients_file`` and
``curve_file`` stand for rows in CSV, and ``timetables`` for entries of the traffic.  A scenario then
holds everything that it says, and its faults are traced back to the files that contain them.
"""

import marshal
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tpss import library
from tpss.errors import Finding, ScenarioError
from tpss.scenario.clock import start_of
from tpss.scenario.files import GRADIENTS, LOSSES, Columns, Profile, read_profile, read_toml
from tpss.scenario.override import copy_of
from tpss.scenario.rolling_stock import completed
from tpss.scenario.timetable import Defaults, TimetabledTrain, read_timetable
from tpss.scenario.timetable_density import at_density, density_of

Location = tuple[int | str, ...]

SUFFIX = ".toml"

PLACES: tuple[tuple[str, ...], ...] = (
    ("line",),
    ("lines", "*"),
    ("supply", "catenary"),
    ("supply", "catenary", "contact_line"),
    ("supply", "catenary", "rails"),
    ("supply", "contact_lines", "*", "catenary"),
    ("supply", "contact_lines", "*", "catenary", "contact_line"),
    ("supply", "contact_lines", "*", "catenary", "rails"),
    ("supply", "high_voltage_line", "type"),
    ("supply", "high_voltage_line", "line_transformer"),
    ("supply", "high_voltage_line", "station_transformer"),
    ("supply", "converter_stations", "*", "type"),
    ("supply", "transformer_stations", "*", "transformer"),
    ("supply", "converter_types", "*"),
    ("supply", "mixed_stations", "*", "units", "*", "type"),
    ("supply", "rectifier_stations", "*", "type"),
    ("supply", "rectifier_types", "*"),
    ("trains", "*", "model"),
    ("standards", "rails"),
    ("conductors", "*", "wire"),
)
"""Where a file may be named, the last one in a geometry; ``*`` is any item or key."""

LOSSES_OF = (
    ("supply", "converter_types", "*", "losses"),
    ("supply", "converter_stations", "*", "type", "losses"),
    ("supply", "mixed_stations", "*", "units", "*", "type", "losses"),
)
"""Where losses may name a CSV file with their curve."""

LEVEL = ({"from_km": 0.0, "permille": 0.0},)
LOSSLESS = ({"load_percent": 0.0, "loss_kw": 0.0}, {"load_percent": 100.0, "loss_kw": 0.0})
"""Rows that allow the rest of a document to be checked, in place of those that cannot be read."""


@dataclass
class Inlined:
    """A document without file names, and where its parts came from."""

    document: dict[str, Any]
    source: Path
    findings: list[Finding] = field(default_factory=list)
    files: dict[Location, Path] = field(default_factory=dict)
    """Files by the tables that they gave."""
    own: dict[Location, set[str]] = field(default_factory=dict)
    """Keys of such a table that the scenario itself gives."""
    unread: set[Location] = field(default_factory=set)
    """Tables whose file could not be read."""
    profiles: dict[Location, Profile] = field(default_factory=dict)
    """Lists that came from CSV files, by their places."""

    timetabled: dict[int, TimetabledTrain] = field(default_factory=dict)
    """Trains that came from timetables, by the numbers of their entries of the traffic."""

    def origin(self, location: Location) -> tuple[Path, Location]:
        """File that holds a value, and the value's place in it."""
        for rows, profile in self.profiles.items():
            if location[: len(rows)] == rows and len(location) > len(rows) + 1:
                row, key = location[len(rows) : len(rows) + 2]
                return profile.path, (profile.place(int(row), str(key)),)
        if location[:1] == ("traffic",) and location[1:]:
            train = self.timetabled.get(int(location[1]))
            if train is not None:
                path, place = train.origin(location[2:])
                return path or self.source, place
        for table, file in self.files.items():
            below = location[len(table) :]
            if below and location[: len(table)] == table and below[0] not in self.own[table]:
                return file, below
        return self.source, location

    def is_unread(self, location: Location) -> bool:
        """Whether a location lies in a table whose file could not be read."""
        return any(location[: len(table)] == table for table in self.unread)


def inline_files(document: dict[str, Any], source: Path) -> Inlined:
    """Replace the names of files by what they hold: in a copy of the document if it names any."""
    if not _names_files(document):
        return Inlined(document, source)
    document = copy_of(document)
    inlined = Inlined(document, source)
    for place in PLACES:
        for container, key, location in _named_files(document, place, ()):
            if place[0] == "trains":
                _merge_model(container, location[:-1], inlined)
            else:
                _insert_table(container, key, location, inlined)
    for location, line in lines_of(document).items():
        _insert_rows(line, location, "gradients", GRADIENTS, LEVEL, inlined)
    for location, losses in _losses_of(document).items():
        _insert_rows(losses, location, "curve", LOSSES, LOSSLESS, inlined)
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


_NAMES = (SUFFIX.encode(), b"gradients_file", b"curve_file", b"timetables")
"""What stands in a document that names files: ends of their names, and keys."""


def _names_files(document: dict[str, Any]) -> bool:
    try:
        whole = marshal.dumps(document)
    except ValueError:  # it holds what no file does, such as a time
        whole = b"".join(_NAMES)
    # Of many cases none does: to look through all their text takes a tenth of a look at the places.
    if not any(name in whole for name in _NAMES):
        return False
    return (
        any("gradients_file" in line for line in lines_of(document).values())
        or any("curve_file" in losses for losses in _losses_of(document).values())
        or bool(document.get("timetables"))
        or any(True for place in PLACES for _ in _named_files(document, place, ()))
    )


def _named_files(
    container: Any, place: tuple[str, ...], above: Location
) -> Iterator[tuple[Any, Any, Location]]:
    """Containers and keys at a place whose value is the name of a file."""
    for found, name, location in _items_at(container, place, above):
        if isinstance(found[name], str) and found[name].endswith(SUFFIX):
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


def _insert_table(container: Any, key: Any, location: Location, inlined: Inlined) -> None:
    name = container[key]
    table = _read(name, location, inlined)
    if table is None:
        inlined.unread.add(location)
        return
    container[key] = table
    inlined.files[location] = inlined.source.parent / name
    inlined.own[location] = set()


def _merge_model(train: dict[str, Any], location: Location, inlined: Inlined) -> None:
    """Complete a train with the values of its file; the train then has no model."""
    name = train.pop("model")
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


def _losses_of(document: Mapping[str, Any]) -> dict[Location, dict[str, Any]]:
    """The tables of losses of a document, by their places."""
    return {
        location: container[key]
        for place in LOSSES_OF
        for container, key, location in _items_at(document, place, ())
        if isinstance(container[key], dict)
    }


def _insert_rows(
    table: dict[str, Any],
    place: Location,
    name: str,
    columns: Columns,
    instead: Sequence[dict[str, float]],
    inlined: Inlined,
) -> None:
    """Read the CSV file that a table names as ``<name>_file`` into its list of that name.

    Parameters
    ----------
    table : dict
    place : tuple
        Where the table is.
    name : str
        Of the list.
    columns : Columns
        Of the file.
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
        rows = read_profile(file.parent / value, ".".join(map(str, (*place, of_file))), columns)
        inlined.profiles[*place, name] = rows
        table[name] = rows.rows
    except ScenarioError as error:
        table[name] = list(instead)
        inlined.findings += error.findings


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
            trains = read_timetable(path, start_of(document), defaults, inlined.findings, text)
        except ScenarioError as error:
            inlined.findings += error.findings
            continue
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
