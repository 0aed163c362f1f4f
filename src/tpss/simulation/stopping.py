"""Trains that brake within steps, to their stop or to a lower limit: aim, forces, motion.

What `driver.aim`, `coupling.settle` and `traffic.move` do for a step of constant acceleration is done
here for one that holds the speed, then brakes; the formulas are those of `driving.within_step`.
"""

from typing import Any

from tpss.driving.speed_limits import UNIFORM, heed_limits_ahead, slows_down
from tpss.driving.within_step import (
    even_braking,
    latest_braking,
    mean_braking_force,
    part_of_step,
    way_of_part,
)
from tpss.kernel import inlined, kernel
from tpss.physics.gradient import mean_gradient
from tpss.physics.locomotive import acceleration
from tpss.physics.running_resistance import gradient_force
from tpss.simulation.state import DRIVING, EVEN, LATEST, LIMIT_FIRST, USUAL, Model, Sight, State
from tpss.simulation.traffic import distance_to_stop, stand_at_stop


@inlined
def _climb(train: Any, kind: Any, way_m: float, sight: Sight) -> None:
    """Find the resistances of a step that goes `way_m`."""
    if sight.options.mean_gradient:
        profile = sight.gradients
        slope = mean_gradient(train.stair, train.position_m, way_m, profile.from_m, profile.value)
        train.gradient_force_n = gradient_force(kind.mass_kg, slope)
        train.resistance_n = train.running_resistance_n + train.gradient_force_n


@kernel
def _follow(hold_s: float, brake_s: float, train: Any, kind: Any, sight: Sight) -> None:
    """Take this step's part of a course."""
    v, h = train.speed_m_s, sight.options.step_s
    train.hold_s, train.brake_s, train.target_speed_m_s = part_of_step(v, hold_s, brake_s, h)
    train.moving_share = (train.hold_s + train.brake_s) / h
    way_m = way_of_part(v, train.target_speed_m_s, train.hold_s, train.brake_s)
    _climb(train, kind, way_m, sight)


@kernel
def steer_to_stop(train: Any, kind: Any, sight: Sight) -> bool:
    """Set the course of a train that brakes to its stop, and the force that it takes.

    Return whether the course holds.  If not, a lower limit before the stop asks for less speed: it goes
    first, and the step is driven as usual.  Where there is such a limit, the train brakes evenly, as
    limits are met in uniform steps.
    """
    h, retardation = sight.options.step_s, kind.highest_retardation_m_s2
    v, distance_m = train.speed_m_s, distance_to_stop(train, sight.stops)
    limits, position_m = sight.limits, train.position_m
    limited = slows_down(v, position_m, position_m + distance_m, limits.from_m, limits.value)
    if train.course != EVEN and not limited:
        train.course = LATEST
        hold_s, brake_s = latest_braking(v, distance_m, retardation)
        _follow(hold_s, brake_s, train, kind, sight)
        if train.resistance_n > kind.inertia_kg * retardation:
            train.course = EVEN  # the machine would have to drive while the train brakes
    else:
        train.course = EVEN
    driven_s, wanted = train.hold_s, train.resistance_n
    if train.course == EVEN:
        _follow(0.0, even_braking(v, distance_m, retardation), train, kind, sight)
        target = train.target_speed_m_s
        if limited and target > heed_limits_ahead(
            position_m, v, target, limits.from_m, limits.value, retardation, h, UNIFORM
        ):
            train.phase = DRIVING
            train.course = LIMIT_FIRST
            drive_uniformly(train, kind, sight)
            return False
        driven_s = train.brake_s
        wanted = train.resistance_n - kind.inertia_kg * (v - target) / driven_s
    elif driven_s == 0.0:
        wanted = 0.0
    _want(wanted, driven_s, train, sight)
    return True


@inlined
def steer_to_limit(train: Any, kind: Any, target_m_s: float, sight: Sight) -> bool:
    """Set the course of a train that brakes to a lower limit, and the force that it takes.

    It holds its speed, then brakes with its highest retardation to the end of the step.  Return whether
    it may: not if the brakes take all of the step, or the machine would have to drive while the train
    brakes.
    """
    h, v, retardation = sight.options.step_s, train.speed_m_s, kind.highest_retardation_m_s2
    train.brake_s = min(h, (v - target_m_s) / retardation)
    train.hold_s = h - train.brake_s
    way_m = way_of_part(v, target_m_s, train.hold_s, train.brake_s)
    _climb(train, kind, way_m, sight)
    if train.hold_s == 0.0 or train.resistance_n > kind.inertia_kg * retardation:
        train.course = USUAL
        drive_uniformly(train, kind, sight)
        return False
    train.target_speed_m_s = target_m_s
    _want(train.resistance_n, train.hold_s, train, sight)
    return True


@inlined
def _want(wanted_n: float, driven_s: float, train: Any, sight: Sight) -> None:
    """Note the force that a train on a course wants, and for how long."""
    train.driven_share = driven_s / sight.options.step_s
    train.mean_speed_weight_s = driven_s / 2.0 if sight.options.mean_power else 0.0
    train.wanted_force_n = wanted_n
    train.force_cap_n = max(0.0, min(wanted_n, train.adhesion_n))


@kernel
def drive_uniformly(train: Any, kind: Any, sight: Sight) -> None:
    """Take a train off its course: the step is one of constant acceleration."""
    h = sight.options.step_s
    train.hold_s = 0.0
    train.driven_share = train.moving_share = 1.0
    train.mean_speed_weight_s = h / 2.0 if sight.options.mean_power else 0.0
    _climb(train, kind, train.speed_m_s * h, sight)


@kernel
def settle_course(train: Any, kind: Any, step_s: float) -> None:
    """Forces and next speed of a train on its course; `force_n` is what the machine gives.

    A train that lacks the force for even braking runs on as it can.  Its step is a whole one: where
    even braking ends in the midst of a step, less force would make it roll back.
    """
    force, wanted = train.force_n, train.wanted_force_n
    if train.course == EVEN and force < wanted:
        a = acceleration(force, train.resistance_n, kind.inertia_kg)
        train.next_speed_m_s = train.speed_m_s + a * step_s
        return
    train.force_n = force * train.driven_share
    train.next_speed_m_s = train.target_speed_m_s
    train.braking_force_n = mean_braking_force(
        train.speed_m_s - train.next_speed_m_s, train.hold_s, train.brake_s, step_s,
        train.resistance_n, kind.inertia_kg,
    )  # fmt: skip


@kernel
def move_on_course(step: int, train: Any, model: Model, state: State) -> None:
    """Bring a train on its course to the next instant; it may stand there, at its stop."""
    if train.next_speed_m_s < train.target_speed_m_s:
        train.position_m += model.options.step_s * (train.speed_m_s + train.next_speed_m_s) / 2.0
        train.speed_m_s = train.next_speed_m_s
        train.phase = DRIVING  # the machine could not follow
        return
    train.position_m += way_of_part(
        train.speed_m_s, train.next_speed_m_s, train.hold_s, train.brake_s
    )
    train.speed_m_s = train.next_speed_m_s
    if train.speed_m_s > 0.0:
        return
    error_m = abs(distance_to_stop(train, model.stops))
    state.clock[0].stop_error_m = max(state.clock[0].stop_error_m, error_m)
    train.stood_s = max(0.0, model.options.step_s * (1.0 - train.moving_share))
    stand_at_stop(step + 1, train, model)
