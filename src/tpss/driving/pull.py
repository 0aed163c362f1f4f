r"""What moves a train in a phase of its passage: forces and acceleration, which belong to each other.

Forces of a phase
-----------------
All forces belong to the phase's mean speed v_m = v + a δ/2, with δ its duration: what the machine gives
there at the line voltage, what the rails pass on there, the running resistance there; the gradient is
the mean over the distance v_m δ.  So the acceleration is the root of

.. math:: g(a) = \frac{F(v_m(a)) - F_{res}(v_m(a))}{M} - a ,

where δ depends on a too.  F falls with the speed and F_res grows, so g falls, and the root is found by
the secant method within bounds.  Work and impulse are exact: at constant acceleration a force F does
the work F v_m δ.  The machine gives at v_m what it can at v_m: its power is never above its limits.

A driver who wants less acceleration than the machine can give (his limit of acceleration, a speed that
is held, braking) gets it: then a is what he wants, and the force follows.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from tpss.driving.data import DrivingData, Floats
from tpss.driving.lookahead import time_to_braking, time_to_place
from tpss.kernel import at, inlined
from tpss.numerics.curve import Points
from tpss.physics.gradient import mean_gradient
from tpss.physics.running_resistance import gradient_force
from tpss.vehicle.adhesion import adhesion_of
from tpss.vehicle.billing import force_of_current
from tpss.vehicle.phase import force_of_phase
from tpss.vehicle.resistance import resistance_at
from tpss.vehicle.train import Passage, Train
from tpss.vehicle.train_type import TrainType

ACCURACY = 1e-13
"""Of an acceleration, relative to the larger of it and 1 m/s²."""

MOST_SECANTS = 60
"""More than bisection alone would take."""


class End(IntEnum):
    """What ends a phase."""

    TIME = 0
    SPEED = 1
    STANDSTILL = 2
    BRAKING = 3
    PLACE = 4


class Aim(NamedTuple):
    """What a driver wants in a phase, and what ends it."""

    acceleration_m_s2: float
    """Acceleration that he wants, if the machine can. [m/s²]"""
    until_m_s: float
    """Speed at which the phase ends; infinite: none. [m/s]"""
    longest_s: float
    """Longest duration. [s]"""
    below_m2_s2: float
    """Square of the speed from which he has to brake here, less that of his own. [m²/s²]"""
    room_m: float
    """Distance to the next limit. [m]"""
    target_m: float
    """Where that speed is to be reached; infinite: anywhere. [m]"""
    retardation_m_s2: float
    """Highest retardation at his speed. [m/s²]"""
    slowest_m_s2: float
    """Below this acceleration he looks ahead as with it: slowing down against his will, a train may
    leave the band of its speed, and until then this is on the safe side. [m/s²]"""


class Pull(NamedTuple):
    """What moves a train in a phase."""

    acceleration_m_s2: float
    duration_s: float
    mean_speed_m_s: float
    cap_n: float
    """Force that driver and adhesion allow. [N]"""
    traction_n: float
    braking_n: float
    running_n: float
    gradient_n: float


@inlined
def when_a_phase_ends(acceleration_m_s2: float, speed_m_s: float, aim: Aim) -> tuple[float, int]:
    """Duration of a phase with a given acceleration [s], and its `End`."""
    a, v = acceleration_m_s2, speed_m_s
    duration, end = aim.longest_s, End.TIME
    if a != 0.0 and aim.until_m_s < math.inf:
        time = (aim.until_m_s - v) / a
        if time >= 0.0 and time <= duration:
            duration, end = time, End.SPEED
    if a < 0.0 and -v / a < duration:
        duration, end = -v / a, End.STANDSTILL
    time = time_to_braking(max(a, aim.slowest_m_s2), v, aim.below_m2_s2, aim.retardation_m_s2)
    if time < duration:
        duration, end = time, End.BRAKING
    time = time_to_place(a, v, aim.room_m)
    if time < duration:
        duration, end = time, End.PLACE
    return duration, end


@inlined
def pull_with(
    acceleration_m_s2: float, voltage_v: float, aim: Aim, passage: Passage, train: Train,
    kind: TrainType, data: DrivingData, points: Points, scratch: Floats,
) -> Pull:  # fmt: skip
    """Forces of the phase that an acceleration would make, and the acceleration that they give.

    References
    ----------
    [Boullanger2009]_, eq. (2.5)-(2.11).
    """
    motion, row, options = passage.motion, at(kind.profile), data.options
    v = motion.speed_m_s
    duration, _ = when_a_phase_ends(acceleration_m_s2, v, aim)
    mean = max(0.0, v + acceleration_m_s2 * duration / 2.0)
    slope = mean_gradient(
        motion.gradient, motion.position_m, mean * duration,
        data.gradients.from_m[row], data.gradients.value[row],
    )  # fmt: skip
    running, gradient = (
        resistance_at(mean, kind),
        gradient_force(kind.mass_kg, slope),
    )
    resistance = running + gradient
    wanted = kind.inertia_kg * aim.acceleration_m_s2 + resistance
    if wanted <= 0.0:
        return Pull(aim.acceleration_m_s2, duration, mean, 0.0, 0.0, -wanted, running, gradient)
    cap = min(wanted, adhesion_of(kind, mean, options.rail, options.adhesion_in_km_h, points))
    if train.allowed_current_a < math.inf:
        allowed_a = train.allowed_current_a
        cap = min(cap, force_of_current(allowed_a, mean, resistance, 0.0, kind))
    force = force_of_phase(voltage_v, mean, resistance, cap, kind, train.demand, points, scratch)
    given = aim.acceleration_m_s2
    if force < wanted:
        given = (force - resistance) / kind.inertia_kg
    return Pull(given, duration, mean, cap, force, 0.0, running, gradient)


@inlined
def find_pull(
    voltage_v: float, aim: Aim, passage: Passage, train: Train,
    kind: TrainType, data: DrivingData, points: Points, scratch: Floats,
) -> Pull:  # fmt: skip
    """Forces and acceleration of a phase, which belong to each other: the root of g.

    References
    ----------
    [Boullanger2009]_, eq. (2.11), here at the mean speed.
    """
    a = aim.acceleration_m_s2
    if a > 0.0:
        a = min(a, max(0.0, passage.acceleration_m_s2))
    low, high = -math.inf, math.inf
    before, above_before = a, math.inf
    for tried in range(MOST_SECANTS + 1):
        pull = pull_with(a, voltage_v, aim, passage, train, kind, data, points, scratch)
        above = pull.acceleration_m_s2 - a
        if abs(above) <= ACCURACY * max(1.0, abs(a)) or tried == MOST_SECANTS:
            break
        # 1. The root lies above where g is positive, and below where it is negative.
        if above > 0.0:
            low = max(low, a)
        else:
            high = min(high, a)
        # 2. A secant, first the value itself; bisection where that would leave the bounds.
        after = pull.acceleration_m_s2
        if above_before < math.inf and above != above_before:
            after = a - above * (a - before) / (above - above_before)
        if not (low < after and after < high):
            after = (low + high) / 2.0 if high - low < math.inf else pull.acceleration_m_s2
        before, above_before, a = a, above, after
    return pull
