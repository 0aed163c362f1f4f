"""What a train's motors give at most, whichever way that is described.

Speed and current limit are fixed while a step is solved; what they decide is evaluated once, when
the speed changes (`update_effort`), and the line voltage is the one input left (`highest_force`).

A kind is a file beside this one, with the record of its parameters and, if need be, of what it keeps
at a speed; here it has a member of `EffortKind`, a field in `TractiveEffort`, and a branch in each of
the four functions.
"""

from enum import IntEnum

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points
from tpss.numerics.neural_network import FeedForwardNetwork
from tpss.numerics.series import Series, reaches, series_at
from tpss.record import Record
from tpss.vehicle.effort.limits import (
    EffortLimits,
    limited_by_speed,
    limited_force,
    steepest_slope,
    voltage_share,
)
from tpss.vehicle.effort.network import (
    VOLTAGE,
    effort_outside_training,
    motor_force,
    motor_force_series,
)
from tpss.vehicle.effort.table import (
    EffortTable,
    TableTerms,
    evaluate_rows,
    outside_table,
    table_by_speed,
    table_force,
)

Array = npt.NDArray[np.float64]


class EffortKind(IntEnum):
    """Ways to describe the tractive effort."""

    NETWORK = 0
    TABLE = 1
    LIMITS = 2


class TractiveEffort(Record):
    """Tractive effort of a type of train: its kind, and the parameters of each kind."""

    kind: EffortKind
    """Which of the kinds holds."""
    highest_current_a: float = 0.0
    """Highest current allowed in one motor, for the network. [A]"""
    table: EffortTable = EffortTable.row()
    limits: EffortLimits = EffortLimits.row()


class EffortTerms(Record):
    """Tractive effort of a train over the line voltage, at its present speed."""

    steepest_n_per_v: float
    """Bound of the slope over the voltage. [N/V]"""
    by_speed_n_s_per_m: float
    """Slope of the network over the speed, at the voltage around which its series is made. [N s/m]"""
    limited_n: float
    """Force by the limits at full voltage. [N]"""
    series: Series
    """The network over the line voltage. [N], [V]"""
    table: TableTerms
    """The rows of the table."""


@inlined
def update_effort(
    speed_m_s: float,
    effort: TractiveEffort,
    terms: EffortTerms,
    network: FeedForwardNetwork,
    points: Points,
) -> None:
    """Evaluate what the speed decides about the force over voltage, and a bound of its slope.

    Parameters
    ----------
    speed_m_s : float
        Train speed. [m/s]
    effort : TractiveEffort
    terms : EffortTerms
        Written.
    network : FeedForwardNetwork
        Of the tractive effort.
    points : records of CurvePoint
    """
    if effort.kind == EffortKind.TABLE:
        terms.steepest_n_per_v = evaluate_rows(speed_m_s, effort.table, terms.table, points)
    elif effort.kind == EffortKind.LIMITS:
        terms.limited_n = limited_force(speed_m_s, effort.limits)
        terms.steepest_n_per_v = steepest_slope(terms.limited_n, effort.limits)
    else:
        terms.series.reach_8 = 0.0
        terms.steepest_n_per_v = network.steepest[VOLTAGE]


@kernel
def _described_force(
    voltage_v: float, effort: TractiveEffort, terms: EffortTerms
) -> tuple[float, float]:
    """`highest_force` of a machine that is described by a table or by limits."""
    if effort.kind == EffortKind.TABLE:
        return table_force(voltage_v, effort.table, terms.table)
    share, slope = voltage_share(voltage_v, effort.limits)
    return terms.limited_n * share, terms.limited_n * slope


@inlined
def highest_force(
    voltage_v: float,
    speed_m_s: float,
    effort: TractiveEffort,
    terms: EffortTerms,
    network: FeedForwardNetwork,
    scratch: Array,
) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    speed_m_s, effort, terms, network
        As in `update_effort`, which comes first.
    scratch : Array, shape `SCRATCH_SHAPE`
    """
    if effort.kind == EffortKind.NETWORK:
        if not reaches(voltage_v, terms.series):
            terms.by_speed_n_s_per_m = motor_force_series(
                speed_m_s, voltage_v, effort.highest_current_a, network, scratch, terms.series
            )
        return series_at(voltage_v, terms.series)
    return _described_force(voltage_v, effort, terms)


@inlined
def effort_at(
    voltage_v: float,
    speed_m_s: float,
    effort: TractiveEffort,
    terms: EffortTerms,
    network: FeedForwardNetwork,
    points: Points,
    scratch: Array,
) -> float:
    """Largest force of all motors at a line voltage and a speed, neither of which is tried again. [N]

    Parameters
    ----------
    voltage_v, speed_m_s : float
        Voltage at the pantograph [V], train speed [m/s].
    terms : EffortTerms
        Written, but for a network.
    effort, network, points, scratch
        As in `update_effort` and `highest_force`.
    """
    if effort.kind == EffortKind.NETWORK:
        return motor_force(speed_m_s, voltage_v, effort.highest_current_a, network, scratch)
    update_effort(speed_m_s, effort, terms, network, points)
    force, _ = _described_force(voltage_v, effort, terms)
    return force


@inlined
def follows_voltage(effort: TractiveEffort, terms: EffortTerms) -> bool:
    """Whether the line voltage has a part in the force that `effort_at` has found."""
    return bool(effort.kind == EffortKind.NETWORK or terms.steepest_n_per_v > 0.0)


@inlined
def effort_by_speed(
    voltage_v: float, speed_m_s: float, effort: TractiveEffort, terms: EffortTerms, points: Points
) -> float:
    """Slope over the speed of the largest force of all motors, about, at a line voltage. [N s/m]

    Parameters
    ----------
    voltage_v, speed_m_s, effort, terms, points
        As in `update_effort` and `highest_force`, which come first.
    """
    if effort.kind == EffortKind.TABLE:
        return table_by_speed(voltage_v, speed_m_s, effort.table, points)
    if effort.kind == EffortKind.LIMITS:
        share, _ = voltage_share(voltage_v, effort.limits)
        return share * limited_by_speed(speed_m_s, terms.limited_n, effort.limits)
    return terms.by_speed_n_s_per_m


@inlined
def effort_extrapolates(
    speed_m_s: float,
    voltage_v: float,
    effort: TractiveEffort,
    network: FeedForwardNetwork,
    points: Points,
) -> bool:
    """Whether network or table are used outside what they were made from; limits hold anywhere."""
    if effort.kind == EffortKind.TABLE:
        return outside_table(speed_m_s, voltage_v, effort.table, points)
    if effort.kind == EffortKind.NETWORK:
        return effort_outside_training(speed_m_s, voltage_v, effort.highest_current_a, network)
    return False
