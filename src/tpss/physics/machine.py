"""What a train's motors give at most: by the Rc4's network, by a table, or by limits.

Speed and current limit are fixed while a step is solved; what they decide is evaluated once, when
the speed changes (`take_effort`), and the line voltage is the one input left (`highest_force`).
"""

from typing import Any

from tpss.kernel import inlined, kernel
from tpss.physics.curve import Points
from tpss.physics.effort_limits import limited_force, voltage_share
from tpss.physics.effort_table import outside_table, table_force, take_rows
from tpss.physics.series import reaches, series_at
from tpss.physics.tractive_effort import (
    VOLTAGE,
    effort_outside_training,
    motor_force_series,
)

NETWORK = 0
TABLE = 1
LIMITS = 2


@inlined
def take_effort(kind: Any, train: Any, machine: Any, points: Points) -> None:
    """Evaluate what the speed decides about the force over voltage, and a bound of its slope.

    Parameters
    ----------
    kind : record of `TRAIN_TYPE`
    train : record of `DEMAND`
        Its speed is read; `bias` or the rows, and `steepest_n_per_v`, are written.
    machine : record of `MACHINE`
    points : records of `CURVE_POINT`
    """
    if kind.effort_model == TABLE:
        train.steepest_n_per_v = take_rows(train.speed_m_s, kind, train, points)
    elif kind.effort_model == LIMITS:
        force = limited_force(
            train.speed_m_s, kind.highest_force_n, kind.highest_power_w, kind.limit_speed_m_s
        )
        train.row_force_n[0] = force
        fall_v = kind.full_voltage_v - kind.zero_voltage_v
        train.steepest_n_per_v = force / fall_v if fall_v > 0.0 else 0.0
    else:
        train.effort.reach_8 = 0.0
        train.steepest_n_per_v = machine.tractive_effort.steepest[VOLTAGE]


@kernel
def _described_force(voltage_v: float, kind: Any, train: Any) -> tuple[float, float]:
    """`highest_force` of a machine that is described by a table or by limits."""
    if kind.effort_model == TABLE:
        return table_force(voltage_v, kind, train)
    share, slope = voltage_share(voltage_v, kind.zero_voltage_v, kind.full_voltage_v)
    return train.row_force_n[0] * share, train.row_force_n[0] * slope


@inlined
def highest_force(voltage_v: float, kind: Any, train: Any, machine: Any) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    kind, train, machine : records
        As in `take_effort`, which comes first.
    """
    if kind.effort_model == NETWORK:
        if not reaches(voltage_v, train.effort):
            motor_force_series(
                train.speed_m_s,
                voltage_v,
                kind.highest_current_a,
                machine.tractive_effort,
                machine.room,
                train.effort,
            )
        return series_at(voltage_v, train.effort)
    return _described_force(voltage_v, kind, train)


@inlined
def effort_extrapolates(
    speed_m_s: float, voltage_v: float, kind: Any, machine: Any, points: Points
) -> bool:
    """Whether network or table are used outside what they were made from; limits hold anywhere."""
    if kind.effort_model == TABLE:
        return outside_table(speed_m_s, voltage_v, kind, points)
    if kind.effort_model == LIMITS:
        return False
    return effort_outside_training(
        speed_m_s, voltage_v, kind.highest_current_a, machine.tractive_effort
    )
