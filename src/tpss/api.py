"""From a scenario to its result, in one call."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from tpss.model import build_model
from tpss.model.build import Layout, steps_of
from tpss.model.traffic import build_services
from tpss.results.contents import FORMAT, FORMAT_KEY
from tpss.results.dataset import attributes, build_dataset
from tpss.results.key_figures import Frame, frame_of, key_figures_of
from tpss.results.result import Result
from tpss.results.summary import provenance, summarise
from tpss.run.clocks import clock_of
from tpss.run.interrupt import interruptible
from tpss.run.kernels import make_ready
from tpss.run.run import Clock, Progress, Start, advance_to_end, begin, outcome_of, run_of
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model
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
    clock, (model, layout) = _clock_of(scenario), build_model(scenario)
    make_ready(model, clock)
    return _prepared(scenario, clock, model, layout)


def build(scenario: Scenario) -> "Prepared":
    """`prepare` that leaves kernels to be compiled by the run."""
    return _prepared(scenario, _clock_of(scenario), *build_model(scenario))


def _prepared(scenario: Scenario, clock: Clock, model: Model, layout: Layout) -> "Prepared":
    services = build_services(scenario, model)
    duration = scenario.simulation.duration_min
    steps = None
    if duration is not None:
        steps = steps_of(si(scenario.simulation, "duration_min"), model.options.step_s)
    return Prepared(scenario, layout, begin(model, services, steps), clock)


def _clock_of(scenario: Scenario) -> Clock:
    return clock_of(scenario.simulation.load_flow, scenario.source)


@dataclass(frozen=True)
class Prepared:
    """A scenario that is ready to run, any number of times."""

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
        start, model = self.start, self.start.model
        run = run_of(start, self.clock)
        started = time.perf_counter()
        status = advance_to_end(run, start, progress, interrupted)
        elapsed_s = time.perf_counter() - started
        outcome = outcome_of(run, status, start.studied)
        figures = {
            FORMAT_KEY: FORMAT,
            **summarise(
                self.scenario, key_figures_of(run, status, start, self.frame), outcome, model
            ),
            "simulation_s": elapsed_s,
            "provenance": provenance(),
        }
        dataset = build_dataset(outcome, model, self.layout)
        dataset.attrs = attributes(figures, model.options.step_s, run.last_step_s)
        return Result(self.scenario, dataset, figures)
