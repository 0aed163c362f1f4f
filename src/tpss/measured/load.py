"""Measured series of a table, in units of SI, each value with the time for which it holds."""

from pathlib import Path
from typing import Literal, NamedTuple, get_args

import numpy as np

from tpss.errors import Finding, ResultError, ScenarioError, suggest
from tpss.measured.columns import Column, find_columns
from tpss.measured.held import Held
from tpss.measured.quantities import Floats
from tpss.measured.table import numbers, read_table
from tpss.measured.times import Times, read_times
from tpss.results.result import Result

Stamps = Literal["begin", "end"]
"""What the time of a value says: when the interval begins over which it holds, or when that ends."""

JUMP = 1.5
"""Steps beyond which the distance of two times is a jump, of whose time nothing is known."""


class Measured(NamedTuple):
    """Measured series.

    Attributes
    ----------
    path : Path
    time_column : str
    times : Times
    step_s : float
        The usual distance of two times, their median. [s]
    series : dict of Column to Held
        In units of SI, over the times of the file.
    notes : tuple of str
        What is told of the file: how it was read, and its gaps.
    """

    path: Path
    time_column: str
    times: Times
    step_s: float
    series: dict[Column, Held]
    notes: tuple[str, ...]

    def fault(self, problem: str, remedy: str, column: str = "", value: str = "") -> ScenarioError:
        """An error about a column of the file, by default that of the times."""
        place = f"column {column or self.time_column!r}"
        return ScenarioError([Finding(str(self.path), place, value, problem, remedy)])


def read_measured(path: Path, map_file: Path | None, stamps: Stamps, result: Result) -> Measured:
    """Measured series of a file.

    A value holds until the next time, or from the one before, whichever the stamps say; at a jump in
    time, which is longer than 1.5 usual steps, it holds for a usual step.  Empty cells and the rest of
    jumps are gaps, which stay so.

    Raises
    ------
    ScenarioError
        The file, or that which explains its columns, has faults.
    ResultError
        There are no such stamps.
    """
    if stamps not in (choices := get_args(Stamps)):
        raise ResultError(f"there are no stamps {stamps!r}; {suggest(stamps, choices)}")
    table = read_table(path)
    columns = find_columns(table, map_file, result)
    times = read_times(table, columns.time, columns.time_unit)
    if len(times.seconds) < 2:
        problem, remedy = "a single time, of which no step follows", "give two rows at least"
        raise ScenarioError(
            [table.fault(0, columns.time, table.cells[columns.time].iloc[0], problem, remedy)]
        )
    begin_s, end_s, step_s = _intervals(times.seconds, stamps)
    findings: list[Finding] = []
    series = {
        column: Held(begin_s, end_s, column.factor * numbers(table, column.name, findings))
        for column in columns.compared
    }
    if findings:
        raise ScenarioError(findings)
    notes = (*table.notes, *_gaps(path.name, times, begin_s, end_s, series))
    return Measured(path, columns.time, times, step_s, series, notes)


def _intervals(seconds: Floats, stamps: Stamps) -> tuple[Floats, Floats, float]:
    """Beginnings and ends of the intervals for which values hold, and their usual length. [s]"""
    distances_s = np.diff(seconds)
    step_s = float(np.median(distances_s))
    follows = distances_s <= JUMP * step_s
    if stamps == "begin":
        until_s = np.where(follows, seconds[1:], seconds[:-1] + step_s)
        return seconds, np.append(until_s, seconds[-1] + step_s), step_s
    since_s = np.where(follows, seconds[:-1], seconds[1:] - step_s)
    return np.insert(since_s, 0, seconds[0] - step_s), seconds, step_s


def _gaps(
    name: str, times: Times, begin_s: Floats, end_s: Floats, series: dict[Column, Held]
) -> list[str]:
    """Gaps of a file in words: empty cells, and jumps in time."""
    notes = []
    for column, held in series.items():
        empty = int(np.isnan(held.values).sum())
        if empty:
            cells = "1 empty cell" if empty == 1 else f"{empty} empty cells"
            notes.append(f"{name}: {cells} in {column.name}, which stay gaps")
    lacking_s = begin_s[1:] - end_s[:-1]
    jumps = np.flatnonzero(lacking_s > 1e-6)
    if len(jumps):
        count = "1 jump" if len(jumps) == 1 else f"{len(jumps)} jumps"
        longest = int(jumps[np.argmax(lacking_s[jumps])])
        notes.append(
            f"{name}: {count} in time, {lacking_s[jumps].sum() / 60.0:.2f} min in all, the longest "
            f"from {times.in_words(float(end_s[longest]))} to "
            f"{times.in_words(float(begin_s[longest + 1]))}, which stay gaps"
        )
    return notes
