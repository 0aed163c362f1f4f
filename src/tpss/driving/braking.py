r"""Braking plans: the exact solution of the thesis's linear program, in closed form.

Derivation
----------
A train has speed v and distance d to its stop.  Time runs in steps h; in step s it decelerates by
u_s b, 0 ≤ u_s ≤ 1, with b the highest retardation.  With V = v/(b h), eq. (2.29) and (2.30) ask for

    Σ u_s = V                                   (the train stands at the end),
    Σ u_s (s - 1/2) = d/(b h²)                  (... at its stop),

and the objective (2.27), the sum of the remaining distances, is a constant plus ½ b h² Σ u_s s²
once these two hold.  So the plan is the distribution of the mass V over steps, of capacity 1 each,
with a given mean and the least second moment.  By duality u_s = 1 where a parabola in s is negative
and 0 where it is positive: one block of full steps, with at most one fraction at either end:

    hold the speed ... | α | 1 1 ... 1 | β | stand.

Write V = n + f with n whole.  Slide the block to the right, starting with α = f before n full steps:
first β takes over α's mass (the mean grows by f(n+1)), then the first full step becomes the new α
(by (1-f) n); after both the block has moved by one step and the mean by V.  The plan is therefore
found by one division, whatever the number of steps, and does not depend on the number t_max of steps
that the linear program allows, if it is enough.

The shortest stop, D_lo, brakes fully at once, the remainder f in the last step.

References
----------
[Boullanger2009]_, eq. (2.26)-(2.33), section 3.4.3.
"""

import math

from tpss.kernel import inlined, kernel

ROUNDING = 1e-10
"""Fractions of a step closer than this to 0 or 1 count as such: a stop is then off by about this
share of b h², 8 µm at steps of five minutes."""


@kernel
def shortest_stop(speed_m_s: float, retardation_m_s2: float, step_s: float) -> float:
    """Shortest distance in which a train stops in whole steps, D_lo. [m]

    Parameters
    ----------
    speed_m_s : float
        Speed now, not negative. [m/s]
    retardation_m_s2 : float
        Highest retardation, positive. [m/s²]
    step_s : float
        Time step. [s]

    References
    ----------
    [Boullanger2009]_, the feasibility of eq. (2.26)-(2.33).
    """
    whole = speed_m_s / (retardation_m_s2 * step_s)
    n = math.floor(whole)
    return retardation_m_s2 * step_s**2 * (n * n / 2.0 + (whole - n) * (n + 0.5))


@kernel
def braking_plan(
    speed_m_s: float, distance_m: float, retardation_m_s2: float, step_s: float
) -> tuple[int, float, int, float]:
    """Latest braking that stops a train exactly at its stop.

    Parameters
    ----------
    speed_m_s : float
        Speed now, positive. [m/s]
    distance_m : float
        Distance to the stop, at least `shortest_stop`; a shortage by rounding counts as none. [m]
    retardation_m_s2, step_s : float
        Highest retardation [m/s²] and time step [s].

    Returns
    -------
    hold : int
        Steps at the present speed.
    first : float
        Then one step with this fraction of the highest retardation, possibly 0,
    full : int
        then so many steps with all of it,
    last : float
        then, unless it is 0, one more with this fraction.

    References
    ----------
    [Boullanger2009]_, eq. (2.26)-(2.33).
    """
    whole = speed_m_s / (retardation_m_s2 * step_s)
    n = math.floor(whole)
    f = whole - n
    mean = distance_m / (retardation_m_s2 * step_s**2) + whole / 2.0
    mean = max(mean, n * (n + 1) / 2.0 + f * (n + 1))
    slide = mean - n * (n + 1) / 2.0
    start = math.floor(slide / whole)
    rest = slide - start * whole
    if rest < f * (n + 1) and start > 0:
        moved = rest / (n + 1)
        hold, first, full, last = start - 1, f - moved, n, moved
    else:
        moved = (rest - f * (n + 1)) / max(n, 1)
        hold, first, full, last = start, 1.0 - moved, n - 1, f + moved
        if n == 0:
            first, full, last = f, 0, 0.0
    if last < ROUNDING:
        last = 0.0
    elif last > 1.0 - ROUNDING:
        full, last = full + 1, 0.0
    return hold, first, full, last


@kernel
def plan_length(hold: int, full: int, last: float) -> int:
    """Number of steps until the train of a plan stands at its stop."""
    return hold + 1 + full + (1 if last > 0.0 else 0)


@inlined
def plan_fraction(step: int, hold: int, first: float, full: int, last: float) -> float:
    """Fraction of the highest retardation in a plan's step, counted from 0."""
    if step < hold:
        return 0.0
    if step == hold:
        return first
    if step <= hold + full:
        return 1.0
    return last


@inlined
def highest_speed_that_stops(
    speed_m_s: float, distance_m: float, retardation_m_s2: float, step_s: float
) -> float:
    r"""Highest speed after this step from which the train can still stop at its stop. [m/s]

    With R = d/(b h²) - V_0/2 the condition d - h (v + v')/2 ≥ D_lo(v') reads
    (V' - n)(n + 1) + n(n + 1)/2 ≤ R in every whole n ≤ V' < n + 1: continuous and piecewise linear
    in V' = v'/(b h), so n is the largest whole number with n(n + 1)/2 ≤ R.

    Parameters
    ----------
    speed_m_s, distance_m, retardation_m_s2, step_s : float
        As in `braking_plan`; the speed may be zero.
    """
    unit = retardation_m_s2 * step_s
    room = max(0.0, distance_m / (unit * step_s) - speed_m_s / unit / 2.0)
    n = math.floor((math.sqrt(1.0 + 8.0 * room) - 1.0) / 2.0)
    return unit * (n + max(0.0, room - n * (n + 1.0) / 2.0) / (n + 1.0))
