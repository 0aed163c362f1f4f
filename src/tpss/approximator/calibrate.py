"""Intervals that hold what they say: measured on cases that the members have not seen."""

import math

import numpy as np

from tpss.approximator.network import Array

COVERED = 0.9
"""Share of cases that shall lie inside their intervals."""

LEAST_ERROR = 1e-5
"""Errors below this, scaled, say nothing of those to come: their logarithms would run away."""


def log_sizes(errors: Array) -> Array:
    """Logarithms of the sizes of errors, which the networks of the noise are fitted to."""
    found: Array = np.log(np.maximum(np.abs(errors), LEAST_ERROR))
    return found


def deviation(log_noise: Array, spread: Array) -> Array:
    """How far predictions may be off, up to a factor.

    Two parts: what the inputs leave open, such as the order of the gradients, which is more on some
    lines than on others; and what the members of the ensemble do not agree on, which grows where
    cases are few.
    """
    found: Array = np.hypot(np.exp(log_noise), spread)
    return found


def factor_of(errors: Array, deviations: Array) -> float:
    """Half an interval in deviations, so that it holds `COVERED` of the cases (conformal prediction).

    Parameters
    ----------
    errors, deviations : array, shape (cases,)
        Of predictions by members, of figures and of noise, that have not seen the case.
    """
    ratios = np.sort(np.abs(errors) / deviations)
    # The rank of split conformal prediction: the new case is one more among these.
    rank = math.ceil(COVERED * (len(ratios) + 1)) - 1
    return float(ratios[min(rank, len(ratios) - 1)])
