"""Cells of a table in a file, before anything is known of their meaning."""

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from tpss.errors import Finding, ScenarioError, shortened
from tpss.printable import in_nfc

Cell = str | float
"""A text, or a number of a workbook, whose decimals are known."""

SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma", "|": "bar"}
"""What may separate columns, and what it is called."""

COMMENT = "#"
"""Lines that begin with it are comments."""

UTF_8 = "UTF-8"

_OF_EXCEL = "sep="
"""How a first line begins that tells Excel the separator."""


class Row(NamedTuple):
    """Cells of a row, and the number of its line in the file, counted from 1."""

    line: int
    cells: Sequence[Cell]


class Sheet(NamedTuple):
    """Rows of a table with anything in them.

    Attributes
    ----------
    path : Path
        Its file, with ``#`` and the name of the sheet if it is one of a workbook.
    rows : sequence of Row
    separator : str
        What separates the columns; empty in a workbook.
    encoding : str
        In words; empty in a workbook.
    """

    path: Path
    rows: Sequence[Row]
    separator: str
    encoding: str

    @property
    def in_words(self) -> str:
        """How it was read."""
        if not self.separator:
            return "workbook of Excel"
        return f"{self.encoding}, separated by {SEPARATORS[self.separator]}s"


def decoded(path: Path, content: bytes) -> tuple[str, str]:
    """Text of a file, in the form C of Unicode, and its encoding in words.

    Files without a mark of their encoding are UTF-8, or else Windows-1252.

    Raises
    ------
    ScenarioError
        It is neither, or no text.
    """
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encodings = {"utf-16": "UTF-16"}
    else:
        encodings = {"utf-8-sig": UTF_8, "cp1252": "Windows-1252"}
    for encoding, words in encodings.items():
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return in_nfc(text.replace("\r\n", "\n").replace("\r", "\n")), words
    problem = "neither text in UTF-8, UTF-16 with its mark or Windows-1252, nor a workbook"
    remedy = "save it as CSV in UTF-8, or as a workbook of Excel (.xlsx)"
    raise ScenarioError([Finding(str(path), "", "", problem, remedy)])


def lines_of(text: str) -> list[tuple[int, str]]:
    """Lines with anything on them that are no comments, and their numbers, counted from 1."""
    return [
        (number, line)
        for number, line in enumerate(text.split("\n"), 1)
        if line.strip() and not line.lstrip().startswith(COMMENT)
    ]


def told_separator(lines: Sequence[tuple[int, str]]) -> str:
    """Separator that the first line tells Excel; empty if it does not."""
    first = lines[0][1].strip().lower() if lines else ""
    told = first.removeprefix(_OF_EXCEL) if first.startswith(_OF_EXCEL) else ""
    return "\t" if first == _OF_EXCEL else told if told in SEPARATORS else ""


def split(path: Path, lines: Sequence[tuple[int, str]], separator: str) -> list[Row]:
    """Rows of cells, white space around them left out; those without any text are left out.

    Raises
    ------
    ScenarioError
        Quotes are not closed.
    """
    rows = _quoted(path, lines, separator) if _has_quotes(lines) else _plain(lines, separator)
    return [row for row in rows if any(row.cells)]


def _has_quotes(lines: Sequence[tuple[int, str]]) -> bool:
    return any('"' in line for _, line in lines)


def _plain(lines: Sequence[tuple[int, str]], separator: str) -> Iterator[Row]:
    for number, line in lines:
        yield Row(number, [cell.strip() for cell in line.split(separator)])


def _quoted(path: Path, lines: Sequence[tuple[int, str]], separator: str) -> Iterator[Row]:
    """Rows some of whose cells stand in quotes, in which there may be separators and ends of lines."""
    texts = (f"{line}\n" for _, line in lines)
    reader = csv.reader(texts, delimiter=separator, skipinitialspace=True, strict=True)
    first = 0
    while True:
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            number, line = lines[min(first, len(lines) - 1)]
            remedy = "close each quote, and double those within a text"
            place = (str(path), f"line {number}", shortened(line))
            raise ScenarioError([Finding(*place, f"not a row of CSV: {error}", remedy)]) from error
        yield Row(lines[first][0], [cell.strip() for cell in cells])
        first = reader.line_num


def csv_of(sheet: Sheet) -> str:
    """Cells as CSV, separated by commas, on lines of the same numbers as in the file."""
    text = io.StringIO()
    writer, line = csv.writer(text, lineterminator="\n"), 1
    for row in sheet.rows:
        text.write("\n" * (row.line - line))
        writer.writerow([f"{cell:.15g}" if isinstance(cell, float) else cell for cell in row.cells])
        line = row.line + 1
    return text.getvalue()
