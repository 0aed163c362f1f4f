r"""How hard a train brakes at a speed, and the distances that follow.

The highest retardation is one number, or one for each band of speeds: :math:`b_i` from the speed
:math:`u_i` up.  Within a band, braking takes the distance :math:`(v^2 - w^2) / 2 b_i`.  With the highest
of all, b, as the measure, the square

.. math:: q(v) = \sum_i \frac{b}{b_i} \left(\min(v, u_{i+1})^2 - u_i^2\right) , \quad u_i < v ,

takes the place of the speed's own: from v to w it takes :math:`(q(v) - q(w)) / 2 b`, whatever the bands.
With a single one, q is v².
"""

import math
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, fused, inlined
from tpss.record import Record

Array = npt.NDArray[np.float64]

MOST_BANDS = 8
"""Bands that a train's retardation may have: its record has so many places."""


class BrakingBands(Record):
    """The highest retardation over speed, a stair."""

    count: int
    """Number of bands."""
    from_m_s: Annotated[Array, (MOST_BANDS + 1,)]
    """Speeds from which they hold, the first 0; infinite behind the last. [m/s]"""
    retardation_m_s2: Annotated[Array, (MOST_BANDS,)]
    """Highest retardation in each, positive. [m/s²]"""
    square_m2_s2: Annotated[Array, (MOST_BANDS,)]
    """q at the speed from which each holds. [m²/s²]"""


def lay_out_bands(from_m_s: list[float], retardation_m_s2: list[float]) -> Any:
    """A row of `BrakingBands` for speeds [m/s] and retardations [m/s²] of at most `MOST_BANDS`."""
    count, highest = len(from_m_s), max(retardation_m_s2)
    squares = [0.0]
    for low, high, b in zip(from_m_s, from_m_s[1:], retardation_m_s2, strict=False):
        squares.append(squares[-1] + highest / b * (high**2 - low**2))
    spare = MOST_BANDS - count
    return BrakingBands.row(
        count=count,
        from_m_s=(*from_m_s, *[math.inf] * (spare + 1)),
        retardation_m_s2=(*retardation_m_s2, *[highest] * spare),
        square_m2_s2=(*squares, *[math.inf] * spare),
    )


@inlined
def band_above(speed_m_s: float, bands: BrakingBands) -> int:
    """Band of the speeds from this one up."""
    band = 0
    while band + 1 < bands.count and bands.from_m_s[at(band + 1)] <= speed_m_s:
        band += 1
    return band


@inlined
def band_below(speed_m_s: float, bands: BrakingBands) -> int:
    """Band of the speeds from this one down."""
    band = 0
    while band + 1 < bands.count and bands.from_m_s[at(band + 1)] < speed_m_s:
        band += 1
    return band


@fused
def braking_distance(speed_m_s: float, highest_m_s2: float, bands: BrakingBands) -> float:
    """Distance in which a train brakes to a stand; parameters are those of `braking_square`. [m]

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30), in each band.
    """
    return braking_square(speed_m_s, highest_m_s2, bands) / (2.0 * highest_m_s2)


@fused
def braking_square(speed_m_s: float, highest_m_s2: float, bands: BrakingBands) -> float:
    """q of a speed: braking to a stand takes q / 2 b. [m²/s²]

    Parameters
    ----------
    speed_m_s : float
        Speed, at least 0. [m/s]
    highest_m_s2 : float
        Highest retardation of all, b. [m/s²]
    bands : BrakingBands

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30), in each band.
    """
    if bands.count == 1:
        return speed_m_s * speed_m_s
    band = band_above(speed_m_s, bands)
    slower_m_s, share = bands.from_m_s[at(band)], highest_m_s2 / bands.retardation_m_s2[at(band)]
    return bands.square_m2_s2[at(band)] + share * (speed_m_s**2 - slower_m_s**2)
