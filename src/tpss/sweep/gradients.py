"""What an approximator may be told of a line's gradients: numbers that any planner has, or can compute.

Mean and standard deviation leave open where the steep pieces lie.  Three weighted means tell what counts
most of that: how steep it is where trains start, towards which end the line climbs, and whether it
climbs far from the converter stations or near them.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.scenario.line import Line

Array = npt.NDArray[np.float64]

START_KM = 2.0
"""Way from a stand over which a rise costs most time; on the thesis's line the best of 2 to 12 km."""


class GradientStatistics(NamedTuple):
    """Statistics of the gradients of a line, positive uphill in the direction of positions. [‰]"""

    mean: float
    deviation: float
    """Standard deviation over the line."""
    steepest: float
    starting: float
    """Mean over the first `START_KM` of the studied train's way, or over all of it if it is shorter."""
    trend: float
    """Rise of the straight line through the gradients, from the line's beginning to its end."""
    middle: float
    """How much steeper it is far from converter stations than on average; NaN of a single one."""


class Weights(NamedTuple):
    """What the gradient of each piece counts in a statistic that is a sum of them."""

    mean: Array
    starting: Array
    trend: Array
    middle: Array


def gradient_statistics(
    line: Line, begin_km: float, end_km: float, stations_km: Sequence[float]
) -> GradientStatistics:
    """Statistics of the gradients of a line.

    Parameters
    ----------
    line : Line
    begin_km, end_km : float
        Ends of the studied train's way. [km]
    stations_km : sequence of float
        Positions of the converter stations, ascending. [km]
    """
    edges_km, permille = staircase(line)
    weights = weights_of(edges_km, begin_km, end_km, stations_km)
    mean = float(weights.mean @ permille)
    return GradientStatistics(
        mean=mean,
        deviation=math.sqrt(float(weights.mean @ (permille - mean) ** 2)),
        steepest=float(permille[weights.mean > 0.0].max()),
        starting=float(weights.starting @ permille),
        trend=float(weights.trend @ permille),
        middle=float(weights.middle @ permille),
    )


def staircase(line: Line) -> tuple[Array, Array]:
    """Edges [km] of the pieces of equal gradient over the whole line, and the gradients [‰]."""
    from_km = np.array([gradient.from_km for gradient in line.gradients])
    # The outer gradients go on beyond the profile's ends.
    from_km[0] = min(from_km[0], 0.0)
    edges_km = np.clip(np.append(from_km, np.inf), 0.0, line.length_km)
    return edges_km, np.array([gradient.permille for gradient in line.gradients])


def weights_of(
    edges_km: Array, begin_km: float, end_km: float, stations_km: Sequence[float]
) -> Weights:
    """Weights of the pieces of a line between `edges_km`, which begin at 0 and end at its length."""
    share = edges_km / edges_km[-1]
    start_km = min(START_KM, end_km - begin_km)
    started = np.clip(edges_km, begin_km, begin_km + start_km) / start_km
    return Weights(
        mean=np.diff(share),
        starting=np.diff(started),
        trend=np.diff(_trend(share)),
        middle=np.diff(_middle(edges_km, np.asarray(stations_km)) - share),
    )


def _trend(share: Array) -> Array:
    r"""Weight up to a place, of the slope of the straight line that fits gradients g best.

    .. math:: \int_0^1 12 (u - 1/2) \, g(u) \, du

    with the place as a share u of the line.
    """
    return 6.0 * share * (share - 1.0)


def _middle(edges_km: Array, stations_km: Array) -> Array:
    r"""Weight up to a place, of the mean that counts what the stations at both sides see of a train.

    .. math:: \int_0^1 6 u (1 - u) \, g(u) \, du

    between two neighbouring stations, with the place as a share u of the way from one to the other: a
    train's current meets a resistance of the contact line in proportion to u (1 - u).  Of several pairs
    of stations each counts by its distance.  NaN of a single station.
    """
    ways_km = np.diff(stations_km)
    if len(ways_km) == 0:
        return np.full(len(edges_km), np.nan)
    section = np.clip(np.searchsorted(stations_km, edges_km) - 1, 0, len(ways_km) - 1)
    u = np.clip((edges_km - stations_km[section]) / ways_km[section], 0.0, 1.0)
    before_km = stations_km[section] - stations_km[0]
    counted: Array = (before_km + ways_km[section] * u**2 * (3.0 - 2.0 * u)) / ways_km.sum()
    return counted
