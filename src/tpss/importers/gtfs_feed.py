"""Tables of a GTFS feed: CSV files in a folder or in a zip file.

References
----------
https://gtfs.org/documentation/schedule/reference
"""

import csv
import io
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tpss.errors import Finding, ScenarioError, shortened
from tpss.files.archive import demand_likely
from tpss.files.read import MEGABYTE, demand_readable
from tpss.files.refusals import reason

MOST_PACKED, MOST_UNPACKED = 1_000 * MEGABYTE, 4_000 * MEGABYTE
"""Largest zip file, and largest table, that are read: feeds of whole countries are smaller. [byte]"""

REMEDY = "correct the feed, or name another one"


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a table."""

    file: str
    line: int
    cells: dict[str, str]

    def __getitem__(self, column: str) -> str:
        """Text of a cell; empty where the table has no such column."""
        return self.cells.get(column, "")

    def finding(self, column: str, problem: str) -> Finding:
        """A fault of a cell."""
        place = f"line {self.line}, {column}"
        return Finding(self.file, place, shortened(self[column]), problem, REMEDY)

    def number(self, column: str) -> float:
        """Number in a cell.

        Raises
        ------
        ScenarioError
            It is none.
        """
        try:
            value = float(self[column])
        except ValueError:
            value = float("nan")
        if not abs(value) < 1e12:
            raise ScenarioError([self.finding(column, "not a number")])
        return value

    def seconds(self, column: str) -> float | None:
        """Time of day in a cell, H:MM:SS, which may go on beyond 24:00:00; None if it is empty. [s]

        Raises
        ------
        ScenarioError
            It is no time.
        """
        text = self[column]
        if not text:
            return None
        parts = text.split(":")
        if len(parts) != 3 or not all(part.isascii() and part.isdigit() for part in parts):
            raise ScenarioError([self.finding(column, "not a time as H:MM:SS")])
        hours, minutes, seconds = map(int, parts)
        if minutes > 59 or seconds > 59 or hours > 999:
            raise ScenarioError([self.finding(column, "not a time as H:MM:SS")])
        return 3600.0 * hours + 60.0 * minutes + seconds


class Feed:
    """A feed, whose tables are read when they are asked for."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._inside: dict[str, str] = {}
        if path.is_dir():
            return
        try:
            demand_readable(path, MOST_PACKED)
            with zipfile.ZipFile(path) as archive:
                names = [name for name in archive.namelist() if name.endswith(".txt")]
        except (OSError, zipfile.BadZipFile) as error:
            problem = f"neither a folder nor a zip file that can be read: {reason(error)}"
            remedy = (
                "name a folder with the tables of a GTFS feed, such as stops.txt, or its zip file"
            )
            raise ScenarioError([Finding(str(path), "", "", problem, remedy)]) from error
        for name in sorted(names, key=lambda each: -each.count("/")):
            self._inside[Path(name).name] = name

    def __contains__(self, table: str) -> bool:
        return table in self._inside or (self.path.is_dir() and (self.path / table).is_file())

    def rows(self, table: str, *needed: str) -> Iterator[Row]:
        """Rows of a table.

        Parameters
        ----------
        table : str
            File name.
        *needed : str
            Columns that it cannot be without.

        Raises
        ------
        ScenarioError
            The table is missing, lacks a column, or cannot be read.
        """
        place = str(self.path / table)
        if table not in self:
            raise ScenarioError([Finding(place, "", "", "the feed has no such table", REMEDY)])
        try:
            with self._open(table) as text:
                yield from _rows(place, text, needed)
        except (OSError, ValueError, csv.Error, zipfile.BadZipFile) as error:
            problem = f"the table cannot be read: {reason(error)}"
            raise ScenarioError([Finding(place, "", "", problem, REMEDY)]) from error

    def optional_rows(self, table: str, *needed: str) -> Iterator[Row]:
        """Rows of a table that a feed need not have."""
        return self.rows(table, *needed) if table in self else iter(())

    def _open(self, table: str) -> io.TextIOWrapper:
        if self.path.is_dir():
            demand_readable(self.path / table, MOST_UNPACKED)
            return (self.path / table).open(encoding="utf-8-sig", newline="")
        archive = zipfile.ZipFile(self.path)
        with archive:  # the file that is opened keeps what it needs
            demand_likely(archive.getinfo(self._inside[table]))
            return io.TextIOWrapper(archive.open(self._inside[table]), "utf-8-sig", newline="")


def _rows(place: str, text: io.TextIOWrapper, needed: tuple[str, ...]) -> Iterator[Row]:
    reader = csv.reader(text)
    header = [cell.strip() for cell in next(reader, [])]
    missing = [column for column in needed if column not in header]
    if missing:
        problem = f"the column {missing[0]} is missing"
        raise ScenarioError(
            [Finding(place, "line 1", shortened(",".join(header)), problem, REMEDY)]
        )
    for cells in reader:
        if cells:
            stripped = (cell.strip() for cell in cells)
            yield Row(place, reader.line_num, dict(zip(header, stripped, strict=False)))
