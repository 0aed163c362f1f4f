"""Common intervals of a file and a run, and the means of both over them."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tpss.measured.columns import Column
from tpss.measured.figures import Aligned
from tpss.measured.held import Held
from tpss.measured.load import Measured
from tpss.measured.quantities import QUANTITIES, SHOWN, Floats

EDGE = 1e-6
"""Share of an interval by which it may miss the end of what is shared."""

Pairs = Mapping[Column, tuple[Held, Held]]
"""Measured and simulated series of each column, in the run's time."""


class Grid(NamedTuple):
    """Intervals of equal length, in the run's time."""

    begin_s: float
    step_s: float
    intervals: int

    @property
    def edges_s(self) -> Floats:
        """Their beginnings, and the end of the last one. [s]"""
        return np.asarray(self.begin_s + self.step_s * np.arange(self.intervals + 1))


def common_grid(
    measured: Measured, pairs: Pairs, zero_s: float, step_s: float, run_step_s: float
) -> Grid:
    """Whole intervals in the time that both cover; one with the longer steps says where they begin.

    Parameters
    ----------
    measured : Measured
    pairs : mapping of Column to pair of Held
    zero_s : float
        Time of the file at the run's minute 0. [s]
    step_s, run_step_s : float
        Length of the intervals, and of the run's steps. [s]

    Raises
    ------
    ScenarioError
        There is no such interval.
    """
    file, run = next(iter(pairs.values()))
    first_s = max(float(file.begin_s[0]), float(run.begin_s[0]))
    last_s = min(float(file.end_s[-1]), float(run.end_s[-1]))
    begins_s = (file if measured.step_s >= run_step_s else run).begin_s
    later_s = begins_s[begins_s >= first_s - EDGE * step_s]
    begin_s = float(later_s[0]) if len(later_s) else math.inf
    count = math.floor((last_s - begin_s) / step_s + EDGE) if begin_s < last_s else 0
    if count < 1:
        covered = {
            name: " to ".join(
                measured.times.in_words(zero_s + float(at))
                for at in (each.begin_s[0], each.end_s[-1])
            )
            for name, each in (("file", file), ("run", run))
        }
        raise measured.fault(
            f"no interval of {step_s / 60.0:g} min lies in it and in the run, which is there from "
            f"{covered['run']}",
            "give --begins with the time of the file at the run's minute 0",
            value=covered["file"],
        )
    return Grid(begin_s, step_s, count)


def aligned_means(measured: Measured, pairs: Pairs, grid: Grid) -> list[Aligned]:
    """Means of all series over the intervals of a grid.

    Raises
    ------
    ScenarioError
        A series has no interval in which both are known.
    """
    edges_s, series = grid.edges_s, []
    for column, (file, run) in pairs.items():
        factor = SHOWN[QUANTITIES[column.quantity].unit].factor
        means = [each.means(edges_s[:-1], edges_s[1:]) / factor for each in (file, run)]
        series.append(Aligned(column.name, column.quantity, column.element, *means))
        if not series[-1].compared:
            raise measured.fault(
                "there is no interval in which it is known all through and simulated too",
                "leave the column out (ignore in a file for --map), or give another --begins",
                column.name,
            )
    return series
