"""Rows of a timetable: a table with columns in any order, empty cells where nothing is given."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tpss.errors import Finding, alike_together, suggest
from tpss.files.content import content_of
from tpss.tables.aliases import ALIASES
from tpss.tables.header import cell_of
from tpss.tables.kinds import TIMETABLE
from tpss.tables.numbers import COMMA
from tpss.tables.read import Table, sheet_of, sheet_of_text, understood
from tpss.tables.sheet import UTF_8, csv_of, decoded
from tpss.tables.workbook import is_workbook, of_workbook

DURATIONS = ("min_dwell_s", "turn_s")


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a timetable: a train at a station."""

    path: Path
    line: int
    """Number of its line in the file, counted from 1."""
    cells: dict[str, str]
    headings: Mapping[str, str]
    """Headings in the file, by the columns that they mean."""

    def __getitem__(self, column: str) -> str:
        """Text of a cell; empty where nothing is given."""
        return self.cells.get(column, "")

    @property
    def kind(self) -> str:
        """What a train does between its ends: as given, else it stops where there is a time to leave or
        a duration, and passes where there is neither.
        """
        stops = self["departure"] or any(self[column] for column in DURATIONS)
        return self["kind"] or ("stop" if stops else "pass")

    def place(self, column: str) -> str:
        """Place of a cell in the file, or of the row."""
        heading = self.headings.get(column, column)
        return f"line {self.line}, {heading}" if heading else f"line {self.line}"

    def finding(self, column: str, problem: str, remedy: str) -> Finding:
        """A fault of a cell, or of the row."""
        value = self[column] if column else ",".join(self.cells.values())
        return Finding(str(self.path), self.place(column), value, problem, remedy)


@dataclass(frozen=True)
class KindOfPlace:
    """What the rows at a place of a train's journey may say."""

    words: str
    kinds: tuple[str, ...]
    unused: tuple[str, ...] = ()
    """Columns that mean nothing there."""

    def faults(self, row: Row) -> Iterator[Finding]:
        """What a row says that it may not."""
        if not row["station"]:
            yield row.finding("station", "no station is given", "add it")
        if row["kind"] not in ("", *self.kinds):
            problem = f"{self.words} has another kind"
            yield row.finding(
                "kind", problem, f"{suggest(row['kind'], self.kinds)}, or leave it empty"
            )
            return
        for column in self.unused:
            if row[column]:
                yield row.finding(column, f"{self.words} has none", "leave it empty")
        if self.kinds != KIND_OF_PLACE["between"].kinds or row.kind != "pass":
            return
        for column in DURATIONS:
            if row[column]:
                yield row.finding(column, "a train that passes has none", "leave it empty")
        if row["departure"] and row["arrival"] not in ("", row["departure"]):
            problem = f"not the time of arrival, {row['arrival']}, at a station that is passed"
            yield row.finding("departure", problem, "give one of them, or write stop as its kind")


KIND_OF_PLACE = {
    "first": KindOfPlace("the first row of a train", ("start",), ("arrival", *DURATIONS)),
    "between": KindOfPlace("a row between the first and the last of a train", ("stop", "pass")),
    "last": KindOfPlace("the last row of a train", ("end",), ("departure", *DURATIONS, "track")),
}


def read_rows(
    path: Path, named_by: str, findings: list[Finding], text: str | None = None
) -> tuple[list[Row], list[str]]:
    """Rows of a timetable, and what is told of how it was read.

    Rows with faults are left out, and their faults added to the findings.  The file is not read where
    its text is given, in CSV.

    Raises
    ------
    ScenarioError
        The file cannot be read, or its header is wrong.
    """
    if text is None:
        sheet = sheet_of(path, content_of(of_workbook(path)[0], named_by), TIMETABLE)
    else:
        sheet = sheet_of_text(path, text, UTF_8, TIMETABLE)
    table, faults = understood(sheet, TIMETABLE)
    findings += alike_together(faults)
    columns = table.header.columns
    rows = [
        Row(
            sheet.path,
            row.line,
            {ALIASES[name].key: text_of_cell(table, k, name) for name in columns},
            {ALIASES[name].key: column.heading for name, column in columns.items()},
        )
        for k, row in enumerate(table.rows)
    ]
    return rows, table.notes


def text_of_timetable(path: Path, named_by: str) -> str:
    """What is in the file of a timetable, as CSV.

    Raises
    ------
    ScenarioError
        The file cannot be read.
    """
    content = content_of(of_workbook(path)[0], named_by)
    if is_workbook(path):
        return csv_of(sheet_of(path, content, TIMETABLE))
    return decoded(path, content)[0]


_SHORT_DECIMALS = re.compile(r"(\d+),(\d{1,2})")
"""Minutes with a decimal comma, which is none of thousands."""


def text_of_cell(table: Table, row: int, quantity: str) -> str:
    """A value as a text with a decimal point; as it was written where that has one already."""
    column, value = table.header.columns[quantity], table.values[quantity][row]
    cell = cell_of(table.rows[row], column)
    if isinstance(value, float) and not math.isnan(value):
        as_it_is = isinstance(cell, str) and COMMA not in cell and column.meaning.factor == 1.0
        return str(cell) if as_it_is else f"{value:.12g}"
    if quantity in ("arrival", "departure") and isinstance(value, str):
        return _SHORT_DECIMALS.sub(r"\1.\2", value) if _SHORT_DECIMALS.fullmatch(value) else value
    return str(cell) if value is None or isinstance(value, float) else value
