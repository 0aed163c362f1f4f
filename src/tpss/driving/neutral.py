"""Neutral sections: trains pass them with their power off, and have it again a while behind them.

There the contact line is parted between two phases or systems.  From where its head enters one until its
head has left it, and for the time that it takes to switch on again, a train has no force and draws
nothing: it coasts and brakes.  Where it comes to stand in one, it stays.
"""

import math

from tpss.driving.data import DrivingData
from tpss.kernel import at, inlined
from tpss.numerics.staircase import index_at, room_to_next
from tpss.physics.constants import GRAVITY_M_S2
from tpss.vehicle.train import Motion, Passage
from tpss.vehicle.train_type import TrainType


@inlined
def has_neutral(data: DrivingData) -> bool:
    """Whether there are neutral sections on any route."""
    return data.neutral.from_m.shape[1] > 1


@inlined
def off_behind(position_m: float, kind: TrainType, data: DrivingData) -> float:
    """Time without power behind the neutral section at a position; negative: there is none. [s]"""
    row = at(kind.profile)
    return data.neutral.value[row][at(index_at(position_m, data.neutral.from_m[row]))]


@inlined
def time_without_power(motion: Motion, kind: TrainType, data: DrivingData) -> float:
    """How long a train that stays where it is has no power; infinite: in a neutral section. [s]"""
    if off_behind(motion.position_m, kind, data) >= 0.0:
        return math.inf
    return motion.power_off_s


@inlined
def room_to_change(position_m: float, kind: TrainType, data: DrivingData) -> float:
    """Distance to the next beginning or end of a neutral section. [m]"""
    return room_to_next(position_m, data.neutral.from_m[at(kind.profile)])


@inlined
def may_lack_power(motion: Motion, kind: TrainType, data: DrivingData) -> bool:
    """Whether a train may lack power in the step; it gains speed less fast than if it fell."""
    if time_without_power(motion, kind, data) > 0.0:
        return True
    h = data.options.step_s
    farthest_m = (motion.speed_m_s + min(kind.highest_acceleration_m_s2, GRAVITY_M_S2) * h) * h
    return room_to_change(motion.position_m, kind, data) <= farthest_m


@inlined
def follow_power(
    off_s: float, position_m: float, left_s: float, passage: Passage, kind: TrainType,
    data: DrivingData,
) -> None:  # fmt: skip
    """Note how a phase has changed a train's time without power.

    Parameters
    ----------
    off_s : float
        `time_without_power` before it. [s]
    position_m, left_s : float
        Position, and what was left of the step, before it. [m], [s]
    """
    motion, spent_s = passage.motion, left_s - passage.left_s
    if off_s > 0.0:
        passage.without_power_s += spent_s
        motion.power_off_s = max(0.0, motion.power_off_s - spent_s)
    if off_s == math.inf and off_behind(motion.position_m, kind, data) < 0.0:
        motion.power_off_s = off_behind(position_m, kind, data)
