"""A run up to the steady state of its timetable, and on over whole periods of it.

Trains of services with headways stand along the line at the start, as if they had always run, but each
as if it were alone.  Means are taken from when the first train of every service that departed since has
arrived, over whole periods; where the run itself ends does not count.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.model.build import Layout, build_model, steps_of
from tpss.model.start import start_of
from tpss.model.traffic import build_services
from tpss.planning.period import period_of
from tpss.planning.plan import Evaluation
from tpss.run.clocks import clock_of
from tpss.run.protection import run_on
from tpss.run.run import Run, arrivals_s, run_of
from tpss.run.start import Start, foreseen_steps
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model
from tpss.step.recording import Memory

LONGEST = 4.0
"""Times what is foreseen of its trains that a run takes at most; then they do not come through. [1]"""

FINISHED = "finished"
NOT_THROUGH = "not through"
"""How a run ends whose trains do not arrive in that time."""

ROUNDING = 1e-9
"""Times that differ by less than this share are the same. [1]"""


@dataclass(frozen=True)
class Window:
    """Where of a run means are taken."""

    begin_s: float
    end_s: float
    per_s: float
    """Time to which all that happens in it belongs. [s]"""

    def weights_s(self, run: Run) -> npt.NDArray[np.float64]:
        """Time of each step of a run that lies in the window, shape (steps,). [s]"""
        at = run.instants_s
        inside = np.minimum(at[1:], self.end_s) - np.maximum(at[:-1], self.begin_s)
        return np.asarray(np.maximum(inside, 0.0), dtype=float)


@dataclass(frozen=True)
class SteadyRun:
    """A run, how it ended, and where its means are taken; there is no window if it ended early."""

    run: Run
    start: Start
    layout: Layout
    scenario: Scenario
    status: str
    period_min: float
    window: Window | None


def run_steadily(
    scenario: Scenario, evaluation: Evaluation, memory: Memory = np.empty
) -> SteadyRun:
    """Run a scenario until its means are known, or it cannot go on.

    Services with headways run for ever: the window begins when the first train of each that departs
    has arrived, and holds whole periods.  Listed departures are run until all trains have arrived, and
    all of it belongs to one period.  With both, the window is one period from the start.

    Raises
    ------
    ScenarioError, TooLargeError
        As of `tpss.api.build`, or the period is not known.
    """
    period_s = 60.0 * period_of(scenario, evaluation)
    model, layout = build_model(scenario)
    rule = _rule_of(scenario, model, period_s, 60.0 * evaluation.measured_min)
    until_s = rule.until_s
    start = start_of(_lasting(scenario, until_s), model)
    run = run_of(start, clock_of(scenario.simulation.load_flow, scenario.given_source), memory)
    while True:
        run, status = run_on(run, start, memory)
        window = rule.window(run, start) if status == FINISHED else None
        if window is not None or status != FINISHED or until_s >= rule.longest_s:
            break
        until_s = min(rule.longest_s, 1.5 * until_s)
        start = replace(start, steps=steps_of(until_s, model.options.step_s))
    if status == FINISHED and window is None:
        status = NOT_THROUGH
    return SteadyRun(run, start, layout, scenario, status, period_s / 60.0, window)


@dataclass(frozen=True)
class _Rule:
    """How long to run, and which window that gives; none if it is too short."""

    until_s: float
    longest_s: float
    window: Callable[[Run, Start], Window | None]


def _rule_of(scenario: Scenario, model: Model, period_s: float, least_s: float) -> _Rule:
    """Rule of a timetable: of headways, of listed departures, or of both."""
    services = build_services(scenario, model)
    trip_s = max(foreseen_steps(model, each) for each in services) * model.options.step_s
    listed = [entry.headway_min is None for entry in scenario.traffic]
    if all(listed):
        last_s = max(service.departures_s[-1] for service in services)
        return _Rule(
            last_s + trip_s, last_s + LONGEST * trip_s, lambda run, _: _of_all(run, period_s)
        )
    if any(listed):
        return _Rule(period_s, period_s, lambda *_: Window(0.0, period_s, period_s))
    measured_s = period_s * math.ceil(least_s / period_s - ROUNDING)
    first_s = max(service.first_s for service in services) + measured_s
    return _Rule(
        first_s + trip_s,
        first_s + LONGEST * trip_s,
        lambda run, start: _of_periods(run, start, measured_s),
    )


def _of_all(run: Run, period_s: float) -> Window | None:
    """A whole run, once all trains have arrived."""
    has_ended = bool(np.isfinite(arrivals_s(run)).all())
    return Window(0.0, float(run.instants_s[-1]), period_s) if has_ended else None


def _of_periods(run: Run, start: Start, measured_s: float) -> Window | None:
    """So long a time from the instant at which the first train of every service has arrived."""
    h, arrived_s = run.model.options.step_s, _first_arrivals_s(run, start)
    if not math.isfinite(arrived_s):
        return None
    begin_s = math.ceil(arrived_s / h - ROUNDING) * h
    end_s = begin_s + measured_s
    is_run = end_s <= float(run.instants_s[-1]) + ROUNDING * h
    return Window(begin_s, end_s, measured_s) if is_run else None


def _lasting(scenario: Scenario, duration_s: float) -> Scenario:
    """The scenario with another end, and trains on the line at the start wherever they can be placed.

    It has been validated, and neither changes anything else.  On single tracks trains that were placed
    as if they were alone might not come past each other.
    """
    end = {"duration_min": duration_s / 60.0, "until": None}
    changes: dict[str, Any] = {"simulation": scenario.simulation.model_copy(update=end)}
    if not scenario.signalling.has_gates:
        changes["traffic"] = tuple(
            entry.model_copy(update={"already_running": True})
            if entry.headway_min is not None and not entry.initial_trains
            else entry
            for entry in scenario.traffic
        )
    return scenario.model_copy(update=changes)


def _first_arrivals_s(run: Run, start: Start) -> float:
    """When the first train of every service has arrived; infinite if one has not. [s]"""
    firsts = {service.name_of(1) for service in start.services}
    arrived = {
        train.name: time_s
        for train, time_s in zip(run.trains, arrivals_s(run).tolist(), strict=True)
        if train.name in firsts and math.isfinite(time_s)
    }
    return max(arrived.values()) if len(arrived) == len(firsts) else math.inf
