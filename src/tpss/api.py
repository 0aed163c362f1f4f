"""From a scenario to its result, in one call."""

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tpss.clock import clock_of
from tpss.compiling import compile_in_parts
from tpss.kernel import kernels_are_compiled
from tpss.model import build_model
from tpss.model.build import Layout, steps_of
from tpss.model.traffic import build_services
from tpss.results import store
from tpss.results.audit import audit
from tpss.results.dataset import build_dataset
from tpss.results.key_figures import Frame, frame_of
from tpss.results.result import Result
from tpss.results.summary import provenance, summarise
from tpss.scenario.scenario import Scenario
from tpss.simulation.interrupt import interruptible
from tpss.simulation.run import (
    Clock,
    Outcome,
    Progress,
    Start,
    begin,
    compile_kernels,
    run_on,
)
from tpss.simulation.state import Model
from tpss.units import si


def simulate(scenario: Scenario, progress: Callable[[Progress], None] | None = None) -> Result:
    """Simulate trains and power supply together.

    Parameters
    ----------
    scenario : Scenario
    progress : callable, optional
        Called several times a second with the `Progress` of the run.

    Returns
    -------
    Result
        Its ``status`` says whether the run finished; a line that cannot carry its load or a train
        that stalls ends it early, and so does a Ctrl-C, with everything up to then kept.

    Raises
    ------
    ScenarioError
        A train that the scenario places on the line could not stop or slow down in time, or scipy
        is missing for ``load_flow = "least-squares"``.
    """
    prepared = prepare(scenario)
    with interruptible() as interrupted:
        return prepared.run(progress, interrupted)


def prepare(scenario: Scenario) -> "Prepared":
    """Build the model of a scenario and compile the kernels, all that comes before the first step.

    Raises
    ------
    ScenarioError, TooLargeError
        As `simulate`.
    """
    if not kernels_are_compiled():
        compile_in_parts(build_model(scenario)[0])
    prepared = build(scenario)
    compile_kernels(prepared.start.model, prepared.clock)
    return prepared


def build(scenario: Scenario) -> "Prepared":
    """`prepare` that leaves kernels to be compiled by the run."""
    clock = clock_of(scenario)
    model, layout = build_model(scenario)
    services = build_services(scenario, model)
    duration = scenario.simulation.duration_min
    steps = None
    if duration is not None:
        steps = steps_of(si(scenario.simulation, "duration_min"), model.options.step_s)
    return Prepared(scenario, layout, begin(model, services, steps), clock)


@dataclass(frozen=True)
class Prepared:
    """A scenario whose run can begin, as often as one likes."""

    scenario: Scenario
    layout: Layout
    start: Start
    clock: Clock

    @cached_property
    def frame(self) -> Frame:
        """What the key figures are measured by."""
        return frame_of(self.scenario, self.layout, self.start.model)

    def run(
        self,
        progress: Callable[[Progress], None] | None = None,
        interrupted: Sequence[int] | None = None,
    ) -> Result:
        """Result of the run; it ends early once `interrupted` is filled."""
        started = time.perf_counter()
        outcome = run_on(self.start, progress, interrupted, self.clock)
        elapsed_s = time.perf_counter() - started
        return _result(self.scenario, outcome, self.start.model, self.layout, elapsed_s)


def _result(
    scenario: Scenario, outcome: Outcome, model: Model, layout: Layout, elapsed_s: float
) -> Result:

    dataset = build_dataset(outcome, model, layout)
    checked = audit(outcome, model, np.array(layout.supply.node_level))
    version = {store.FORMAT_KEY: store.FORMAT}
    summary = {**version, **summarise(scenario, outcome, model, dataset, checked)}
    summary["simulation_s"] = elapsed_s
    summary["provenance"] = provenance()
    energy = summary["station_energy_mwh"]
    dataset.attrs = {
        **version,
        "title": scenario.name,
        "status": outcome.status,
        "time_step_s": model.options.step_s,
        "trip_time_min": summary["trip_time_min"]
        if summary["trip_time_min"] is not None
        else np.nan,
        "station_energy_mwh": np.array(list(energy.values())),
        "losses_mwh": summary["losses_mwh"],
        "audit": json.dumps(summary["audit"]),
        **summary["provenance"],
    }
    result = Result(scenario, dataset, summary)
    summary["standards"] = result.standards.as_dict()
    return result
