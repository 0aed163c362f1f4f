r"""Curves through points: monotone cubic interpolation in one variable (PCHIP).

Between two points a curve is the cubic that has their values and slopes.  With the secant
:math:`d = (f_1 - f_0)/h`, :math:`s = x - x_0`,

.. math:: f = f_0 + s \Big(m_0 + s \Big(\frac{3 d - 2 m_0 - m_1}{h}
              + s \frac{m_0 - 2 d + m_1}{h^2}\Big)\Big)

The slope at a point is a weighted harmonic mean of the secants on either side, or zero where they
differ in sign: the derivative is continuous, and a curve neither overshoots its points nor ripples
between them.  Beyond its ends a curve keeps its outer values.

Points of all curves lie in one array; a `Curve` says where its own begin.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.record import Record, Records

Array = npt.NDArray[np.float64]


class CurvePoint(Record):
    """A point of a curve."""

    x: float
    """Where it is."""
    value: float
    """Value there."""
    slope: float
    """Slope of the curve there."""


class Curve(Record):
    """Place of a curve in the array of all points; one point makes a constant."""

    first: int = 0
    """Its first point."""
    points: int = 0
    """Number of its points; 0: there is no curve."""


Points = Records[CurvePoint]
"""Points of all curves."""


@kernel
def _end_slope(step: float, next_step: float, secant: float, next_secant: float) -> float:
    """Slope at the end of a curve, from its last two pieces, counted from the end.

    A parabola through three points, cut where it would not keep the monotony.

    References
    ----------
    [Moler2004]_, section 3.6, ``pchiptx``.
    """
    slope = ((2.0 * step + next_step) * secant - step * next_secant) / (step + next_step)
    if slope * secant <= 0.0:
        return 0.0
    if secant * next_secant < 0.0 and abs(slope) > 3.0 * abs(secant):
        return 3.0 * secant
    return slope


@inlined
def slope_at(k: int, count: int, x: Array, value: Array) -> float:
    r"""Slope of a curve at its `k`-th point.

    .. math:: \frac{w_1 + w_2}{m_k} = \frac{w_1}{d_{k-1}} + \frac{w_2}{d_k}, \quad
              w_1 = 2 h_k + h_{k-1}, \; w_2 = h_k + 2 h_{k-1}

    Parameters
    ----------
    k, count : int
        The point, and how many of the arrays' entries are points.
    x, value : Array
        Where the points are, ascending, and their values.

    References
    ----------
    [FritschButland1984]_; at the ends [Moler2004]_.
    """
    if count == 1:
        return 0.0
    if count == 2:
        return (value[1] - value[0]) / (x[1] - x[0])
    i = min(max(k, 1), count - 2)
    before, after = x[i] - x[i - 1], x[i + 1] - x[i]
    secant = (value[i] - value[i - 1]) / before
    next_secant = (value[i + 1] - value[i]) / after
    if k < i:
        return _end_slope(before, after, secant, next_secant)
    if k > i:
        return _end_slope(after, before, next_secant, secant)
    if secant * next_secant <= 0.0:
        return 0.0
    w1, w2 = 2.0 * after + before, after + 2.0 * before
    return (w1 + w2) / (w1 / secant + w2 / next_secant)


@kernel
def hermite(
    distance: float, step: float, value: float, next_value: float, slope: float, next_slope: float
) -> tuple[float, float]:
    """Value and slope of a cubic between two points, at a distance behind the first one.

    References
    ----------
    [FritschCarlson1980]_.
    """
    secant = (next_value - value) / step
    square = (3.0 * secant - 2.0 * slope - next_slope) / step
    cube = (slope - 2.0 * secant + next_slope) / (step * step)
    return (
        value + distance * (slope + distance * (square + distance * cube)),
        slope + distance * (2.0 * square + 3.0 * distance * cube),
    )


@inlined
def steepest_between(
    step: float, value: float, next_value: float, slope: float, next_slope: float
) -> float:
    """Bound of the magnitude of a cubic's slope between two points.

    The slope is a parabola; a parabola lies within its Bézier points, which are the slopes at both
    ends and 3 d - m₀ - m₁.

    References
    ----------
    [FritschCarlson1980]_, the derivative of its cubic.
    """
    secant = (next_value - value) / step
    return max(abs(slope), abs(next_slope), abs(3.0 * secant - slope - next_slope))


@inlined
def _piece_at(x: float, low: int, high: int, points: Points) -> int:
    """The last of the points from `low` to `high` - 1 that is not beyond `x`."""
    while high - low > 1:
        middle = (low + high) // 2
        if points[middle].x <= x:
            low = middle
        else:
            high = middle
    return low


@kernel
def curve_slope(x: float, first: int, count: int, points: Points) -> float:
    """Slope of the curve of `count` points from `first` on; 0 beyond its ends.

    References
    ----------
    [FritschCarlson1980]_.
    """
    last = first + count - 1
    if x <= points[first].x or x >= points[last].x:
        return 0.0
    low = _piece_at(x, first, last, points)
    before, after = points[low], points[low + 1]
    _, slope = hermite(
        x - before.x, after.x - before.x, before.value, after.value, before.slope, after.slope
    )
    return slope


@kernel
def curve_at(x: float, first: int, count: int, points: Points) -> float:
    """Value of the curve of `count` points from `first` on.

    References
    ----------
    [FritschCarlson1980]_.
    """
    low, high = first, first + count - 1
    if x <= points[low].x:
        return points[low].value
    if x >= points[high].x:
        return points[high].value
    low = _piece_at(x, low, high, points)
    before, after = points[low], points[low + 1]
    value, _ = hermite(
        x - before.x, after.x - before.x, before.value, after.value, before.slope, after.slope
    )
    # The cubic is monotone; a rounding beyond its ends would make a power factor of more than 1.
    lower, higher = min(before.value, after.value), max(before.value, after.value)
    return min(max(value, lower), higher)


@inlined
def extremes(curve: Curve, points: Points) -> tuple[float, float]:
    """Lowest and highest value of a curve, which it has at its points.

    References
    ----------
    [FritschCarlson1980]_: between two points it is monotone.
    """
    low = high = points[curve.first].value
    for k in range(curve.first + 1, curve.first + curve.points):
        low, high = min(low, points[k].value), max(high, points[k].value)
    return low, high


@kernel
def outside_curve(x: float, curve: Curve, points: Points) -> bool:
    """Whether a curve of more than one point keeps its outer value at `x`."""
    first, last = points[curve.first], points[curve.first + curve.points - 1]
    return curve.points > 1 and (x < first.x or x > last.x)
