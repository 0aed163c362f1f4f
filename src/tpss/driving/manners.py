"""Which manner of braking holds, and what a manner is.

A manner is a file beside this one with these functions; here it has a branch in each (its member of
`Braking` stands in `driving.data`):

- ``highest_speed_that_stops``: highest speed after a step from which a train can still stop,
- ``allowed_speed``: highest speed after a step that lower limits ahead allow,
- ``aim_to_stop``: target and force of a train that brakes to its stop,
- ``settle``: brakes and next speed, once the solution has told what the machine gives,
- ``must_replan``, ``replan``: whether a train has to brake otherwise than decided, and how,
- ``move``: the train's motion to the next instant.
"""

from tpss.driving.braking import highest_speed_that_stops as highest_speed_whole
from tpss.driving.course import highest_speed_that_stops_within as highest_speed_within
from tpss.driving.data import Braking, DrivingData, Options
from tpss.driving.whole_steps import aim_to_stop as aim_to_stop_whole
from tpss.driving.whole_steps import allowed_speed as allowed_speed_whole
from tpss.driving.whole_steps import move as move_whole
from tpss.driving.whole_steps import must_replan as must_replan_whole
from tpss.driving.whole_steps import replan as replan_whole
from tpss.driving.whole_steps import settle as settle_whole
from tpss.driving.within_step import aim_to_stop as aim_to_stop_within
from tpss.driving.within_step import allowed_speed as allowed_speed_within
from tpss.driving.within_step import move as move_within
from tpss.driving.within_step import must_replan as must_replan_within
from tpss.driving.within_step import replan as replan_within
from tpss.driving.within_step import settle as settle_within
from tpss.kernel import inlined
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType


@inlined
def highest_speed_that_stops(
    speed_m_s: float, distance_m: float, retardation_m_s2: float, options: Options
) -> float:
    """Highest speed after a step of constant acceleration from which a train can still stop. [m/s]"""
    if options.braking == Braking.WITHIN_STEP:
        return highest_speed_within(speed_m_s, distance_m, retardation_m_s2, options.step_s)
    return highest_speed_whole(speed_m_s, distance_m, retardation_m_s2, options.step_s)


@inlined
def allowed_speed(train: Train, kind: TrainType, target_m_s: float, data: DrivingData) -> float:
    """Highest speed after this step, up to the target, that lower limits ahead allow. [m/s]"""
    if data.options.braking == Braking.WITHIN_STEP:
        return allowed_speed_within(train, kind, target_m_s, data)
    return allowed_speed_whole(train, kind, target_m_s, data)


@inlined
def aim_to_stop(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Set target and force of a train that brakes to its stop; return whether that holds."""
    if data.options.braking == Braking.WITHIN_STEP:
        return aim_to_stop_within(train, kind, data)
    return aim_to_stop_whole(train, kind, data)


@inlined
def settle(train: Train, kind: TrainType, options: Options) -> None:
    """Brakes and next speed of a train, whose `forces.tractive_n` is what the rails pass on."""
    if options.braking == Braking.WITHIN_STEP:
        settle_within(train, kind, options.step_s)
    else:
        settle_whole(train, kind, options.step_s)


@inlined
def must_replan(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether a train has to brake otherwise than its driver has decided."""
    if data.options.braking == Braking.WITHIN_STEP:
        return must_replan_within(train, kind, data)
    return must_replan_whole(train, kind, data)


@inlined
def replan(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Let a train brake otherwise; its driver then decides anew."""
    if data.options.braking == Braking.WITHIN_STEP:
        replan_within(train, kind, data)
    else:
        replan_whole(train, kind, data)


@inlined
def move(step: int, train: Train, data: DrivingData) -> float:
    """Bring a train to the next instant; return how far from its stop it came to stand, or 0. [m]"""
    if data.options.braking == Braking.WITHIN_STEP:
        return move_within(step, train, data)
    return move_whole(step, train, data)
