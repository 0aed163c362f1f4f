"""What both parts of the slow audit need: the largest error, and the lengths of the intervals."""

from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.run.run import Outcome
from tpss.step.model import Model

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


def largest(values: npt.NDArray[Any]) -> float:
    """Largest magnitude; NaN, which no limit admits, if one of the values is NaN."""
    return float(np.abs(values).max(initial=0.0))


def nan_is_largest(value: float) -> float:
    return np.inf if np.isnan(value) else value


def intervals_s(outcome: Outcome, model: Model) -> Floats:
    """Lengths of the steps: all alike, but the last one may end with the studied train's arrival. [s]"""
    each_s = np.full(outcome.steps, model.options.step_s)
    each_s[-1:] = np.where(
        np.isclose(np.diff(outcome.instants_s)[-1:], each_s[-1:], rtol=1e-9, atol=0.0),
        each_s[-1:],
        np.diff(outcome.instants_s)[-1:],
    )
    return each_s
