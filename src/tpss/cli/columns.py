"""Columns of the terminal's tables: where numbers come from, and how they are shown."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd
from rich import box
from rich.markup import escape
from rich.table import Table


@dataclass(frozen=True)
class Column:
    """A column of numbers: where they come from, and how they are shown."""

    key: str
    heading: str
    unit: str
    digits: int
    scale: float = 1.0


def number(value: float, digits: int) -> str:
    """A number as it is shown: a dash where there is none, "any" where it has no bound."""
    if math.isnan(value):
        return "-"
    return "any" if math.isinf(value) else f"{value:.{digits}f}"


def table_of_columns(
    title: str,
    first: str,
    columns: Sequence[Column],
    rows: Sequence[tuple[str, Mapping[str, Any]]],
    widest_name: int | None = None,
) -> Table:
    """Table with a name in the first column and numbers, with their units, in the others.

    Names that are longer than `widest_name` characters are broken.
    Columns are there where the rows have them, as that with the names of lines.
    """
    columns = [column for column in columns if all(column.key in values for _, values in rows)]
    table = Table(title=escape(title), box=box.SIMPLE_HEAD, title_justify="left", padding=0)
    table.add_column(first, overflow="fold", max_width=widest_name)
    for column in columns:
        heading = f"{column.heading}\n[dim]{column.unit}[/dim]"
        table.add_column(heading, justify="right", no_wrap=True)
    for name, values in rows:
        cells = [_cell(values[column.key], column) for column in columns]
        table.add_row(escape(name), *cells)
    return table


def named_rows(frame: pd.DataFrame, name: str) -> list[tuple[str, dict[str, Any]]]:
    """Rows of a table with their names, which stand in a column of it."""
    rows: list[dict[str, Any]] = frame.to_dict("records")  # type: ignore[assignment]
    return [(str(row[name]), row) for row in rows]


def _cell(value: Any, column: Column) -> str:
    if isinstance(value, str):
        return escape(value)
    return number(value * column.scale, column.digits)
