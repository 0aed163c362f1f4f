"""Braking in whole steps, the manner of the thesis: plans of full steps with a fraction at either end.

The interface is stated in `driving.manners`; the formulas are those of `driving.braking`.
"""

from tpss.driving.braking import (
    braking_plan,
    plan_fraction,
    plan_length,
    shortest_stop,
)
from tpss.driving.data import DrivingData
from tpss.driving.motion import (
    apply_solution_uniformly,
    force_to_target,
    move_uniformly,
    set_target,
)
from tpss.driving.speed_limits import SLACK_M, UNIFORM, respect_limits_ahead
from tpss.driving.stops import distance_to_stop, stand_at_stop
from tpss.kernel import at, inlined, kernel
from tpss.vehicle.train import Phase, Plan, Train
from tpss.vehicle.train_type import TrainType


@inlined
def least_stopping_distance(speed_m_s: float, retardation_m_s2: float, step_s: float) -> float:
    """Distance that a train needs to stop, less what a plan makes up for, a rounding. [m]"""
    return shortest_stop(speed_m_s, retardation_m_s2, step_s) - SLACK_M


@inlined
def allowed_speed(train: Train, kind: TrainType, target_m_s: float, data: DrivingData) -> float:
    """Highest speed after this step, up to the target, that lower limits ahead allow. [m/s]"""
    row = at(kind.profile)
    return respect_limits_ahead(
        train.motion.position_m, train.motion.speed_m_s, target_m_s,
        data.limits.from_m[row], data.limits.value[row],
        kind.highest_retardation_m_s2, data.options.step_s, UNIFORM,
    )  # fmt: skip


@inlined
def planned_speed(speed_m_s: float, plan: Plan, full_braking_m_s: float) -> float:
    """Speed that a braking plan asks for after this step. [m/s]

    Parameters
    ----------
    speed_m_s : float
        Speed now. [m/s]
    plan : Plan
    full_braking_m_s : float
        What a step of full braking takes off the speed. [m/s]
    """
    if plan.step + 1 == plan_length(plan.hold_steps, plan.full_steps, plan.last):
        return 0.0
    fraction = plan_fraction(plan.step, plan.hold_steps, plan.first, plan.full_steps, plan.last)
    return max(0.0, speed_m_s - fraction * full_braking_m_s)


@inlined
def aim_to_stop(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Set the target of a train on its plan; a limit that asks for less speed goes first."""
    h = data.options.step_s
    full_braking_m_s = kind.highest_retardation_m_s2 * h
    target = planned_speed(train.motion.speed_m_s, train.plan, full_braking_m_s)
    allowed = allowed_speed(train, kind, target, data)
    if allowed < target:
        train.motion.phase = Phase.DRIVING  # the train plans anew
    wanted = force_to_target(train, kind, allowed, h)
    set_target(train, wanted, min(wanted, train.demand.adhesion_n), allowed)
    return True


@inlined
def apply_solution(train: Train, kind: TrainType, step_s: float) -> None:
    """Brakes and next speed of a train, whose `forces.tractive_n` is what the rails pass on."""
    apply_solution_uniformly(train, kind, step_s)


@inlined
def must_replan(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether this step, driven as it is, would leave a train too little distance to stop.

    References
    ----------
    [Boullanger2009]_, ``final_brake`` of figure 3-7.
    """
    v, next_v = train.motion.speed_m_s, train.forces.next_speed_m_s
    if train.motion.phase != Phase.DRIVING or v <= 0.0:
        return False
    h, retardation = data.options.step_s, kind.highest_retardation_m_s2
    needed_m = least_stopping_distance(max(next_v, 0.0), retardation, h)
    return distance_to_stop(train, data.stops) - h * (v + next_v) / 2.0 < needed_m


@kernel
def replan(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Put a train on its braking plan, from its present speed and position."""
    hold, first, full, last = braking_plan(
        train.motion.speed_m_s,
        distance_to_stop(train, data.stops),
        kind.highest_retardation_m_s2,
        data.options.step_s,
    )
    train.motion.phase = Phase.PLANNED
    plan = train.plan
    plan.step = 0
    plan.hold_steps = hold
    plan.first = first
    plan.full_steps = full
    plan.last = last


@inlined
def move(step: int, train: Train, data: DrivingData) -> float:
    """Bring a train to the next instant; it may stand there, at the end of its plan.

    Return how far its stop is from there, 0 unless it has come to it. [m]
    """
    motion, plan = train.motion, train.plan
    move_uniformly(train, data.options.step_s)
    if motion.phase != Phase.PLANNED:
        return 0.0
    if train.forces.tractive_n < train.decision.force_n:
        motion.phase = Phase.DRIVING  # the machine could not follow: plan anew
        return 0.0
    plan.step += 1
    if plan.step < plan_length(plan.hold_steps, plan.full_steps, plan.last):
        return 0.0
    error_m = abs(distance_to_stop(train, data.stops))
    stand_at_stop(step + 1, data.options.step_s, train, data.stops)
    return error_m
