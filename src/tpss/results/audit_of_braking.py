"""The audit of steps that hold the speed, then brake to a stop or a lower limit.

The simulation sums forces over the times of a course; the audit knows of it only how long the speed was
held, and has all else from the speeds and positions at the instants around the step.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def braking_work(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Work of resistances and brakes, phase by phase. [J]

    Of the resistances the mean over the step is recorded, for a part of which the train may stand.  To
    hold the speed downhill takes brakes; the rest of their recorded impulse slows the train down.

    Parameters
    ----------
    before, after : records of `TRAIN_ROW`, shape (steps, trains)
        At the instants before and after each step.
    kind : records of `TRAIN_TYPE`, shape (trains,)
    step_s : float
        Time step. [s]
    """
    v, hold_s = before["speed"], before["holding_time"]
    brake_s = (v - after["speed"]) / kind.highest_retardation_m_s2
    moving_s = hold_s + brake_s
    impulse_ns = step_s * (before["running_resistance"] + before["gradient_force"])
    resistance_n = impulse_ns / np.where(moving_s > 0.0, moving_s, np.nan)
    holding_ns = np.maximum(0.0, -resistance_n) * hold_s
    stopping_ns = before["braking_force"] * step_s - holding_ns
    while_holding = (resistance_n * hold_s + holding_ns) * v
    while_braking = (resistance_n * brake_s + stopping_ns) * (v + after["speed"]) / 2.0
    return np.asarray(while_holding + while_braking, dtype=float)


def braking_motion_error_m(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Difference between the way of each step and that of its speeds. [m]

    A step that holds the speed v for τ, then brakes with b, goes v τ + (v² - v'²)/2b; together that
    takes the whole step, or less of it if the train stops.  A step without τ is a uniform one, but that
    a train may come to its stop in any part of it: it goes no less than with b, and no further than
    uniformly.  Parameters are those of `braking_work`.
    """
    v, w, hold_s = before["speed"], after["speed"], before["holding_time"]
    way_m = after["position"] - before["position"]
    brake_s = (v - w) / kind.highest_retardation_m_s2
    over_s = hold_s + brake_s - step_s
    over_s = np.where(w > 0.0, np.abs(over_s), np.maximum(0.0, over_s))
    held_m = v * hold_s + (v + w) / 2.0 * brake_s
    uniform_m = step_s * (v + w) / 2.0
    shortest_m = np.minimum(uniform_m, v / 2.0 * brake_s)
    stop_m = np.clip(way_m, shortest_m, uniform_m)
    other_m = np.where((w == 0.0) & (v > 0.0), stop_m, uniform_m)
    error = np.where(hold_s > 0.0, np.abs(way_m - held_m) + v * over_s, way_m - other_m)
    return np.asarray(error, dtype=float)
