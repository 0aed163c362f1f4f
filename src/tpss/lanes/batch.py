"""Runs of like cases, eight at a time; each ends as it would have ended alone."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tpss.lanes import functions  # noqa: F401  which gives what kernels call
from tpss.lanes.records import LaneArray, join, new_lanes, part, words_of
from tpss.lanes.state import join_model, join_state, word_of
from tpss.lanes.step import End, Kept, Rows, run_together
from tpss.lanes.types import LANES
from tpss.record import Records
from tpss.run.protection import run_to_end
from tpss.run.run import STATUS_NAME, Clock, Run, run_of
from tpss.run.start import Start
from tpss.step.recorded import NodeRow, StationRow, TrainRow
from tpss.step.recording import Memory, Recording
from tpss.step.state import State, Status
from tpss.vehicle.train import Train

FIRST = 1
"""Steps that each case makes alone: the load flow of the first one knows of none before it."""


def run_batch(
    starts: Sequence[Start], clock: Clock, memory: Memory = np.empty
) -> list[tuple[Run, str, bool]]:
    """Run cases together; each one's run, its status, and whether it was made in lanes.

    Parameters
    ----------
    starts : sequence of Start
        As many as there are lanes at most, of one structure that lanes cover.
    clock : callable
        Runs the steps of those that have to run alone.
    memory : callable, optional
        Allocates the recordings.
    """
    runs = [run_of(start, clock, memory) for start in starts]
    for run in runs:
        run.advance_to(FIRST)
    if any(run.status != Status.RUNNING or run.step != FIRST for run in runs):
        together = [False] * len(runs)
    else:
        together = _advance(runs, starts)
    ended = []
    for run, start, done in zip(runs, starts, together, strict=True):
        if done:
            ended.append((run, STATUS_NAME[Status.FINISHED], True))
        else:
            ended.append((*run_to_end(start, clock, memory), False))
    return ended


def _advance(runs: list[Run], starts: Sequence[Start]) -> list[bool]:
    """Advance runs to their ends; whether each has come to it."""
    lanes = [runs[min(lane, len(runs) - 1)] for lane in range(LANES)]
    last = min(run.capacity for run in runs)
    model = join_model([run.model for run in lanes])
    state, numbers = join_state([run.state for run in lanes])
    recording, rows = _one_row(lanes, state, numbers, last)
    studied = [run.model.control.studied_train for run in lanes]
    ends = join([End.array([(FIRST, Status.RUNNING, each)]) for each in studied])
    position, speed = (word_of(Train.dtype, "motion", each) for each in ("position_m", "speed_m_s"))
    run_together(
        FIRST, last, position, speed, model, state, recording, numbers, rows, _kept(lanes), ends
    )
    return [
        _end(lane, run, start.steps == last, state, numbers, recording, ends)
        for lane, (run, start) in enumerate(zip(runs, starts, strict=True))
    ]


def _one_row(
    lanes: list[Run], state: State, numbers: LaneArray, last: int
) -> tuple[Recording, Rows]:
    """A recording of lanes, whose rows are all one that each step overwrites; and that as words."""
    kept = lanes[0].recording
    trains = numbers.shape[0]
    made = {
        "trains": new_lanes(TrainRow.dtype, (trains,)),
        "train_state": new_lanes(np.int64, (trains,)),
        "nodes": new_lanes(NodeRow.dtype, kept.nodes.shape[1:]),
        "stations": new_lanes(StationRow.dtype, kept.stations.shape[1:]),
        "branch_current": new_lanes(np.float64, kept.branch_current.shape[1:]),
    }
    single = {
        "network_losses": new_lanes(np.float64, (1,)),
        "passes": new_lanes(np.int64, (1,)),
    }
    whole: Any = {
        name: np.broadcast_to(row, (last + 1, *row.shape), subok=True) for name, row in made.items()
    } | {name: np.broadcast_to(row, (last + 1,), subok=True) for name, row in single.items()}
    counters: Any = join([run.recording.counters for run in lanes])
    recording = kept._replace(**whole, counters=counters)
    words = {name: row.words for name, row in (made | single).items()}
    motion: Any = state.trains
    return recording, Rows(**words, motion=motion.words, numbers=numbers.words)


def _kept(lanes: list[Run]) -> Kept:
    """The cases' recordings as words."""

    def of(name: str) -> tuple[Any, ...]:
        return tuple(
            words_of(getattr(run.recording, name)) for run in lanes
        )

    def plain(name: str) -> tuple[Any, ...]:
        return tuple(getattr(run.recording, name).view(np.int64) for run in lanes)

    return Kept(
        trains=of("trains"),
        train_state=tuple(run.recording.train_state for run in lanes),
        nodes=of("nodes"),
        stations=of("stations"),
        branch_current=plain("branch_current"),
        network_losses=plain("network_losses"),
        passes=plain("passes"),
    )


def _end(
    lane: int, run: Run, is_last: bool, state: State, numbers: LaneArray, recording: Recording,
    ends: LaneArray,
) -> bool:  # fmt: skip
    """Give a run its end in lanes; whether it has come to that there."""
    end: Records[End] = End.blank(1)
    part(ends, lane, end)
    status = Status(end[0].status)
    if status == Status.RUNNING and is_last:
        status = Status.FINISHED
    if status != Status.FINISHED:
        return False
    run.step, run.status = int(end[0].step), status
    trains: Any = state.trains
    of_lane = numbers.words[:, 0, lane]
    known = of_lane >= 0
    words_of(run.state.trains)[of_lane[known]] = trains.words[known][:, :, lane]
    clock: Any = state.clock
    part(clock, lane, run.state.clock)
    counters: Any = recording.counters
    part(counters, lane, run.recording.counters.reshape(-1, 1)[:, 0])
    return True
