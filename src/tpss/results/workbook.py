"""Workbooks of Excel: a sheet a table, headings that stay visible, columns as wide as they need."""

import io
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

import pandas as pd

MOST_ROWS = 2**20
"""Rows of a sheet of Excel, its heading included."""

WIDEST = 40
"""Widest column of a sheet, in characters."""

LOOKED_AT = 200
"""First rows of a table by which the widths of its columns are chosen."""

DIGITS = 7
"""Significant digits that a number shows, which keeps all of them."""

MOST_FORMATTED = 50_000
"""Cells of a table whose numbers get formats: each takes its time."""


def workbook(tables: Mapping[str, pd.DataFrame]) -> bytes:
    """A workbook with one sheet per table, by its name.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        With headings as they are to be read, of fewer than `MOST_ROWS` rows.
    """
    import openpyxl  # a tenth of a second to load

    book = openpyxl.Workbook(write_only=True)
    for name, table in tables.items():
        sheet = book.create_sheet(name)
        sheet.freeze_panes = "A2"
        for i, width in enumerate(_widths(table)):
            letter = openpyxl.utils.get_column_letter(i + 1)
            sheet.column_dimensions[letter].width = width
        if len(table.columns):
            last = openpyxl.utils.get_column_letter(len(table.columns))
            sheet.auto_filter.ref = f"A1:{last}{len(table) + 1}"
        for row in _rows(table, sheet):
            sheet.append(row)
    file = io.BytesIO()
    book.save(file)
    return file.getvalue()


def _widths(table: pd.DataFrame) -> Iterator[int]:
    """Width of each column, in characters."""
    for i, heading in enumerate(table.columns):
        shown = (_shown(value) for value in islice(table.iloc[:, i], LOOKED_AT))
        yield min(WIDEST, max(map(len, [str(heading), *shown])) + 3)


def _shown(value: Any) -> str:
    return f"{value:,.{DIGITS}g}" if isinstance(value, float) else str(value)


def _rows(table: pd.DataFrame, sheet: Any) -> Iterator[list[Any]]:
    """Headings, in bold, and the rows below."""
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.styles import Font

    bold = []
    for heading in table.columns:
        cell = WriteOnlyCell(sheet, str(heading))
        cell.font = Font(bold=True)
        bold.append(cell)
    yield bold
    formats = [_number_format(table.iloc[:, i]) for i in range(len(table.columns))]
    if table.size > MOST_FORMATTED:
        formats = [None] * len(formats)
    known = table.astype(object).where(table.notna(), None)
    for row in known.itertuples(index=False, name=None):
        yield [_cell(value, each, sheet) for value, each in zip(row, formats, strict=True)]


def _number_format(column: pd.Series) -> str | None:
    """Format of the numbers of a column: a comma for thousands, digits by the largest of them.

    None for whole numbers, such as years, and for what is so small that Excel shows powers of ten.
    """
    if not pd.api.types.is_float_dtype(column):
        return None
    sizes = column.abs()
    sizes = sizes[sizes.notna() & (sizes < float("inf")) & (sizes > 0.0)]
    if sizes.empty or (sizes % 1.0 == 0.0).all() or sizes.min() < 1e-4:
        return None
    whole = len(str(int(sizes.max())))
    return "#,##0." + "0" * max(1, min(4, DIGITS - whole))


def _cell(value: Any, number_format: str | None, sheet: Any) -> Any:
    """A value as it is: openpyxl would turn a name that begins with "=" into a formula."""
    is_formula = isinstance(value, str) and value.startswith("=")
    if not is_formula and (number_format is None or not isinstance(value, float)):
        return value
    from openpyxl.cell import WriteOnlyCell

    cell = WriteOnlyCell(sheet, value)
    if is_formula:
        cell.data_type = "s"
    else:
        cell.number_format = number_format
    return cell
