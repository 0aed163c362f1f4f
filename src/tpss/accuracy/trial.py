"""A scenario that is run with one step after another, of which only the key figures are kept."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from tpss.accuracy.changes import Change, changes_between
from tpss.errors import ScenarioError, TooLargeError
from tpss.model.build import at_step
from tpss.model.start import start_of
from tpss.results.key_figures import Frame, KeyFigures, run_for_figures
from tpss.run.run import INTERRUPTED, Clock, Progress
from tpss.run.start import Start
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model


@dataclass(frozen=True)
class Trial:
    """A scenario and its model, to be run at any step."""

    scenario: Scenario
    model: Model
    clock: Clock
    frame: Frame
    interrupted: Sequence[int] | None = None
    """Runs end early once it is filled."""
    report: Callable[[Progress], None] | None = None
    """Called with the progress of each run."""

    def start(self, step_min: float) -> Start | None:
        """What a run at a step begins with.

        None if a train could not stop in time in such steps, or if there is too little memory.
        """
        try:
            model = at_step(self.model, self.scenario, 60.0 * step_min)
            return start_of(self.scenario, model)
        except (ScenarioError, TooLargeError):
            return None

    def run(self, step_min: float, most: float = math.inf) -> KeyFigures | None:
        """Key figures at a step; None if they are not to be had.

        That is so if it cannot start, would take more than `most` trains times steps or outgrow the
        memory, or is interrupted.
        """
        start = self.start(step_min)
        if start is None or start.capacity * len(start.trains) > most:
            return None
        try:
            figures = run_for_figures(
                start, self.frame, self.clock, interrupted=self.interrupted, report=self.report
            )
        except TooLargeError:
            return None
        return None if figures.status == INTERRUPTED else figures

    def changes(self, figures: KeyFigures, finer: KeyFigures) -> tuple[Change, ...]:
        """What moves from a run to that with half its step."""
        return changes_between(figures, finer, self._no_load_kv)

    @cached_property
    def _no_load_kv(self) -> float:
        return max(station.no_load_voltage_kv for station in self.scenario.supply.stations)
