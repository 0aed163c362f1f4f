"""Runs of like cases, eight at a time: their key figures, without a recording."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tpss.api import Prepared
from tpss.audit.aggregate import Figures, TrainFigures, conclude_audit, gather, new_figures
from tpss.kernel import plain
from tpss.lanes.places import Rows
from tpss.lanes.records import LaneArray, join, new_lanes, part, words_of
from tpss.lanes.state import join_model, join_state, part_trains, word_of
from tpss.lanes.step import End, Together, run_together
from tpss.lanes.types import LANES
from tpss.record import Records
from tpss.results.key_figures import KeyFigures, key_figures_of
from tpss.results.standards.useful_voltage import window_steps
from tpss.run.run import STATUS_NAME, Run
from tpss.run.services import departing_trains
from tpss.step.recorded import NodeRow, StationRow, TrainRow
from tpss.step.recording import Recording
from tpss.step.state import Status

FIRST = 1
"""Steps that each case makes alone: the load flow of the first one knows of none before it."""


MOST_TIMES = 8
"""A run that takes longer than so many times what is foreseen is made alone."""

OPEN = 1 << 40
"""More steps than any run has."""


class Begun(NamedTuple):
    """A case that has made its first step."""

    case: Prepared
    run: Run
    figures: Figures
    window: tuple[int, int]
    """Bounds of the peak window, in steps, as if it were covered."""


def figures_together(cases: Sequence[Prepared], longer: int = 1) -> list[KeyFigures | None]:
    """Key figures of cases that run together; None of one that has to run alone.

    Parameters
    ----------
    cases : sequence of Prepared
        As many as there are lanes at most, of one structure that lanes cover.
    longer : int, optional
        How many times the steps that are foreseen they may have, unless the number is given; those that
        need more are run anew with twice as many.
    """
    begun = [_begin(case, longer) for case in cases]
    going = [each for each in begun if each.run.status == Status.RUNNING and each.run.step == FIRST]
    if not going:
        return [None] * len(cases)
    together = _join([going[min(lane, len(going) - 1)] for lane in range(LANES)])
    run_together(FIRST, min(_room(each.case, longer) for each in going), together)
    found = {id(each): _end(lane, each, together) for lane, each in enumerate(going)}
    left = together.ends.words[0, word_of(End.dtype, "status")] == Status.RUNNING
    late = [
        each
        for lane, each in enumerate(going)
        if left[lane] and found[id(each)] is None and longer < MOST_TIMES
    ]
    if late:
        again = figures_together([each.case for each in late], 2 * longer)
        found |= {id(each): figures for each, figures in zip(late, again, strict=True)}
    return [found.get(id(each)) for each in begun]


def _room(case: Prepared, longer: int) -> int:
    """Steps for which a case is prepared."""
    return case.start.steps or longer * case.start.capacity


def _begin(case: Prepared, longer: int) -> Begun:
    """Let a case make its first step, and gather its figures."""
    start, frame = case.start, case.frame
    late = departing_trains(
        start.services, start.model.options, start.capacity, _room(case, longer)
    )
    run = Run(start.model, [*start.trains, *late], FIRST, case.clock, turns=start.turns)
    run.advance_to(FIRST)
    figures = new_figures(run.model, len(run.trains), frame.zones)
    h = run.model.options.step_s
    peak = window_steps(OPEN, h, frame.peak_from_min, frame.peak_to_min)
    window = (0, 0) if peak is None else (peak.start, peak.stop)
    gather(
        0, FIRST, FIRST + 1, h, window[0], window[1], frame.at_line_level, run.state.trains, run.model,
        run.recording, figures,
    )  # fmt: skip
    figures.run[0].passes = figures.run[0].most_passes = run.recording.passes[0]
    return Begun(case, run, figures, window)


def _join(lanes: list[Begun]) -> Together:
    runs = [each.run for each in lanes]
    model = join_model([run.model for run in runs])
    state, numbers = join_state([run.state for run in runs])
    figures, rows = _join_figures(lanes, numbers)
    recording, interval = _recordings(runs, numbers)
    ends = [
        End.array([(FIRST, Status.RUNNING, each.run.model.control.studied_train, *each.window)])
        for each in lanes
    ]
    trains: Any = state.trains
    at_line_level = lanes[0].case.frame.at_line_level
    return Together(
        model, state, numbers, recording, interval, figures, at_line_level, join(ends),
        Rows(trains.words, numbers.words, rows.words),
    )  # fmt: skip


def _join_figures(lanes: list[Begun], numbers: LaneArray) -> tuple[Figures, LaneArray]:
    """Figures in lanes, and those of the trains, in the order of these."""
    count = numbers.shape[0]
    trains = new_lanes(TrainFigures.dtype, (count,))
    for lane, each in enumerate(lanes):
        order = numbers.words[:, 0, lane]
        known = order >= 0
        trains.words[known, :, lane] = words_of(each.figures.trains)[order[known]]
    whole: Any = {
        name: join([getattr(each.figures, name) for each in lanes], same)
        for name, same in (("run", ()), ("stations", ()), ("zones", ("line",)))
    }
    first = lanes[0].figures.audit
    scratch: Any = {
        "balances": join([each.figures.audit.balances for each in lanes]),
        "leaving_a": new_lanes(np.complex128, first.leaving_a.shape),
        "node_v": new_lanes(np.complex128, first.node_v.shape),
        "order": join([np.arange(count)] * LANES),
        "section": new_lanes(np.int64, (count,)),
        "place_m": new_lanes(np.float64, (count,)),
    }
    whole |= {"trains": trains, "audit": first._replace(**scratch)}
    return Figures(**whole), trains


def _recordings(runs: list[Run], numbers: LaneArray) -> tuple[Recording, Recording]:
    """A recording of the interval and of the instant behind it; and one that writes to the first."""
    kept, trains = runs[0].recording, numbers.shape[0]
    interval: Any = {
        "trains": new_lanes(TrainRow.dtype, (2, trains)),
        "train_state": new_lanes(np.int64, (2, trains)),
        "nodes": new_lanes(NodeRow.dtype, (1, kept.nodes.shape[1])),
        "stations": new_lanes(StationRow.dtype, (1, kept.stations.shape[1])),
        "branch_current": new_lanes(np.float64, (1, kept.branch_current.shape[1])),
        "network_losses": new_lanes(np.float64, (1,)),
        "passes": new_lanes(np.int64, (1,)),
        "counters": join([run.recording.counters for run in runs]),
    }
    written: Any = {
        name: np.broadcast_to(array[:1], (OPEN, *array.shape[1:]), subok=True)
        for name, array in interval.items()
        if name != "counters"
    }
    return (
        kept._replace(**written, counters=interval["counters"]),
        kept._replace(**interval),
    )


def _end(lane: int, begun: Begun, together: Together) -> KeyFigures | None:
    """Key figures of a case, if it has come to its end in lanes."""
    case, run, figures = begun.case, begun.run, begun.figures
    end: Records[End] = End.blank(1)
    part(together.ends, lane, end)
    status = Status(end[0].status)
    if status == Status.RUNNING and end[0].step == case.start.steps:
        status = Status.FINISHED
    if status != Status.FINISHED:
        return None
    run.step, run.status = int(end[0].step), status
    part_trains(together.state.trains, together.numbers, lane, run.state.trains)
    order = together.numbers.words[:, 0, lane]
    known = order >= 0
    words_of(figures.trains)[order[known]] = together.figures.trains.words[:, :, lane][known]
    for whole, own in (
        (together.state.clock, run.state.clock),
        (together.interval.counters, run.recording.counters),
        (together.figures.run, figures.run),
        (together.figures.stations, figures.stations),
        (together.figures.zones, figures.zones),
        (together.figures.audit.balances, figures.audit.balances),
    ):
        part(whole, lane, own)
    _conclude(begun)
    found = key_figures_of(run, STATUS_NAME[status], case.start, case.frame, figures)
    return replace(found, way="lanes")


def _conclude(begun: Begun) -> None:
    """What the figures of a whole run need besides those of its steps."""
    run, frame, figures = begun.run, begun.case.frame, begun.figures
    h = run.model.options.step_s
    for name in ("energy_j", "reactive_j"):
        figures.stations[name] *= h
    if window_steps(run.step, h, frame.peak_from_min, frame.peak_to_min) is None:
        for name in ("useful_steps", "pulling_steps", "pulling_voltage_v"):
            figures.trains[name] = 0
        figures.zones["steps"], figures.zones["voltage_v"] = 0, 0.0
    plain(conclude_audit)(run.step, run.model, figures.audit)
