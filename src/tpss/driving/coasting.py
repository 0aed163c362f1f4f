r"""Coasting: stretches before stops on which trains let their speed fall, to save energy.

There a train that is faster than its stretch asks for gives no force: resistances slow it down, or a
gradient speeds it up, as far as the limit, which its brakes hold.  Once it has come down to the speed of
the stretch it goes on with that, as if it were its limit; but it never brakes for it.  It brakes for
limits and stops as ever.  So it does all along where a driver by a law of his own (`own_driver`) wants
less than it has.
"""

import math

from tpss.driving.data import DrivingData, Floats, Profiles
from tpss.driving.pull import Aim, Pull, pull_with
from tpss.kernel import at, fused, inlined
from tpss.numerics.curve import Points
from tpss.numerics.staircase import index_at, room_to_next
from tpss.vehicle.train import Motion, Passage, Train
from tpss.vehicle.train_type import TrainType

CLOSE = 1e-6
"""A speed that is above that of a stretch by less than this share of it is held. [1]"""


@inlined
def has_coasting(data: DrivingData) -> bool:
    """Whether there are trains that coast."""
    return data.coasting.from_m.shape[1] > 1


@fused
def coasting_speed(position_m: float, kind: TrainType, coasting: Profiles) -> float:
    """Speed down to which a train coasts at a position; infinite: it does not. [m/s]"""
    row = at(kind.profile)
    return coasting.value[row][at(index_at(position_m, coasting.from_m[row]))]


@inlined
def _room_to_change(position_m: float, kind: TrainType, data: DrivingData) -> float:
    """Distance to where the next stretch begins or ends. [m]"""
    return room_to_next(position_m, data.coasting.from_m[at(kind.profile)])


@inlined
def may_coast(motion: Motion, kind: TrainType, data: DrivingData) -> bool:
    """Whether a train is on a stretch on which it coasts, or may come to one in this step."""
    if coasting_speed(motion.position_m, kind, data.coasting) < math.inf:
        return True
    farthest_m = kind.highest_speed_m_s * data.options.step_s
    return _room_to_change(motion.position_m, kind, data) <= farthest_m


@inlined
def coast(
    aim: Aim, passage: Passage, train: Train, kind: TrainType, data: DrivingData, points: Points,
    scratch: Floats,
) -> tuple[Aim, bool]:  # fmt: skip
    """What a driver wants where his train may coast, and whether it does.

    Parameters
    ----------
    aim : Aim
        What he would want if it did not.
    passage, train, kind, data, points, scratch
        As of `driving.pull.pull_with`.
    """
    motion = passage.motion
    room_m = min(aim.room_m, _room_to_change(motion.position_m, kind, data))
    v, on_stretch_m_s = motion.speed_m_s, coasting_speed(motion.position_m, kind, data.coasting)
    down_to_m_s = min(on_stretch_m_s, train.decision.wanted_m_s)
    acceleration, until_m_s, longest_s = aim.acceleration_m_s2, aim.until_m_s, aim.longest_s
    coasts = acceleration >= 0.0 and v > down_to_m_s * (1.0 + CLOSE)
    if coasts:
        free = pull_with(0.0, 0.0, aim, passage, train, kind, data, points, scratch)
        if free.acceleration_m_s2 < 0.0:
            longest_s = min(longest_s, (down_to_m_s - v) / free.acceleration_m_s2)
    elif acceleration >= 0.0 and v >= down_to_m_s:
        acceleration, until_m_s = 0.0, math.inf
    elif acceleration > 0.0:
        until_m_s = min(until_m_s, down_to_m_s)
    wanted = Aim(
        acceleration, until_m_s, longest_s, aim.below_m2_s2, room_m, aim.target_m,
        aim.retardation_m_s2, aim.slowest_m_s2,
    )  # fmt: skip
    return wanted, coasts


@inlined
def without_force(pull: Pull) -> Pull:
    """Forces of a phase in which the driver asks for none."""
    return Pull(
        pull.acceleration_m_s2, pull.duration_s, pull.mean_speed_m_s, 0.0, 0.0, pull.braking_n,
        pull.running_n, pull.gradient_n,
    )  # fmt: skip
