"""Tractive effort as a table over speed and line voltage.

Each row of the table, one a voltage, is a curve over speed (see `curve`).  All rows are evaluated
once a step, when the train's speed changes; what they give are the points of a curve over voltage,
which is all that is evaluated while a step is solved.  Beyond the table its outer values hold.
"""

import math
from typing import Annotated

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined
from tpss.numerics.curve import (
    Curve,
    Points,
    curve_at,
    curve_slope,
    hermite,
    slope_at,
    steepest_between,
)
from tpss.record import Record

Array = npt.NDArray[np.float64]

MOST_VOLTAGES = 16
"""Rows that a table may have at most: a train's record has so many places."""


class EffortTable(Record):
    """A table at the train's current limit."""

    first_row: Curve = Curve.row()
    """Force over speed at the lowest voltage; the other rows follow it. [N]"""
    rows: int = 0
    """Number of rows, one a voltage."""
    voltage_v: Annotated[Array, (MOST_VOLTAGES,)] = (math.inf,) * MOST_VOLTAGES  # type: ignore[assignment]
    """Line voltages of the rows, ascending, then infinite. [V]"""


class TableTerms(Record):
    """The rows of a table at a train's present speed."""

    force_n: Annotated[Array, (MOST_VOLTAGES,)]
    """Force at the voltages of the table. [N]"""
    slope_n_per_v: Annotated[Array, (MOST_VOLTAGES,)]
    """Slope over the voltage there. [N/V]"""


@inlined
def evaluate_rows(speed_m_s: float, table: EffortTable, terms: TableTerms, points: Points) -> float:
    """Evaluate the rows at a speed into `terms`; return the steepest slope over voltage. [N/V]

    Parameters
    ----------
    speed_m_s : float
        Train speed. [m/s]
    table : EffortTable
    terms : TableTerms
        Written.
    points : records of CurvePoint
    """
    rows, voltage_v = table.rows, table.voltage_v
    for row in range(rows):
        first = table.first_row.first + row * table.first_row.points
        terms.force_n[row] = curve_at(speed_m_s, first, table.first_row.points, points)
    for row in range(rows):
        terms.slope_n_per_v[row] = slope_at(row, rows, voltage_v, terms.force_n)
    steepest = 0.0
    for row in range(rows - 1):
        bound = steepest_between(
            voltage_v[row + 1] - voltage_v[row],
            terms.force_n[row],
            terms.force_n[row + 1],
            terms.slope_n_per_v[row],
            terms.slope_n_per_v[row + 1],
        )
        steepest = max(steepest, bound)
    return steepest


@inlined
def table_force(voltage_v: float, table: EffortTable, terms: TableTerms) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph; beyond the table's the force is constant. [V]
    table : EffortTable
    terms : TableTerms
        From `evaluate_rows`.

    References
    ----------
    [FritschCarlson1980]_.
    """
    at_v, last = table.voltage_v, table.rows - 1
    if last == 0 or voltage_v <= at_v[0]:
        return terms.force_n[0], 0.0
    if voltage_v >= at_v[last]:
        return terms.force_n[last], 0.0
    row = 0
    while voltage_v >= at_v[row + 1]:
        row += 1
    return hermite(
        voltage_v - at_v[row],
        at_v[row + 1] - at_v[row],
        terms.force_n[row],
        terms.force_n[row + 1],
        terms.slope_n_per_v[row],
        terms.slope_n_per_v[row + 1],
    )


@inlined
def table_by_speed(voltage_v: float, speed_m_s: float, table: EffortTable, points: Points) -> float:
    """Slope over the speed of the largest force at a line voltage, straight between rows. [N s/m]

    References
    ----------
    [FritschCarlson1980]_, the derivative of its cubic.
    """
    count, row = table.first_row.points, 0
    while row + 1 < table.rows and voltage_v >= table.voltage_v[row + 1]:
        row += 1
    slope = curve_slope(speed_m_s, table.first_row.first + row * count, count, points)
    if row + 1 == table.rows or voltage_v <= table.voltage_v[row]:
        return slope
    after = curve_slope(speed_m_s, table.first_row.first + (row + 1) * count, count, points)
    width_v = table.voltage_v[row + 1] - table.voltage_v[row]
    return slope + (after - slope) * (voltage_v - table.voltage_v[row]) / width_v


@inlined
def outside_table(speed_m_s: float, voltage_v: float, table: EffortTable, points: Points) -> bool:
    """Whether a table is used beyond its speeds or voltages, where its outer values hold."""
    last, first_row = table.rows - 1, table.first_row
    first_point = points[first_row.first]
    last_point = points[first_row.first + first_row.points - 1]
    if speed_m_s < first_point.x or speed_m_s > last_point.x:
        return True
    return last > 0 and (voltage_v < table.voltage_v[0] or voltage_v > table.voltage_v[last])
