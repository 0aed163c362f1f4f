r"""The road ahead of a train: which limit or stop it has to brake for, and when it has to begin.

Braking with its highest retardation b to the speed w at a place a distance d ahead, a train may be as
fast as

.. math:: v^2 = w^2 + 2 b d .

Where b depends on the speed, the squares q of `vehicle.braking` take the place of v² and w².  Over the
distance these are straight lines of one slope, so of all limits and stops ahead one binds, whatever the
speed: that whose line is the lowest.

A train with the acceleration a reaches a line, K above the square of its speed, after the time (in the
band of its speed: with its b, and K in the same measure)

.. math:: (v + a t)^2 = v^2 + K - 2 b (v t + a t^2 / 2)
          \;\Rightarrow\;
          t = \frac{K}{s v + \sqrt{s^2 v^2 + a s K}}, \quad s = a + b,

and a place at the distance d after :math:`t = 2 d / (v + \sqrt{v^2 + 2 a d})`.
"""

import math

from tpss.driving.data import DrivingData
from tpss.kernel import at, fused, inlined
from tpss.vehicle.braking import braking_square
from tpss.vehicle.train import Motion
from tpss.vehicle.train_type import TrainType


@fused
def highest_speed(limit_m_s: float, kind: TrainType) -> float:
    """Highest speed of a train where a limit holds. [m/s]"""
    return min(limit_m_s, kind.highest_speed_m_s)


@inlined
def what_to_brake_for(
    here: int, route: int, motion: Motion, kind: TrainType, data: DrivingData
) -> tuple[float, float, float]:
    """Square q of the speed from which a train has to brake here; where to, and to which speed.

    In m²/s², m and m/s.  Limits are looked for as far as they can matter within a step.

    Parameters
    ----------
    here : int
        Index of the limit that holds where the train is.
    route : int
        Of the train.
    motion : Motion
        Where it is; its next stop.
    kind : TrainType
    data : DrivingData

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30).
    """
    row = at(kind.profile)
    from_m, value = data.limits.from_m[row], data.limits.value[row]
    per_metre = 2.0 * kind.highest_retardation_m_s2
    position_m, fastest = motion.position_m, kind.highest_speed_m_s
    stop_m, target_m_s = data.stops[at(route), at(motion.next_stop)].position_m, 0.0
    target_m = min(stop_m, motion.authority_m)
    square = per_metre * (target_m - position_m)
    b, bands = kind.highest_retardation_m_s2, kind.braking
    reach = braking_square(fastest, b, bands) + fastest * per_metre * data.options.step_s
    j = here + 1
    while j < from_m.size:
        room = per_metre * (from_m[at(j)] - position_m)
        if room >= min(square, reach):
            break
        limit_m_s = highest_speed(value[at(j)], kind)
        from_there = room + braking_square(limit_m_s, b, bands)
        if from_there < square:
            square, target_m, target_m_s = from_there, from_m[at(j)], limit_m_s
        j += 1
    return square, target_m, target_m_s


@inlined
def time_to_braking(
    acceleration_m_s2: float, speed_m_s: float, below_m2_s2: float, retardation_m_s2: float
) -> float:
    """Time until a train has to brake; infinite if it never has. [s]

    Parameters
    ----------
    acceleration_m_s2, speed_m_s : float
        Of the train. [m/s²], [m/s]
    below_m2_s2 : float
        Square of the speed from which it has to brake here, less that of its own, in the band of its
        speed. [m²/s²]
    retardation_m_s2 : float
        Its highest retardation in that band. [m/s²]
    """
    nearing = acceleration_m_s2 + retardation_m_s2
    root = (nearing * speed_m_s) ** 2 + acceleration_m_s2 * nearing * below_m2_s2
    if nearing <= 0.0 or not root > 0.0 or below_m2_s2 == math.inf:
        return math.inf
    return max(0.0, below_m2_s2) / (nearing * speed_m_s + math.sqrt(root))


@inlined
def time_to_place(acceleration_m_s2: float, speed_m_s: float, distance_m: float) -> float:
    """Time until a train has gone a distance; infinite if it never has. [s]

    Parameters
    ----------
    acceleration_m_s2, speed_m_s, distance_m : float
        Of the train [m/s²], [m/s], and the distance [m].
    """
    square = speed_m_s**2 + 2.0 * acceleration_m_s2 * distance_m
    if not square > 0.0 or distance_m == math.inf:
        return math.inf
    return 2.0 * distance_m / (speed_m_s + math.sqrt(square))
