"""The audit of the trains: work, forces and motion."""

from tpss.audit.balances import Balances, worst
from tpss.audit.feed_back import audit_feed_back
from tpss.driving.data import Braking, Driver, MotionModel
from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import curve_at, extremes
from tpss.numerics.staircase import index_at
from tpss.physics.constants import GRAVITY_M_S2
from tpss.step.model import Model
from tpss.step.recorded import TrainRow
from tpss.step.recording import Recording
from tpss.step.state import TrainState
from tpss.vehicle.part_load import range_over_load
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType


@inlined
def audit_train(
    step: int, i: int, step_s: float, train: Train, model: Model, recording: Recording,
    figures: Balances,
) -> None:  # fmt: skip
    """Add a train's step, of this length, to the balances of energy, force and motion. [s]"""
    kind, before = model.types[train.train_type], recording.trains[step, i]
    figures.drawn_j += before.active_power * step_s
    if model.options.motion == MotionModel.CONTINUOUS:
        _audit_continuous(step, i, step_s, train, kind, model, recording, figures)
    else:
        _audit_stepped(step, i, kind, model, recording, figures)
    _audit_forces(step, i, step_s, kind, model, recording, figures)


@inlined
def _audit_continuous(
    step: int, i: int, step_s: float, train: Train, kind: TrainType, model: Model,
    recording: Recording, figures: Balances,
) -> None:  # fmt: skip
    """Work and motion of a train whose step may have several phases.

    What the motors do follows from the energy drawn, but for the efficiency, which changes with speed
    and load: the recorded work is taken as far as some efficiency of the train's makes it that.  The
    rotors keep of it what is not work at the wheel rim.  A train goes forward, and no further than its
    limits let it.
    """
    before, after = recording.trains[step, i], recording.trains[step + 1, i]
    h = present_s = step_s
    if step == train.timetable.departure_step:
        present_s -= train.timetable.departure_wait_s
    if step + 1 == train.timetable.arrival_step:
        present_s -= train.timetable.stood_s
    low, high = extremes(kind.efficiency, model.points)
    low_load, high_load = range_over_load(kind.over_load)
    low, high = low * low_load, high * high_load
    if recording.without_power_s.shape[0] > 0:
        present_s -= recording.without_power_s[step, i]
    fed = before.pantograph_real != 0.0 or before.pantograph_imag != 0.0
    stored_j = 0.0
    if recording.on_board.shape[0] > 0:
        stored_j = recording.on_board[step, i].train_storage_power * h
        fed = fed or feeds_itself(step, i, recording)
    auxiliary_w = kind.auxiliary_power_w if fed else 0.0
    for_motors_j = before.active_power * h - stored_j - auxiliary_w * present_s
    if recording.regeneration.shape[0] > 0:
        for_motors_j += recording.regeneration[step, i].regenerated_power * h
        audit_feed_back(step, i, kind, model.points, recording, figures)
    motor_j = min(max(before.motor_power * h, low * for_motors_j), high * for_motors_j)
    traction_j = before.traction_power * h
    spent_j = (before.resistance_power + before.gradient_power + before.braking_power) * h
    figures.work_j += motor_j / kind.slip_factor
    figures.moving_j += spent_j + before.motor_power * h / kind.slip_factor - traction_j
    kinetic = kind.inertia_kg / 2.0 * (after.speed * after.speed - before.speed * before.speed)
    figures.kinetic_j += kinetic
    figures.fallen_j -= min(before.gradient_power, 0.0) * h
    figures.slowed_j -= min(kinetic, 0.0)
    limits, row = model.limits, at(kind.profile)
    begin_m, end_m = before.route_position, after.route_position
    fastest, j = before.speed, index_at(begin_m, limits.from_m[row])
    while j < limits.from_m[row].size and limits.from_m[row][j] <= end_m:
        fastest = max(fastest, min(limits.value[row][j], kind.highest_speed_m_s))
        j += 1
    way_m = end_m - begin_m
    figures.motion_error_m = worst(figures.motion_error_m, min(0.0, way_m))
    figures.motion_error_m = worst(figures.motion_error_m, max(0.0, way_m - fastest * h))
    over = after.speed - min(limits.value[row][j - 1], kind.highest_speed_m_s)
    if before.speed <= after.speed:
        figures.motion_error_m = worst(figures.motion_error_m, max(0.0, over) * h)


@kernel
def feeds_itself(step: int, i: int, recording: Recording) -> bool:
    """Whether a train's store gives it power, or takes what its brakes give."""
    gives = recording.on_board[step, i].train_storage_power != 0.0
    if recording.regeneration.shape[0] > 0:
        return gives or recording.regeneration[step, i].regenerated_power > 0.0
    return gives


@inlined
def _audit_stepped(
    step: int, i: int, kind: TrainType, model: Model, recording: Recording, figures: Balances
) -> None:
    """Work of a train that moves in steps.

    Where the efficiency follows the load, the motors' recorded work is taken as in `_audit_continuous`.

    References
    ----------
    [Boullanger2009]_, eq. (2.11), (F.19), (2.29) and (2.30).
    """
    before, after = recording.trains[step, i], recording.trains[step + 1, i]
    h = model.options.step_s
    # Not the difference of positions, which would round a short distance far along the line.
    way_m = h * (before.speed + after.speed) / 2.0
    moved_m = after.route_position - before.route_position
    efficiency = curve_at(before.speed, kind.efficiency.first, kind.efficiency.points, model.points)
    power_w = (before.active_power - kind.auxiliary_power_w) * efficiency
    if kind.over_load.count > 0:
        low, high = range_over_load(kind.over_load)
        power_w = min(max(before.motor_power, low * power_w), high * power_w)
    figures.work_j += power_w * h / kind.slip_factor
    force, rotor = before.tractive_force, 0.0
    if force > 0.0:
        rotor = max(-force, kind.rotor_mass_kg * before.acceleration)
    opposing = before.running_resistance + before.gradient_force + before.braking_force
    if before.holding_time > 0.0:
        figures.moving_j += _braking_work(before, after.speed, kind, h)
    elif way_m > 0.0:
        figures.moving_j += (rotor + opposing) * way_m
    kinetic = kind.inertia_kg / 2.0 * (after.speed * after.speed - before.speed * before.speed)
    figures.kinetic_j += kinetic
    figures.fallen_j -= min(before.gradient_force, 0.0) * way_m
    figures.slowed_j -= min(kinetic, 0.0)
    if model.options.braking == Braking.WITHIN_STEP:
        off_m = _braking_motion_error(before, after, moved_m, kind, h)
    else:
        off_m = moved_m - way_m
    figures.motion_error_m = worst(figures.motion_error_m, off_m)


@inlined
def _braking_work(before: TrainRow, next_speed_m_s: float, kind: TrainType, step_s: float) -> float:
    """Work of resistances and brakes in a step that holds the speed, then brakes. [J]

    Of the resistances the mean over the step is recorded, for a part of which the train may stand.  To
    hold the speed downhill takes brakes; the rest of their recorded impulse slows the train down.
    """
    v, hold_s = before.speed, before.holding_time
    brake_s = (v - next_speed_m_s) / kind.highest_retardation_m_s2
    impulse_ns = step_s * (before.running_resistance + before.gradient_force)
    resistance_n = impulse_ns / (hold_s + brake_s)
    holding_ns = max(0.0, -resistance_n) * hold_s
    stopping_ns = before.braking_force * step_s - holding_ns
    while_holding = (resistance_n * hold_s + holding_ns) * v
    return while_holding + (resistance_n * brake_s + stopping_ns) * (v + next_speed_m_s) / 2.0


@inlined
def _braking_motion_error(
    before: TrainRow, after: TrainRow, way_m: float, kind: TrainType, step_s: float
) -> float:
    """Difference between a step's movement and that of its speeds, where trains brake within steps. [m]

    A step that holds the speed v for τ, then brakes with b, goes v τ + (v² - v'²)/2b; together that
    takes the whole step, or less of it if the train stops.  A step without τ is a uniform one, but that
    a train may come to its stop in any part of it: it goes no less than with b, and no further than
    uniformly.
    """
    v, w, hold_s = before.speed, after.speed, before.holding_time
    brake_s = (v - w) / kind.highest_retardation_m_s2
    uniform_m = step_s * (v + w) / 2.0
    if hold_s > 0.0:
        over_s = hold_s + brake_s - step_s
        over_s = abs(over_s) if w > 0.0 else max(0.0, over_s)
        return abs(way_m - v * hold_s - (v + w) / 2.0 * brake_s) + v * over_s
    if w == 0.0 and v > 0.0:
        shortest_m = min(uniform_m, v / 2.0 * brake_s)
        return way_m - min(max(way_m, shortest_m), uniform_m)
    return way_m - uniform_m


@inlined
def _driver_coasts(before: TrainRow, kind: TrainType, model: Model) -> bool:
    """Whether a train without force and brakes is one whose driver has switched off.

    The original driver does so at the speed limit and above.  Below it he asks for all that the machine
    gives, which may be nothing: then the train rolls as one that pulls.

    References
    ----------
    [Boullanger2009]_, section 2.3.1.
    """
    if model.options.driver != Driver.AGGRESSIVE:
        return False
    limits, row = model.limits, at(kind.profile)
    here = index_at(before.route_position, limits.from_m[row])
    limit = limits.value[row][here]
    return before.speed >= min(limit, kind.highest_speed_m_s)


@inlined
def _audit_forces(
    step: int, i: int, step_s: float, kind: TrainType, model: Model,
    recording: Recording, figures: Balances,
) -> None:  # fmt: skip
    """Note how far the mean forces on a train are off its change of speed."""
    before, after = recording.trains[step, i], recording.trains[step + 1, i]
    change = after.speed - before.speed - step_s * before.acceleration
    figures.motion_error_m = worst(figures.motion_error_m, change * step_s)
    state = recording.train_state[step, i]
    if state in (TrainState.MOTORING, TrainState.COASTING, TrainState.BRAKING):
        inertia_kg = kind.inertia_kg
        if state == TrainState.COASTING and _driver_coasts(before, kind, model):
            inertia_kg = kind.coasting_inertia_kg
        rest = before.tractive_force - before.braking_force - before.running_resistance
        rest -= before.gradient_force + inertia_kg * before.acceleration
        figures.force_balance = worst(figures.force_balance, rest / (kind.mass_kg * GRAVITY_M_S2))
