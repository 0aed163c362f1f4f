"""Workbooks of Excel: a sheet a table, headings that stay visible, columns as wide as they need."""

import io
import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pandas as pd

MOST_ROWS = 2**20
"""Rows of a sheet of Excel, its heading included."""

MOST_TEXT = 32_767
"""Characters of a cell of Excel."""

WIDEST = 60
"""Widest column of a sheet, in characters; longer texts are broken into lines."""

DIGITS = 5
"""Significant digits that a number shows, which keeps all of them."""

PLAIN_LENGTH = 8
"""Characters of a number among texts that is shown as it is."""

SMALL, NOTHING = 1e-3, 1e-12
"""Sizes below which numbers are shown with powers of ten, and as 0: what rounding leaves of nothing."""

GENERAL = "General"


def workbook(tables: Mapping[str, pd.DataFrame]) -> bytes:
    """A workbook with one sheet per table, by its name.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        With headings as they are to be read, of fewer than `MOST_ROWS` rows.
    """
    import xlsxwriter  # some hundredths of a second to load

    file = io.BytesIO()
    # A row at a time: the cells of a day's run would not fit into memory well.
    with xlsxwriter.Workbook(file, {"constant_memory": True}) as book:
        formats = _Formats(book)
        for name, table in tables.items():
            _write(table, book.add_worksheet(name), formats)
    return file.getvalue()


class _Formats:
    """Formats of a workbook, each made once."""

    def __init__(self, book: Any) -> None:
        self._book = book
        self._made: dict[tuple[str, bool], Any] = {}
        self.bold = book.add_format({"bold": True})

    def of(self, number_format: str, breaks: bool = False) -> Any:
        """The format of some numbers, or of texts that are broken into lines."""
        key = number_format, breaks
        if key not in self._made:
            looks = {"num_format": number_format, "text_wrap": breaks, "valign": "top"}
            self._made[key] = self._book.add_format(looks)
        return self._made[key]


def _write(table: pd.DataFrame, sheet: Any, formats: _Formats) -> None:
    sheet.freeze_panes(1, 0)
    if len(table.columns):
        sheet.autofilter(0, 0, len(table), len(table.columns) - 1)
    for c, heading in enumerate(table.columns):
        column = table.iloc[:, c]
        number_format = _number_format(column)
        width = max(len(str(heading)) + 3, *_lengths(column, number_format)) + 2
        breaks = width > WIDEST
        # Cells without a format of their own have that of their column, at no cost.
        sheet.set_column(c, c, min(width, WIDEST), formats.of(number_format, breaks))
        sheet.write_string(0, c, str(heading), formats.bold)
    writers = [_writer(table.iloc[:, c], sheet, formats) for c in range(len(table.columns))]
    columns = [table.iloc[:, c].tolist() for c in range(len(table.columns))]
    for r, row in enumerate(zip(*columns, strict=True), 1):
        for c, value in enumerate(row):
            writers[c](r, c, value)


def _writer(column: pd.Series, sheet: Any, formats: _Formats) -> Callable[[int, int, Any], None]:
    """What writes the values of a column: numbers with its format, others each with their own."""
    if pd.api.types.is_float_dtype(column) and not column.isin([math.inf, -math.inf]).any():
        write_number = sheet.write_number

        def write_float(row: int, place: int, value: float) -> None:
            if value == value:  # a cell of a number that is not known stays empty
                write_number(row, place, value)

        return write_float

    def write(row: int, place: int, value: Any) -> None:
        if value is None or value is pd.NA or value != value:
            return
        if isinstance(value, bool):
            sheet.write_boolean(row, place, value)
        elif isinstance(value, int | float) and math.isfinite(value):
            own = _format_among_texts(value)
            sheet.write_number(row, place, value, None if own == GENERAL else formats.of(own))
        else:  # write_string makes no formula of a name that begins with "="
            sheet.write_string(row, place, _text(value))

    return write


def _text(value: Any) -> str:
    """A text as a cell can hold it; one that is too long ends in an ellipsis."""
    text = str(value)
    return text if len(text) <= MOST_TEXT else f"{text[: MOST_TEXT - 1]}…"


def _lengths(column: pd.Series, number_format: str) -> Iterator[int]:
    """Characters of the longest values of a column, as they are shown."""
    yield 0
    if pd.api.types.is_float_dtype(column):
        decimals = len(number_format.rpartition(".")[2]) if "." in number_format else 1
        for value in (column.min(), column.max()):
            if math.isfinite(value):
                small = number_format.endswith("E+00")
                yield len(f"{value:.2e}" if small else f"{value:,.{decimals}f}")
        return
    for value in column.unique():
        known = isinstance(value, float) and math.isfinite(value)
        yield max(map(len, f"{value:.{DIGITS}g}" if known else str(value).split("\n")), default=0)


def _number_format(column: pd.Series) -> str:
    """Format of the numbers of a column by the largest of them; none for whole ones, such as years."""
    if not pd.api.types.is_float_dtype(column):
        return GENERAL
    sizes = column.abs()
    sizes = sizes[sizes.notna() & (sizes < math.inf)]
    if sizes.empty or (sizes % 1.0 == 0.0).all():
        return GENERAL
    return _format_of_size(float(sizes.max()))


def _format_among_texts(value: float) -> str:
    """Format of a number in a column of texts and numbers: what is short is shown as it is."""
    short = isinstance(value, int) or value % 1.0 == 0.0 or len(repr(value)) <= PLAIN_LENGTH
    return GENERAL if short else _format_of_size(abs(value))


def _format_of_size(size: float) -> str:
    """Format for numbers up to a size: a comma for thousands, and as many digits as tell something."""
    if size < NOTHING:
        return "0.0"
    if size < SMALL:
        return "0.00E+00"
    if size < 1.0:
        return "0." + "0" * (3 - math.floor(math.log10(size)))
    return "#,##0." + "0" * max(1, min(4, DIGITS - len(str(int(size)))))
