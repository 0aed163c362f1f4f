"""From a scenario to its result, in one call."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from tpss.accuracy.check import StepCheck, check_step
from tpss.accuracy.choose import StepChoice, choose_step
from tpss.accuracy.trial import Trial
from tpss.events import is_heard, tell
from tpss.model import build_model
from tpss.model.build import Layout, at_step
from tpss.model.start import start_of
from tpss.results.contents import FORMAT, FORMAT_KEY
from tpss.results.converter_losses import converter_losses, describes_losses, totals
from tpss.results.dataset import attributes, build_dataset
from tpss.results.key_figures import Frame, KeyFigures, frame_of, key_figures_of
from tpss.results.notes import notes
from tpss.results.result import Result
from tpss.results.storage import has_stores, storage
from tpss.results.storage import totals as totals_of_stores
from tpss.results.summary import provenance, summarise
from tpss.run.clocks import clock_of
from tpss.run.interrupt import interruptible
from tpss.run.kernels import make_ready
from tpss.run.protection import run_to_end
from tpss.run.run import Clock, Progress, Run, outcome_of
from tpss.run.start import Start
from tpss.run.stiff import LostTime, lost_to_voltage
from tpss.scenario.load import load_scenario
from tpss.scenario.open_step import LADDER_MIN, with_step
from tpss.scenario.scenario import Scenario


def simulate(
    scenario: Scenario | str | Path,
    progress: Callable[[Progress], None] | None = None,
    *,
    step_check: bool = False,
    lost_time: bool = False,
) -> Result:
    """Simulate trains and power supply together.

    Parameters
    ----------
    scenario : Scenario or path
        A scenario, or its file.  Without a time step, the longest one is taken whose figures keep close
        to those at half of it.
    progress : callable, optional
        Called several times a second with the `Progress` of the run, and of its check.
    step_check : bool
        Whether to make the run again with half its step, for its key figures only: what moves is then
        in the summary, as ``step_check``.
    lost_time : bool
        Whether to make the run again at the supply's voltage without load: what trains lost to the
        voltage is then in the summary, as ``lost_time``.

    Returns
    -------
    Result
        Its ``status`` says whether the run finished; a line that cannot carry its load or a train
        that stalls ends it early, and so does a Ctrl-C, with everything up to then kept.

    Raises
    ------
    ScenarioError
        The file has faults, a train that the scenario places on the line could not stop or slow down in
        time, or scipy is missing for ``load_flow = "least-squares"``.
    """
    prepared = prepare(scenario)
    with interruptible() as interrupted:
        return prepared.run(progress, interrupted, step_check=step_check, lost_time=lost_time)


def prepare(scenario: Scenario | str | Path) -> "Prepared":
    """Build the model of a scenario and compile the kernels, all that comes before the first step.

    Raises
    ------
    ScenarioError, TooLargeError
        As `simulate`.
    """
    if not isinstance(scenario, Scenario):
        scenario = load_scenario(scenario)
    return _prepared(scenario, compiled=True)


def build(scenario: Scenario) -> "Prepared":
    """`prepare` that leaves kernels to be compiled by the run."""
    return _prepared(scenario, compiled=False)


def _prepared(scenario: Scenario, compiled: bool) -> "Prepared":
    clock = _clock_of(scenario)
    as_built = with_step(scenario, LADDER_MIN[0])
    model, layout = build_model(as_built)
    if compiled:
        make_ready(model, clock)
    if scenario.simulation.time_step_min is not None:
        return Prepared(scenario, layout, start_of(scenario, model), clock)
    choice = choose_step(Trial(as_built, model, clock, frame_of(as_built, layout, model)))
    chosen = with_step(scenario, choice.step_min)
    model = at_step(model, chosen, 60.0 * choice.step_min)
    return Prepared(chosen, layout, start_of(chosen, model), clock, choice)


def _clock_of(scenario: Scenario) -> Clock:
    return clock_of(scenario.simulation.load_flow, scenario.given_source)


def _tell_end(result: Result) -> None:
    """Tell those who listen how a run ended."""
    # Not the summary, whose evidence for standards takes as long as a short run.
    name, figures, audit = result.scenario.name, result.figures, result.audit
    remarks = notes(result) if audit["passed"] and is_heard("note") else []
    for remark in remarks:
        tell("note", scenario=name, note=remark)
    tell(
        "simulated",
        scenario=name,
        notes=len(remarks),
        limited=sum(figures["limited"].values()),
        **{key: figures[key] for key in ("status", "duration_min", "simulation_s")},
    )
    if not audit["passed"]:
        tell("audit failed", scenario=name, failures="; ".join(audit["failures"]))


def _in_check(
    progress: Callable[[Progress], None] | None,
) -> Callable[[Progress], None] | None:
    """What is told of a run that checks another one, where anybody listens."""
    if progress is None:
        return None
    return lambda state: progress(replace(state, in_check=True))


@dataclass(frozen=True)
class Prepared:
    """A scenario that is ready to run, any number of times."""

    scenario: Scenario
    """With the step that was chosen, if it gave none."""
    layout: Layout
    start: Start
    clock: Clock
    choice: StepChoice | None = None
    """How the step was chosen, if it was."""

    @cached_property
    def frame(self) -> Frame:
        """What the key figures are measured by."""
        return frame_of(self.scenario, self.layout, self.start.model)

    def run(
        self,
        progress: Callable[[Progress], None] | None = None,
        interrupted: Sequence[int] | None = None,
        *,
        step_check: bool = False,
        lost_time: bool = False,
    ) -> Result:
        """Result of the run.

        Parameters
        ----------
        progress : callable, optional
            Called several times a second with the `Progress` of the run, and of its check.
        interrupted : sequence of int, optional
            The run, or its check, ends early once it is filled.
        step_check, lost_time : bool
            As of `simulate`.
        """
        start = self.start
        tell("simulating", scenario=self.scenario.name)
        started = time.perf_counter()
        run, status = run_to_end(start, self.clock, report=progress, interrupted=interrupted)
        elapsed_s = time.perf_counter() - started
        outcome, model = outcome_of(run, status, start.studied), run.model
        key_figures = key_figures_of(run, status, start, self.frame)
        check = self.check_step(key_figures, interrupted, progress) if step_check else None
        lost = self.find_lost_time(run, interrupted, progress) if lost_time else None
        figures = {
            FORMAT_KEY: FORMAT,
            **summarise(self.scenario, key_figures, outcome, model),
            "step_choice": self.choice and self.choice.as_dict(),
            "step_check": check and check.as_dict(),
            "lost_time": lost and lost.as_dict(),
            "simulation_s": elapsed_s,
            "provenance": provenance(self.scenario),
        }
        dataset = build_dataset(outcome, model, self.layout)
        dataset.attrs = attributes(figures, model.options.step_s, run.last_step_s)
        if describes_losses(self.scenario):
            table = converter_losses(dataset, self.scenario)
            figures["converter_losses"] = totals(table, dataset, self.scenario)
        if has_stores(dataset):  # a table of none takes as long as a run
            figures["storage"] = totals_of_stores(storage(dataset, self.scenario))
        result = Result(self.scenario, dataset, figures)
        _tell_end(result)
        return result

    def find_lost_time(
        self,
        run: Run,
        interrupted: Sequence[int] | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> LostTime | None:
        """Make the run at the supply's voltage without load, and tell what trains lost.

        Parameters are those of `check_step`.
        """
        if interrupted:
            return None
        stations = self.scenario.supply.stations
        voltage_v = 1e3 * max(station.no_load_voltage_kv for station in stations)
        return lost_to_voltage(run, self.start, voltage_v, _in_check(progress), interrupted)

    def check_step(
        self,
        figures: KeyFigures,
        interrupted: Sequence[int] | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> StepCheck:
        """Make the run with half its step, and tell what moves.

        Parameters
        ----------
        figures : KeyFigures
            Of the run.
        interrupted : sequence of int, optional
            There is no check once it is filled.
        progress : callable, optional
            Called several times a second with the `Progress` of the check.
        """
        trial = Trial(
            self.scenario, self.start.model, self.clock, self.frame, interrupted,
            _in_check(progress),
        )  # fmt: skip
        step_min = self.start.model.options.step_s / 60.0
        half = None if self.choice is None else self.choice.half
        return check_step(figures, step_min, trial, half)
