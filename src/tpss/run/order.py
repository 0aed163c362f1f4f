"""The planned order of trains at gates, from their times at nominal voltage.

All trains run once at nominal voltage, none waiting at gates, but behind trains ahead, which they do not
overtake.  From the times at which they come to gates and leave the stretches behind them follows who
passes first; where that does not work out, trains wait (`dispatch`).
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import plain, switch
from tpss.run.dispatch import Dispatcher
from tpss.run.run import Run, advance_to_end, run_of
from tpss.run.services import ScheduledTrain
from tpss.run.start import Start
from tpss.run.under_way import Passage
from tpss.step.model import Model, RunControl
from tpss.step.turns import AT_GATE_M, no_turns
from tpss.track.gate import Gate, Precedence
from tpss.track.leg import leg_of, place_on_line

Floats = npt.NDArray[np.float64]


def with_order(start: Start) -> Start:
    """A start at which the order of its trains at gates is planned, if they keep one.

    Raises
    ------
    NoOrderError
        Trains stand on a single track head to head, or cannot all come through.
    """
    model = start.model
    if model.signalling.precedence != Precedence.TIMETABLE_ORDER or model.rules.gates.shape[1] < 2:
        return start
    passages = _passages(_run_freely(start))
    order = Dispatcher(passages, model.rules.tracks.tolist()).run()
    turns: Any = no_turns(len(start.trains), model.rules)
    for i in range(len(start.trains)):
        count = len(order.stretch[i])
        turns["stretch"][i, :count] = order.stretch[i]
        turns["place"][i, :count] = order.place[i]
    return replace(start, turns=turns)


def _run_freely(start: Start) -> Run:
    """The trains at nominal voltage, on single tracks as if nobody came towards them."""
    model = start.model
    free = model._replace(
        control=RunControl(fixed_voltage_v=model.network.system.nominal_voltage_v),
        signalling=model.signalling._replace(precedence=switch(Precedence.FREE)),
    )
    start = replace(start, model=free, steps=start.capacity, switchings=())
    run = run_of(start)
    advance_to_end(run, start)
    return run


def _passages(run: Run) -> list[list[Passage]]:
    """What each train has planned at the gates of its route."""
    model, instants_s = run.model, run.instants_s
    gates = model.rules.gates
    position_m = np.asarray(run.recording.trains["route_position"][: run.step + 1])
    numbers: dict[object, int] = {}
    found = []
    for i, train in enumerate(run.trains):
        kind = model.types[train.train_type]
        course = _Course(instants_s, position_m[:, i], kind.highest_speed_m_s, train, model)
        own = [gates[train.route, k] for k in range(gates.shape[1] - 1)]
        own = [gate for gate in own if gate.from_m < math.inf]
        ready_s = [course.time_behind(gate.from_m) for gate in own]
        found.append(
            [
                _passage(gate, course, here_s, next_s, kind.length_m, numbers)
                for gate, here_s, next_s in zip(own, ready_s, [*ready_s, math.inf][1:], strict=True)
            ]
        )
    return found


class _Course:
    """When a train comes past positions; beyond where the run ends, it goes on at its highest speed."""

    def __init__(
        self, instants_s: Floats, position_m: Floats, fastest_m_s: float, train: ScheduledTrain,
        model: Model,
    ) -> None:  # fmt: skip
        self.route, self.legs = train.route, model.legs
        there = np.isfinite(position_m)
        self.time_s, self.position_m = instants_s[there], position_m[there]
        if not there.any():  # it departs after the end
            self.time_s, self.position_m = instants_s[-1:], np.array([train.position_m])
        self.fastest_m_s = fastest_m_s

    def waits_on(self, gate: Gate) -> tuple[int, int, float, float]:
        """Where a train waits at a gate: line, track, direction and place to a metre."""
        leg = leg_of(float(gate.from_m) - AT_GATE_M, self.route, self.legs)
        place_m = plain(place_on_line)(gate.from_m, leg)
        return int(leg.line), int(leg.track), float(leg.sign), float(round(place_m))

    def place_m(self, gate: Gate) -> float:
        """Where a gate is on its line, to a metre. [m]"""
        leg = leg_of(float(gate.from_m), self.route, self.legs)
        return float(round(plain(place_on_line)(gate.from_m, leg)))

    def time_behind(self, place_m: float) -> float:
        """When a train leaves a position for what lies behind it. [s]"""
        behind = int(np.searchsorted(self.position_m, place_m + AT_GATE_M, side="right"))
        if behind == 0:
            return -math.inf
        last_s, last_m = self.time_s[behind - 1], self.position_m[behind - 1]
        if behind == self.position_m.size:
            return float(last_s + max(0.0, place_m - last_m) / self.fastest_m_s)
        share = (place_m - last_m) / (self.position_m[behind] - last_m)
        return float(last_s + max(0.0, share) * (self.time_s[behind] - last_s))

    def time_at(self, place_m: float) -> float:
        """When a train reaches a position. [s]"""
        reached = int(np.searchsorted(self.position_m, place_m - AT_GATE_M, side="left"))
        if reached == 0:
            return -math.inf
        if reached == self.position_m.size:
            left_m = max(0.0, place_m - self.position_m[-1])
            return float(self.time_s[-1] + left_m / self.fastest_m_s)
        before_s, before_m = self.time_s[reached - 1], self.position_m[reached - 1]
        share = (place_m - before_m) / (self.position_m[reached] - before_m)
        return float(before_s + min(1.0, share) * (self.time_s[reached] - before_s))


def _passage(
    gate: Gate, course: _Course, ready_s: float, next_s: float, length_m: float,
    numbers: dict[object, int],
) -> Passage:  # fmt: skip
    """What a train has planned at a gate that it passes at a time, and the next one at another [s];
    places where trains wait on one track get numbers.
    """
    clear_s = course.time_at(gate.until_m + length_m * gate.clears_whole)
    if not gate.clears_whole:  # it is in the crossing place before it leaves that
        clear_s = min(clear_s, next_s)
    waits_on = -1
    if not gate.aside:
        waits_on = numbers.setdefault(course.waits_on(gate), len(numbers))
    behind = int(gate.stretch), int(gate.direction), int(gate.place)
    return Passage(*behind, ready_s, max(ready_s, clear_s), waits_on, course.place_m(gate))
