"""Any scenario has one of four outcomes: a result, an early end that says why, findings, a refusal."""

import math
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss import Result, Scenario, ScenarioError, simulate
from tpss.cli.run import DONE, NO_SOLUTION, exit_code
from tpss.errors import TooLargeError
from tpss.model import build_model
from tpss.model.build import steps_of
from tpss.model.traffic import build_services
from tpss.run.lone import EmptyLine
from tpss.run.run import Progress
from tpss.run.services import Service
from tpss.run.start import foreseen_steps
from tpss.step.model import Model

from .roots import Replay, follow_paths
from .rules import keep_the_rules
from .trips import trips_of

Document = dict[str, Any]

PATIENCE_S = 300.0
"""A case that takes longer of the processor hangs: it should take some hundredths of a second."""

LONGEST_S = 3600.0
"""So does one that takes longer by the clock, however little the processor has done. [s]"""

MOST_STEPS, MOST_TRAINS = 5_000, 200
"""Larger runs, which a spoilt scenario may ask for, are checked but not run.  Nor are runs that become
so large taken to their end: the first train may not arrive for a week, and others fill the line."""

STEP_OF_CHOICE_MIN = 1.0
"""In place of the step of runs that choose their own."""


class BecomesTooLongError(Exception):
    """A run has become larger than was foreseen."""


SMALLEST: Document = {
    "format": 1,
    "name": "smallest",
    "simulation": {"time_step_min": 1.0, "duration_min": 2.0},
    "line": {
        "length_km": 5.0,
        "gradients": [{"from_km": 0.0, "permille": 0.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 1.0}],
    },
    "supply": {
        "frequency_hz": 16.7,
        "catenary": "BT",
        "converter_stations": [
            {"name": "A", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}
        ],
    },
    "trains": {"freight": {"model": "Rc4-freight-1470t"}},
    "traffic": [{"name": "a", "train": "freight", "from": "A", "to": "B", "headway_min": 60.0}],
}


@contextmanager
def patience(document: Document) -> Iterator[None]:
    """End the process, the scenario printed, if a case hangs; a kernel cannot be interrupted."""
    ended = threading.Event()

    def watch() -> None:
        spent_s, begun_s = time.process_time(), time.monotonic()
        while not ended.wait(1.0):
            hangs = time.process_time() - spent_s > PATIENCE_S
            if hangs or time.monotonic() - begun_s > LONGEST_S:
                print(f"hangs: {document!r}", file=sys.stderr, flush=True)
                os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
    try:
        yield
    finally:
        ended.set()


def warm_up() -> None:
    """Compile all kernels, which takes longer than any case may."""
    judge_result(simulate(Scenario.from_document(SMALLEST, "smallest")))


def judge(document: Document) -> str:
    """Check and run a scenario; return the kind of its outcome."""
    with patience(document):
        try:
            scenario = Scenario.from_document(document, "random")
            if scenario.simulation.time_step_min is not None and is_long(scenario):
                return "checked, too long to run"
            result = simulate(scenario, ending_long_ones(scenario))
        except ScenarioError as error:
            return judge_findings(error)
        except TooLargeError:
            return "refused: too large"
        except BecomesTooLongError:
            return "begun, too long to end"
        judge_result(result)
        return result.status


def is_long(scenario: Scenario) -> bool:
    """Whether a run would take more than a moment."""
    model, _ = build_model(scenario)
    services = build_services(scenario, model)
    h = model.options.step_s
    steps = foreseen_steps(model, services[0])
    if scenario.simulation.duration_min is not None:
        steps = steps_of(60.0 * scenario.simulation.duration_min, h)
    on_line = sum(
        foreseen_steps(model, service) * h / service.headway_s
        for service in services
        if service.already_running
    )
    departing = sum(service.departures_before(steps * h) for service in services)
    if steps > MOST_STEPS or on_line + departing > MOST_TRAINS:
        return True
    return any(is_long_under_way(service, model) for service in services if service.already_running)


def is_long_under_way(service: Service, model: Model) -> bool:
    """Whether a train alone on the line takes as many steps, as its machine is all but powerless."""
    line = EmptyLine(model)
    lone = line.train_of(service)
    line.advance(lone, MOST_STEPS)
    return lone.is_under_way(MOST_STEPS)


def ending_long_ones(scenario: Scenario) -> Callable[[Progress], None]:
    """What looks at the progress of a run, and ends it if it becomes too large."""
    step_min = scenario.simulation.time_step_min or STEP_OF_CHOICE_MIN

    def look(progress: Progress) -> None:
        if progress.time_s > 60.0 * step_min * MOST_STEPS or progress.trains > MOST_TRAINS:
            raise BecomesTooLongError

    return look


def judge_findings(error: ScenarioError) -> str:
    """Each finding says where, what, and what to do; the kind is that of the first."""
    for finding in error.findings:
        for part in (finding.file, finding.key, finding.problem, finding.remedy):
            assert part.strip(), finding
    return "finding: " + re.sub(r"-?\d+\S*", "…", error.findings[0].problem)


def judge_result(result: Result) -> None:
    """Everything that a run promises."""
    judge_ending(result)
    keep_the_rules(result)
    judge_roots(result)


def judge_ending(result: Result) -> None:
    """A run that ends early says why, what helps, and has its exit code."""
    if result.status == "finished":
        assert exit_code(result) == DONE, result.audit["failures"]
        return
    assert result.status in ("collapsed", "stalled", "deadlocked")
    assert exit_code(result) == NO_SOLUTION
    assert result.summary["problem"]
    assert result.summary["advice"]


def farthest_off(volts: npt.NDArray[np.float64], again: npt.NDArray[np.float64]) -> float:
    """By how much the voltages of trains that draw anything differ at most, relative to them."""
    drawn = volts > 0.0
    return float(np.abs(again[: drawn.size][drawn] / volts[drawn] - 1.0).max(initial=0.0))


LEAST_DRAWN_W = 1e3
"""Where trains of a line of direct current draw less in all, its voltage is loose: all stations but one
block, and what holds it is their leak, up to a volt within the tolerance of the load flow. [W]"""


def no_answer(share: float, step: int, data: xr.Dataset) -> bool:
    """Whether loads that are raised from zero tell nothing of a step on a line of direct current.

    At the kinks of rectifiers they may get stuck, which says nothing of the whole load.
    """
    drawn_w = np.nansum(np.abs(data.active_power.to_numpy()[step]))
    return share != 1.0 or bool(drawn_w < LEAST_DRAWN_W)


def judge_roots(result: Result) -> None:
    """Some steps again, by raising all loads from zero: the same root, or none where it collapsed."""
    data = result.dataset
    steps, volts = data.sizes["time"] - 1, data.pantograph_voltage.to_numpy()
    picks = {0, steps // 2, steps - 1}
    if (volts > 0.0).any():
        lowest = np.where(volts > 0.0, volts, np.inf).argmin()
        picks.add(int(lowest // volts.shape[1]))
    replay = Replay(result.scenario, steps + 1, trips_of(result))
    for step in sorted(picks & set(range(steps))):
        length_s = data.attrs["last_step_s"] if step == steps - 1 else data.attrs["time_step_s"]
        share, again = replay.root_of_step(step, length_s)
        if math.isnan(share) or (result.scenario.supply.is_direct and no_answer(share, step, data)):
            continue
        assert share == 1.0, f"step {step} is solved, but by raising the loads only {share} of them"
        error = farthest_off(volts[step], again)
        if error >= 1e-6:
            # Stations out of phase feed each other in several ways, and the first of the loads, raised
            # at once, may lead to any: the path from stations made alike says which one counts.
            share, again = replay.root_of_step(step, length_s, follow_paths)
            error = farthest_off(volts[step], again) if share == 1.0 else error
        assert error < 1e-6, f"a false root in step {step}: off by {error}"
    if result.status == "collapsed":
        share, _ = replay.root_of_step(steps, replay.tried_s(steps))
        assert share != 1.0, "the load of the collapse can be carried"
