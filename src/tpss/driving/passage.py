r"""The way of a train through a step at a line voltage, phase by phase, however long the step is.

A train stands until it departs, accelerates, holds a limit, brakes, stands at its stop and departs
again, all at their instants.  A phase is a time of constant acceleration, whose forces `pull` finds.
It ends

- with the step, or after `LONGEST_PHASE_S`, as forces change with speed and place,
- at a speed: the limit, or that to which the train brakes,
- where the train has to brake (`lookahead`), or where another limit begins.

Without voltage a train has no force and draws nothing.  It coasts and brakes, and once it stands it
stays, also on a gradient.  So it does in neutral sections (`neutral`), where phases begin and end.
Where its driver saves energy (`coasting`) it has no force either, but draws what its auxiliaries need.

The voltage is tried several times a step.  Where neither forces nor powers follow it, as of a train
that brakes, or of a machine that gives its force at any voltage, the first passage stays.

The powers that the train draws are means over the step.  Where the voltage decides about a force, their
slopes over it are found by a second passage at a voltage close by; else those of the phases add up.
"""

import math

from tpss.driving.coasting import coast, has_coasting, without_force
from tpss.driving.data import DrivingData, Floats
from tpss.driving.electric_brakes import brake_electrically, rails_pass_on
from tpss.driving.lookahead import highest_speed, what_to_brake_for
from tpss.driving.neutral import follow_power, has_neutral, room_to_change, time_without_power
from tpss.driving.pull import Aim, End, Pull, find_pull, when_a_phase_ends
from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import Points
from tpss.numerics.staircase import index_at, index_from
from tpss.vehicle.braking import band_above, band_below, braking_square
from tpss.vehicle.feed_back import regenerates
from tpss.vehicle.phase import demand_of_phase, demand_standing, voltage_decides
from tpss.vehicle.train import MOST_CALLS, Motion, Passage, Phase, Train, copy_motion
from tpss.vehicle.train_type import TrainType

LONGEST_PHASE_S = 3.0
"""Longest phase of changing forces. [s]"""

ROUNDING = 1e-10
"""Relative rounding of a speed's square: a train brakes from so close to where it has to."""

SLACK_M = 1e-6
"""Distance that is a rounding: braking that ends so close to its place ends there. [m]"""

LEAST_WAY_M = 1e-12
"""Before a change of limit or gradient a moving train goes no less in a phase: near position 0, where
numbers are dense, rounding may leave the place of the change just ahead of it, again and again. [m]"""

MOST_PHASES = 100_000
"""Phases of a step after which a train is taken to stand; its limits and stops would not fill them."""


@inlined
def _while_gradient_stays(passage: Passage, kind: TrainType, data: DrivingData) -> float:
    """Time for which a speed can be held before the gradient changes, up to the end of the step. [s]"""
    motion, following = passage.motion, passage.motion.gradient + 1
    from_m = data.gradients.from_m[at(kind.profile)]
    if following >= from_m.size:
        return passage.left_s
    return min(passage.left_s, (from_m[at(following)] - motion.position_m) / motion.speed_m_s)


@inlined
def _note_departure(passage: Passage, train: Train, step_s: float) -> None:
    """A train goes on from its stop."""
    place = passage.motion.next_stop - train.motion.next_stop
    if place < MOST_CALLS:
        passage.departure_s[place] = step_s - passage.left_s


@inlined
def _note_arrival(passage: Passage, train: Train, step_s: float) -> None:
    """A train has come to stand at its stop."""
    place = passage.motion.next_stop - train.motion.next_stop + 1
    if place < MOST_CALLS:
        passage.arrival_s[place] = step_s - passage.left_s
        passage.departure_s[place] = math.nan


@kernel
def _draw_standing(voltage_v: float, duration_s: float, passage: Passage, kind: TrainType) -> None:
    """Add what a train draws while it stands."""
    active, reactive, slope = demand_standing(voltage_v, kind)
    passage.active_j += active * duration_s
    passage.reactive_vars += reactive * duration_s
    passage.reactive_slope_vars += slope * duration_s


@inlined
def _stand(
    voltage_v: float, until_s: float, passage: Passage, train: Train, kind: TrainType, step_s: float
) -> None:
    """Let a train wait, for a time at most; one that has not departed yet is not on the line. [s]"""
    motion = passage.motion
    duration = min(motion.wait_s, passage.left_s, until_s)
    if motion.phase == Phase.DWELLING:
        _draw_standing(voltage_v, duration, passage, kind)
    passage.left_s -= duration
    motion.wait_s -= duration
    passage.acceleration_m_s2 = 0.0
    if motion.wait_s <= 0.0:
        if motion.phase == Phase.DWELLING:
            _note_departure(passage, train, step_s)
        motion.phase = Phase.DRIVING


@inlined
def _is_held(voltage_v: float, motion: Motion) -> bool:
    """Whether a train that stands is held: at the end of its authority, or without power."""
    at_end = motion.authority_m - motion.position_m <= SLACK_M
    return motion.speed_m_s <= 0.0 and (at_end or voltage_v <= 0.0)


@inlined
def _hold(voltage_v: float, until_s: float, passage: Passage, kind: TrainType) -> None:
    """Let a train stand for the rest of the step, or for a time if that is less. [s]"""
    duration = min(passage.left_s, until_s)
    _draw_standing(voltage_v, duration, passage, kind)
    passage.left_s -= duration
    passage.acceleration_m_s2 = 0.0


@inlined
def _come_to_stop(passage: Passage, train: Train, data: DrivingData) -> None:
    """A train stands at its stop: it has arrived, dwells, or continues at once."""
    motion = passage.motion
    stop = data.stops[at(train.route), at(motion.next_stop)]
    _note_arrival(passage, train, data.options.step_s)
    if stop.destination:
        motion.phase = Phase.ARRIVED
        passage.stood_s = passage.left_s
        return
    motion.next_stop += 1
    now_s = motion.under_way_s + data.options.step_s - passage.left_s
    motion.wait_s = max(stop.dwell_s, stop.leaves_after_s - now_s)
    motion.phase = Phase.DWELLING
    if motion.wait_s <= 0.0:
        _note_departure(passage, train, data.options.step_s)
        motion.phase = Phase.DRIVING


@kernel
def _add_phase(
    voltage_v: float, pull: Pull, passage: Passage, train: Train, kind: TrainType,
    points: Points, scratch: Floats,
) -> None:  # fmt: skip
    """Add impulses, works and energies of a phase."""
    duration, distance_m = pull.duration_s, pull.mean_speed_m_s * pull.duration_s
    passage.traction_ns += pull.traction_n * duration
    passage.braking_ns += pull.braking_n * duration
    passage.running_ns += pull.running_n * duration
    passage.gradient_ns += pull.gradient_n * duration
    passage.traction_j += pull.traction_n * distance_m
    passage.braking_j += pull.braking_n * distance_m
    passage.running_j += pull.running_n * distance_m
    passage.gradient_j += pull.gradient_n * distance_m
    resistance = pull.running_n + pull.gradient_n
    active, reactive, reactive_slope, motor, current, breaches = demand_of_phase(
        voltage_v, pull.mean_speed_m_s, resistance, pull.traction_n, pull.cap_n,
        kind, train.demand, points, scratch,
    )  # fmt: skip
    passage.breaches |= breaches
    if voltage_decides(pull.traction_n, pull.cap_n, kind, train.demand):
        passage.by_voltage = True
    if pull.cap_n > 0.0 and not kind.pulls_at_any_voltage:
        passage.at_any_voltage = False
    passage.active_j += active * duration
    passage.reactive_vars += reactive * duration
    passage.reactive_slope_vars += reactive_slope * duration
    passage.motor_j += motor * duration
    passage.current_as += current * duration
    passage.acceleration_m_s2, passage.resistance_n = pull.acceleration_m_s2, resistance
    passage.left_s -= duration


@inlined
def _aim(
    here: int, square: float, target_m: float, target_m_s: float, passage: Passage,
    kind: TrainType, data: DrivingData,
) -> Aim:  # fmt: skip
    """What the driver of a moving train, or of one that is to start, wants now.

    Parameters are what `what_to_brake_for` takes and gives.
    """
    motion, from_m = passage.motion, data.limits.from_m[at(kind.profile)]
    v, b, left = motion.speed_m_s, kind.highest_retardation_m_s2, passage.left_s
    cruise = highest_speed(data.limits.value[at(kind.profile)][at(here)], kind)
    cruise = min(cruise, motion.ceiling_m_s)
    bands = kind.braking
    own = braking_square(v, b, bands)
    to_brake = v > target_m_s and own >= square * (1.0 - ROUNDING)
    if to_brake or v > cruise:
        # 1. Brake, down to the speed wanted or to the next band.
        wanted, band = target_m_s if to_brake else cruise, band_below(v, bands)
        until, retardation = max(wanted, bands.from_m_s[at(band)]), bands.retardation_m_s2[at(band)]
        if to_brake:
            # That leads to the place but for roundings, unless a train has been placed too near.
            excess, way_m = own - braking_square(target_m_s, b, bands), target_m - motion.position_m
            if abs(excess / (2.0 * b) - way_m) > SLACK_M:
                retardation *= excess / (2.0 * b * way_m)
        place_m = target_m if to_brake and until == target_m_s else math.inf
        return Aim(-retardation, until, left, math.inf, math.inf, place_m, retardation, -math.inf)
    # 2. Go on, up to the limit or to the next band.
    band = band_above(v, bands)
    retardation = bands.retardation_m_s2[at(band)]
    room_m = from_m[at(here + 1)] - motion.position_m if here + 1 < from_m.size else math.inf
    wanted, until = 0.0, math.inf
    if v < cruise:
        wanted = kind.highest_acceleration_m_s2
        until = min(cruise, bands.from_m_s[at(band + 1)])
    return Aim(
        wanted, until, min(left, LONGEST_PHASE_S), (square - own) * (retardation / b), room_m,
        math.inf, retardation, 0.0 if band > 0 else -math.inf,
    )  # fmt: skip


@inlined
def _choose_pull(
    voltage_v: float, until_s: float, aim: Aim, passage: Passage, train: Train, kind: TrainType,
    data: DrivingData, points: Points, scratch: Floats,
) -> tuple[Pull, int]:  # fmt: skip
    """Forces, duration and end of the next phase.  A speed held where nothing changes is one phase."""
    pull = find_pull(voltage_v, aim, passage, train, kind, data, points, scratch)
    v, a, longest_s = passage.motion.speed_m_s, pull.acceleration_m_s2, aim.longest_s
    if a == 0.0 and v > 0.0:
        longest_s = min(until_s, max(longest_s, _while_gradient_stays(passage, kind, data)))
    aim = Aim(
        aim.acceleration_m_s2, aim.until_m_s, longest_s, aim.below_m2_s2, aim.room_m, aim.target_m,
        aim.retardation_m_s2, aim.slowest_m_s2,
    )  # fmt: skip
    duration, end = when_a_phase_ends(a, v, aim)
    after = aim.until_m_s if end == End.SPEED else max(0.0, v + a * duration)
    chosen = Pull(
        a, duration, (v + after) / 2.0, pull.cap_n, pull.traction_n, pull.braking_n,
        pull.running_n, pull.gradient_n,
    )  # fmt: skip
    return chosen, end


@inlined
def _is_caught(pull: Pull, end: int, aim: Aim) -> bool:
    """Whether a moving train is left just before a change of limit or gradient, again and again."""
    v, way_m = pull.mean_speed_m_s, pull.mean_speed_m_s * pull.duration_s
    at_a_limit = end == End.BRAKING and aim.room_m < LEAST_WAY_M
    return v > 0.0 and way_m < LEAST_WAY_M and (at_a_limit or end == End.TIME)


@inlined
def _with_power_unchanged(
    until_s: float, aim: Aim, motion: Motion, kind: TrainType, data: DrivingData
) -> Aim:
    """What a driver wants as long as his train has power, or has none: for a time at most. [s]"""
    room_m = min(aim.room_m, room_to_change(motion.position_m, kind, data))
    return Aim(
        aim.acceleration_m_s2, aim.until_m_s, min(aim.longest_s, until_s), aim.below_m2_s2, room_m,
        aim.target_m, aim.retardation_m_s2, aim.slowest_m_s2,
    )  # fmt: skip


@inlined
def _drive(
    voltage_v: float, until_s: float, passage: Passage, train: Train, kind: TrainType,
    data: DrivingData, points: Points, scratch: Floats,
) -> None:  # fmt: skip
    """Take the next phase, for a time at most, of a train that moves, or is to start. [s]"""
    motion = passage.motion
    position_m, v = motion.position_m, motion.speed_m_s
    motion.gradient = index_from(
        motion.gradient, position_m, data.gradients.from_m[at(kind.profile)]
    )
    # 1. What the driver wants.
    here = index_at(position_m, data.limits.from_m[at(kind.profile)])
    square, target_m, target_m_s = what_to_brake_for(here, train.route, motion, kind, data)
    aim = _aim(here, square, target_m, target_m_s, passage, kind, data)
    if has_neutral(data):
        aim = _with_power_unchanged(until_s, aim, motion, kind, data)
    asked_v, coasts = voltage_v, False
    if has_coasting(data) or train.decision.wanted_m_s < math.inf:
        aim, coasts = coast(aim, passage, train, kind, data, points, scratch)
        if coasts:
            asked_v = 0.0
    # 2. What the machine gives, if it is asked.
    pull, end = _choose_pull(asked_v, until_s, aim, passage, train, kind, data, points, scratch)
    if coasts:
        pull = without_force(pull)
    _add_phase(voltage_v, pull, passage, train, kind, points, scratch)
    if regenerates(kind) and pull.braking_n > 0.0 and voltage_v > 0.0:
        brake_electrically(pull, passage, kind, data, points)
    a = pull.acceleration_m_s2
    if voltage_v > 0.0 and (end == End.STANDSTILL or (v == 0.0 and a <= 0.0)):
        passage.stalled = True
        passage.needed_n = pull.running_n + pull.gradient_n
        passage.available_n = pull.traction_n
        # A voltage tried may let the train stall that the solution does not: without the auxiliaries
        # of the time that is left, the demand would jump there.
        _draw_standing(voltage_v, passage.left_s, passage, kind)
        # For those who ask what limits it.
        train.demand.force_cap_n = pull.cap_n
        train.demand.adhesion_n = rails_pass_on(pull.mean_speed_m_s, kind, data.options, points)
    # 3. Where that leads: to speeds and places exactly.
    motion.position_m = position_m + pull.mean_speed_m_s * pull.duration_s
    motion.speed_m_s = max(0.0, v + a * pull.duration_s)
    if end == End.PLACE:
        motion.position_m = position_m + aim.room_m
    elif _is_caught(pull, end, aim):
        motion.position_m = position_m + LEAST_WAY_M
    elif end == End.SPEED:
        motion.speed_m_s = aim.until_m_s
        if a == aim.acceleration_m_s2 and aim.target_m < math.inf:
            off_m = abs(motion.position_m - aim.target_m)
            passage.stop_error_m = max(passage.stop_error_m, off_m)
            motion.position_m = aim.target_m
            stop = data.stops[at(train.route), at(motion.next_stop)]
            if aim.until_m_s == 0.0 and motion.position_m >= stop.position_m:
                _come_to_stop(passage, train, data)


@inlined
def _begin(passage: Passage, train: Train, kind: TrainType, step_s: float) -> None:
    """A passage at its start."""
    copy_motion(train.motion, passage.motion)
    passage.acceleration_m_s2 = train.decision.acceleration_m_s2
    passage.resistance_n = 0.0
    passage.left_s = step_s
    passage.stood_s, passage.stop_error_m = 0.0, 0.0
    passage.without_power_s = 0.0
    passage.departure_s[0] = math.nan
    passage.breaches = 0
    passage.stalled, passage.by_voltage = False, False
    passage.at_any_voltage = kind.filter_susceptance_s == 0.0
    passage.needed_n, passage.available_n = 0.0, 0.0
    passage.traction_ns, passage.traction_j = 0.0, 0.0
    passage.braking_ns, passage.braking_j = 0.0, 0.0
    passage.running_ns, passage.running_j = 0.0, 0.0
    passage.gradient_ns, passage.gradient_j = 0.0, 0.0
    passage.motor_j, passage.current_as = 0.0, 0.0
    passage.electric_j, passage.offered_j = 0.0, 0.0
    passage.active_j, passage.reactive_vars = 0.0, 0.0
    passage.reactive_slope_vars = 0.0


@kernel
def pass_through(
    voltage_v: float, passage: Passage, train: Train, kind: TrainType, data: DrivingData,
    points: Points, scratch: Floats,
) -> None:  # fmt: skip
    """Find the way of a train through this step at a line voltage.

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph, all through the step. [V]
    passage : Passage
        Written.
    train, kind, data
        The train, its type, and what its driver knows.
    points : records of CurvePoint
    scratch : Array, shape `SCRATCH_SHAPE`
    """
    _begin(passage, train, kind, data.options.step_s)
    motion = passage.motion
    for _ in range(MOST_PHASES):
        if passage.left_s <= 0.0 or passage.stalled or motion.phase == Phase.ARRIVED:
            return
        # 1. Whether it has power now, and until when that stays so.
        here_v, off_s, until_s = voltage_v, 0.0, math.inf
        if has_neutral(data):
            off_s = time_without_power(motion, kind, data)
            if off_s > 0.0:
                here_v, until_s = 0.0, off_s
        position_m, left_s = motion.position_m, passage.left_s
        # 2. What it does.
        if motion.wait_s > 0.0:
            _stand(here_v, until_s, passage, train, kind, data.options.step_s)
        elif _is_held(here_v, motion):
            _hold(here_v, until_s, passage, kind)
        else:
            _drive(here_v, until_s, passage, train, kind, data, points, scratch)
        # 3. Whether it has entered or left a neutral section.
        if has_neutral(data):
            follow_power(off_s, position_m, left_s, passage, kind, data)
    passage.stalled = True


@kernel
def demand_of_passage(
    voltage_v: float, with_slopes: bool, train: Train, kind: TrainType, data: DrivingData,
    points: Points, scratch: Floats,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Mean active and reactive power of a train on its passage, and their slopes: P, Q, P', Q'.

    What its electric brakes offer the line is not part of them.

    [W], [var], [W/V], [var/V]

    Parameters
    ----------
    with_slopes : bool
        Whether the slopes are asked for; else they may be anything.

    Others are those of `pass_through`.
    """
    passage, per_second = train.passage, 1.0 / data.options.step_s
    # A voltage that was checked and does not solve the step is asked for its slopes next.
    again = with_slopes and voltage_v == passage.tried_v
    if not (passage.stays or again) or voltage_v <= 0.0:
        pass_through(voltage_v, passage, train, kind, data, points, scratch)
        passage.stays, passage.tried_v = passage.at_any_voltage and voltage_v > 0.0, voltage_v
    active_slope, reactive_slope = 0.0, passage.reactive_slope_vars
    if with_slopes and passage.by_voltage:
        trial, change_v = train.trial, data.options.slope_change * voltage_v
        pass_through(voltage_v + change_v, trial, train, kind, data, points, scratch)
        passage.tried_v = 0.0
        active_slope = (trial.active_j - passage.active_j) / change_v
        reactive_slope = (trial.reactive_vars - passage.reactive_vars) / change_v
    demand = train.demand
    demand.wheel_force_n = passage.traction_ns * per_second
    demand.active_power_w = passage.active_j * per_second
    demand.reactive_power_var = passage.reactive_vars * per_second
    return (
        demand.active_power_w,
        demand.reactive_power_var,
        active_slope * per_second,
        reactive_slope * per_second,
    )
