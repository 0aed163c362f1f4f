"""Sheets of Excel's workbooks (.xlsx), with bounds on what they unpack to."""

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

from tpss import extras
from tpss.errors import Finding, ScenarioError, suggest
from tpss.files.archive import demand_bounded
from tpss.printable import in_nfc
from tpss.tables.sheet import COMMENT, Cell, Row, Sheet

SUFFIXES = (".xlsx", ".xlsm")

_WITH_SHEET = re.compile(r"(.+?\.xls[xm])#(.*)", re.IGNORECASE)
"""Name of a file, and behind the mark that of a sheet."""

MOST_UNPACKED = 200_000_000
"""Of the parts of a workbook together. [byte]"""

MOST_CELLS = 5_000_000
"""Of a sheet."""


def of_workbook(path: Path) -> tuple[Path, str]:
    """File of a workbook and the name of its sheet, empty for the first; of other files the path."""
    match = _WITH_SHEET.fullmatch(path.name)
    return (path.with_name(match[1]), match[2]) if match else (path, "")


def is_workbook(path: Path) -> bool:
    """Whether a path names a workbook, or a sheet of one."""
    return of_workbook(path)[0].suffix.lower() in SUFFIXES


def read_sheet(path: Path, content: bytes) -> Sheet:
    """A sheet of a workbook.

    Parameters
    ----------
    path : Path
        The file, with ``#`` and the name of the sheet unless it is the first.
    content : bytes
        Of the file.

    Raises
    ------
    ScenarioError
        It is no workbook, has no such sheet, or is too large, or openpyxl is missing.
    """
    file, name = of_workbook(path)
    _demand_package(file)
    try:
        demand_bounded(content, MOST_UNPACKED)
        with _quiet():
            sheets = {each.title: each for each in _opened(content).worksheets}
            chosen = sheets[name] if name in sheets else next(iter(sheets.values()))
            rows = list(_rows(path, chosen)) if name in ("", *sheets) else []
    except ScenarioError:
        raise
    except Exception as error:  # of all that may be wrong within, each part has errors of its own
        problem = f"not a workbook that can be read: {error}"
        remedy = "save it as a workbook of Excel (.xlsx) again, or as CSV"
        raise ScenarioError([Finding(str(file), "", "", problem, remedy)]) from error
    if name not in ("", *sheets):
        problem, remedy = "the workbook has no such sheet", suggest(name, sheets)
        raise ScenarioError([Finding(str(file), "sheet", name, problem, remedy)])
    return Sheet(path, rows, "", "")


def _demand_package(file: Path) -> None:
    if lacking := extras.absent("sheets"):
        problem = f"to read a workbook takes {', '.join(lacking)}, which is not installed"
        remedy = f"{extras.remedy('sheets')}, or save the sheet as CSV"
        raise ScenarioError([Finding(str(file), "", "", problem, remedy)])


def _opened(content: bytes) -> Any:
    import openpyxl  # a tenth of a second to load

    return openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)


@contextmanager
def _quiet() -> Iterator[None]:
    """Without warnings of what a workbook has besides its cells, such as forms."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def _rows(path: Path, sheet: Any) -> Iterator[Row]:
    """Rows with anything in them; those that begin with # are comments, as in CSV."""
    sheet.reset_dimensions()  # what a file says of its size may be wrong
    count = 0
    for number, values in enumerate(sheet.iter_rows(values_only=True), 1):
        count += len(values)
        if count > MOST_CELLS:
            problem = f"the sheet has more than {MOST_CELLS:,} cells"
            remedy = "keep the columns and rows that are needed"
            raise ScenarioError([Finding(str(path), f"line {number}", "", problem, remedy)])
        cells = [_cell(value) for value in values]
        while cells and cells[-1] == "":
            cells.pop()
        if cells and not str(cells[0]).startswith(COMMENT):
            yield Row(number, cells)


def _cell(value: Any) -> Cell:
    """A value as a number or a text; times as CSV would have them."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, int | float):
        return float(value)
    if isinstance(value, datetime):
        return _clock(value.hour, value.minute, value.second)
    if isinstance(value, time):
        return _clock(value.hour, value.minute, value.second)
    if isinstance(value, timedelta):
        seconds = round(value.total_seconds())
        return _clock(seconds // 3600, seconds // 60 % 60, seconds % 60)
    return value.isoformat() if isinstance(value, date) else in_nfc(str(value)).strip()


def _clock(hours: int, minutes: int, seconds: int) -> str:
    return f"{hours:02d}:{minutes:02d}:{seconds:02d}"
