"""Tractive effort as a table over speed and line voltage.

Each row of the table, one a voltage, is a curve over speed (see `curve`).  All rows are evaluated
once a step, when the train's speed changes; what they give are the points of a curve over voltage,
which is all that is evaluated while a step is solved.  Beyond the table its outer values hold.
"""

from typing import Any

from tpss.kernel import inlined
from tpss.physics.curve import Points, curve_at, hermite, slope_at, steepest_between

MOST_VOLTAGES = 16
"""Rows that a table may have at most: there is room for so many in a train's record."""


@inlined
def take_rows(speed_m_s: float, kind: Any, train: Any, points: Points) -> float:
    """Evaluate the rows at a speed; return the steepest slope of the force over voltage. [N/V]

    Writes forces and slopes at the table's voltages into the train's `row_force_n` and
    `row_slope_n_per_v`.

    Parameters
    ----------
    speed_m_s : float
        Train speed. [m/s]
    kind : record of `TRAIN_TYPE`
        With the places of the rows, and their voltages, ascending.
    train : record of `DEMAND`
    points : records of `CURVE_POINT`
    """
    rows, voltage_v = kind.effort_rows, kind.effort_voltage_v
    for row in range(rows):
        first = kind.effort.first + row * kind.effort.points
        train.row_force_n[row] = curve_at(speed_m_s, first, kind.effort.points, points)
    for row in range(rows):
        train.row_slope_n_per_v[row] = slope_at(row, rows, voltage_v, train.row_force_n)
    steepest = 0.0
    for row in range(rows - 1):
        bound = steepest_between(
            voltage_v[row + 1] - voltage_v[row],
            train.row_force_n[row],
            train.row_force_n[row + 1],
            train.row_slope_n_per_v[row],
            train.row_slope_n_per_v[row + 1],
        )
        steepest = max(steepest, bound)
    return steepest


@inlined
def table_force(voltage_v: float, kind: Any, train: Any) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph; beyond the table's the force is constant. [V]
    kind : record of `TRAIN_TYPE`
    train : record of `DEMAND`
        With what `take_rows` has written.

    References
    ----------
    [FritschCarlson1980]_.
    """
    at_v, last = kind.effort_voltage_v, kind.effort_rows - 1
    if last == 0 or voltage_v <= at_v[0]:
        return train.row_force_n[0], 0.0
    if voltage_v >= at_v[last]:
        return train.row_force_n[last], 0.0
    row = 0
    while voltage_v >= at_v[row + 1]:
        row += 1
    return hermite(
        voltage_v - at_v[row],
        at_v[row + 1] - at_v[row],
        train.row_force_n[row],
        train.row_force_n[row + 1],
        train.row_slope_n_per_v[row],
        train.row_slope_n_per_v[row + 1],
    )


@inlined
def outside_table(speed_m_s: float, voltage_v: float, kind: Any, points: Points) -> bool:
    """Whether a table is used beyond its speeds or voltages, where its outer values hold."""
    last = kind.effort_rows - 1
    first_point = points[kind.effort.first]
    last_point = points[kind.effort.first + kind.effort.points - 1]
    if speed_m_s < first_point.at or speed_m_s > last_point.at:
        return True
    at_v = kind.effort_voltage_v
    return last > 0 and (voltage_v < at_v[0] or voltage_v > at_v[last])
