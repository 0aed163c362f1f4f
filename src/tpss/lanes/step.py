"""Steps of all cases together, in the order of `tpss.step.advance`."""

from typing import Any, NamedTuple

from tpss.lanes import load_flow  # noqa: F401  which gives what kernels of a step call
from tpss.lanes.compile import compiled, lane_version
from tpss.lanes.masks import anyone, both, either, lane_at, lane_of, negated, select
from tpss.lanes.places import place_trains
from tpss.lanes.types import LANES
from tpss.powerflow.solve import ASKS, predict
from tpss.record import Record
from tpss.step.advance import end_step, prepare_step
from tpss.step.converter_control import control_converters
from tpss.step.coupling import solve_step
from tpss.step.state import Status, TrainState
from tpss.step.traffic import depart, remove_arrived
from tpss.vehicle.train import Phase, is_on_line

_depart, _remove_arrived, _control, _prepare, _predict, _solve, _end, _is_on_line = (
    lane_version(each)[0]
    for each in (
        depart, remove_arrived, control_converters, prepare_step, predict, solve_step, end_step,
        is_on_line,
    )
)  # fmt: skip
_RUNNING, _FINISHED = int(Status.RUNNING), int(Status.FINISHED)
_SEARCHING = int(Status.SEARCHING)
_ARRIVED, _STATE_ARRIVED = int(Phase.ARRIVED), int(TrainState.ARRIVED)


class Kept(NamedTuple):
    """The recordings of the cases as words, each as `step.recording` has it; a tuple of all lanes."""

    trains: Any
    """Shape (instants, trains, words)."""
    train_state: Any
    """Shape (instants, trains)."""
    nodes: Any
    """Shape (instants, nodes, words)."""
    stations: Any
    """Shape (instants, stations, words)."""
    branch_current: Any
    """Shape (instants, ends)."""
    network_losses: Any
    """Shape (instants,)."""
    passes: Any
    """Shape (instants,)."""


class Rows(NamedTuple):
    """What is recorded of the present step, as words, lanes last."""

    trains: Any
    train_state: Any
    nodes: Any
    stations: Any
    branch_current: Any
    network_losses: Any
    passes: Any
    motion: Any
    """Of the trains' records."""
    numbers: Any
    """Numbers of the trains in their rows."""


class End(Record):
    """Where a case stands, and how its run ends."""

    step: int
    """The step at which it stands."""
    status: Status
    """Of one that has to run alone, `Status.SEARCHING`."""
    studied: int
    """Number of the train with whose arrival it ends, or -1."""


@compiled(fused=False)
def keep_instant(
    step: int, mask: Any, trains: Any, position: int, speed: int, rows: Rows, kept: Kept
) -> None:
    """`step.record.record_instant` of each case in the mask."""
    here = select(mask, 1, 0)
    for k in range(trains.size):
        phase = trains[lane_at(k)].motion.phase
        arrived = select(phase == _ARRIVED, 1, 0)
        shown = select(either(_is_on_line(phase), phase == _ARRIVED), here, 0)
        if not anyone(shown == 1):
            continue
        for lane in range(LANES):
            if lane_of(shown, lane) == 1:
                i = rows.numbers[k, 0, lane]
                kept.trains[lane][step, i, 0] = rows.motion[k, position, lane]
                kept.trains[lane][step, i, 1] = rows.motion[k, speed, lane]
                if lane_of(arrived, lane) == 1:
                    kept.train_state[lane][step, i] = _STATE_ARRIVED


@compiled(fused=False)
def keep_step(step: int, count: Any, mask: Any, rows: Rows, kept: Kept) -> None:
    """Put what is recorded of a step into the recordings of the cases in the mask."""
    here = select(mask, 1, 0)
    for lane in range(LANES):
        if lane_of(here, lane) == 0:
            continue
        of_trains, states = kept.trains[lane], kept.train_state[lane]
        for k in range(lane_of(count, lane)):
            i = rows.numbers[k, 0, lane]
            for w in range(2, rows.trains.shape[1]):
                of_trains[step, i, w] = rows.trains[k, w, lane]
            states[step, i] = rows.train_state[k, 0, lane]
        copy_table(step, lane, rows.nodes, kept.nodes[lane])
        copy_table(step, lane, rows.stations, kept.stations[lane])
        for b in range(rows.branch_current.shape[0]):
            kept.branch_current[lane][step, b] = rows.branch_current[b, 0, lane]
        kept.network_losses[lane][step] = rows.network_losses[0, 0, lane]
        kept.passes[lane][step] = rows.passes[0, 0, lane]


@compiled(fused=False)
def has_arrived(step: int, studied: Any, trains: Any, numbers: Any) -> Any:
    """The cases whose studied train stands at its destination at an instant."""
    found = studied != studied
    for k in range(trains.size):
        arrives = trains[lane_at(k)].timetable.arrival_step == step
        found = either(found, both(arrives, numbers[lane_at(k)] == studied))
    return found


@compiled(fused=True)
def copy_table(step: int, lane: int, rows: Any, table: Any) -> None:
    """Put the rows of one case into its table."""
    for n in range(rows.shape[0]):
        for w in range(rows.shape[1]):
            table[step, n, w] = rows[n, w, lane]


@compiled(fused=False)
def run_together(
    first: int, last: int, position: int, speed: int, model: Any, state: Any, recording: Any,
    numbers: Any, rows: Rows, kept: Kept, ends: Any,
) -> None:  # fmt: skip
    """Run steps `first` to `last` - 1 of all cases.

    Parameters
    ----------
    position, speed : int
        Words of a train's position and speed.
    model, state, recording : Model, State, Recording
        Of lanes; the recording has one row.
    numbers : lanes
        Numbers of the trains in their rows.
    rows : Rows
        The same memory as words.
    kept : Kept
        The cases' recordings, written.
    ends : records of End
        One, of lanes; written.
    """
    step_s = model.options.step_s
    left = ends[lane_at(0)].status == _RUNNING
    for step in range(first, last):
        state.clock[0].begin_s = step * step_s
        _depart(step, state.trains, left)
        keep_instant(step, left, state.trains, position, speed, rows, kept)
        _remove_arrived(state.trains, left)
        _control(step * step_s, model, state, left)
        count = place_trains(model, state, rows.motion, rows.numbers)
        _prepare(count, model, state, left)
        _predict(state.flow, left)
        share, passes = _solve(count, True, model, state, left)
        asks = both(left, share == ASKS)
        left = both(left, negated(asks))
        status = _end(step, count, share, passes, model, state, recording, left)
        keep_step(step, count, left, rows, kept)
        arrived = has_arrived(step + 1, ends[lane_at(0)].studied, state.trains, numbers)
        goes_on = both(left, status == _RUNNING)
        finished = both(goes_on, arrived)
        goes_on = both(goes_on, negated(arrived))
        alone = both(either(asks, left), negated(either(finished, goes_on)))
        ends[lane_at(0)].step = select(either(finished, goes_on), step + 1, ends[lane_at(0)].step)
        ends[lane_at(0)].status = select(finished, _FINISHED, ends[lane_at(0)].status)
        ends[lane_at(0)].status = select(alone, _SEARCHING, ends[lane_at(0)].status)
        if anyone(finished):
            keep_instant(step + 1, finished, state.trains, position, speed, rows, kept)
        left = goes_on
        if not anyone(left):
            return
    keep_instant(last, left, state.trains, position, speed, rows, kept)
