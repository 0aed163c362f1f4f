r"""A network over the line voltage as a Taylor series, where that is as exact as the network itself.

While a train holds its speed, the line voltage is the only input of its machine's networks that
changes, and from pass to pass and step to step it changes little.  With a the neurons' inputs at the
centre and δ the distance from it,

.. math:: y = b^2 + \sum_{k=0}^{7} c_k \delta^k + R, \quad
          c_k = \sum_n \frac{w^2_n (w^1_n)^k}{k!} f^{(k)}(a_n) .

With p = s(1 - s) and u = 1 - 2s, of s = logsig(a), the derivatives f⁽ᵏ⁾(a) are, from the first on,

    p                              pu
    p(1 - 6p)                      pu(1 - 12p)
    p(1 - 30p + 120p²)             pu(1 - 60p + 360p²)
    p(1 - 126p + 1680p² - 5040p³)  pu(1 - 252p + 5040p² - 20160p³)

The eighth is at most 10.21 p, as p ≤ 1/4, and p, whose logarithm has the slope u, grows by e^d at
most over a distance d of an input.  So, as long as no input moves by more than 1/2,

.. math:: |R| \le \frac{10.21 \, e^{1/2}}{8!} \, |\delta|^8 \sum_n |w^2_n| |w^1_n|^8 p_n .

The series reaches as far as this is below the rounding of the network's own sum, ε Σ |w²|: nothing
is approximated that the network would give more exactly.
"""

from typing import Annotated

import numpy as np
import numpy.typing as npt

from tpss.kernel import fused, kernel
from tpss.numerics.neural_network import (
    NEURONS,
    TAYLOR_TERMS,
    FeedForwardNetwork,
    logsig,
    weigh,
)
from tpss.record import Record

Array = npt.NDArray[np.float64]


class Series(Record):
    """A network over one of its inputs, near one value of it."""

    centre: float
    """The input around which it is made."""
    reach_8: float
    """Eighth power of the distance to which it holds; 0: nowhere."""
    coefficient: Annotated[Array, (TAYLOR_TERMS,)]
    """Of the powers of the distance."""


SCRATCH_SHAPE = (TAYLOR_TERMS, NEURONS)
"""Shape of the scratch array of `make_series`: what each neuron adds to each coefficient."""


@kernel
def make_series(centre: float, network: FeedForwardNetwork, scratch: Array, series: Series) -> None:
    """Make the series of a network around a value of its input `SERIES_INPUT`.

    Parameters
    ----------
    centre : float
        The value.
    network : FeedForwardNetwork
    scratch : Array, shape `SCRATCH_SHAPE`
        Its first row holds the neurons' inputs; its second holds p = s(1 - s) afterwards.
    series : Series
        Written.

    References
    ----------
    [Boullanger2009]_, eq. (B.2) and (B.4), expanded; the proof stands at the top of this file.
    """
    logsig(scratch[0])
    for n in range(NEURONS):
        s = scratch[0, n]
        p, u = s * (1.0 - s), 1.0 - 2.0 * s
        scratch[1, n] = p
        scratch[2, n] = p * u
        scratch[3, n] = p * (1.0 - 6.0 * p)
        scratch[4, n] = p * u * (1.0 - 12.0 * p)
        scratch[5, n] = p * (1.0 - p * (30.0 - p * 120.0))
        scratch[6, n] = p * u * (1.0 - p * (60.0 - p * 360.0))
        scratch[7, n] = p * (1.0 - p * (126.0 - p * (1680.0 - p * 5040.0)))
    for k in range(TAYLOR_TERMS):
        series.coefficient[k] = weigh(network.taylor[k], scratch[k])
    series.coefficient[0] += network.output_bias
    series.centre = centre
    series.reach_8 = 1.0 / max(network.closest_8, weigh(network.remainder, scratch[1]))


@fused
def reaches(value: float, series: Series) -> bool:
    """Whether a series holds at a value of the input."""
    d = value - series.centre
    d2 = d * d
    d4 = d2 * d2
    return bool(d4 * d4 < series.reach_8)


@fused
def series_at(value: float, series: Series) -> tuple[float, float]:
    """The network at a value of its input that the series reaches, and its slope."""
    c, d = series.coefficient, value - series.centre
    d2 = d * d
    d4 = d2 * d2
    # Short sums that do not wait for each other, in place of one long chain.
    low = (c[0] + c[1] * d) + (c[2] + c[3] * d) * d2
    high = (c[4] + c[5] * d) + (c[6] + c[7] * d) * d2
    slope_low = (c[1] + 2.0 * c[2] * d) + (3.0 * c[3] + 4.0 * c[4] * d) * d2
    slope_high = (5.0 * c[5] + 6.0 * c[6] * d) + 7.0 * c[7] * d2
    return low + high * d4, slope_low + slope_high * d4
