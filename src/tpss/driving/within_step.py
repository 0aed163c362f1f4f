"""Braking that may begin and end within a step, to a stop or to a lower limit.

The interface is stated in `driving.manners`; the formulas are those of `driving.course`.
"""

from tpss.driving.course import (
    distance_of_part,
    even_braking,
    latest_braking,
    mean_braking_force,
    part_of_step,
    stopping_distance,
)
from tpss.driving.data import DrivingData
from tpss.driving.motion import (
    apply_solution_uniformly,
    drive_uniformly,
    move_uniformly,
    set_target,
    update_gradient,
)
from tpss.driving.speed_limits import (
    HOLD_FIRST,
    OUT_OF_REACH,
    UNIFORM,
    respect_limits_ahead,
    slows_down,
)
from tpss.driving.stops import distance_to_stop, stand_at_stop
from tpss.kernel import at, inlined, kernel
from tpss.physics.locomotive import acceleration
from tpss.vehicle.train import Course, Phase, Train, brakes_within_step
from tpss.vehicle.train_type import TrainType


@inlined
def allowed_speed(train: Train, kind: TrainType, target_m_s: float, data: DrivingData) -> float:
    """Highest speed after this step, up to the target, that lower limits ahead allow. [m/s]

    A train that has to slow down for one is put on its course.  One that cannot hold its speed aims at
    the same speed uniformly, which takes less distance.
    """
    from_m, limit_m_s = data.limits.from_m[at(kind.profile)], data.limits.value[at(kind.profile)]
    v, decision = train.motion.speed_m_s, train.decision
    holds = train.motion.phase == Phase.DRIVING and decision.course != Course.LIMIT_FIRST
    slowing = HOLD_FIRST if holds else UNIFORM
    allowed = respect_limits_ahead(
        train.motion.position_m, v, target_m_s, from_m, limit_m_s,
        kind.highest_retardation_m_s2, data.options.step_s, slowing,
    )  # fmt: skip
    if allowed == OUT_OF_REACH:
        return respect_limits_ahead(
            train.motion.position_m, v, target_m_s, from_m, limit_m_s,
            kind.highest_retardation_m_s2, data.options.step_s, UNIFORM,
        )  # fmt: skip
    if holds and decision.course == Course.UNIFORM and allowed < min(v, target_m_s):
        decision.course = Course.TO_LIMIT
    return allowed


@kernel
def _follow(
    hold_s: float, brake_s: float, train: Train, kind: TrainType, data: DrivingData
) -> None:
    """Take this step's part of a course."""
    decision, v, h = train.decision, train.motion.speed_m_s, data.options.step_s
    part = part_of_step(v, hold_s, brake_s, h)
    decision.hold_s, decision.brake_s, decision.target_speed_m_s = part
    decision.moving_share = (decision.hold_s + decision.brake_s) / h
    distance_m = distance_of_part(v, decision.target_speed_m_s, decision.hold_s, decision.brake_s)
    update_gradient(train, kind, distance_m, data)


@kernel
def aim_to_stop(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Set the course of a train that brakes to its stop, and the force that it takes.

    Return whether the course holds.  If not, a lower limit before the stop asks for less speed: it goes
    first, and the step is driven as usual.  Where there is such a limit, the train brakes evenly, as
    limits are met in uniform steps.
    """
    h, retardation = data.options.step_s, kind.highest_retardation_m_s2
    v, distance_m = train.motion.speed_m_s, distance_to_stop(train, data.stops)
    from_m, limit_m_s = data.limits.from_m[at(kind.profile)], data.limits.value[at(kind.profile)]
    position_m, decision = train.motion.position_m, train.decision
    limited = slows_down(v, position_m, position_m + distance_m, from_m, limit_m_s)
    if decision.course != Course.EVEN and not limited:
        decision.course = Course.LATEST
        hold_s, brake_s = latest_braking(v, distance_m, retardation)
        _follow(hold_s, brake_s, train, kind, data)
        if train.demand.resistance_n > kind.inertia_kg * retardation:
            decision.course = Course.EVEN  # the machine would have to drive while the train brakes
    else:
        decision.course = Course.EVEN
    driven_s, wanted = decision.hold_s, train.demand.resistance_n
    if decision.course == Course.EVEN:
        _follow(0.0, even_braking(v, distance_m, retardation), train, kind, data)
        target = decision.target_speed_m_s
        if limited and target > respect_limits_ahead(
            position_m, v, target, from_m, limit_m_s, retardation, h, UNIFORM
        ):
            train.motion.phase = Phase.DRIVING
            decision.course = Course.LIMIT_FIRST
            drive_uniformly(train, kind, data)
            return False
        driven_s = decision.brake_s
        wanted = train.demand.resistance_n - kind.inertia_kg * (v - target) / driven_s
    elif driven_s == 0.0:
        wanted = 0.0
    _set_target_for(driven_s, wanted, train, data)
    return True


@inlined
def aim_to_limit(train: Train, kind: TrainType, target_m_s: float, data: DrivingData) -> bool:
    """Set the course of a train that brakes to a lower limit, and the force that it takes.

    It holds its speed, then brakes with its highest retardation to the end of the step.  Return whether
    it may: not if the brakes take all of the step, or the machine would have to drive while the train
    brakes.
    """
    decision, v, h = train.decision, train.motion.speed_m_s, data.options.step_s
    retardation = kind.highest_retardation_m_s2
    decision.brake_s = min(h, (v - target_m_s) / retardation)
    decision.hold_s = h - decision.brake_s
    distance_m = distance_of_part(v, target_m_s, decision.hold_s, decision.brake_s)
    update_gradient(train, kind, distance_m, data)
    resistance_n = train.demand.resistance_n
    if decision.hold_s == 0.0 or resistance_n > kind.inertia_kg * retardation:
        decision.course = Course.UNIFORM
        drive_uniformly(train, kind, data)
        return False
    decision.target_speed_m_s = target_m_s
    _set_target_for(decision.hold_s, resistance_n, train, data)
    return True


@inlined
def _set_target_for(driven_s: float, wanted_n: float, train: Train, data: DrivingData) -> None:
    """Note the force that a train on a course wants, and for how long."""
    demand = train.demand
    demand.driven_share = driven_s / data.options.step_s
    demand.mean_speed_weight_s = driven_s / 2.0 if data.options.mean_power else 0.0
    set_target(train, wanted_n, min(wanted_n, demand.adhesion_n), train.decision.target_speed_m_s)


@kernel
def _apply_solution_on_course(train: Train, kind: TrainType, step_s: float) -> None:
    """`apply_solution` of a train on a course.

    A train that lacks the force for even braking runs on as it can.  Its step is a whole one: where
    even braking ends in the midst of a step, less force would make it roll back.
    """
    decision, forces, v = train.decision, train.forces, train.motion.speed_m_s
    resistance_n = train.demand.resistance_n
    if decision.course == Course.EVEN and forces.tractive_n < decision.force_n:
        a = acceleration(forces.tractive_n, resistance_n, kind.inertia_kg)
        forces.next_speed_m_s = v + a * step_s
        return
    forces.tractive_n *= train.demand.driven_share
    forces.next_speed_m_s = decision.target_speed_m_s
    forces.braking_n = mean_braking_force(
        v - forces.next_speed_m_s, decision.hold_s, decision.brake_s, step_s,
        resistance_n, kind.inertia_kg,
    )  # fmt: skip


@inlined
def apply_solution(train: Train, kind: TrainType, step_s: float) -> None:
    """Brakes and next speed of a train, whose `forces.tractive_n` is what the rails pass on."""
    if brakes_within_step(train.decision.course):
        _apply_solution_on_course(train, kind, step_s)
    else:
        apply_solution_uniformly(train, kind, step_s)


@inlined
def _cannot_hold(train: Train) -> bool:
    """Whether a train that is to hold its speed before it brakes cannot do so."""
    course = train.decision.course
    if course != Course.LATEST and course != Course.TO_LIMIT:
        return False
    return bool(train.forces.tractive_n < train.decision.force_n * train.demand.driven_share)


@inlined
def must_replan(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether a train cannot hold its speed as it is to, or has too little distance left to stop."""
    decision, forces, v = train.decision, train.forces, train.motion.speed_m_s
    if _cannot_hold(train):
        return True
    if train.motion.phase != Phase.DRIVING or decision.course == Course.LIMIT_FIRST or v <= 0.0:
        return False
    next_v = max(forces.next_speed_m_s, 0.0)
    distance_m = data.options.step_s * (v + forces.next_speed_m_s) / 2.0
    if decision.course == Course.TO_LIMIT:
        distance_m = distance_of_part(v, next_v, decision.hold_s, decision.brake_s)
    needed_m = stopping_distance(next_v, kind.highest_retardation_m_s2)
    return distance_to_stop(train, data.stops) - distance_m < needed_m


@kernel
def replan(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Let a train brake to its stop; one that cannot hold its speed brakes evenly."""
    decision = train.decision
    if decision.course == Course.TO_LIMIT and _cannot_hold(train):
        decision.course = Course.TO_LIMIT_UNIFORMLY
        drive_uniformly(train, kind, data)
        return
    decision.course = Course.EVEN if decision.course == Course.LATEST else Course.UNIFORM
    train.motion.phase = Phase.PLANNED


@kernel
def _move_on_course(step: int, train: Train, data: DrivingData) -> float:
    """`move` of a train on a course."""
    motion, decision, next_v = train.motion, train.decision, train.forces.next_speed_m_s
    if next_v < decision.target_speed_m_s:
        move_uniformly(train, data.options.step_s)
        motion.phase = Phase.DRIVING  # the machine could not follow
        return 0.0
    motion.position_m += distance_of_part(
        motion.speed_m_s, next_v, decision.hold_s, decision.brake_s
    )
    motion.speed_m_s = next_v
    if next_v > 0.0:
        return 0.0
    error_m = abs(distance_to_stop(train, data.stops))
    train.timetable.stood_s = max(0.0, data.options.step_s * (1.0 - decision.moving_share))
    stand_at_stop(step + 1, data.options.step_s, train, data.stops)
    return error_m


@inlined
def move(step: int, train: Train, data: DrivingData) -> float:
    """Bring a train to the next instant; it may stand there, at its stop.

    Return how far its stop is from where it came to stand, 0 unless it has. [m]
    """
    if brakes_within_step(train.decision.course):
        return _move_on_course(step, train, data)
    move_uniformly(train, data.options.step_s)
    return 0.0
