r"""Lower speed limits ahead, met at their position.

A limit w at position p holds from p on.  A step that passes p must begin and end at or below w.
Braking fully, but never below standstill, a train at (x', v') is slow enough after
n = ⌈(v' - w)/(b h)⌉ steps; the limit can still be met if these take it no further than p.
Both x' and that way grow with v' (by slopes, and by jumps where n does), so the speeds from which
the limit can be met are those up to a highest one, which bisection finds to the last digit.  From
such a speed full braking always leads to another, so the limit stays within reach.
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.driving.braking import shortest_stop
from tpss.kernel import inlined, kernel
from tpss.physics.gradient import step_index

Array = npt.NDArray[np.float64]

SLACK_M = 1e-9
"""Rounding allowed where a way is compared with a distance. [m]"""

SLACK_STEPS = 1e-12
"""Rounding allowed where a speed is counted in steps of full braking. [1]"""

SLACK_M_S = 1e-9
"""Rounding by which a train may enter a limit too fast: a limit met a step before is one of these
above it, and must not call for another, impossible, step of braking. [m/s]"""

BISECTIONS = 60
"""Halvings after which the bracket of a speed is as wide as a rounding."""


@inlined
def slowing_distance(
    speed_m_s: float, limit_m_s: float, retardation_m_s2: float, step_s: float
) -> float:
    """Shortest way in whole steps until a train is at or below a limit. [m]

    Parameters
    ----------
    speed_m_s, limit_m_s : float
        Speed now and limit, not negative. [m/s]
    retardation_m_s2, step_s : float
        Highest retardation [m/s²] and time step [s].
    """
    unit = retardation_m_s2 * step_s
    n = max(0.0, math.ceil((speed_m_s - limit_m_s) / unit - SLACK_STEPS))
    if n * unit > speed_m_s:
        return shortest_stop(speed_m_s, retardation_m_s2, step_s)
    return step_s * n * (speed_m_s - n * unit / 2.0)


@inlined
def slows_down(
    speed_m_s: float, from_m: float, to_m: float, limits_from_m: Array, limit_m_s: Array
) -> bool:
    """Whether a limit below a speed begins between two positions, both left out."""
    j = step_index(from_m, limits_from_m) + 1
    while j < limits_from_m.size and limits_from_m[j] < to_m:
        if limit_m_s[j] < speed_m_s:
            return True
        j += 1
    return False


@kernel
def can_meet_limit(
    speed_m_s: float, next_speed_m_s: float, distance_m: float, limit_m_s: float,
    retardation_m_s2: float, step_s: float,
) -> bool:  # fmt: skip
    """Whether a limit ahead can still be met after a step from one speed to the next.

    Parameters
    ----------
    speed_m_s, next_speed_m_s : float
        Speed at the start and at the end of the step. [m/s]
    distance_m : float
        Distance from the start of the step to the limit's position. [m]
    limit_m_s, retardation_m_s2, step_s : float
        As in `slowing_distance`.
    """
    if speed_m_s <= limit_m_s + SLACK_M_S and next_speed_m_s <= limit_m_s:
        return True
    way = step_s * (speed_m_s + next_speed_m_s) / 2.0
    slowing = slowing_distance(next_speed_m_s, limit_m_s, retardation_m_s2, step_s)
    return way + slowing <= distance_m + SLACK_M


@kernel
def highest_speed_before_limit(
    speed_m_s: float, wanted_m_s: float, distance_m: float, limit_m_s: float,
    retardation_m_s2: float, step_s: float,
) -> float:  # fmt: skip
    """Highest speed after this step, up to the wanted one, from which a limit can be met. [m/s]

    Parameters are those of `can_meet_limit`; `wanted_m_s` is what the driver wants after the step.
    """
    if can_meet_limit(speed_m_s, wanted_m_s, distance_m, limit_m_s, retardation_m_s2, step_s):
        return wanted_m_s
    low, high = max(0.0, speed_m_s - retardation_m_s2 * step_s), wanted_m_s
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        if can_meet_limit(speed_m_s, middle, distance_m, limit_m_s, retardation_m_s2, step_s):
            low = middle
        else:
            high = middle
    return low


@kernel
def heed_limits_ahead(
    position_m: float, speed_m_s: float, wanted_m_s: float, from_m: Array, limit_m_s: Array,
    retardation_m_s2: float, step_s: float,
) -> float:  # fmt: skip
    """Highest speed after this step, up to the wanted one, that every lower limit ahead allows. [m/s]

    A limit no lower than the one before it asks for nothing: a train that is allowed to be faster than
    both may stay so.

    Parameters
    ----------
    position_m : float
        Position of the train. [m]
    from_m, limit_m_s : Array, shape (n,)
        Positions from which the limits hold [m], ascending, and the limits [m/s].
    """
    # No train looks further ahead than a step at both speeds, a stop and one step more.
    fastest = max(speed_m_s, wanted_m_s)
    horizon_m = position_m + fastest * (2.0 * step_s + fastest / retardation_m_s2)
    j = step_index(position_m, from_m) + 1
    while j < from_m.size and from_m[j] <= horizon_m:
        if limit_m_s[j] < min(fastest, limit_m_s[j - 1]):
            wanted_m_s = highest_speed_before_limit(
                speed_m_s, wanted_m_s, from_m[j] - position_m, limit_m_s[j],
                retardation_m_s2, step_s,
            )  # fmt: skip
        j += 1
    return wanted_m_s
