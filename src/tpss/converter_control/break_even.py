"""Up to which power one converter less loses less."""

import math

import numpy as np

from tpss.results.grid_side import LossLaw
from tpss.results.standards.windows import Floats


def break_even_va(converters: int, law: LossLaw) -> float:
    r"""Apparent power of a station at which all converters lose as much as all but one. [VA]

    Below it one converter less loses less, above it more.  Of losses by coefficients, with :math:`n`
    converters of :math:`a` = idle losses over the rated power,

    .. math:: S^* = S_N \sqrt{n (n-1) \, a / c}

    follows from :math:`n a S_N + c S^2 / (n S_N)` being equal for both numbers; the losses in proportion
    to the power are, always.  On a curve it is found where both change places first.

    Parameters
    ----------
    converters : int
        Number of converters that share alike, at least 2.
    law : LossLaw
        Losses of each, while the railway is fed.

    Returns
    -------
    float
        Infinite: one less always loses less.  0: never.
    """
    if law.curve_load:
        return _on_curve_va(converters, law)
    if law.quadratic == 0.0:
        return math.inf if law.idle_w > 0.0 else 0.0
    idle = law.idle_w / law.rating_va
    return law.rating_va * math.sqrt(converters * (converters - 1) * idle / law.quadratic)


def _on_curve_va(converters: int, law: LossLaw) -> float:
    """Where one less begins to lose more: the difference is straight between points of both curves."""
    fewer, loads = converters - 1, np.array(law.curve_load)
    points = np.unique(np.concatenate([converters * loads, fewer * loads])) * law.rating_va
    points = np.append(points, 2.0 * points[-1])
    more_w = station_losses_w(points, fewer, law) - station_losses_w(points, converters, law)
    above = np.flatnonzero(more_w >= 0.0)
    if above.size == 0:
        return math.inf
    k = int(above[0])
    if k == 0:
        return 0.0
    share = more_w[k - 1] / (more_w[k - 1] - more_w[k])
    return float(points[k - 1] + share * (points[k] - points[k - 1]))


def station_losses_w(apparent_va: Floats, converters: int, law: LossLaw) -> Floats:
    """Losses of converters that share a power alike, while the railway is fed. [W]"""
    loading = apparent_va / (converters * law.rating_va)
    by_load = law.by_load_w(loading, np.zeros(loading.shape, dtype=np.bool_))
    return np.asarray(converters * (law.idle_w + by_load))
