r"""Lower speed limits ahead, met at their position.

A limit w at position p holds from p on.  A step that passes p must begin and end at or below w.
Braking fully, but never below standstill, a train at (x', v') is slow enough after
n = ⌈(v' - w)/(b h)⌉ steps; the limit can still be met if these take it no further than p.
Both x' and that distance grow with v' (by slopes, and by jumps where n does), so the speeds from which
the limit can be met are those up to a highest one, which bisection finds to the last digit.  From
such a speed full braking always leads to another, so the limit stays within reach.

Steps in which the speed is held first
--------------------------------------
Full braking over whole steps leaves a train far below the limit where steps are long against
(v - w)/b: at 0.85 m/s² from 100 km/h, at 8 km/h after 30 s.  A step that may hold its speed v for a
while and brake with b at its end, from v to v' in (v - v')/b, goes

    distance = v (h - (v - v')/b) + (v² - v'²)/2b = v h - (v - v')²/2b,

and n such steps, all but the first of them with the brakes alone, bring a train to w exactly,

    distance = v (n h - (v - w)/b) + (v² - w²)/2b.

These distances grow with v' and v too, and again a step of the latest braking leads from a speed from
which the limit can be met to another.  The train comes to the limit's position with w, or is that
slow up to a step before it.  Other than steps of full braking these may be too long for a train that
has been placed too near to a limit: it is driven in uniform steps.
"""

import math
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from tpss.driving.braking import shortest_stop
from tpss.kernel import inlined, kernel, switch
from tpss.numerics.staircase import index_at

Array = npt.NDArray[np.float64]

SLACK_M = 1e-9
"""Rounding allowed where distances are compared. [m]"""

SLACK_STEPS = 1e-12
"""Rounding allowed where a speed is counted in steps of full braking. [1]"""

SLACK_M_S = 1e-9
"""Rounding by which a train may enter a limit too fast: a limit met a step before is one of these
above it, and must not call for another, impossible, step of braking. [m/s]"""


class Slowing(IntEnum):
    """How a step slows a train down."""

    UNIFORM = 0
    """At constant acceleration."""
    HOLD_FIRST = 1
    """With the highest retardation at its end."""


UNIFORM, HOLD_FIRST = switch(Slowing.UNIFORM), switch(Slowing.HOLD_FIRST)

OUT_OF_REACH = -1.0
"""In place of a speed: steps that hold their speed first cannot meet a limit."""

BISECTIONS = 60
"""Halvings after which the bracket of a speed is as wide as a rounding."""


@inlined
def slowing_distance(
    speed_m_s: float, limit_m_s: float, retardation_m_s2: float, step_s: float
) -> float:
    """Shortest distance in whole steps until a train is at or below a limit. [m]

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
def latest_slowing_distance(
    speed_m_s: float, limit_m_s: float, retardation_m_s2: float, step_s: float
) -> float:
    r"""Distance to a limit in whole steps that end with full braking, the first holding its speed.

    In metres, 0 at or below the limit.

    .. math:: v \left(n h - \frac{v - w}{b}\right) + \frac{v^2 - w^2}{2 b}

    Parameters are those of `slowing_distance`.
    """
    if speed_m_s <= limit_m_s:
        return 0.0
    slowing_s = (speed_m_s - limit_m_s) / retardation_m_s2
    n = math.ceil(slowing_s / step_s)
    braking_m = slowing_s * (speed_m_s + limit_m_s) / 2.0
    return speed_m_s * (n * step_s - slowing_s) + braking_m


@inlined
def slows_down(
    speed_m_s: float, from_m: float, to_m: float, limits_from_m: Array, limit_m_s: Array
) -> bool:
    """Whether a limit below a speed begins between two positions, both left out."""
    j = index_at(from_m, limits_from_m) + 1
    while j < limits_from_m.size and limits_from_m[j] < to_m:
        if limit_m_s[j] < speed_m_s:
            return True
        j += 1
    return False


@kernel
def can_meet_limit(
    speed_m_s: float, next_speed_m_s: float, distance_m: float, limit_m_s: float,
    retardation_m_s2: float, step_s: float, slowing: Slowing,
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
    slowing : Slowing
    """
    if speed_m_s <= limit_m_s + SLACK_M_S and next_speed_m_s <= limit_m_s:
        return True
    if slowing == HOLD_FIRST:
        slower_m_s = max(0.0, speed_m_s - next_speed_m_s)
        faster_m_s = max(0.0, next_speed_m_s - speed_m_s)
        distance = step_s * (speed_m_s + faster_m_s / 2.0) - slower_m_s**2 / (
            2.0 * retardation_m_s2
        )
        slowing_m = latest_slowing_distance(next_speed_m_s, limit_m_s, retardation_m_s2, step_s)
    else:
        distance = step_s * (speed_m_s + next_speed_m_s) / 2.0
        slowing_m = slowing_distance(next_speed_m_s, limit_m_s, retardation_m_s2, step_s)
    return distance + slowing_m <= distance_m + SLACK_M


@kernel
def highest_speed_before_limit(
    speed_m_s: float, wanted_m_s: float, distance_m: float, limit_m_s: float,
    retardation_m_s2: float, step_s: float, slowing: Slowing,
) -> float:  # fmt: skip
    """Highest speed after this step, up to the wanted one, from which a limit can be met. [m/s]

    Or `OUT_OF_REACH`.  Parameters are those of `can_meet_limit`; `wanted_m_s` is what the driver wants
    after the step.
    """
    d, limit, b, h = distance_m, limit_m_s, retardation_m_s2, step_s
    if can_meet_limit(speed_m_s, wanted_m_s, d, limit, b, h, slowing):
        return wanted_m_s
    low, high = max(0.0, speed_m_s - b * h), wanted_m_s
    if slowing == HOLD_FIRST:
        low = max(low, min(speed_m_s, limit))
        # Roundings of a distance and of a speed do not take a train off the braking that it has begun.
        if not can_meet_limit(speed_m_s, low - SLACK_M_S, d + SLACK_M, limit, b, h, slowing):
            return OUT_OF_REACH
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        if can_meet_limit(speed_m_s, middle, d, limit, b, h, slowing):
            low = middle
        else:
            high = middle
    return low


@kernel
def respect_limits_ahead(
    position_m: float, speed_m_s: float, wanted_m_s: float, from_m: Array, limit_m_s: Array,
    retardation_m_s2: float, step_s: float, slowing: Slowing,
) -> float:  # fmt: skip
    """Highest speed after this step, up to the wanted one, that every lower limit ahead allows. [m/s]

    Or `OUT_OF_REACH`, if steps that hold their speed first cannot meet all of them.

    A limit no lower than the one before it asks for nothing: a train that is allowed to be faster than
    both may stay so.

    Parameters
    ----------
    position_m : float
        Position of the train. [m]
    from_m, limit_m_s : Array, shape (n,)
        Positions from which the limits hold [m], ascending, and the limits [m/s].
    retardation_m_s2, step_s, slowing
        As in `can_meet_limit`.
    """
    # No train looks further ahead than a step at both speeds, a stop and one step more.
    fastest = max(speed_m_s, wanted_m_s)
    horizon_m = position_m + fastest * (2.0 * step_s + fastest / retardation_m_s2)
    j = index_at(position_m, from_m) + 1
    while j < from_m.size and from_m[j] <= horizon_m:
        if limit_m_s[j] < min(fastest, limit_m_s[j - 1]):
            wanted_m_s = highest_speed_before_limit(
                speed_m_s, wanted_m_s, from_m[j] - position_m, limit_m_s[j],
                retardation_m_s2, step_s, slowing,
            )  # fmt: skip
            if wanted_m_s == OUT_OF_REACH:
                return OUT_OF_REACH
        j += 1
    return wanted_m_s
