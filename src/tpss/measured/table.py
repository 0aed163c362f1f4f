"""Tables of measured values: CSV as recorders and spreadsheets write it."""

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from tpss.errors import Finding, ScenarioError, shortened
from tpss.files.content import content_of
from tpss.files.read import MEGABYTE
from tpss.measured.quantities import Floats, Indices
from tpss.tables.sheet import UTF_8, decoded

SEPARATORS = ("\t", ";", ",")
"""What may separate columns; the first that is in the header does."""

MOST_BYTES = 1_000 * MEGABYTE
"""Longest file that is read: recorders write less in months. [byte]"""

COMMA_NUMBER = r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"
DECISIVE = rf"(?![+-]?[1-9]\d{{0,2}},\d{{3}}$){COMMA_NUMBER}"
"""A number with a decimal comma, and one whose comma cannot part thousands."""

GAPS = ("", "nan", "na")
"""Texts of cells, in small letters, that are no values."""

MOST_FAULTS = 5
"""Faults of one column that are listed."""


class Table(NamedTuple):
    """Cells of a table as texts.

    Attributes
    ----------
    path : Path
    cells : pandas.DataFrame
        White space around the texts is left out; the names of the columns are those of the header.
    lines : sequence of int
        Number of each row's line in the file, counted from 1.
    decimal : str
        Decimal point or comma.
    notes : tuple of str
        What is told of the file.
    """

    path: Path
    cells: pd.DataFrame
    lines: Indices
    decimal: str
    notes: tuple[str, ...]

    def fault(self, row: int | None, column: str, value: str, problem: str, remedy: str) -> Finding:
        """A fault of a cell, or of a whole column."""
        where = f"column {column!r}"
        place = where if row is None else f"line {int(self.lines[row])}, {where}"
        return Finding(str(self.path), place, shortened(value), problem, remedy)


def read_table(path: Path) -> Table:
    """Table of a CSV file: UTF-8 or Windows-1252, separated by tabs, semicolons or commas.

    Lines before the header that begin with # are comments; lines without a value are left out.

    Raises
    ------
    ScenarioError
        The file cannot be read, its rows do not fit its header, or a column is there twice.
    """
    text, notes = _text_of(path)
    lines = text.split("\n")
    skipped = next((k for k, line in enumerate(lines) if not _is_idle(line)), len(lines))
    if skipped == len(lines):
        problem = "the file is empty"
        remedy = "write a header, such as time [s],station_active_power:West [MW], and rows"
        raise ScenarioError([Finding(str(path), "line 1", "", problem, remedy)])
    separator = next((each for each in SEPARATORS if each in lines[skipped]), ",")
    (_, header), *rows = _rows(path, "\n".join(lines[skipped:]), separator, skipped)
    while (
        len(header) > 1
        and not header[-1]
        and not any(any(row[len(header) - 1 :]) for _, row in rows)
    ):
        header = header[:-1]  # lines that end with a separator
    findings = list(_faults(path, header, rows))
    if findings:
        raise ScenarioError(findings)
    cells = pd.DataFrame([row[: len(header)] for _, row in rows], columns=header, dtype=str)
    numbers = np.array([number for number, _ in rows], dtype=np.int64)
    decimal = "," if separator != "," and _has(COMMA_NUMBER, cells) else "."
    if decimal == "," and not _has(DECISIVE, cells):
        notes = (*notes, f"{path.name}: commas are read as those of decimals, 1,234 as 1.234")
    return Table(path, cells, numbers, decimal, notes)


def _is_idle(line: str) -> bool:
    return not line.strip() or line.startswith("#")


def _text_of(path: Path) -> tuple[str, tuple[str, ...]]:
    """Text of a file, and what is told of how it was read."""
    text, encoding = decoded(path, content_of(path, most_bytes=MOST_BYTES))
    notes = [] if encoding == UTF_8 else [f"{path.name} is not UTF-8 and was read as {encoding}"]
    return text, tuple(notes)


def _rows(path: Path, text: str, separator: str, skipped: int) -> list[tuple[int, list[str]]]:
    """Rows with anything in them, and the numbers of their lines; no white space around the cells.

    Raises
    ------
    ScenarioError
        A cell is longer than any that Python's reader takes, such as one of quotes that nobody closes.
    """
    reader = csv.reader(io.StringIO(text), delimiter=separator, skipinitialspace=True)
    try:
        rows = [(skipped + reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        place = f"line {skipped + reader.line_num}"
        remedy = "close quotes that are open, and leave out what is no table"
        raise ScenarioError([Finding(str(path), place, "", str(error), remedy)]) from error
    return [(number, row) for number, row in rows if any(row)]


def _faults(path: Path, header: list[str], rows: list[tuple[int, list[str]]]) -> Iterator[Finding]:
    """What is wrong with the form of a table."""
    for name in dict.fromkeys(header):
        if header.count(name) > 1:
            problem, remedy = "the column is there twice", "give each its own name"
            yield Finding(str(path), "header", name, problem, remedy)
    if not rows:
        remedy = "add rows of a time and values"
        yield Finding(str(path), "", "", "no rows follow the header", remedy)
    count = len(header)
    odd = [(k, row) for k, row in rows if len(row) < count or any(row[count:])]
    for number, row in odd[:MOST_FAULTS]:
        value = shortened(",".join(row))
        remedy = (
            "write one for each column of the header; those that are not known are empty, and those "
            "with separators stand in quotes"
        )
        problem = f"{len(row)} values, expected {count}"
        yield Finding(str(path), f"line {number}", value, problem, remedy)


def _has(pattern: str, cells: pd.DataFrame) -> bool:
    """Whether a cell is written like this."""
    return any(cells[name].str.fullmatch(pattern).any() for name in cells.columns)


def numbers(table: Table, column: str, findings: list[Finding]) -> Floats:
    """Numbers of a column; NaN: a cell is empty.  Other texts are added to the findings."""
    texts = table.cells[column]
    plain = texts if table.decimal == "." else texts.str.replace(",", ".", regex=False)
    values = pd.to_numeric(plain, errors="coerce").to_numpy(dtype=float, copy=True)
    # In a file with decimal commas a point would be one of thousands.
    mixed = np.zeros(len(texts), bool)
    if table.decimal == ",":
        mixed = texts.str.contains(".", regex=False).to_numpy()
    gaps = texts.str.lower().isin(GAPS).to_numpy()
    wrong = (~np.isfinite(values) | mixed) & ~gaps
    values[gaps | wrong] = np.nan
    remedy = f"write a number with a decimal {'comma' if table.decimal == ',' else 'point'} and no "
    remedy += "separators of thousands, or leave the cell empty"
    for row in np.flatnonzero(wrong)[:MOST_FAULTS]:
        findings.append(table.fault(int(row), column, texts.iloc[row], "not a number", remedy))
    more = int(wrong.sum()) - MOST_FAULTS
    if more > 0:
        problem = f"{more} more cells are not numbers"
        findings.append(table.fault(None, column, "", problem, remedy))
    return values
