"""A linear program as solvers take it: rows between limits, columns that are not negative."""

from dataclasses import dataclass

import numpy as np

from tpss.planning.money import Array
from tpss.planning.tree import Indices


@dataclass(frozen=True)
class LinearProgram:
    """Least cost of columns x with low <= A x <= high and 0 <= x <= upper, A stored column by column."""

    cost: Array
    """Shape (columns,)."""
    upper: Array
    """Shape (columns,)."""
    low: Array
    """Shape (rows,)."""
    high: Array
    """Shape (rows,)."""
    start: Indices
    """Where each column starts in the two below, shape (columns + 1,)."""
    row: Indices
    value: Array

    @property
    def entries(self) -> Array:
        """Row, column and value of each entry, shape (3, entries)."""
        column = np.repeat(np.arange(len(self.cost)), np.diff(self.start))
        return np.stack([self.row, column, self.value])


def linear_program(
    cost: Array, upper: Array, low: Array, high: Array, entries: Array
) -> LinearProgram:
    """Linear program of entries in any order.

    Parameters
    ----------
    cost, upper, low, high : array
        As `LinearProgram` has them.
    entries : array
        Row, column and value of each entry of the matrix, shape (3, entries).
    """
    row, column, value = entries
    order = np.lexsort((row, column))
    start = np.searchsorted(column[order], np.arange(len(cost) + 1))
    return LinearProgram(cost, upper, low, high, start, row[order].astype(np.int64), value[order])


def moved(entries: Array, rows: int, columns: int) -> Array:
    """Entries some rows and columns further on."""
    offset: Array = entries + np.array([[rows], [columns], [0.0]])
    return offset
