"""Tables whose columns are understood: values by what they are, in the units of TPSS, and notes."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from tpss import units
from tpss.errors import Finding, ScenarioError, alike_together, shortened
from tpss.files.content import content_of
from tpss.kept import Kept
from tpss.tables.aliases import ALIASES
from tpss.tables.header import MOST_ABOVE, Column, Header, cell_of, demand_header, find_header
from tpss.tables.kinds import Kind
from tpss.tables.numbers import (
    COMMA,
    IN_WORDS,
    is_post,
    number,
    plain,
    post_km,
    readings_of,
    signs_of,
)
from tpss.tables.sheet import (
    SEPARATORS,
    UTF_8,
    Cell,
    Row,
    Sheet,
    decoded,
    lines_of,
    split,
    told_separator,
)
from tpss.tables.workbook import is_workbook, of_workbook, read_sheet

Value = float | str | None
"""None: the cell is empty."""


Made = TypeVar("Made")


@dataclass(frozen=True)
class Table:
    """A table of a file.

    Attributes
    ----------
    sheet : Sheet
    kind : Kind
    header : Header
    rows : sequence of Row
        Below the header.
    values : dict of str to list
        Values of each row by quantity, in the units of TPSS.
    signs : dict of str to str
        What begins the decimals, by quantity.
    notes : list of str
        What is told of how it was read.
    """

    sheet: Sheet
    kind: Kind
    header: Header
    rows: Sequence[Row]
    values: dict[str, list[Value]]
    signs: dict[str, str]
    notes: list[str]

    @property
    def path(self) -> Path:
        """Its file, perhaps with the name of a sheet."""
        return self.sheet.path

    def __len__(self) -> int:
        """Number of its rows."""
        return len(self.rows)

    def place(self, row: int, quantity: str) -> str:
        """Place in the file of a row's value."""
        column = self.header.columns.get(quantity)
        return f"line {self.rows[row].line}" + (f", {column.heading}" if column else "")

    def numbers(self, quantity: str) -> list[float]:
        """Numbers of a quantity that each row has."""
        return [float(value) for value in self.values[quantity] if value is not None]

    def fault(self, row: int, quantity: str, value: object, problem: str, remedy: str) -> Finding:
        """A fault of a cell."""
        place = self.place(row, quantity)
        return Finding(str(self.path), place, shortened(str(value)), problem, remedy)


def reading(kind: Kind, make: Callable[[Table], Made]) -> Callable[[Path, str], Made]:
    """What reads a file, by its path and the key that names it, and makes of its table what it means."""
    return lambda path, named_by: make(read_table(path, kind, named_by))


def read_table(
    path: Path, kind: Kind, named_by: str = "", content: bytes | None = None, decimal: str = ""
) -> Table:
    """Table of a file: CSV, or a sheet of a workbook, ``file.xlsx#Sheet``, the first unless named.

    Parameters
    ----------
    path : Path
    kind : Kind
    named_by : str
        Key that names the file.
    content : bytes, optional
        What is in the file, if that has been read before.
    decimal : str
        What begins the decimals, if that is known.

    Raises
    ------
    ScenarioError
        The file cannot be read, or has faults; all are listed, those of one kind once.
    """
    content = content_of(of_workbook(path)[0], named_by) if content is None else content
    if len(content) > MOST_KEPT:
        return table_of(sheet_of(path, content, kind), kind, decimal)
    key = path, kind, decimal, content
    table = _kept.of(key, lambda: table_of(sheet_of(path, content, kind), kind, decimal))
    return replace(table, notes=list(table.notes))  # to which whoever makes something of it adds


MOST_KEPT = 100_000
"""Bytes of a file whose table is kept: a scenario that is changed reads its files again and again."""

_kept: Kept[Table] = Kept(8)


def sheet_of(path: Path, content: bytes, kind: Kind) -> Sheet:
    """Cells of a file; of CSV parted by what makes its header one of a kind.

    Raises
    ------
    ScenarioError
        It is neither a workbook nor a text.
    """
    if is_workbook(path):
        return read_sheet(path, content)
    return sheet_of_text(path, *decoded(path, content), kind)


def sheet_of_text(path: Path, text: str, encoding: str, kind: Kind) -> Sheet:
    """Cells of CSV, parted by what makes its header one of a kind.

    Raises
    ------
    ScenarioError
        Quotes are not closed.
    """
    lines = lines_of(text)
    if told := told_separator(lines):
        return Sheet(path, split(path, lines[1:], told), told, encoding)
    first = lines[0][1] if lines else ""
    above = "\n".join(line for _, line in lines[: MOST_ABOVE + 1])
    likely = [each for each in SEPARATORS if each in first] or [COMMA]
    sheets = [
        Sheet(path, split(path, lines, separator), separator, encoding)
        for separator in dict.fromkeys([*likely, *SEPARATORS])
        if separator in likely or separator in above
    ]
    return next((each for each in sheets if find_header(each.rows, kind)), sheets[0])


def table_of(sheet: Sheet, kind: Kind, decimal: str = "") -> Table:
    """Table of cells, as `read_table`.

    Raises
    ------
    ScenarioError
        It has faults; those of one kind are listed once.
    """
    table, findings = understood(sheet, kind, decimal)
    findings += _faults_of_cells(table)
    if findings:
        raise ScenarioError(alike_together(findings))
    return table


def understood(sheet: Sheet, kind: Kind, decimal: str = "") -> tuple[Table, list[Finding]]:
    """Table of cells without the rows that do not fit its header, and faults of rows and columns.

    Cells that are no numbers where they should be are NaN.

    Raises
    ------
    ScenarioError
        There is no header.
    """
    header = demand_header(sheet, kind)
    rows = sheet.rows[header.first :]
    findings = list(_faults_of_rows(sheet, header, rows, kind))
    whole = [row for row in rows if not _is_odd(row, sheet, header)]
    signs, told = _signs(sheet, header, whole, decimal, findings)
    values = {
        name: [_value(column, cell_of(row, column), signs.get(name, "")) for row in whole]
        for name, column in header.columns.items()
    }
    notes = [f"{sheet.path.name}: {note}" for note in (*_notes(sheet, header), *told)]
    return Table(sheet, kind, header, whole, values, signs, notes), findings


def _faults_of_rows(
    sheet: Sheet, header: Header, rows: Sequence[Row], kind: Kind
) -> Iterator[Finding]:
    """Rows that do not fit the header, or that there are none."""
    separator = SEPARATORS.get(sheet.separator, "comma")
    shown = sheet.separator or ","
    if not rows:
        value = shortened(shown.join(header.headings))
        remedy = f"add rows of {kind.row}"
        place = f"line {header.line}"
        yield Finding(str(sheet.path), place, value, "no rows follow the header", remedy)
    for row in rows:
        if _is_odd(row, sheet, header):
            remedy = (
                f"write one for each column of the header, separated by a {separator}; a text with "
            )
            remedy += "one stands in quotes"
            if sheet.separator == COMMA:
                remedy += "; with decimal commas, save it with semicolons"
            problem = f"{len(row.cells)} values, expected {len(header.headings)}"
            text = shortened(shown.join(map(str, row.cells)))
            yield Finding(str(sheet.path), f"line {row.line}", text, problem, remedy)


def _is_odd(row: Row, sheet: Sheet, header: Header) -> bool:
    """Whether a row has more values than the header, or, in CSV, fewer."""
    count = len(header.headings)
    return any(row.cells[count:]) or (sheet.separator != "" and len(row.cells) < count)


def _signs(
    sheet: Sheet, header: Header, rows: Sequence[Row], decimal: str, findings: list[Finding]
) -> tuple[dict[str, str], list[str]]:
    """What begins the decimals of the numbers of each quantity, and what is told of it."""
    texts, ranges = dict[str, list[str]](), dict[str, tuple[float, float]]()
    numeric = {n: c for n, c in header.columns.items() if ALIASES[n].is_number}
    for name, column in numeric.items():
        cells = [cell_of(row, column) for row in rows]
        own = [plain(each) for each in cells if isinstance(each, str)]
        texts[column.heading] = [each for each in own if not is_post(each)]
        quantity, factor = ALIASES[name], column.meaning.factor
        ranges[column.heading] = (quantity.low / factor, quantity.high / factor)
    if decimal:
        return dict.fromkeys(numeric, decimal), []
    signs, told = signs_of(texts, sheet.separator, ranges)
    for column in numeric.values():
        if column.heading not in signs:
            findings.append(_unclear(sheet, column, texts[column.heading]))
            signs[column.heading] = ""
    return {name: signs[column.heading] for name, column in numeric.items()}, told


def _unclear(sheet: Sheet, column: Column, texts: Sequence[str]) -> Finding:
    """The fault that a column does not say what begins its decimals."""
    example = next(text for text in texts if "," in text or "." in text)
    both = {sign: number(example, sign) for sign in IN_WORDS}
    if not readings_of(texts).possible:
        problem = "some numbers have decimal points and some have decimal commas"
        remedy = "write all of them in one way"
    else:
        problem = "is it " + " or ".join(f"{value:.10g}" for value in both.values())
        problem += (
            "? no number of the column says whether the sign begins decimals or parts thousands"
        )
        remedy = (
            "write one number with other decimals, such as 0 behind the last one, or say it to "
        )
        remedy += f"tpss import csv {sheet.path.name} --decimal comma (or point)"
    return Finding(str(sheet.path), f"column {column.heading!r}", example, problem, remedy)


def _value(column: Column, cell: Cell, sign: str) -> Value:
    """Value of a cell in the unit of TPSS; NaN: it is no number."""
    quantity, factor = ALIASES[column.meaning.quantity], column.meaning.factor
    if cell == "":
        return None
    if not quantity.is_number:
        return f"{cell:.15g}" if isinstance(cell, float) else cell
    if isinstance(cell, str):
        cell = _number(plain(cell), sign, is_position=quantity.key in ("position_km", "to_km"))
    return cell if factor == 1.0 else float(f"{cell * factor:.13g}")


def _number(text: str, sign: str, is_position: bool) -> float:
    if is_position and is_post(text):
        return post_km(text)
    return number(text, sign) if sign else 0.0  # whose column has a fault of its own


def _faults_of_cells(table: Table) -> Iterator[Finding]:
    """Cells that are empty and may not be, and those that are not numbers."""
    needed = {each for either in table.kind.needed for each in either}
    for name, column in table.header.columns.items():
        sign = table.signs.get(name, "")
        for k, value in enumerate(table.values[name]):
            if value is None and name in needed and ALIASES[name].is_number:
                remedy = "write a number, or leave out the row"
                yield table.fault(k, name, "", "the cell is empty", remedy)
            elif isinstance(value, float) and math.isnan(value):
                remedy = f"write a number with a {IN_WORDS[sign or '.']} and no unit"
                cell = cell_of(table.rows[k], column)
                yield table.fault(k, name, cell, "not a number", remedy)


def _notes(sheet: Sheet, header: Header) -> Iterator[str]:
    if sheet.encoding and sheet.encoding != UTF_8:
        yield f"read as {sheet.encoding}"
    if header.above:
        yield f"{header.above} line{'s' * (header.above > 1)} above the header passed over"
    if header.passed_over:
        yield f"columns passed over: {', '.join(header.passed_over)}"
    for name, column in header.columns.items():
        if ALIASES[name].usual not in ("", "1") and not column.meaning.is_given:
            label = units.label(ALIASES[name].key)
            yield f"{column.heading} gives no unit and is read in {label}"
