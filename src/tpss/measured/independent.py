"""How well a mean is known from values that follow each other, and so are alike."""

import math
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from tpss.measured.quantities import Floats

WINDOW = 5.0
"""Lags that count, in correlation times: more add noise, fewer leave out what is alike."""

CONFIDENCE = 0.95
"""Probability with which an interval of confidence holds the mean."""

FEWEST = 3.0
"""Independent values below which a mean has no interval."""


class Interval(NamedTuple):
    """An interval of confidence.

    Attributes
    ----------
    low, high : float
        Its ends; NaN where too few values are independent.
    independent : float
        Number of independent values that tell as much.
    """

    low: float
    high: float
    independent: float


def correlation_time(values: Floats) -> float:
    r"""Integrated correlation time of a series, in steps; 1 where the values are independent.

    .. math:: \tau = 1 + 2 \sum_{k=1}^{M} \rho_k

    The sum ends at the first lag :math:`M \ge 5 \tau(M)`, Sokal's automatic window.  A pair of values
    counts if both are known.

    Parameters
    ----------
    values : Floats, shape (n,)
        At equal steps; NaN: not known.

    References
    ----------
    [BayleyHammersley1946]_; [Sokal1997]_, section 3.
    """
    known = np.isfinite(values)
    count = len(values)
    if not known.any():
        return 1.0
    apart = np.where(known, values - values[known].mean(), 0.0)
    spread = float(apart @ apart) / known.sum()
    if spread <= 0.0:
        return 1.0
    tau = 1.0
    for lag in range(1, count):
        pairs = int(np.count_nonzero(known[lag:] & known[:-lag]))
        if pairs:
            mean = float(apart[lag:] @ apart[:-lag]) / pairs
            tau += 2.0 * (1.0 - lag / count) * mean / spread
        if lag >= WINDOW * tau:
            break
    return max(tau, 1.0)


def mean_interval(values: Floats) -> Interval:
    """Interval of confidence, 95 %, of the mean of a series whose values are correlated.

    As many values count as would tell as much if they were independent, their number over the
    correlation time, with Student's distribution.  A mean over a time in which the correlation has not
    decayed looks better known than it is.

    Parameters
    ----------
    values : Floats, shape (n,)
        At equal steps; NaN: not known.
    """
    known = values[np.isfinite(values)]
    independent = len(known) / correlation_time(values)
    if independent < FEWEST:
        return Interval(math.nan, math.nan, independent)
    mean = float(known.mean())
    error = float(known.std()) / math.sqrt(independent - 1.0)
    half = student(independent - 1.0) * error
    return Interval(mean - half, mean + half, independent)


def student(freedom: float, confidence: float = CONFIDENCE) -> float:
    """Two-sided quantile of Student's distribution, which need not have whole degrees of freedom.

    The expansion in their inverse; at 95 % within 0.2 % from 3 degrees on, 0.7 % too low at 2.

    References
    ----------
    [AbramowitzStegun1964]_, 26.7.5.
    """
    x = NormalDist().inv_cdf(0.5 + confidence / 2.0)
    terms = (
        x,
        (x**3 + x) / 4.0,
        (5 * x**5 + 16 * x**3 + 3 * x) / 96.0,
        (3 * x**7 + 19 * x**5 + 17 * x**3 - 15 * x) / 384.0,
        (79 * x**9 + 776 * x**7 + 1482 * x**5 - 1920 * x**3 - 945 * x) / 92160.0,
    )
    return sum(term / freedom**power for power, term in enumerate(terms))
