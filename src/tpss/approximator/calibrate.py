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


USUAL = 0.9
"""Share of the trained cases in which the members disagree no more than usual."""


def usual_spread(log_noise: Array, spread: Array) -> float:
    """How far the members disagree at most in most cases, in sizes of the errors."""
    return float(np.quantile(spread / np.exp(log_noise), USUAL))


def deviation(log_noise: Array, spread: Array, usual: float) -> Array:
    """How far predictions may be off, up to a factor.

    That is the size of the errors for cases not seen: what the inputs leave open, such as the order
    of the gradients, which is more on some lines than on others.  Where the members of the ensemble
    disagree more than usual, as they do where cases are few, it grows with their disagreement.
    """
    found: Array = np.maximum(np.exp(log_noise), spread / usual)
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
