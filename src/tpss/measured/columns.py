"""What the columns of a table are: by their headings, or by a file that explains them.

A heading says quantity, element and unit: ``station_active_power:West [MW]``.  A TOML file gives them
for columns that recorders have named::

    time = "Zeitstempel"          # else the first column
    time_unit = "s"               # of times that are numbers
    ignore = ["Bemerkung"]

    [columns."UW West P"]
    quantity = "station_active_power"
    element = "West"
    unit = "kW"
    factor = -1.0                 # else 1
"""

import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tpss.errors import Finding, ScenarioError, suggest
from tpss.measured.column_map import OF_A_COLUMN, faults_of_map
from tpss.measured.quantities import QUANTITIES, UNITS, elements_of, nodes_of, units_of
from tpss.measured.table import Table
from tpss.results.result import Result
from tpss.scenario.files import read_toml

HEADING = r"(\w+)\s*:\s*(.+?)\s*\[\s*(.*?)\s*\]"
TIME_HEADING = r"(.*?)\s*\[\s*(\w+)\s*\]"

CONVENTION = "QUANTITY:ELEMENT [UNIT], such as station_active_power:West [MW]"


class Column(NamedTuple):
    """A column to compare: what it holds, and the factor to the unit of SI."""

    name: str
    quantity: str
    element: str
    factor: float

    @property
    def series(self) -> str:
        """Name of the series."""
        return f"{self.quantity}:{self.element}"


class Columns(NamedTuple):
    """Columns of a table: that of the times with their unit, and those to compare."""

    time: str
    time_unit: str | None
    compared: list[Column]


def find_columns(table: Table, map_file: Path | None, result: Result) -> Columns:
    """What the columns of a table are in a run.

    Raises
    ------
    ScenarioError
        A column is not explained, or names what there is not in the run; all faults are listed.
    """
    document = {} if map_file is None else read_toml(map_file)
    names = [str(name) for name in table.cells.columns]
    findings = [] if map_file is None else list(faults_of_map(map_file, document, names))
    if findings:
        raise ScenarioError(findings)
    time = document.get("time", names[0])
    given: Mapping[str, Any] = document.get("columns", {})
    compared = []
    for name in names:
        if name == time or name in document.get("ignore", []):
            continue
        place = f"column {name!r}"
        if name in given:
            entry, blamed = given[name], (str(map_file), f"columns.{name}.")
        else:
            match = re.fullmatch(HEADING, name)
            if match is None:
                findings.append(_unexplained(table, place))
                continue
            entry = dict(zip(OF_A_COLUMN, match.groups(), strict=False))
            blamed = (str(table.path), f"{place}, ")
        faults = list(_faults_of_column(entry, blamed, result))
        findings += faults
        if not faults:
            factor = UNITS[entry["unit"]][1] * entry.get("factor", 1.0)
            compared.append(Column(name, entry["quantity"], entry["element"], factor))
    findings += _faults_of_all(table, compared, bool(findings))
    if findings:
        raise ScenarioError(findings)
    match = re.fullmatch(TIME_HEADING, time)
    return Columns(time, document.get("time_unit", match and match[2]), compared)


def _unexplained(table: Table, place: str) -> Finding:
    problem = "the column maps to nothing of the run"
    remedy = f"name it {CONVENTION}, or explain it or list it in ignore in a file for --map"
    return Finding(str(table.path), place, "", problem, remedy)


def _faults_of_all(table: Table, compared: list[Column], others: bool) -> Iterator[Finding]:
    """Columns that are the same, or none at all."""
    series = [column.series for column in compared]
    for k, column in enumerate(compared):
        if column.series in series[:k]:
            problem = (
                f"another column, {compared[series.index(column.series)].name!r}, has the same"
            )
            remedy = "leave one out, or list it in ignore in a file for --map"
            yield Finding(
                str(table.path), f"column {column.name!r}", column.series, problem, remedy
            )
    if not compared and not others:
        remedy = f"name at least one column {CONVENTION}"
        yield Finding(str(table.path), "header", "", "no column is to be compared", remedy)


def _faults_of_column(
    entry: Mapping[str, Any], blamed: tuple[str, str], result: Result
) -> Iterator[Finding]:
    """What is wrong with quantity, element, unit and factor of a column."""
    file, place = blamed

    def fault(key: str, problem: str, remedy: str) -> Finding:
        return Finding(file, f"{place}{key}", repr(entry.get(key, "")), problem, remedy)

    if entry.get("quantity") not in list(QUANTITIES):
        yield fault("quantity", "no quantity that can be compared", suggest(
            str(entry.get("quantity", "")), QUANTITIES))  # fmt: skip
        return
    quantity = QUANTITIES[entry["quantity"]]
    elements = elements_of(quantity, result.dataset)
    if entry.get("element") not in elements:
        remedy = suggest(str(entry.get("element", "")), elements)
        yield fault("element", f"the run has no such {quantity.of}", remedy)
    elif entry["quantity"] == "station_voltage":
        nodes = nodes_of(entry["element"], result)
        if len(nodes) != 1:
            problem = "its place does not tell which node it feeds"
            remedy = f"take node_voltage, and as its element one of: {'; '.join(nodes)}"
            yield fault("element", problem, remedy)
    if entry.get("unit") not in units_of(quantity):
        remedy = f"choose from {', '.join(units_of(quantity))}"
        yield fault("unit", f"no unit of {entry['quantity']}", remedy)
    factor = entry.get("factor", 1.0)
    if not _is_number(factor) or factor == 0.0:
        yield fault(
            "factor", "not a number other than 0", "give -1 for the opposite sign, or leave it out"
        )


def _is_number(value: object) -> bool:
    is_one = isinstance(value, int | float) and not isinstance(value, bool)
    return is_one and math.isfinite(float(value))  # type: ignore[arg-type]
