"""Intervals that hold what they say: measured on cases that the members have not seen."""

import math

import numpy as np

from tpss.approximator.approximator import deviation
from tpss.approximator.network import Array

COVERED = 0.9
"""Share of cases that shall lie inside their intervals."""


def noise_and_factor(errors: Array, spread: Array) -> tuple[float, float]:
    """Noise of an output, and half its interval in standard deviations (conformal prediction).

    An error has two parts: what the inputs leave open, the same everywhere, and what the members of
    the ensemble do not agree on, which grows where cases are few.  The half interval is as many of
    their common standard deviations as `COVERED` of the unseen cases stayed within.

    Parameters
    ----------
    errors : array, shape (cases,)
        Errors for unseen cases, scaled.
    spread : array, shape (cases,)
        Standard deviation over the members, scaled.
    """
    noise = math.sqrt(max(float(np.mean(errors**2) - np.mean(spread**2)), 0.0))
    ratios = np.sort(np.abs(errors) / np.maximum(deviation(spread, noise), 1e-300))
    # The rank of split conformal prediction: the new case is one more among these.
    rank = math.ceil(COVERED * (len(ratios) + 1)) - 1
    return noise, float(ratios[min(rank, len(ratios) - 1)])
