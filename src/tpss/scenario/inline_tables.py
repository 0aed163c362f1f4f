"""Put the tables that a scenario names, in CSV or in a workbook, in place of their names.

``gradients_file``, ``speed_limits_file``, ``stations_file`` and ``curve_file`` stand for lists and
curves, and ``timetables`` for entries of the traffic.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.scenario.clock import start_of
from tpss.scenario.curve_files import CurveOfFile, braking_from, effort_from
from tpss.scenario.document_places import lines_of, tables_at
from tpss.scenario.inlined import Inlined, Location
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


def names_tables(document: Mapping[str, Any]) -> bool:
    """Whether a document names any table."""
    of_lines = {f"{name}_file" for name in ("gradients", *OF_LINES)}
    return (
        any(of_lines & line.keys() for line in lines_of(document).values())
        or any(CURVE_FILE in losses for losses in tables_at(document, LOSSES_OF).values())
        or any(
            isinstance(train.get(name), dict) and CURVE_FILE in train[name]
            for train in tables_at(document, OF_TRAINS).values()
            for name in CURVES
        )
        or bool(document.get("timetables"))
    )


def insert_tables(inlined: Inlined) -> None:
    """Put the tables that a document names in place of their names."""
    for location, line in lines_of(inlined.document).items():
        smoothed = line.pop(SMOOTHED, None) if "gradients_file" in line else None
        gradients = _reader_of_gradients(smoothed, location, inlined)
        _insert_rows(line, location, "gradients", gradients, LEVEL, inlined)
        for name, (reader, instead) in OF_LINES.items():
            _insert_rows(line, location, name, reader, instead, inlined)
    for location, losses in tables_at(inlined.document, LOSSES_OF).items():
        _insert_rows(losses, location, "curve", reading(LOSSES, losses_from), LOSSLESS, inlined)
    for location, train in tables_at(inlined.document, OF_TRAINS).items():
        for name in CURVES:
            _insert_curve(train, location, name, inlined)
    _insert_timetables(inlined)


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
