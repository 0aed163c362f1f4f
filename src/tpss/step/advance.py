"""The clock: the order of things in a step, and when a run ends."""

from tpss.driving.data import DrivingData, Floats, MotionModel
from tpss.driving.driver import prepare
from tpss.driving.passage import SLACK_M
from tpss.kernel import at, inlined, kernel, plain
from tpss.numerics.curve import Points
from tpss.powerflow.bundle_points import order_points
from tpss.powerflow.network import Request, Standing
from tpss.powerflow.placing import locate_trains, measure_pieces, set_unfed_aside
from tpss.powerflow.solve import ASKS, answer_in_turn, predict, remember
from tpss.powerflow.stores import begin_stores
from tpss.record import Records
from tpss.step.converter_control import control_converters, note_loading
from tpss.step.coupling import solve_step
from tpss.step.deadlock import find_deadlock
from tpss.step.model import Model, driving_data, with_step
from tpss.step.precedence import let_pass
from tpss.step.record import (
    record_instant,
    record_network,
    record_trains,
    settle_own_stores,
    settle_stores,
)
from tpss.step.recording import Recording
from tpss.step.separation import Separation, keep_apart
from tpss.step.sparing import allow_currents, heat_motors
from tpss.step.state import Counter, State, Status, loads_in_python, loads_of
from tpss.step.traffic import depart, list_trains, move_train, remove_arrived, withhold
from tpss.track.gate import Precedence
from tpss.vehicle.on_board import begin_own_store
from tpss.vehicle.train import Course, Phase, Train
from tpss.vehicle.train_type import TrainType

ARRIVAL_S = 1e-6
"""A run ends with the arrival of its studied train, or so soon after it. [s]"""

SHORTEST_STEP_S = 0.01
"""A last step is no shorter: means over less than this would be roundings. [s]"""

MOST_LENGTHS = 30
"""Lengths of a last step that are tried."""


@inlined
def find_stalled(count: int, state: State) -> bool:
    """Whether a train would roll back, or stands with no force to start; note the first one."""
    for k in range(count):
        i = state.flow.standing[at(k)].train
        train = state.trains[at(i)]
        dwells = train.motion.phase == Phase.DWELLING
        if dwells and train.decision.course != Course.PASSAGE:  # in which it may leave, and fail to
            continue
        forces = train.forces
        powerless = train.motion.speed_m_s <= 0.0 and forces.tractive_n < train.decision.force_n
        if forces.next_speed_m_s < 0.0 or (powerless and forces.next_speed_m_s <= 0.0):
            clock = state.clock[0]
            clock.stalled_train = i
            clock.force_needed_n = train.demand.resistance_n
            clock.force_available_n = forces.tractive_n
            return True
    return False


@inlined
def begin_step(step: int, model: Model, state: State, recording: Recording) -> int:
    """Traffic, converter control, places; return the number of trains on the line."""
    # 1. Departures, and removal of arrived trains, which this instant still shows.
    state.clock[0].begin_s = step * model.options.step_s
    state.clock[0].last_step_s = model.options.step_s
    depart(step, state.trains)
    record_instant(step, state.trains, recording)
    remove_arrived(state.trains)
    # 2. Converter control (3.6)-(3.9).
    control_converters(step * model.options.step_s, model, state)
    # 3. Where the trains stand, and how far that lets others go.
    count = place_trains(model, state)
    if model.signalling.separation != Separation.NONE:
        separate_trains(step, count, model, state, recording)
    return count


@kernel
def separate_trains(
    step: int, count: int, model: Model, state: State, recording: Recording
) -> None:
    """Let trains pass their gates, and go as far as others let them; note whom they wait for."""
    step_s, signalling, standing = model.options.step_s, model.signalling, state.flow.standing
    gated = signalling.precedence != Precedence.FREE
    if gated:
        let_pass(
            count, step * step_s, step_s, signalling.reaction_s, signalling.margin_m, standing,
            state.trains, model.types, model.stops, model.rules, state.turns,
        )  # fmt: skip
    recording.counters[Counter.TOO_NEAR] += keep_apart(
        count, step_s, standing, state.trains, model.types, model.legs, model.rules, state.turns,
        state.occupancies, state.first_on_track, signalling, step * step_s, model.halts,
        recording.waits_for[at(step)],
    )  # fmt: skip
    if gated:
        state.clock[0].deadlocked_train = find_deadlock(
            count, standing, state.trains, model.rules, state.turns
        )


@kernel
def place_trains(model: Model, state: State) -> int:
    """Find where the trains on the line stand; return their number."""
    count = list_trains(state.trains, state.flow)
    locate_trains(count, state.trains, model.legs, model.network, state.flow)
    state.clock[0].short_pieces = measure_pieces(count, model.network, state.flow)
    if model.control.fixed_voltage_v <= 0.0:
        state.clock[0].unfed = set_unfed_aside(model.network, state.flow)
    order_points(model.network.bundles, model.network, state.flow)
    return count


@kernel
def prepare_trains(
    count: int,
    standing: Records[Standing],
    trains: Records[Train],
    data: DrivingData,
    points: Points,
    scratch: Floats,
) -> None:
    """Find what stays fixed while a step is solved, of the first `count` trains on the line."""
    for k in range(count):
        prepare(trains[at(standing[at(k)].train)], data, points, scratch)


@kernel
def begin_own_stores(
    count: int,
    step_s: float,
    kinds: Records[TrainType],
    standing: Records[Standing],
    trains: Records[Train],
) -> None:
    """Find the limits of the stores of the first `count` trains in a step of this length. [s]"""
    for k in range(count):
        train = trains[at(standing[at(k)].train)]
        begin_own_store(step_s, train, kinds[at(train.train_type)])


@inlined
def prepare_step(count: int, model: Model, state: State) -> None:
    """`prepare_trains` of this step."""
    data = driving_data(model)
    prepare_trains(count, state.flow.standing, state.trains, data, model.points, state.scratch)
    if model.network.stores.size > 0:
        begin_stores(model.options.step_s, model.network, state.flow)
    if model.control.has_stores:
        begin_own_stores(
            count, model.options.step_s, model.types, state.flow.standing, state.trains
        )


@inlined
def end_step(
    step: int,
    count: int,
    share: float,
    passes: int,
    model: Model,
    state: State,
    recording: Recording,
) -> int:
    """Record the interval, then bring every train to the next instant; return a `Status`.

    Parameters
    ----------
    count : int
        Number of trains on the line.
    share : float
        1.0, or the share of the load that the line can carry.
    passes : int
        Evaluations of the network that the solution took.

    Returns
    -------
    int
        With `Status.COLLAPSED` and `Status.STALLED` the step is not carried out.
    """
    recording.passes[at(step)] = passes
    recording.counters[Counter.SHORT_PIECE] += state.clock[0].short_pieces
    if share < 1.0:
        state.clock[0].carried_share = share
        return Status.COLLAPSED
    if find_stalled(count, state):
        return Status.STALLED
    remember(step == state.clock[0].fresh_step, state.flow)
    record_trains(
        step, count, state.clock[0].begin_s, model.options.step_s, model.types, model.points,
        state.flow.standing, state.trains, recording.trains, recording.train_state, recording.calls,
        recording.counters, recording.without_power_s, recording.regeneration,
    )  # fmt: skip
    if model.control.has_stores:
        settle_own_stores(
            step, count, model.options.step_s, model.types, state.flow.standing, state.trains,
            recording.on_board,
        )  # fmt: skip
    if model.control.fixed_voltage_v <= 0.0:
        record_network(step, model.network, state.flow, recording)
        note_loading(model, state)
        if model.network.stores.size > 0:
            settle_stores(step, model.options.step_s, model.network, state.flow, recording.stores)
    data = loads_of(model, state).driving
    for k in range(count):
        train = state.trains[at(state.flow.standing[at(k)].train)]
        move_train(step, train, data, state.clock[0])
    studied = model.control.studied_train
    if studied >= 0 and state.trains[at(studied)].timetable.arrival_step == step + 1:
        return Status.FINISHED
    return Status.RUNNING


@inlined
def step_to_arrival(tries: int, step_s: float, model: Model, state: State) -> float:
    """Length of a step that ends with the arrival of the studied train; or `step_s`, if that will do.

    Parameters
    ----------
    tries : int
        Lengths tried so far.
    step_s : float
        The last of them, with which the step is solved. [s]
    """
    full_s, studied = model.options.step_s, model.control.studied_train
    if model.options.motion != MotionModel.CONTINUOUS or studied < 0:
        return step_s
    train = state.trains[at(studied)]
    passage, motion = train.passage, train.passage.motion
    if train.decision.course != Course.PASSAGE or passage.stalled:
        return step_s
    if motion.phase == Phase.ARRIVED:
        if passage.stood_s <= ARRIVAL_S or tries > MOST_LENGTHS:
            return step_s
        return max(SHORTEST_STEP_S, step_s - passage.stood_s + ARRIVAL_S / 2.0)
    if step_s == full_s or tries > MOST_LENGTHS:
        return full_s
    # With another mean voltage it is not there yet: what is left of its way, with the brakes.
    way_m = model.stops[at(train.route), at(motion.next_stop)].position_m - motion.position_m
    left_s = ARRIVAL_S / 2.0
    if way_m > SLACK_M and motion.speed_m_s > 0.0:
        left_s += 2.0 * way_m / motion.speed_m_s
    return min(full_s, step_s + left_s)


@inlined
def solve_lengths(
    step: int, goes_on: bool, model: Model, state: State, recording: Recording
) -> float:
    """Solve a step, with lengths until it ends with the arrival of the studied train, if it does.

    Parameters
    ----------
    goes_on : bool
        Whether that is done in part, up to a search, which has been answered.

    Returns
    -------
    float
        As `solve_step`.
    """
    clock = state.clock[0]
    while True:
        now = with_step(model, clock.last_step_s)
        if not goes_on:
            prepare_step(clock.on_line, now, state)
        warm = step + clock.lengths_tried > clock.fresh_step
        share, passes = solve_step(clock.on_line, warm, now, state)
        clock.passes += passes
        if share < 1.0:
            return share
        goes_on = False
        clock.lengths_tried += 1
        wanted_s = step_to_arrival(clock.lengths_tried, clock.last_step_s, model, state)
        if wanted_s == clock.last_step_s:
            return share
        change_length(step, wanted_s, model, state, recording)


@kernel
def change_length(
    step: int, step_s: float, model: Model, state: State, recording: Recording
) -> None:
    """Give a step that is to end with an arrival another length; who is on the line may change. [s]"""
    clock = state.clock[0]
    longer = step_s > clock.last_step_s
    clock.last_step_s = step_s
    if longer:  # who was withheld may depart in time after all
        depart(step, state.trains)
    if withhold(step, step_s, state.trains, recording) or longer:
        record_instant(step, state.trains, recording)
        clock.on_line = place_trains(model, state)


@kernel
def run_steps(
    first: int, last: int, model: Model, state: State, recording: Recording
) -> tuple[int, int]:
    """`advance` up to the first step that needs a search: `Status.SEARCHING`.

    Once the search is done, the next call goes on with this step.
    """
    step, clock = first, state.clock[0]
    status: int = Status.RUNNING
    while step < last and status == Status.RUNNING:
        goes_on = state.flow.search[0].request == Request.ANSWERED
        if not goes_on:
            clock.on_line = begin_step(step, model, state, recording)
            clock.lengths_tried, clock.passes = 0, 0
            if clock.deadlocked_train >= 0:
                status = Status.DEADLOCKED
                break
            if step > clock.fresh_step:
                predict(state.flow)
        share = solve_lengths(step, goes_on, model, state, recording)
        if share == ASKS:
            return Status.SEARCHING, step
        now = with_step(model, clock.last_step_s)
        status = end_step(step, clock.on_line, share, clock.passes, now, state, recording)
        if status == Status.RUNNING or status == Status.FINISHED:
            step += 1
    record_instant(step, state.trains, recording)
    return status, step


@kernel
def run_steps_sparing(
    first: int, last: int, model: Model, state: State, recording: Recording
) -> tuple[int, int]:
    """`run_steps` where drivers spare hot motors."""
    step = first
    status: int = Status.RUNNING
    while step < last and status == Status.RUNNING:
        allow_currents(step, model.options.step_s, model, state)
        status, reached = run_steps(step, step + 1, model, state, recording)
        if reached > step:
            heat_motors(step, state.clock[0].last_step_s, model, state, recording)
        step = reached
    return status, step


def advance(
    first: int, last: int, model: Model, state: State, recording: Recording
) -> tuple[int, int]:
    """Run steps `first` to `last` - 1; return a `Status` and the step at which it holds.

    With `Status.FINISHED` that is the instant at which the studied train has arrived; with
    `Status.COLLAPSED` and `Status.STALLED` the step that has no solution or in which a train stalls,
    which is not carried out.
    """
    carry_out = run_steps_sparing if model.control.spares_motors else run_steps
    status, step = carry_out(first, last, model, state, recording)
    while status == Status.SEARCHING:
        now = plain(with_step)(model, state.clock[0].last_step_s)
        answer_in_turn(model.network, state.flow, loads_in_python(now, state))
        status, step = carry_out(step, last, model, state, recording)
    return status, step
