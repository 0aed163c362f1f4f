"""The trains' part of the slow audit: works, forces, and the way of each of them."""

from typing import Any

import numpy as np
import numpy.typing as npt

from slow_figures import intervals_s, largest, nan_is_largest
from tpss.driving.data import Braking, Driver, MotionModel
from tpss.numerics.curve import CurvePoint
from tpss.physics.constants import GRAVITY_M_S2
from tpss.run.run import Outcome
from tpss.step.model import Model
from tpss.step.state import TrainState

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


def _kinds(outcome: Outcome, model: Model) -> Any:
    """Kind of each train."""
    return model.types[np.array([train.train_type for train in outcome.trains], dtype=int)]


def traction_balance(outcome: Outcome, model: Model) -> float:
    """Relative difference between the motors' work and where it went. [1]"""
    if model.options.motion == MotionModel.CONTINUOUS:
        return continuous_traction_balance(outcome, model)
    return stepped_traction_balance(outcome, model)


def continuous_traction_balance(outcome: Outcome, model: Model) -> float:
    """`traction_balance` of trains whose steps may have several phases, from the recorded powers.

    The motors' recorded work counts as far as some efficiency of the train, at some speed and load,
    makes it what the drawn energy is, less the auxiliaries of the time from departure to arrival.
    """
    trains, timetable = outcome.recording.trains, outcome.state.trains["timetable"]
    kind, count = _kinds(outcome, model), len(outcome.trains)
    h = intervals_s(outcome, model)[:, np.newaxis]
    before, after = trains[:-1], trains[1:]
    step, own = np.arange(outcome.steps)[:, np.newaxis], timetable[:count]
    present_s = h - np.where(step == own["departure_step"], own["departure_wait_s"], 0.0)
    present_s = present_s - np.where(step + 1 == own["arrival_step"], own["stood_s"], 0.0)
    low, high = np.empty(count), np.empty(count)
    for i, curve in enumerate(kind.efficiency):
        values = model.points.value[curve.first : curve.first + curve.points]
        factors = _factors_over_load(kind[i].over_load)
        low[i], high[i] = values.min() * factors.min(), values.max() * factors.max()
    for_motors = before["active_power"] * h - kind.auxiliary_power_w * present_s
    if outcome.recording.regeneration.size:
        for_motors = for_motors + outcome.recording.regeneration["regenerated_power"][:-1] * h
    if outcome.recording.on_board.size:
        taken = outcome.recording.on_board["train_storage_power"][:-1]
        for_motors = for_motors - taken * h
        used = 0.0
        if outcome.recording.regeneration.size:
            used = outcome.recording.regeneration["regenerated_power"][:-1]
        unfed = (before["pantograph_real"] == 0.0) & (taken == 0.0) & (used == 0.0)
        for_motors = for_motors + np.where(unfed, kind.auxiliary_power_w * present_s, 0.0)
    if outcome.recording.without_power_s.size:
        for_motors = for_motors + kind.auxiliary_power_w * outcome.recording.without_power_s[:-1]
    recorded = before["motor_power"] * h
    work = np.clip(recorded, low * for_motors, high * for_motors) / kind.slip_factor
    opposing = before["resistance_power"] + before["gradient_power"] + before["braking_power"]
    moving = (opposing - before["traction_power"]) * h + recorded / kind.slip_factor
    kinetic = kind.inertia_kg / 2.0 * (after["speed"] ** 2 - before["speed"] ** 2)
    difference = np.nansum(work) - np.nansum(moving) - np.nansum(kinetic)
    fallen = -np.nansum(np.minimum(before["gradient_power"], 0.0) * h)
    slowed = -np.nansum(np.minimum(kinetic, 0.0))
    return float(abs(difference) / max(np.nansum(work) + fallen + slowed, 1.0))


def stepped_traction_balance(outcome: Outcome, model: Model) -> float:
    """`traction_balance` of trains that move in steps of one acceleration.

    The motors' work is that of the recorded electric power; it goes into slip, the rotors, running
    resistance, climb, kinetic energy and brakes.
    """
    trains, h = outcome.recording.trains, model.options.step_s
    kind = _kinds(outcome, model)
    before, after = trains[:-1], trains[1:]
    # Not the difference of positions, which would round a short way of a train far along the line.
    way_m = h * (before["speed"] + after["speed"]) / 2.0
    efficiency = _efficiency(before["speed"], kind, model.points)
    power_w = (before["active_power"] - kind.auxiliary_power_w) * efficiency
    for i, curve in enumerate(kind.over_load):
        if curve.count:
            factors = _factors_over_load(curve)
            least, most = factors.min() * power_w[:, i], factors.max() * power_w[:, i]
            power_w[:, i] = np.clip(before["motor_power"][:, i], least, most)
    work = power_w * h / kind.slip_factor
    force = before["tractive_force"]
    rotor = np.where(
        force > 0.0, np.maximum(-force, kind.rotor_mass_kg * before["acceleration"]), 0.0
    )
    opposing = before["running_resistance"] + before["gradient_force"] + before["braking_force"]
    moving = np.where(way_m > 0.0, (rotor + opposing) * way_m, 0.0)
    moving = np.where(before["holding_time"] > 0.0, braking_work(before, after, kind, h), moving)
    kinetic = kind.inertia_kg / 2.0 * (after["speed"] ** 2 - before["speed"] ** 2)
    difference = np.nansum(work) - np.nansum(moving) - np.nansum(kinetic)
    # Where the motors do no work, gravity and the trains' own motion turn over the energy.
    fallen = -np.nansum(np.minimum(before["gradient_force"], 0.0) * way_m)
    slowed = -np.nansum(np.minimum(kinetic, 0.0))
    return float(abs(difference) / max(np.nansum(work) + fallen + slowed, 1.0))


def _factors_over_load(curve: Any) -> Floats:
    """Factors of the efficiency at a thousand loads; 1 if it does not follow the load. [1]"""
    if not curve.count:
        return np.ones(1)
    own = CurvePoint.array([(0.0, 0.0, 0.0)] * curve.count)
    own.x, own.value = curve.power_w[: curve.count], curve.factor[: curve.count]
    own.slope = curve.slope_per_w[: curve.count]
    loads = np.union1d(np.linspace(0.0, own.x[-1], 1000), own.x)
    return _curve(loads, own)


def _efficiency(speed: Floats, kind: Any, points: Any) -> Floats:
    """Efficiency of each train at its speeds, shape (steps, trains). [1]"""
    found = np.empty_like(speed)
    for i, curve in enumerate(kind.efficiency):
        own = points[curve.first : curve.first + curve.points]
        found[:, i] = _curve(speed[:, i], own) if curve.points > 1 else own.value[0]
    return found


def _curve(x: Floats, points: Any) -> Floats:
    """Values of a curve, written as Hermite's basis functions; beyond its ends the outer ones."""
    x = np.clip(x, points.x[0], points.x[-1])
    k = np.clip(np.searchsorted(points.x, x, side="right") - 1, 0, points.size - 2)
    before, after = points[k], points[k + 1]
    step = after.x - before.x
    t = (x - before.x) / step
    values = before.value * (1 + 2 * t) * (1 - t) ** 2 + after.value * t**2 * (3 - 2 * t)
    slopes = before.slope * t * (1 - t) ** 2 - after.slope * t**2 * (1 - t)
    return np.asarray(values + step * slopes, dtype=float)


def _limits(position_m: Floats, kind: Any, model: Model) -> Floats:
    """Speed limits that trains of their lengths have to keep. [m/s]"""
    limits, row = model.limits, np.broadcast_to(kind.profile, position_m.shape)
    begun = (limits.from_m[row] <= position_m[..., np.newaxis]).sum(axis=-1)
    return np.asarray(limits.value[row, np.maximum(begun - 1, 0)], dtype=float)


def force_balance(outcome: Outcome, model: Model) -> float:
    """Largest |F - F_res - F_brake - M a| of a moving train, relative to its weight. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    rows = slice(0, outcome.steps)
    trains = outcome.recording.trains[rows]
    state = outcome.recording.train_state[rows]
    kind = _kinds(outcome, model)
    rest = trains["tractive_force"] - trains["braking_force"]
    rest = rest - trains["running_resistance"] - trains["gradient_force"]
    inertia_kg = np.broadcast_to(kind.inertia_kg, state.shape)
    if model.options.driver == Driver.AGGRESSIVE:
        # At its limit and above a driver switches off; below, the machine may give nothing.
        limit = np.minimum(_limits(trains["route_position"], kind, model), kind.highest_speed_m_s)
        coasts = (state == TrainState.COASTING) & (trains["speed"] >= limit)
        inertia_kg = np.where(coasts, kind.coasting_inertia_kg, inertia_kg)
    rest = rest - inertia_kg * trains["acceleration"]
    driven = (
        (state == TrainState.MOTORING)
        | (state == TrainState.COASTING)
        | (state == TrainState.BRAKING)
    )
    return largest((rest / (kind.mass_kg * GRAVITY_M_S2))[driven])


def motion_error_m(outcome: Outcome, model: Model) -> float:
    """Largest |x' - x - h (v + v')/2|, and |v' - v - a h| h, of a train. [m]

    Braking within steps has `braking_motion_error_m` in place of the first.

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30).
    """
    trains, step_s = outcome.recording.trains, model.options.step_s
    before, after = trains[:-1], trains[1:]
    # Present at both instants; positions that are not numbers stay, and fail.
    both = (outcome.recording.train_state[:-1] >= 0) & (
        outcome.recording.train_state[:-1] != TrainState.ARRIVED
    )
    if model.options.motion == MotionModel.CONTINUOUS:
        return continuous_motion_error_m(outcome, model, both)
    way = after["route_position"] - before["route_position"]
    way = way - step_s * (before["speed"] + after["speed"]) / 2.0
    if model.options.braking == Braking.WITHIN_STEP:
        way = braking_motion_error_m(before, after, _kinds(outcome, model), step_s)
    speed = after["speed"] - before["speed"] - step_s * before["acceleration"]
    return max(largest(way[both]), largest(speed[both]) * step_s, key=nan_is_largest)


def continuous_motion_error_m(outcome: Outcome, model: Model, both: npt.NDArray[np.bool_]) -> float:
    """How far a train runs backwards, or further than its limits let it, and |v' - v - a h| h.

    A train that comes to an instant faster than its limit there, and no slower than it was, is over it.
    """
    trains = outcome.recording.trains
    kind = _kinds(outcome, model)
    h = intervals_s(outcome, model)[:, np.newaxis]
    before, after = trains[:-1], trains[1:]
    from_m, to_m = before["route_position"], after["route_position"]
    fastest = np.maximum(
        before["speed"], np.minimum(_limits(from_m, kind, model), kind.highest_speed_m_s)
    )
    for j in range(model.limits.from_m.shape[1]):
        begins_m, value = model.limits.from_m[kind.profile, j], model.limits.value[kind.profile, j]
        passed = (from_m < begins_m) & (begins_m <= to_m)
        allowed = np.minimum(value, kind.highest_speed_m_s)
        fastest = np.where(passed, np.maximum(fastest, allowed), fastest)
    way_m = to_m - from_m
    limit = np.minimum(_limits(to_m, kind, model), kind.highest_speed_m_s)
    over = np.where(before["speed"] <= after["speed"], np.maximum(0.0, after["speed"] - limit), 0.0)
    change = after["speed"] - before["speed"] - h * before["acceleration"]
    errors = (np.minimum(0.0, way_m), np.maximum(0.0, way_m - fastest * h), over * h, change * h)
    return max((largest(error[both]) for error in errors), key=nan_is_largest)


def braking_work(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Work of resistances and brakes, phase by phase. [J]

    Of the resistances the mean over the step is recorded, for a part of which the train may stand.  To
    hold the speed downhill takes brakes; the rest of their recorded impulse slows the train down.

    Parameters
    ----------
    before, after : records of `TrainRow`, shape (steps, trains)
        At the instants before and after each step.
    kind : records of `TrainType`, shape (trains,)
    step_s : float
        Time step. [s]
    """
    v, hold_s = before["speed"], before["holding_time"]
    brake_s = (v - after["speed"]) / kind.highest_retardation_m_s2
    moving_s = hold_s + brake_s
    impulse_ns = step_s * (before["running_resistance"] + before["gradient_force"])
    resistance_n = impulse_ns / np.where(moving_s > 0.0, moving_s, np.nan)
    holding_ns = np.maximum(0.0, -resistance_n) * hold_s
    stopping_ns = before["braking_force"] * step_s - holding_ns
    while_holding = (resistance_n * hold_s + holding_ns) * v
    while_braking = (resistance_n * brake_s + stopping_ns) * (v + after["speed"]) / 2.0
    return np.asarray(while_holding + while_braking, dtype=float)


def braking_motion_error_m(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Difference between the way of each step and that of its speeds. [m]

    A step that holds the speed v for τ, then brakes with b, goes v τ + (v² - v'²)/2b; together that
    takes the whole step, or less of it if the train stops.  A step without τ is a uniform one, but that
    a train may come to its stop in any part of it: it goes no less than with b, and no further than
    uniformly.  Parameters are those of `braking_work`.
    """
    v, w, hold_s = before["speed"], after["speed"], before["holding_time"]
    way_m = after["route_position"] - before["route_position"]
    brake_s = (v - w) / kind.highest_retardation_m_s2
    over_s = hold_s + brake_s - step_s
    over_s = np.where(w > 0.0, np.abs(over_s), np.maximum(0.0, over_s))
    held_m = v * hold_s + (v + w) / 2.0 * brake_s
    uniform_m = step_s * (v + w) / 2.0
    shortest_m = np.minimum(uniform_m, v / 2.0 * brake_s)
    stop_m = np.clip(way_m, shortest_m, uniform_m)
    other_m = np.where((w == 0.0) & (v > 0.0), stop_m, uniform_m)
    error = np.where(hold_s > 0.0, np.abs(way_m - held_m) + v * over_s, way_m - other_m)
    return np.asarray(error, dtype=float)
