"""The header of a table: which of its rows it is, and what its headings mean."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tpss.errors import Finding, ScenarioError, closest, shortened
from tpss.tables.aliases import ALIASES, Meaning, meaning_of, unit_named
from tpss.tables.kinds import Kind
from tpss.tables.numbers import is_post
from tpss.tables.sheet import Cell, Row, Sheet

MOST_ABOVE = 20
"""Rows, such as a title, that may stand above the header."""


class Column(NamedTuple):
    """A column that is known: its place from 0, its heading and what that means."""

    place: int
    heading: str
    meaning: Meaning


class Header(NamedTuple):
    """The header of a table.

    Attributes
    ----------
    above : int
        Number of rows above it.
    first : int
        Number of rows above the first one of values: those above, the header, and perhaps units.
    line : int
    headings : tuple of str
    columns : dict of str to Column
        By their quantities.
    """

    above: int
    first: int
    line: int
    headings: tuple[str, ...]
    columns: dict[str, Column]

    @property
    def passed_over(self) -> list[str]:
        """Headings of the columns that are not used."""
        used = {column.place for column in self.columns.values()}
        return [text for k, text in enumerate(self.headings) if k not in used and text]


def cell_of(row: Row, column: Column) -> Cell:
    """Cell of a row in a column; empty where a row of a workbook ends before."""
    return row.cells[column.place] if column.place < len(row.cells) else ""


def find_header(rows: Sequence[Row], kind: Kind) -> Header | None:
    """The first row with all columns that a kind of table needs; None if there is none."""
    for above, row in enumerate(rows[: MOST_ABOVE + 1]):
        headings = tuple(cell if isinstance(cell, str) else "" for cell in row.cells)
        columns = _known(headings, kind)
        if all(any(each in columns for each in either) for either in kind.needed):
            with_units = _units_below(columns, rows[above + 1 :])
            first = above + 2 if with_units else above + 1
            columns = _by_their_form(with_units or columns, rows[first:])
            _leave_one(columns, kind, rows[first:])
            return Header(above, first, row.line, headings, columns)
    return None


def _leave_one(columns: dict[str, Column], kind: Kind, below: Sequence[Row]) -> None:
    """Leave, of columns of which one is enough, the first with anything in it."""
    for either in kind.needed:
        given = [each for each in either if each in columns]
        filled = [each for each in given if any(cell_of(row, columns[each]) != "" for row in below)]
        for each in given:
            if each != (filled or given)[0]:
                del columns[each]


def _units_below(columns: dict[str, Column], below: Sequence[Row]) -> dict[str, Column]:
    """Columns with the units that stand in a row of their own below the headings; empty: in none."""
    numeric = {name: each for name, each in columns.items() if ALIASES[name].is_number}
    texts = {name: str(cell_of(below[0], each)) for name, each in numeric.items()} if below else {}
    found = {name: unit_named(text, name) for name, text in texts.items() if text}
    named = {name: meaning for name, meaning in found.items() if meaning is not None}
    if not named or len(named) < len(found):
        return {}
    return {
        name: each._replace(meaning=named.get(name, each.meaning)) for name, each in columns.items()
    }


def _by_their_form(columns: dict[str, Column], below: Sequence[Row]) -> dict[str, Column]:
    """Columns of which some say their unit by how all of their cells are written: 438+500 is in km."""
    completed = dict(columns)
    for name, each in columns.items():
        cells = [cell for row in below if (cell := cell_of(row, each)) != ""]
        is_open = ALIASES[name].is_number and not each.meaning.unit
        if is_open and cells and all(isinstance(c, str) and is_post(c) for c in cells):
            meaning = Meaning(name, "km", 1.0, True)
            completed[name] = each._replace(meaning=meaning)
    return completed


def _known(headings: Sequence[str], kind: Kind) -> dict[str, Column]:
    """Columns by their quantities; one that is called as in files of TPSS comes before others."""
    columns: dict[str, Column] = {}
    for place, heading in enumerate(headings):
        meaning = meaning_of(heading, kind.quantities) if heading else None
        if meaning is None:
            continue
        own = heading == ALIASES[meaning.quantity].key
        if own or meaning.quantity not in columns:
            columns[meaning.quantity] = Column(place, heading, meaning)
    for further, needed in kind.alone:
        column = columns.get(further)
        if column and needed not in columns and column.heading.casefold() == ALIASES[further].key:
            columns[needed] = columns.pop(further)._replace(meaning=Meaning(needed, "", 1.0, False))
    return columns


def demand_header(sheet: Sheet, kind: Kind) -> Header:
    """The header of a table of a kind.

    Raises
    ------
    ScenarioError
        There is none, or it does not say what its columns are.
    """
    header = find_header(sheet.rows, kind)
    if header is None:
        raise ScenarioError([_no_header(sheet, kind)])
    if findings := list(_faults(sheet, header, kind)):
        raise ScenarioError(findings)
    return header


def _no_header(sheet: Sheet, kind: Kind) -> Finding:
    """The fault that no row is a header: what the most likely one lacks."""
    rows = sheet.rows[: MOST_ABOVE + 1]
    remedy = f"begin with the line {kind.header}, or see what other headings are known: "
    remedy += "tpss import csv --headings"
    if not rows:
        return Finding(str(sheet.path), "line 1", "", "the file has no rows", remedy)
    known = [_known([str(cell) for cell in row.cells], kind) for row in rows]
    best = max(range(len(rows)), key=lambda k: (len(known[k]), -k))
    lacking = [
        " or ".join(ALIASES[each].words for each in either)
        for either in kind.needed
        if not any(each in known[best] for each in either)
    ]
    shown = (sheet.separator or ",").join(str(cell) for cell in rows[best].cells)
    problem = f"not the expected header: no column is the {' and none the '.join(lacking)}"
    return Finding(str(sheet.path), f"line {rows[best].line}", shortened(shown), problem, remedy)


def _faults(sheet: Sheet, header: Header, kind: Kind) -> Iterator[Finding]:
    """Headings without a unit that has to be given, or twice, and those that are misspelt."""
    file, place = str(sheet.path), f"line {header.line}"
    for name, column in header.columns.items():
        quantity = ALIASES[name]
        if quantity.is_number and not column.meaning.unit:
            units = " or ".join(f"[{names.split()[0]}]" for names in quantity.units)
            remedy = f"write it behind, as in {quantity.key} or {column.heading} {units}"
            problem = f"the heading gives no unit of the {quantity.words}"
            yield Finding(file, place, column.heading, problem, remedy)
        twice = [
            other
            for k, other in enumerate(header.headings)
            if k != column.place and other == column.heading
        ]
        if twice:
            yield Finding(file, place, column.heading, "the column is there twice", "leave one out")
    yield from _faults_of_rivals(sheet, header, kind)
    free = [ALIASES[each].key for each in kind.further if each not in header.columns]
    for heading in header.passed_over:
        if near := closest(heading, free):
            remedy = f"did you mean {near}? else give it a name that is not so like it"
            yield Finding(file, place, heading, "no such column", remedy)


def _faults_of_rivals(sheet: Sheet, header: Header, kind: Kind) -> Iterator[Finding]:
    """Several columns that may be the same thing, none of them called as in files of TPSS."""
    for heading in header.passed_over:
        meaning = meaning_of(heading, kind.quantities)
        column = header.columns.get(meaning.quantity) if meaning is not None else None
        if column is None or column.heading in (heading, ALIASES[column.meaning.quantity].key):
            continue
        quantity = ALIASES[column.meaning.quantity]
        problem = f"the column {column.heading} may be the {quantity.words} too"
        remedy = f"call the one that counts {quantity.key}; the other one is then passed over"
        yield Finding(str(sheet.path), f"line {header.line}", heading, problem, remedy)
