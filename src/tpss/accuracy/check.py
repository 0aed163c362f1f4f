"""The check of a run's step: the same run with half of it, and the step that would do."""

from dataclasses import dataclass
from typing import Any

from tpss.accuracy.changes import Change
from tpss.accuracy.trial import Trial
from tpss.results.key_figures import KeyFigures
from tpss.run.run import INTERRUPTED

MOST_HALVINGS = 3
"""Halvings of a step that is too long, in search of one that is not."""

MOST_TRAIN_STEPS = 500_000
"""Trains times steps of a run in that search; it takes about half a second."""

SHORTEST_STEP_MIN = 0.001
"""The shortest step that a scenario may ask for."""

LEAST_SQUARES = "a run by least squares takes too long to be made twice"
FAILED_AUDIT = "the audit of the run failed"
FAILED_AUDIT_OF_HALF = "the audit of the run at half the step failed"
WAS_INTERRUPTED = "it was interrupted"
NOT_TO_BE_HAD = "the run at half the step needs too much memory"


@dataclass(frozen=True)
class StepCheck:
    """What moves at half the step of a run."""

    half_step_min: float
    status: str | None = None
    """How the run at half the step ended; None if there is none."""
    duration_min: float | None = None
    """Its simulated time."""
    changes: tuple[Change, ...] = ()
    within: bool | None = None
    """Whether it ended alike, and all changes are within their limits; None if that is not known."""
    tried_min: tuple[float, ...] = ()
    """Shorter steps that were tried because this one is too long."""
    would_do_min: float | None = None
    """The longest one of them that is short enough."""
    not_made: str | None = None
    """Why there is no check."""

    def as_dict(self) -> dict[str, Any]:
        """The check, of plain types only."""
        changes = [change.as_dict() for change in self.changes]
        return {**vars(self), "changes": changes, "tried_min": list(self.tried_min)}


def check_step(
    figures: KeyFigures, step_min: float, trial: Trial, half: KeyFigures | None = None
) -> StepCheck:
    """Compare a run with that at half its step; look for a shorter step if this one is too long.

    Parameters
    ----------
    figures : KeyFigures
        Of the run.
    step_min : float
        Its step. [min]
    trial : Trial
        Its scenario.
    half : KeyFigures, optional
        Of the run at half the step, if it was made already.
    """
    half_min = step_min / 2.0
    reason = _why_not(figures, trial)
    if reason is None:
        half = half or trial.run(half_min)
        reason = _why_not_with(half, trial)
    if reason is not None or half is None:
        return StepCheck(half_min, not_made=reason)
    within = agree(figures, half, trial)
    tried_min, would_do_min = ((), None) if within else _shorter(half_min, half, trial)
    return StepCheck(
        half_step_min=half_min,
        status=half.status,
        duration_min=half.duration_min,
        changes=trial.changes(figures, half),
        within=within,
        tried_min=tried_min,
        would_do_min=would_do_min,
    )


def agree(figures: KeyFigures, finer: KeyFigures, trial: Trial, strictness: float = 1.0) -> bool:
    """Whether two runs end alike, and all their figures are as close as the limits ask."""
    alike = figures.status == finer.status and finer.audit.passed
    return alike and all(change.within(strictness) for change in trial.changes(figures, finer))


def _why_not(figures: KeyFigures, trial: Trial) -> str | None:
    if trial.scenario.simulation.load_flow == "least-squares":
        return LEAST_SQUARES
    if figures.status == INTERRUPTED:
        return WAS_INTERRUPTED
    return None if figures.audit.passed else FAILED_AUDIT


def _why_not_with(half: KeyFigures | None, trial: Trial) -> str | None:
    if half is None:
        return WAS_INTERRUPTED if trial.interrupted else NOT_TO_BE_HAD
    return None if half.audit.passed else FAILED_AUDIT_OF_HALF


def _shorter(
    step_min: float, figures: KeyFigures, trial: Trial
) -> tuple[tuple[float, ...], float | None]:
    """Steps that were tried, from one whose figures are known, and the first one that would do."""
    tried_min: list[float] = []
    while len(tried_min) < MOST_HALVINGS and step_min >= SHORTEST_STEP_MIN:
        finer = trial.run(step_min / 2.0, MOST_TRAIN_STEPS)
        if finer is None:
            break
        tried_min.append(step_min)
        if agree(figures, finer, trial):
            return tuple(tried_min), step_min
        step_min, figures = step_min / 2.0, finer
    return tuple(tried_min), None
