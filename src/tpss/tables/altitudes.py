"""Gradients from altitudes."""

from bisect import bisect_right
from collections.abc import Sequence
from itertools import accumulate, pairwise

DECIMALS = 6
"""Of gradients [‰]: what is beyond is rounding of the altitudes."""


def gradients_of(positions_km: Sequence[float], altitudes_m: Sequence[float]) -> list[float]:
    """Gradients from each position to the next one, that of the last pair from the last one too. [‰]

    Parameters
    ----------
    positions_km : sequence of float
        Ascending, at least two. [km]
    altitudes_m : sequence of float
        [m]
    """
    points = zip(positions_km, altitudes_m, strict=True)
    rises = [
        round((high - low) / (end - begin), DECIMALS)
        for (begin, low), (end, high) in pairwise(points)
    ]
    return [*rises, rises[-1]]


def smoothed(
    positions_km: Sequence[float], altitudes_m: Sequence[float], length_km: float
) -> tuple[list[float], list[float]]:
    """Positions one length apart, and means of the altitude over that length around each. [km], [m]

    Nearer to an end than half the length the mean is over as much on both sides as there is, so that
    both ends keep their altitudes.  Between its points the altitude is a straight line.

    Parameters
    ----------
    positions_km : sequence of float
        Ascending, at least two. [km]
    altitudes_m : sequence of float
        [m]
    length_km : float
        [km]
    """
    points = list(zip(positions_km, altitudes_m, strict=True))
    areas = [0.5 * (low + high) * (end - begin) for (begin, low), (end, high) in pairwise(points)]
    before = list(accumulate(areas, initial=0.0))

    def altitude(at_km: float) -> float:
        k = min(bisect_right(positions_km, at_km), len(points) - 1) - 1
        (begin, low), (end, high) = points[k], points[k + 1]
        return low + (high - low) * (at_km - begin) / (end - begin)

    def area(until_km: float) -> float:
        k = min(bisect_right(positions_km, until_km), len(points) - 1) - 1
        begin, low = points[k]
        return before[k] + 0.5 * (low + altitude(until_km)) * (until_km - begin)

    def mean(at_km: float) -> float:
        half = min(0.5 * length_km, at_km - positions_km[0], positions_km[-1] - at_km)
        if half <= 0.0:
            return altitude(at_km)
        return (area(at_km + half) - area(at_km - half)) / (2.0 * half)

    begin_km, end_km = positions_km[0], positions_km[-1]
    count = max(1, round((end_km - begin_km) / length_km))
    places = [begin_km + k * (end_km - begin_km) / count for k in range(count)] + [end_km]
    return places, [mean(km) for km in places]
