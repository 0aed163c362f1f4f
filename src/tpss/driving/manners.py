"""Which manner of braking holds, and what a manner is.

A manner is a file beside this one with these functions; here it has a branch in each (its member of
`Braking` stands in `driving.data`):

- ``allowed_speed``: highest speed after a step that lower limits ahead allow,
- ``aim_to_stop``: target and force of a train that brakes to its stop,
- ``apply_solution``: brakes and next speed, once the solution says what the machine gives,
- ``must_replan``, ``replan``: whether a train has to brake otherwise than decided, and how,
- ``move``: the train's motion to the next instant;

and in the file of its formulas

- ``stopping_distance``: shortest distance in which a train stops,
- ``highest_speed_that_stops``: highest speed after a step from which a train can still stop.
"""

from tpss.driving import braking, course, whole_steps, within_step
from tpss.driving.data import Braking, DrivingData, Options
from tpss.kernel import inlined, kernel
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType


@kernel
def stopping_distance(speed_m_s: float, retardation_m_s2: float, options: Options) -> float:
    """Shortest distance in which a train stops. [m]"""
    if options.braking == Braking.WITHIN_STEP:
        return course.stopping_distance(speed_m_s, retardation_m_s2)
    return braking.shortest_stop(speed_m_s, retardation_m_s2, options.step_s)


@inlined
def highest_speed_that_stops(
    speed_m_s: float, distance_m: float, retardation_m_s2: float, options: Options
) -> float:
    """Highest speed after a step of constant acceleration from which a train can still stop. [m/s]"""
    if options.braking == Braking.WITHIN_STEP:
        return course.highest_speed_that_stops(
            speed_m_s, distance_m, retardation_m_s2, options.step_s
        )
    return braking.highest_speed_that_stops(speed_m_s, distance_m, retardation_m_s2, options.step_s)


@inlined
def allowed_speed(train: Train, kind: TrainType, target_m_s: float, data: DrivingData) -> float:
    """Highest speed after this step, up to the target, that lower limits ahead allow. [m/s]"""
    if data.options.braking == Braking.WITHIN_STEP:
        return within_step.allowed_speed(train, kind, target_m_s, data)
    return whole_steps.allowed_speed(train, kind, target_m_s, data)


@inlined
def aim_to_stop(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Set target and force of a train that brakes to its stop; return whether that holds."""
    if data.options.braking == Braking.WITHIN_STEP:
        return within_step.aim_to_stop(train, kind, data)
    return whole_steps.aim_to_stop(train, kind, data)


@inlined
def apply_solution(train: Train, kind: TrainType, options: Options) -> None:
    """Brakes and next speed of a train, whose `forces.tractive_n` is what the rails pass on."""
    if options.braking == Braking.WITHIN_STEP:
        within_step.apply_solution(train, kind, options.step_s)
    else:
        whole_steps.apply_solution(train, kind, options.step_s)


@inlined
def must_replan(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether a train has to brake otherwise than its driver has decided."""
    if data.options.braking == Braking.WITHIN_STEP:
        return within_step.must_replan(train, kind, data)
    return whole_steps.must_replan(train, kind, data)


@inlined
def replan(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Let a train brake otherwise; its driver then decides anew."""
    if data.options.braking == Braking.WITHIN_STEP:
        within_step.replan(train, kind, data)
    else:
        whole_steps.replan(train, kind, data)


@inlined
def move(step: int, train: Train, data: DrivingData) -> float:
    """Bring a train to the next instant; return how far from its stop it came to stand, or 0. [m]"""
    if data.options.braking == Braking.WITHIN_STEP:
        return within_step.move(step, train, data)
    return whole_steps.move(step, train, data)
