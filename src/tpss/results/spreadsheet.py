"""Tables for spreadsheets: no text that they would run as a formula."""

import pandas as pd

FORMULAS = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""Beginnings of what spreadsheets take for a formula, or skip to find one; the last ones are wide."""

TEXT_MARK = "'"
"""What makes a spreadsheet take a cell as a text."""


def without_formulas(table: pd.DataFrame) -> pd.DataFrame:
    """A table whose texts and headings that begin like formulas are marked as texts.

    Numbers stay as they are, negative ones too.
    """
    marked = table.rename(columns=_marked)
    for k, kind in enumerate(table.dtypes):
        if not pd.api.types.is_numeric_dtype(kind):
            column = marked.columns[k]
            marked[column] = marked[column].map(_marked, na_action="ignore")
    return marked


def _marked(value: object) -> object:
    is_formula = isinstance(value, str) and value.startswith(FORMULAS)
    return f"{TEXT_MARK}{value}" if is_formula else value
