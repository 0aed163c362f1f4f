"""Statistics of a line's gradients, as inputs of an approximator: any planner can compute them.

Mean and standard deviation do not say where the steep sections are.  Three weighted means describe what
matters most about that: how steep it is where trains start, towards which end the line climbs, and
whether it climbs far from the feeding stations or near them.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.scenario.line import Line

Array = npt.NDArray[np.float64]

START_KM = 2.0
"""Distance from a start over which a rise costs most time; best of 2 to 12 km on the thesis's line."""


class GradientStatistics(NamedTuple):
    """Statistics of the gradients of a line, positive uphill in the direction of positions. [‰]"""

    mean: float
    deviation: float
    """Standard deviation over the line."""
    steepest: float
    starting: float
    """Mean over the first `START_KM` of the studied train's route, or over all of a shorter one."""
    trend: float
    """Rise of the straight line through the gradients, from the line's beginning to its end."""
    middle: float
    """How much steeper it is far from feeding stations than on average; NaN for a single one."""


class Weights(NamedTuple):
    """Weights of the gradients of all pieces in statistics that are weighted sums."""

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
        Ends of the studied train's route. [km]
    stations_km : sequence of float
        Positions of the feeding stations, ascending. [km]
    """
    edges_km, permille = gradient_profile(line)
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


def gradient_profile(line: Line) -> tuple[Array, Array]:
    """Edges [km] of the pieces of equal gradient over the whole line, and the gradients [‰]."""
    from_km = np.array([gradient.from_km for gradient in line.gradients])
    # The outer gradients continue beyond the ends of the profile.
    from_km[0] = min(from_km[0], line.begins_at_km)
    edges_km = np.clip(np.append(from_km, np.inf), line.begins_at_km, line.end_km)
    return edges_km, np.array([gradient.permille for gradient in line.gradients])


def weights_of(
    edges_km: Array, begin_km: float, end_km: float, stations_km: Sequence[float]
) -> Weights:
    """Weights of the pieces of a line between `edges_km`, from its beginning to its end."""
    share = (edges_km - edges_km[0]) / (edges_km[-1] - edges_km[0])
    start_km = min(START_KM, end_km - begin_km)
    started = np.clip(edges_km, begin_km, begin_km + start_km) / start_km
    return Weights(
        mean=np.diff(share),
        starting=np.diff(started),
        trend=np.diff(_trend(share)),
        middle=np.diff(_middle(edges_km, np.asarray(stations_km)) - share),
    )


def _trend(share: Array) -> Array:
    r"""Cumulative weight of the slope of the straight line that fits gradients g best.

    .. math:: \int_0^1 12 (u - 1/2) \, g(u) \, du

    with the place as a share u of the line.
    """
    return 6.0 * share * (share - 1.0)


def _middle(edges_km: Array, stations_km: Array) -> Array:
    r"""Cumulative weight of a mean by the resistance between a train and the stations at both sides.

    .. math:: \int_0^1 6 u (1 - u) \, g(u) \, du

    between two neighbouring stations, with the place as a share u of the distance from one to the other:
    the resistance of the contact line that a train's current meets is proportional to u (1 - u).
    Several pairs of stations are weighted by their distances.  NaN for a single station.
    """
    distances_km = np.diff(stations_km)
    if len(distances_km) == 0:
        return np.full(len(edges_km), np.nan)
    section = np.clip(np.searchsorted(stations_km, edges_km) - 1, 0, len(distances_km) - 1)
    u = np.clip((edges_km - stations_km[section]) / distances_km[section], 0.0, 1.0)
    before_km = stations_km[section] - stations_km[0]
    counted: Array = (
        before_km + distances_km[section] * u**2 * (3.0 - 2.0 * u)
    ) / distances_km.sum()
    return counted
