"""Prediction intervals, calibrated on cases that the members have not seen."""

import math

import numpy as np

from tpss.approximator.network import Array

COVERED = 0.9
"""Share of cases that are to lie inside their intervals."""

LEAST_ERROR = 1e-5
"""Least scaled error: logarithms of smaller ones would dominate, and mean nothing."""


def log_sizes(errors: Array) -> Array:
    """Logarithms of the sizes of errors, which the networks of the noise are fitted to."""
    return np.asarray(np.log(np.maximum(np.abs(errors), LEAST_ERROR)))


USUAL = 0.9
"""Share of the trained cases in which the members disagree no more than usual."""


def usual_spread(log_noise: Array, spread: Array) -> float:
    """How far the members disagree at most in most cases, in sizes of the errors."""
    return float(np.quantile(spread / np.exp(log_noise), USUAL))


def deviation(log_noise: Array, spread: Array, usual: float) -> Array:
    """Expected deviation of predictions, up to a factor.

    That is the size of the errors for cases not seen: the effect of what the inputs do not describe,
    such as the order of the gradients, which is larger on some lines than on others.  Where the members
    of the ensemble disagree more than usual, as where cases are few, it increases with the disagreement.
    """
    return np.asarray(np.maximum(np.exp(log_noise), spread / usual))


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
