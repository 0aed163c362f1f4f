"""The clock: the order of things in a step, and when a run ends."""

from tpss.driving.driver import prepare
from tpss.kernel import at, inlined, kernel
from tpss.powerflow.placing import locate_trains, measure_pieces
from tpss.powerflow.solve import predict, remember
from tpss.step.converter_control import control_converters, note_loading
from tpss.step.coupling import solve_step
from tpss.step.model import Model, driving_data
from tpss.step.record import record_instant, record_network, record_train
from tpss.step.recording import Recording
from tpss.step.state import Counter, State, Status
from tpss.step.traffic import depart, list_trains, move_train, remove_arrived
from tpss.vehicle.train import Phase


@inlined
def find_stalled(count: int, state: State) -> bool:
    """Whether a train would roll back, or stands with no force to start; note the first one."""
    for k in range(count):
        i = state.flow.standing[at(k)].train
        train = state.trains[at(i)]
        if train.motion.phase == Phase.DWELLING:
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
    """Traffic, converter control, drivers; return the number of trains on the line."""
    # 1. Departures, and removal of arrived trains, which this instant still shows.
    depart(step, state.trains)
    record_instant(step, state.trains, recording)
    remove_arrived(state.trains)
    # 2. Converter control (3.6)-(3.9).
    control_converters(step * model.options.step_s, model, state)
    # 3. Where the trains stand, and what their drivers want.
    count = list_trains(state.trains, state.flow)
    locate_trains(count, state.trains, model.network, state.flow)
    short = measure_pieces(count, model.network, state.flow)
    recording.counters[Counter.SHORT_PIECE] += short
    data = driving_data(model)
    for k in range(count):
        train = state.trains[at(state.flow.standing[at(k)].train)]
        prepare(train, data, model.points, state.scratch)
    return count


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
    if share < 1.0:
        state.clock[0].carried_share = share
        return Status.COLLAPSED
    if find_stalled(count, state):
        return Status.STALLED
    remember(step == 0, state.flow)
    for k in range(count):
        record_train(step, k, model, state, recording)
    if model.control.fixed_voltage_v <= 0.0:
        record_network(step, model, state, recording)
        note_loading(model, state)
    data = driving_data(model)
    for k in range(count):
        train = state.trains[at(state.flow.standing[at(k)].train)]
        move_train(step, train, data, state.clock[0])
    studied = model.control.studied_train
    if studied >= 0 and state.trains[at(studied)].timetable.arrival_step == step + 1:
        return Status.FINISHED
    return Status.RUNNING


@kernel
def advance(
    first: int, last: int, model: Model, state: State, recording: Recording
) -> tuple[int, int]:
    """Run steps `first` to `last` - 1; return a `Status` and the step at which it holds.

    With `Status.FINISHED` that is the instant at which the studied train has arrived; with
    `Status.COLLAPSED` and `Status.STALLED` the step that has no solution or in which a train stalls,
    which is not carried out.
    """
    step = first
    status: int = Status.RUNNING
    while step < last and status == Status.RUNNING:
        count = begin_step(step, model, state, recording)
        if step > 0:
            predict(state.flow)
        share, passes = solve_step(count, step > 0, model, state)
        status = end_step(step, count, share, passes, model, state, recording)
        if status == Status.RUNNING or status == Status.FINISHED:
            step += 1
    record_instant(step, state.trains, recording)
    return status, step
