r"""The work of electric brakes in a phase of constant retardation, however long it is.

Their force follows the speed, v = v₀ + a t: it has corners where they begin to fade, where they give
nothing, and where their power passes its limit.  Between two corners :math:`F_e v` is a polynomial of
the time, of the second degree at most, but for what follows a curve over speed or load; so the rule of
Gauss with two points is exact, at

.. math:: t_m \pm \frac{\delta}{2 \sqrt{3}} .
"""

import math

from tpss.driving.data import DrivingData, Options
from tpss.driving.pull import Pull
from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points, curve_at
from tpss.vehicle.adhesion import adhesion_of
from tpss.vehicle.part_load import given_share
from tpss.vehicle.regeneration import electric_force
from tpss.vehicle.train import Passage
from tpss.vehicle.train_type import TrainType

MOST_PIECES = 4
"""Pieces between three corners."""

GAUSS = 1.0 / math.sqrt(3.0)
"""Places of the two points in half the length of a piece. [1]"""


@kernel
def rails_pass_on(speed_m_s: float, kind: TrainType, options: Options, points: Points) -> float:
    """`adhesion_of` a train, where it is asked for in few steps only. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.6), (F.5).
    """
    return adhesion_of(kind, speed_m_s, options.rail, options.adhesion_in_km_h, points)


@inlined
def _time_to(speed_m_s: float, begin_m_s: float, acceleration_m_s2: float) -> float:
    """When a train has a speed; infinite: never. [s]"""
    if acceleration_m_s2 == 0.0:
        return math.inf
    return (speed_m_s - begin_m_s) / acceleration_m_s2


@inlined
def _next_corner(
    after_s: float, end_s: float, begin_m_s: float, acceleration_m_s2: float, kind: TrainType
) -> float:
    """When the force has its next corner after a time, or when the phase ends. [s]"""
    own, found = kind.regeneration, end_s
    corners = (own.none_up_to_m_s, own.whole_from_m_s, own.highest_power_w / own.highest_force_n)
    for speed_m_s in corners:
        time = _time_to(speed_m_s, begin_m_s, acceleration_m_s2)
        if time > after_s and time < found:
            found = time
    return found


@kernel
def brake_electrically(
    pull: Pull, passage: Passage, kind: TrainType, data: DrivingData, points: Points
) -> None:
    """Add the electric brakes' part in a phase, of a train with power.

    References
    ----------
    [EN50388]_, as `vehicle.regeneration.electric_force`.
    """
    own, a = kind.regeneration, pull.acceleration_m_s2
    begin_m_s = pull.mean_speed_m_s - a * pull.duration_s / 2.0
    time = 0.0
    for _ in range(MOST_PIECES):
        until = _next_corner(time, pull.duration_s, begin_m_s, a, kind)
        half = (until - time) / 2.0
        for side in (-GAUSS, GAUSS):
            speed = max(0.0, begin_m_s + a * (time + half * (1.0 + side)))
            rails_n = rails_pass_on(speed, kind, data.options, points)
            force_n = electric_force(pull.braking_n, speed, rails_n, own)
            work_j = force_n * speed * half
            passage.electric_j += work_j
            curve = own.efficiency
            efficiency = curve_at(speed, curve.first, curve.points, points)
            efficiency *= given_share(force_n * speed, own.over_load)
            passage.offered_j += work_j * efficiency
        time = until
        if time >= pull.duration_s:
            return
