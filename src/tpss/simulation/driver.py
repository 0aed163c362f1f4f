"""The driver of each train: which speed to reach in this step, and which force that takes."""

from typing import Any

from tpss.driving.aggressive import aggressive_force, aggressive_speed
from tpss.driving.braking import highest_speed_that_stops, plan_fraction, plan_length
from tpss.driving.speed_limits import HOLD_FIRST, OUT_OF_REACH, UNIFORM, heed_limits_ahead
from tpss.driving.speed_regulation import ideal_force, wanted_acceleration
from tpss.driving.within_step import highest_speed_that_stops_within
from tpss.kernel import at, inlined, kernel
from tpss.physics.adhesion import adhesion_limit
from tpss.physics.gradient import mean_gradient, stair_ahead, step_index
from tpss.physics.locomotive import (
    FULL_EFFORT_N,
    Machine,
    acceleration,
    note_cap,
    prove_free_band,
    speed_is_taken,
    take_speed,
)
from tpss.physics.running_resistance import (
    DavisCoefficients,
    gradient_force,
    running_resistance,
)
from tpss.simulation.state import (
    AGGRESSIVE,
    DRIVING,
    DWELLING,
    LIMIT_FIRST,
    PLANNED,
    TO_LIMIT,
    TO_LIMIT_UNIFORMLY,
    USUAL,
    WITHIN_STEP,
    Model,
    Sight,
)
from tpss.simulation.stopping import drive_uniformly, steer_to_limit, steer_to_stop
from tpss.simulation.traffic import distance_to_stop


@inlined
def fastest_and_coasting(train: Any, kind: Any, step_s: float) -> tuple[float, float]:
    """Speeds after this step: the highest that the rails allow, and without motors or brakes. [m/s]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    v, resistance = train.speed_m_s, train.resistance_n
    fastest = v + step_s * acceleration(train.adhesion_n, resistance, kind.inertia_kg)
    coasting = v + step_s * acceleration(0.0, resistance, kind.coasting_inertia_kg)
    return max(0.0, fastest), coasting


@inlined
def target_speed(train: Any, kind: Any, sight: Sight) -> float:
    """Speed that a train is to have after this step, if its machine can. [m/s]

    The lower of line and train limits it, or the original driver's rule, and the highest acceleration
    that the train may have; a braking plan and limits ahead lower it.  A train that stands, or as
    good as does, takes no more than leaves room for its next stop: a plan only ever lowers the speed,
    so one that creeps would creep on to the stop.

    References
    ----------
    [Boullanger2009]_, section 2.3.1 and figure 3-7.
    """
    limits, h, retardation = sight.limits, sight.options.step_s, kind.highest_retardation_m_s2
    if train.phase == PLANNED:
        target = planned_speed(train, retardation * h)
    else:
        limit = limits.value[step_index(train.position_m, limits.from_m)]
        target = min(limit, kind.highest_speed_m_s)
        if sight.options.driver == AGGRESSIVE:
            fastest, coasting = fastest_and_coasting(train, kind, h)
            slowest = train.speed_m_s - retardation * h
            target = aggressive_speed(train.speed_m_s, target, fastest, coasting, slowest)
        if train.speed_m_s < target / 2.0:
            room_m = distance_to_stop(train, sight.stops)
            if sight.options.braking == WITHIN_STEP:
                most = highest_speed_that_stops_within(train.speed_m_s, room_m, retardation, h)
            else:
                most = highest_speed_that_stops(train.speed_m_s, room_m, retardation, h)
            if most >= 2.0 * train.speed_m_s:
                target = min(target, most)
        target = min(target, train.speed_m_s + kind.highest_acceleration_m_s2 * h)
    allowed = allowed_speed(train, target, retardation, sight)
    if allowed < target and train.phase == PLANNED:
        train.phase = DRIVING  # a limit goes first; the train plans anew
    return allowed


@inlined
def allowed_speed(train: Any, target_m_s: float, retardation_m_s2: float, sight: Sight) -> float:
    """Highest speed after this step, up to the target, that lower limits ahead allow. [m/s]

    Within steps, a train that has to slow down for one is put on its course.  One that cannot hold its
    speed aims at the same speed uniformly, which takes less way.
    """
    limits, options, v = sight.limits, sight.options, train.speed_m_s
    manner = UNIFORM
    if options.braking == WITHIN_STEP and train.phase == DRIVING and train.course != LIMIT_FIRST:
        manner = HOLD_FIRST
    allowed = heed_limits_ahead(
        train.position_m, v, target_m_s, limits.from_m, limits.value,
        retardation_m_s2, options.step_s, manner,
    )  # fmt: skip
    if allowed == OUT_OF_REACH:
        return heed_limits_ahead(
            train.position_m, v, target_m_s, limits.from_m, limits.value,
            retardation_m_s2, options.step_s, UNIFORM,
        )  # fmt: skip
    if manner == HOLD_FIRST and train.course == USUAL and allowed < min(v, target_m_s):
        train.course = TO_LIMIT
    return allowed


@inlined
def planned_speed(train: Any, full_braking_m_s: float) -> float:
    """Speed that the braking plan of a train asks for after this step. [m/s]"""
    hold, full, last = train.plan_hold, train.plan_full, train.plan_last
    if train.plan_step + 1 == plan_length(hold, full, last):
        return 0.0
    fraction = plan_fraction(train.plan_step, hold, train.plan_first, full, last)
    return max(0.0, train.speed_m_s - fraction * full_braking_m_s)


@inlined
def oppose(train: Any, kind: Any, model: Model) -> None:
    """Forces on a train that do not depend on what its driver does, for this step.

    A standing train is held by its brakes; no running resistance is billed.

    References
    ----------
    [Boullanger2009]_, eq. (2.8)-(2.10), (F.2)-(F.4).
    """
    profile, speed = model.gradients, train.speed_m_s
    train.stair = stair_ahead(train.stair, train.position_m, profile.from_m)
    way_m = speed * model.options.step_s if model.options.mean_gradient else 0.0
    slope = mean_gradient(train.stair, train.position_m, way_m, profile.from_m, profile.value)
    davis = DavisCoefficients(
        kind.resistance_a_n, kind.resistance_b_n_s_per_m, kind.resistance_c_n_s2_per_m2
    )
    standing = train.phase == DWELLING
    train.running_resistance_n = 0.0 if standing else running_resistance(speed, davis)
    train.gradient_force_n = gradient_force(kind.mass_kg, slope)
    train.resistance_n = train.running_resistance_n + train.gradient_force_n


@inlined
def aim_usually(train: Any, kind: Any, sight: Sight) -> None:
    """Set the target of a train that does not brake to its stop, and the force that it takes.

    The step is one of constant acceleration, unless the train brakes to a lower limit within it.
    """
    options = sight.options
    if train.course == TO_LIMIT_UNIFORMLY:
        drive_uniformly(train, kind, sight)
    by_rule = options.driver == AGGRESSIVE and train.phase == DRIVING
    target = target_speed(train, kind, sight)
    if train.course == TO_LIMIT and steer_to_limit(train, kind, target, sight):
        return
    a = wanted_acceleration(train.speed_m_s, target, options.step_s)
    wanted = ideal_force(a, train.resistance_n, kind.inertia_kg)
    if by_rule:
        fastest, coasting = fastest_and_coasting(train, kind, options.step_s)
        wanted = aggressive_force(target, fastest, coasting, wanted, FULL_EFFORT_N)
    allowed = wanted if wanted == FULL_EFFORT_N else min(wanted, train.adhesion_n)
    train.force_cap_n = max(0.0, allowed)
    train.target_speed_m_s = target
    train.wanted_force_n = wanted


@inlined
def aim(train: Any, sight: Sight) -> None:
    """Set the target of a train, and the force that adhesion and driver allow at most.

    References
    ----------
    [Boullanger2009]_, eq. (2.6), (F.5), (F.20).
    """
    kind, options = sight.types[at(train.train_type)], sight.options
    train.force_cap_n = 0.0
    train.target_speed_m_s = 0.0
    train.wanted_force_n = 0.0
    if train.phase != DWELLING:
        on_course = False
        if train.phase == PLANNED and options.braking == WITHIN_STEP:
            on_course = steer_to_stop(train, kind, sight)
        if not on_course:
            aim_usually(train, kind, sight)
    prove_free_band(kind, train)
    note_cap(kind, train)


@kernel
def decide(count: int, standing: Any, trains: Any, sight: Sight) -> None:
    """Let those drivers decide who have not done so in this step, of the first `count` trains."""
    for k in range(count):
        train = trains[at(standing[at(k)].train)]
        if not train.decided:
            aim(train, sight)
            train.decided = True


@inlined
def prepare(train: Any, machine: Machine, model: Model) -> None:
    """Everything about a train that stays fixed while this step is solved, but what its driver decides.

    References
    ----------
    [Boullanger2009]_, appendix F.1.
    """
    kind, options = model.types[at(train.train_type)], model.options
    train.mean_speed_weight_s = options.step_s / 2.0 if options.mean_power else 0.0
    train.driven_share = train.moving_share = 1.0
    train.hold_s = 0.0
    train.course = USUAL
    # Adhesion hangs on the speed alone, as does what `take_speed` evaluates when that has changed.
    if train.speed_m_s != train.taken_speed_m_s:
        speed = train.speed_m_s * 3.6 if options.adhesion_in_km_h else train.speed_m_s
        train.adhesion_n = adhesion_limit(kind.adhesive_mass_kg, speed, options.rail)
    if not speed_is_taken(train.voltage_v, train):
        take_speed(train.voltage_v, kind, train, machine, model.points)
    oppose(train, kind, model)
    train.decided = False
