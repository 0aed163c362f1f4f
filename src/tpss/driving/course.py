r"""Braking to a stop that may begin and end in the midst of a step.

Derivation
----------
A train has speed v and distance d to its stop, b is its highest retardation.  Braking with b takes the
time v/b and the distance v²/2b.  So the latest that a train can do is to hold its speed for

    τ = (d - v²/2b) / v,

and then to brake with b: it stands at its stop after τ + v/b.  Of this course a step of length h sees
the part τ' = min(τ, h) at constant speed and σ' = min(v/b, h - τ') with the brakes,

    v' = v - b σ',      s = v τ' + (v + v') σ' / 2,

and if it has come to an end, the train stands for what is left of the step.  A step later the course is
computed again from v' and d - s; that it is the same one, d - s = v'²/2b once the brakes act, is what
the formulas say.

A train must begin if this step, driven as usual, would leave d' < v'²/2b.  Then τ < h, or the usual
step would have accelerated it and it holds on for a while: in a uniform step that does not accelerate,
s ≤ v h, and d ≥ s + v'²/2b follows from τ ≥ h.

If the machine cannot hold the speed, or would have to drive against a hill that slows the train down
by more than b, the train brakes evenly with β = v²/2d ≤ b, which leads to its stop too.  A train that
even so slows down by more, by a ≥ β, stops short: d' = d - s and v'² = v² - 2 a s give

    v'²/2d' ≤ v²/2d ≤ b,

so its stop stays within reach, and it drives on from there.

Mean forces
-----------
Within the step the resistances F_res are constant as ever.  The motors give F_res for τ', the brakes
M b - F_res for σ'; over the step that is

    F = F_res τ'/h,      F_brake = (M b - F_res) σ'/h,      F_res (τ' + σ')/h

(a train that runs downhill, F_res < 0, holds its speed with the brakes).  Their sum is M (v' - v)/h:
the momentum balance holds exactly.  Work is not mean force times distance, as force and speed change
together; motors draw power for the share τ'/h of the step, at the speed v.
"""

import math

from tpss.driving.braking import ROUNDING
from tpss.driving.speed_limits import SLACK_M
from tpss.kernel import inlined, kernel


@kernel
def stopping_distance(speed_m_s: float, retardation_m_s2: float) -> float:
    """Distance in which a train stops with its highest retardation, v²/2b. [m]"""
    return speed_m_s**2 / (2.0 * retardation_m_s2)


@kernel
def even_braking(speed_m_s: float, distance_m: float, retardation_m_s2: float) -> float:
    """Time of braking that begins at once and is even down to the stop, 2 d/v. [s]

    Over less than a nanometre, where distances are roundings, the brakes take what they need.
    """
    if distance_m <= SLACK_M:
        return speed_m_s / retardation_m_s2
    return 2.0 * distance_m / speed_m_s


@inlined
def latest_braking(
    speed_m_s: float, distance_m: float, retardation_m_s2: float
) -> tuple[float, float]:
    """Time at the present speed, and of braking after it, that end at the stop. [s]

    Parameters
    ----------
    speed_m_s : float
        Speed now, positive. [m/s]
    distance_m : float
        Distance to the stop, at least `stopping_distance`; the brakes make up for a shortage by
        rounding. [m]
    retardation_m_s2 : float
        Highest retardation, positive. [m/s²]
    """
    needed_m = stopping_distance(speed_m_s, retardation_m_s2)
    hold_s = max(0.0, distance_m - needed_m) / speed_m_s
    return hold_s, even_braking(speed_m_s, min(distance_m, needed_m), retardation_m_s2)


@inlined
def part_of_step(
    speed_m_s: float, hold_s: float, brake_s: float, step_s: float
) -> tuple[float, float, float]:
    """What a step sees of a course: times of holding and braking [s], and the speed after it [m/s].

    A course that is longer than the step by a rounding ends with it.
    """
    if hold_s + brake_s <= step_s * (1.0 + ROUNDING):
        return hold_s, brake_s, 0.0
    held_s = min(hold_s, step_s)
    braked_s = step_s - held_s
    return held_s, braked_s, speed_m_s * (1.0 - braked_s / brake_s)


@kernel
def distance_of_part(
    speed_m_s: float, next_speed_m_s: float, hold_s: float, brake_s: float
) -> float:
    """Distance of a step that holds, then brakes. [m]"""
    return speed_m_s * hold_s + (speed_m_s + next_speed_m_s) / 2.0 * brake_s


@inlined
def mean_braking_force(
    slowing_m_s: float, hold_s: float, brake_s: float, step_s: float,
    resistance_n: float, inertia_kg: float,
) -> float:  # fmt: skip
    """Force of the brakes, mean over a step that holds, then brakes; never negative. [N]

    Parameters
    ----------
    slowing_m_s : float
        Speed at the start less speed at the end of the step. [m/s]
    resistance_n, inertia_kg : float
        Running resistance and gradient force [N]; mass with rotating parts [kg].
    """
    holding_ns = max(0.0, -resistance_n) * hold_s
    stopping_ns = max(0.0, inertia_kg * slowing_m_s - resistance_n * brake_s)
    return (holding_ns + stopping_ns) / step_s


@inlined
def highest_speed_that_stops(
    speed_m_s: float, distance_m: float, retardation_m_s2: float, step_s: float
) -> float:
    r"""Highest speed after a uniform step from which the train can still stop at its stop. [m/s]

    .. math:: d - h (v + v')/2 = v'^2 / 2b
              \;\Rightarrow\; v' = \sqrt{(b h / 2)^2 + 2 b (d - h v / 2)} - b h / 2

    Parameters
    ----------
    speed_m_s, distance_m, retardation_m_s2, step_s : float
        As in `latest_braking`; the speed may be zero.
    """
    half = retardation_m_s2 * step_s / 2.0
    room = 2.0 * retardation_m_s2 * max(0.0, distance_m - step_s * speed_m_s / 2.0)
    return room / (math.sqrt(half**2 + room) + half)
