"""Texts of tables in CSV: nothing that steers what shows them, and, for spreadsheets, no formulas."""

from collections.abc import Callable
from functools import partial

import pandas as pd

from tpss.printable import printable, steering

FORMULAS = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""Beginnings of what spreadsheets take for a formula, or skip to find one; the last ones are wide."""

TEXT_MARK = "'"
"""What makes a spreadsheet take a cell as a text."""


def with_shown_texts(table: pd.DataFrame) -> pd.DataFrame:
    """A table in whose texts and headings what steers is shown as its code."""
    return _changed(table, printable, lambda text: bool(steering(text)))


def without_formulas(table: pd.DataFrame) -> pd.DataFrame:
    """A table whose texts and headings that begin like formulas are marked as texts.

    Numbers stay as they are, negative ones too.
    """
    return _changed(table, TEXT_MARK.__add__, lambda text: text.startswith(FORMULAS))


def csv_of(table: pd.DataFrame) -> bytes:
    """A table as CSV for other programs."""
    return with_shown_texts(table).to_csv(index=False).encode()


def _instead(changes: dict[object, str], value: object) -> object:
    return changes.get(value, value) if isinstance(value, str) else value


def _changed(
    table: pd.DataFrame, change: Callable[[str], str], is_meant: Callable[[str], bool]
) -> pd.DataFrame:
    """A table some of whose texts are changed; the table itself if none are meant."""

    def of(texts: "pd.Series | pd.Index") -> dict[object, str]:
        each = (text for text in texts.unique() if isinstance(text, str) and is_meant(text))
        return {text: change(text) for text in each}

    by_column = {
        k: changes
        for k, kind in enumerate(table.dtypes)
        if not pd.api.types.is_numeric_dtype(kind) and (changes := of(table.iloc[:, k]))
    }
    if not by_column and not of(table.columns):
        return table
    columns = [table.iloc[:, k] for k in range(len(table.columns))]
    for k, changes in by_column.items():
        columns[k] = columns[k].map(partial(_instead, changes))
    headings = [of(pd.Index([name])).get(name, name) for name in table.columns]
    return pd.concat(columns, axis="columns", keys=headings)
