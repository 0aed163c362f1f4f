"""The step of a scenario that does not give one."""

from dataclasses import dataclass
from typing import Any

from tpss.accuracy.changes import LARGEST
from tpss.accuracy.check import agree
from tpss.accuracy.trial import MOST_TRAIN_STEPS, Trial
from tpss.results.key_figures import KeyFigures
from tpss.scenario.scenario import Scenario

LADDER_MIN = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
"""Steps that are tried, the longest one first."""

STRICTNESS = 0.3
"""Share of the limits of a check that a step has to keep to be chosen: 0.3 % of times and energies, as
the limit of their changes is 1 %. [1]"""


@dataclass(frozen=True)
class StepChoice:
    """The step that was chosen, and how."""

    step_min: float
    tried_min: tuple[float, ...]
    """Steps that were tried; none if a run takes too long to be tried."""
    within: bool
    """Whether it is short enough; otherwise it is the shortest one that could be tried, if any."""
    half: KeyFigures | None
    """Of the run at half of it, if it was made."""

    def as_dict(self) -> dict[str, Any]:
        """How it was chosen, of plain types only."""
        return {
            "tried_min": list(self.tried_min),
            "largest_share": STRICTNESS * LARGEST,
            "within": self.within,
        }


def with_step(scenario: Scenario, step_min: float = LADDER_MIN[-1]) -> Scenario:
    """A scenario with a step if it gives none, by default with the shortest one.

    That is enough to find faults: what a train can do in long steps it can do in short ones.
    """
    if scenario.simulation.time_step_min is not None:
        return scenario
    return scenario.with_({"simulation.time_step_min": step_min})


def choose_step(trial: Trial) -> StepChoice:
    """The longest step of the ladder whose figures keep close to those at half of it."""
    known: dict[float, KeyFigures | None] = {}

    def figures_at(step_min: float) -> KeyFigures | None:
        if step_min not in known:
            known[step_min] = trial.run(step_min, MOST_TRAIN_STEPS)
        return known[step_min]

    taken: StepChoice | None = None
    for place, step_min in enumerate(LADDER_MIN, start=1):
        figures, finer = figures_at(step_min), figures_at(step_min / 2.0)
        tried_min = LADDER_MIN[:place]
        if figures is not None and finer is not None:
            within = agree(figures, finer, trial, STRICTNESS)
            taken = StepChoice(step_min, tried_min, within, finer)
            if within:
                break
    if taken is not None:
        return taken
    startable = (step_min for step_min in LADDER_MIN if trial.start(step_min) is not None)
    return StepChoice(next(startable, LADDER_MIN[-1]), (), within=False, half=None)
