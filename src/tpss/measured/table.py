"""Tables of measured values: CSV as recorders and spreadsheets write it."""

import io
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from tpss.errors import Finding, ScenarioError, shortened
from tpss.measured.quantities import Floats, Indices
from tpss.scenario.files import read_text

SEPARATORS = ("\t", ";", ",")
"""What may separate columns; the first that is in the header does."""

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
    raw = _parsed(path, "\n".join(lines[skipped:]), separator, skipped)
    rows = raw.iloc[1:]
    filled = (rows.fillna("") != "").any(axis=1).to_numpy()
    # What ends every line with a separator has a last column without anything.
    columns = [c for c in raw.columns if not (raw[c].fillna("") == "").all()]
    cells = rows.loc[filled, columns]
    cells.columns = pd.Index([str(name) for name in raw.loc[0, columns]])
    numbers = np.flatnonzero(filled) + skipped + 2
    _demand_whole(path, cells, numbers)
    decimal = "," if separator != "," and _has_decimal_commas(cells) else "."
    return Table(path, cells.reset_index(drop=True), numbers, decimal, notes)


def _is_idle(line: str) -> bool:
    return not line.strip() or line.startswith("#")


def _text_of(path: Path) -> tuple[str, tuple[str, ...]]:
    """Text of a file, and what is told of how it was read."""
    try:
        text, notes = read_text(path), list[str]()
    except ScenarioError as error:
        if not isinstance(error.__cause__, UnicodeDecodeError):
            raise
        try:
            text = path.read_bytes().decode("cp1252")
        except UnicodeDecodeError:
            raise error from None
        notes = [f"{path.name} is not UTF-8 and was read as Windows-1252"]
    return text.replace("\r\n", "\n").replace("\r", "\n"), tuple(notes)


def _parsed(path: Path, text: str, separator: str, skipped: int) -> pd.DataFrame:
    """Cells without white space around them, the header among them; NaN where a row ends early."""
    try:
        raw: pd.DataFrame = pd.read_csv(
            io.StringIO(text), sep=separator, header=None, dtype=str, keep_default_na=False,
            skip_blank_lines=False, skipinitialspace=True,
        )  # fmt: skip
    except pd.errors.ParserError as error:
        problem = (
            f"the rows do not fit the header: {str(error).removeprefix('Error tokenizing data. ')}"
        )
        remedy = (
            "write one value for each column of the header, and texts with separators in quotes; "
            f"lines are counted from the header, line {skipped + 1}"
        )
        raise ScenarioError([Finding(str(path), "", "", problem.strip(), remedy)]) from error
    return pd.DataFrame({name: raw[name].str.strip() for name in raw.columns})


def _demand_whole(path: Path, cells: pd.DataFrame, lines: Indices) -> None:
    """Raise a `ScenarioError` unless there are rows, and every one has a cell for each column."""
    findings = []
    names = list(cells.columns)
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            problem, remedy = "the column is there twice", "give each its own name"
            findings.append(Finding(str(path), "header", name, problem, remedy))
    if cells.empty:
        remedy = "add rows of a time and values"
        findings.append(Finding(str(path), "", "", "no rows follow the header", remedy))
    short = cells.isna().any(axis=1).to_numpy()
    for row in np.flatnonzero(short)[:MOST_FAULTS]:
        value = ",".join(cells.iloc[row].dropna())
        problem = f"{cells.iloc[row].notna().sum()} values, expected {len(names)}"
        remedy = "write one for each column of the header; those that are not known are empty"
        findings.append(Finding(str(path), f"line {lines[row]}", value, problem, remedy))
    if findings:
        raise ScenarioError(findings)


def _has_decimal_commas(cells: pd.DataFrame) -> bool:
    pattern = r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"
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
