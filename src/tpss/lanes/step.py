"""Steps of all cases together, in the order of `tpss.step.advance`, with their figures.

Nothing is kept of a step but its figures and its audit, which are gathered as it ends: the recording has
two rows, the interval and the instant that ends it.
"""

from typing import Any, NamedTuple

from tpss.audit.aggregate import audit_step, gather_network, gather_trains, note_place
from tpss.lanes import functions, load_flow  # noqa: F401  which give what kernels of a step call
from tpss.lanes.compile import compiled, lane_version
from tpss.lanes.masks import anyone, both, either, highest, lane_at, negated, select
from tpss.lanes.places import place_trains
from tpss.powerflow.solve import ASKS, predict
from tpss.record import Record
from tpss.step.advance import end_step, prepare_step
from tpss.step.converter_control import control_converters
from tpss.step.coupling import solve_step
from tpss.step.state import Status, TrainState
from tpss.step.traffic import depart, remove_arrived

_depart, _remove_arrived, _control, _prepare, _predict, _solve, _end = (
    lane_version(each)[0]
    for each in (
        depart, remove_arrived, control_converters, prepare_step, predict, solve_step, end_step,
    )
)  # fmt: skip
_gather_trains, _gather_network, _audit_step, _note_place = (
    lane_version(each)[0] for each in (gather_trains, gather_network, audit_step, note_place)
)
_RUNNING, _FINISHED = int(Status.RUNNING), int(Status.FINISHED)
_SEARCHING, _ABSENT = int(Status.SEARCHING), int(TrainState.ABSENT)


class End(Record):
    """Where a case stands, and how its run ends."""

    step: int
    """The step at which it stands."""
    status: Status
    """Of one that has to run alone, `Status.SEARCHING`."""
    studied: int
    """Number of the train with whose arrival it ends, or -1."""
    peak_from: int
    """Bounds of the peak window, in steps."""
    peak_to: int


class Together(NamedTuple):
    """All of the cases, in lanes."""

    model: Any
    state: Any
    numbers: Any
    """Numbers of the trains in their rows."""
    recording: Any
    """Whose rows are all the first one of `interval`."""
    interval: Any
    """The recording of the step that ends, and of the instant at its end."""
    figures: Any
    at_line_level: Any
    """Whether a node is at the contact line's level."""
    ends: Any
    """One record of `End`."""
    rows: Any
    """As `places.Rows`."""


@compiled(fused=False)
def has_arrived(step: int, studied: Any, count: Any, trains: Any, numbers: Any) -> Any:
    """The cases whose studied train stands at its destination at an instant."""
    found = studied != studied
    for k in range(highest(count)):
        arrives = trains[lane_at(k)].timetable.arrival_step == step
        found = either(found, both(arrives, numbers[lane_at(k)] == studied))
    return found


@compiled(fused=False)
def begin_interval(count: Any, trains: Any, interval: Any) -> None:
    """Note where the trains on the line are at the instant at which a step begins."""
    for k in range(trains.size):
        row, motion = interval.trains[lane_at(0), lane_at(k)], trains[lane_at(k)].motion
        row.route_position, row.speed = motion.position_m, motion.speed_m_s
        interval.train_state[lane_at(0), lane_at(k)] = select(k < count, 0, _ABSENT)


@compiled(fused=False)
def end_interval(step: int, count: Any, passes: Any, mask: Any, cases: Together) -> None:
    """Gather the figures of a step, and audit it, where the trains are at the next instant."""
    interval, trains, figures = cases.interval, cases.state.trains, cases.figures
    step_s, end, run = cases.model.options.step_s, cases.ends[lane_at(0)], figures.run[lane_at(0)]
    for k in range(highest(count)):
        row, motion = interval.trains[lane_at(1), lane_at(k)], trains[lane_at(k)].motion
        row.route_position, row.speed = motion.position_m, motion.speed_m_s
        here = both(mask, k < count)
        _note_place(row.route_position, figures.trains[lane_at(k)], here)
    lowest_v, lowest_train = run.lowest_voltage_v, run.lowest_voltage_train
    lowest_step = run.lowest_voltage_step
    in_window = both(end.peak_from <= step, step < end.peak_to)
    _gather_trains(0, in_window, step_s, trains, cases.model.legs, interval, figures, mask)
    lower = run.lowest_voltage_v < lowest_v
    number = cases.numbers[lane_at(run.lowest_voltage_train)]
    run.lowest_voltage_train = select(lower, number, lowest_train)
    run.lowest_voltage_step = select(lower, step, lowest_step)
    _gather_network(0, step_s, cases.at_line_level, interval, figures, mask)
    _audit_step(0, step_s, trains, cases.model, interval, figures.audit, mask)
    run.passes = select(mask, run.passes + passes, run.passes)
    run.most_passes = select(mask, max(run.most_passes, passes), run.most_passes)


@compiled(fused=False)
def run_together(first: int, last: int, cases: Together) -> None:
    """Run steps `first` to `last` - 1 of all cases; `cases.ends` tells how each ends."""
    model, state, end = cases.model, cases.state, cases.ends[lane_at(0)]
    step_s = model.options.step_s
    left = end.status == _RUNNING
    for step in range(first, last):
        state.clock[lane_at(0)].begin_s = step * step_s
        _depart(step, state.trains, left)
        _remove_arrived(state.trains, left)
        _control(step * step_s, model, state, left)
        count = place_trains(model, state, cases.rows)
        begin_interval(count, state.trains, cases.interval)
        _prepare(count, model, state, left)
        _predict(state.flow, left)
        share, passes = _solve(count, True, model, state, left)
        solved = both(left, share != ASKS)
        status = _end(step, count, share, passes, model, state, cases.recording, solved)
        goes_on = both(solved, status == _RUNNING)
        end_interval(step, count, passes, goes_on, cases)
        end.step = select(goes_on, step + 1, end.step)
        end.status = select(both(left, negated(goes_on)), _SEARCHING, end.status)
        arrived = has_arrived(step + 1, end.studied, count, state.trains, cases.numbers)
        finished = both(goes_on, arrived)
        end.status = select(finished, _FINISHED, end.status)
        left = both(goes_on, negated(finished))
        if not anyone(left):
            return
