"""Files of a scenario from tables of offices: CSV with headings of TPSS, and the line of the tables."""

import csv
import io
from collections.abc import Sequence
from typing import Any

import tomli_w

from tpss.importers.office_tables import OfficeTable
from tpss.importers.texts import comments
from tpss.scenario.line import IN_FILES
from tpss.scenario.scenario import Scenario
from tpss.tables.kinds import GRADIENTS, SPEED_LIMITS, STATIONS

LINE = "line.toml"

OF_A_LINE = (STATIONS.name, GRADIENTS.name, SPEED_LIMITS.name)
"""Kinds of tables of a line; the first that is there says where it begins and ends."""


PLACEHOLDER_KMH = 80.0
"""Speed limit of a line whose limits are not known, while the rest of it is looked at. [km/h]"""


PLACEHOLDER_KM = 1.0
"""Length of a line that its tables do not tell. [km]"""


def files(tables: Sequence[OfficeTable]) -> dict[str, str]:
    """Texts by file name: a table in CSV of each, and the line if tables are of one.

    Raises
    ------
    ScenarioError
        The line that they make has faults; what is missing of it is taken to be plain.
    """
    texts = {each.file: _csv(each) for each in tables}
    own = {each.kind.name: each for each in tables if each.kind.name in OF_A_LINE}
    if own:
        texts[LINE] = _line(own)
    return texts


def _csv(each: OfficeTable) -> str:
    """A table in CSV, with comments on how it was read."""
    text = io.StringIO()
    text.write(comments(f"Imported from {each.table.path.name}.", each).rstrip("\n") + "\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(each.made.columns)
    for row in zip(*each.made.columns.values(), strict=True):
        writer.writerow([f"{cell:.12g}" if isinstance(cell, float) else cell for cell in row])
    return text.getvalue()


def _line(own: dict[str, OfficeTable]) -> str:
    """The line, in TOML."""
    begin_km, end_km, of = ends_of(own)
    sources = ", ".join(each.table.path.name for each in own.values())
    lines = [
        f'# A line from {sources}; a scenario names it: line = "{LINE}"',
        f"# ASSUMED, edit it: it begins and ends where its {of.replace('-', ' ')} do.",
    ]
    document: dict[str, Any] = {"source": sources}
    if begin_km != 0.0:
        document["begins_at_km"] = begin_km
    document["length_km"] = round(end_km - begin_km, 9)
    for name, each in own.items():
        document[f"{name.replace('-', '_')}_file"] = each.file
    missing = [name for name in IN_FILES if f"{name}_file" not in document]
    lines += [f"# MISSING, add it: {name}, or {name}_file" for name in missing]
    _check(own, document)
    return "\n".join([*lines, "", tomli_w.dumps(document)])


def ends_of(own: dict[str, OfficeTable]) -> tuple[float, float, str]:
    """Beginning and end of a line [km], and the kind of table that says so."""
    name = next(each for each in OF_A_LINE if each in own)
    columns = own[name].made.columns
    places = columns.get("position_km") or columns["from_km"]
    ends = own[name].table.values.get("end", [])
    return min(places), max([*places, *(km for km in ends if isinstance(km, float))]), name


def _check(own: dict[str, OfficeTable], line: dict[str, Any]) -> None:
    """Validate the line in a scenario whose other parts, and missing tables, are placeholders.

    Raises
    ------
    ScenarioError
        It has faults.
    """
    begin_km = line.get("begins_at_km", 0.0)
    length_km = line["length_km"] or PLACEHOLDER_KM  # a table of one row has no end
    end_km = begin_km + length_km
    rows: dict[str, list[dict[str, Any]]] = {
        STATIONS.name: [
            {"name": "begin", "position_km": begin_km},
            {"name": "end", "position_km": end_km},
        ],
        GRADIENTS.name: [{"from_km": begin_km, "permille": 0.0}],
        SPEED_LIMITS.name: [{"from_km": begin_km, "speed_kmh": PLACEHOLDER_KMH}],
        **{name: _rows(each) for name, each in own.items()},
    }
    first, last = (rows[STATIONS.name][k]["name"] for k in (0, -1))
    plain = {"begins_at_km": begin_km, "length_km": length_km}
    station = {"name": "S", "position_km": begin_km, "type": "Q48/Q49", "converters": 1}
    document: dict[str, Any] = {
        "format": 1,
        "name": "check",
        "line": plain | {name.replace("-", "_"): each for name, each in rows.items()},
        "simulation": {"time_step_min": 1.0, "duration_min": 60.0},
        "supply": {"catenary": "BT", "converter_stations": [station]},
        "trains": {"t": {"model": "Rc4-freight-1470t"}},
        "traffic": [{"name": "t", "train": "t", "from": first, "to": last, "headway_min": 10.0}],
    }
    Scenario.from_document(document, next(iter(own.values())).table.path)


def _rows(each: OfficeTable) -> list[dict[str, Any]]:
    """Rows of a table as in a scenario."""
    keys = {"gradient_permille": "permille"}
    if each.kind.name != STATIONS.name:
        keys["position_km"] = "from_km"
    names = [keys.get(name, name) for name in each.made.columns]
    rows = zip(*each.made.columns.values(), strict=True)
    return [
        {name: value for name, value in zip(names, row, strict=True) if value is not None}
        for row in rows
    ]
