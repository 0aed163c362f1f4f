"""Rows of a timetable: CSV with a header, columns in any order, empty cells where nothing is given."""

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tpss.errors import Finding, ScenarioError, suggest
from tpss.scenario.files import read_text

COLUMNS = (
    "name", "train", "station", "arrival", "departure", "min_dwell_s", "turn_s", "track", "kind",
)  # fmt: skip

DURATIONS = ("min_dwell_s", "turn_s")

NEEDED = ("name", "station", "departure")
"""Columns that a timetable cannot be without."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a timetable: a train at a station."""

    path: Path
    line: int
    """Number of its line in the file, counted from 1."""
    cells: dict[str, str]

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
        return f"line {self.line}, {column}" if column else f"line {self.line}"

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
) -> list[Row]:
    """Rows of a timetable; those with faults are left out, and their faults added to the findings.

    The file is not read where its text is given.

    Lines that begin with # are comments, and semicolons may stand for the commas.

    Raises
    ------
    ScenarioError
        The file cannot be read, or its header is wrong.
    """
    content = read_text(path, named_by) if text is None else text
    lines = [
        (number, line)
        for number, line in enumerate(content.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    number, header = lines[0] if lines else (1, "")
    separator = ";" if ";" in header else ","
    columns = _split(header, separator)
    faults = list(_faults_of_header(path, number, columns))
    if not faults and not lines[1:]:
        remedy = "add rows, one for each station of a train"
        faults.append(
            Finding(str(path), f"line {number}", header, "no rows follow the header", remedy)
        )
    if faults:
        raise ScenarioError(faults)
    rows = []
    for number, line in lines[1:]:
        cells = _split(line, separator)
        if len(cells) == len(columns):
            rows.append(Row(path, number, dict(zip(columns, cells, strict=True))))
        else:
            problem = f"{len(cells)} values, expected {len(columns)}"
            remedy = "write one for each column of the header; those that are not given are empty"
            findings.append(Finding(str(path), f"line {number}", line, problem, remedy))
    return rows


def _split(text: str, separator: str) -> list[str]:
    cells = next(csv.reader([text], delimiter=separator)) if '"' in text else text.split(separator)
    return [cell.strip() for cell in cells]


def _faults_of_header(path: Path, number: int, columns: list[str]) -> Iterator[Finding]:
    place = f"line {number}"
    if not set(columns) & set(COLUMNS):
        remedy = f"begin with the line {','.join(COLUMNS)}"
        yield Finding(str(path), place, ",".join(columns), "not the header of a timetable", remedy)
        return
    for column in dict.fromkeys(columns):
        if columns.count(column) > 1:
            yield Finding(str(path), place, column, "the column is there twice", "leave one out")
        if column not in COLUMNS:
            yield Finding(str(path), place, column, "no such column", suggest(column, COLUMNS))
    for column in NEEDED:
        if column not in columns:
            yield Finding(str(path), place, "", f"the column {column} is missing", "add it")
