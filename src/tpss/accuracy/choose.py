"""The step of a scenario that does not give one."""

from dataclasses import dataclass
from typing import Any

from tpss.accuracy.changes import LARGEST
from tpss.accuracy.check import agree
from tpss.accuracy.trial import Trial
from tpss.results.key_figures import KeyFigures
from tpss.scenario.open_step import LADDER_MIN

MOST_TRAIN_STEPS = 2_000_000
"""Trains times steps of a run that is tried; it takes about two seconds."""

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
