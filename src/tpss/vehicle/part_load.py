r"""Efficiency over load: what motors take, and electric brakes give, at a part of their rated power.

Beside the efficiency over speed, η, stands a factor λ over the load, the mechanical power while the
motors work.  Motors take, and brakes offer, over a part s of a step and as means over it,

.. math:: P_{taken} = \frac{P}{\eta \, \lambda(P/s)}, \qquad P_{offered} = P \, \eta \, \lambda(P)

λ is interpolated as other curves are (`numerics.curve`), but with slope 0 at its ends, beyond which the
outer values hold: so its derivative is continuous at all loads.  What is taken rises with P as long as
:math:`\lambda > P \lambda'`, what is offered as long as :math:`\lambda > -P \lambda'`; a table of which
that is not true is refused (`falls_with_power`).
"""

import math
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import hermite, slope_at
from tpss.record import Record

Array = npt.NDArray[np.float64]

MOST_LOADS = 8
"""Points that a curve over load may have: a train's record has so many places."""

MOST_HALVINGS = 60
"""More than the digits of a number."""


class LoadCurve(Record):
    """A factor of the efficiency over the mechanical power."""

    count: int = 0
    """Number of points; 0: the load changes nothing."""
    power_w: Annotated[Array, (MOST_LOADS,)] = (math.inf,) * MOST_LOADS  # type: ignore[assignment]
    """Mechanical power of the points, ascending, then infinite. [W]"""
    factor: Annotated[Array, (MOST_LOADS,)] = (1.0,) * MOST_LOADS  # type: ignore[assignment]
    """λ there. [1]"""
    slope_per_w: Annotated[Array, (MOST_LOADS,)] = (0.0,) * MOST_LOADS  # type: ignore[assignment]
    """Its slope there. [1/W]"""


def slopes_over_load(load: list[float], factor: list[float]) -> list[float]:
    """Slopes of the curve through points: those of any curve between its ends, at these 0."""
    x, value = np.array(load), np.array(factor)
    own: Any = getattr(slope_at, "py_func", slope_at)
    between = [float(own(k, len(load), x, value)) for k in range(1, len(load) - 1)]
    return [0.0, *between, 0.0]


def lay_out_loads(power_w: list[float], factor: list[float]) -> Any:
    """A row of `LoadCurve` for powers [W] and factors of at most `MOST_LOADS` points."""
    spare = MOST_LOADS - len(power_w)
    return LoadCurve.row(
        count=len(power_w),
        power_w=(*power_w, *[math.inf] * spare),
        factor=(*factor, *[factor[-1]] * spare),
        slope_per_w=(*slopes_over_load(power_w, factor), *[0.0] * spare),
    )


def falls_with_power(load: list[float], factor: list[float], sign: float) -> int | None:
    r"""First piece of a curve on which electric power falls as mechanical power rises; None: nowhere.

    It does where :math:`\lambda \mp P \lambda'` is not positive.  On a piece that is a cubic of the
    power, least at one of its ends or where its own derivative is 0.

    Parameters
    ----------
    sign : float
        1 for what motors take, -1 for what electric brakes offer.
    """
    slope = slopes_over_load(load, factor)
    for k in range(len(load) - 1):
        step = load[k + 1] - load[k]
        secant = (factor[k + 1] - factor[k]) / step
        square = (3.0 * secant - 2.0 * slope[k] - slope[k + 1]) / step
        cube = (slope[k] - 2.0 * secant + slope[k + 1]) / step**2
        piece = np.polynomial.Polynomial([factor[k], slope[k], square, cube])
        rising = piece - sign * np.polynomial.Polynomial([load[k], 1.0]) * piece.deriv()
        flat = [complex(root) for root in rising.deriv().roots()]
        places = [z.real for z in flat if z.imag == 0.0 and 0.0 < z.real < step]
        if min(float(rising(place)) for place in (0.0, step, *places)) <= 0.0:
            return k
    return None


@inlined
def range_over_load(curve: LoadCurve) -> tuple[float, float]:
    """Lowest and highest factor of a curve, which it has at its points; 1 where there is none. [1]

    References
    ----------
    [FritschCarlson1980]_: between two points it is monotone.
    """
    if curve.count == 0:
        return 1.0, 1.0
    low = high = curve.factor[0]
    for k in range(1, curve.count):
        low, high = min(low, curve.factor[k]), max(high, curve.factor[k])
    return low, high


@kernel
def factor_at(power_w: float, curve: LoadCurve) -> tuple[float, float]:
    """λ at a mechanical power, and its slope. [1], [1/W]

    References
    ----------
    [FritschCarlson1980]_.
    """
    last = curve.count - 1
    if power_w <= curve.power_w[0]:
        return curve.factor[0], 0.0
    if power_w >= curve.power_w[at(last)]:
        return curve.factor[at(last)], 0.0
    k = 0
    while curve.power_w[at(k + 1)] <= power_w:
        k += 1
    before_w, after_w = curve.power_w[at(k)], curve.power_w[at(k + 1)]
    return hermite(
        power_w - before_w, after_w - before_w,
        curve.factor[at(k)], curve.factor[at(k + 1)],
        curve.slope_per_w[at(k)], curve.slope_per_w[at(k + 1)],
    )  # fmt: skip


@kernel
def taken_at_load(power_w: float, driven_share: float, curve: LoadCurve) -> tuple[float, float]:
    r"""Power that motors would take if the load were all of their losses, and its slope. [W], [1]

    .. math:: \frac{P}{\lambda(P/s)}, \qquad \frac{1}{\lambda} - \frac{P \lambda'}{s \lambda^2}

    Parameters
    ----------
    power_w : float
        Mechanical power of the motors, mean over the step. [W]
    driven_share : float
        Share of the step in which they work, s. [1]
    curve : LoadCurve

    References
    ----------
    [Boullanger2009]_, eq. (2.14), with an efficiency that follows the load.
    """
    if power_w <= 0.0:
        return 0.0, 1.0 / curve.factor[0]
    working_w = power_w / driven_share
    factor, slope = factor_at(working_w, curve)
    return power_w / factor, (1.0 - working_w * slope / factor) / factor


@kernel
def given_share(power_w: float, curve: LoadCurve) -> float:
    """Share of their power that electric brakes would give if the load were all of their losses. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.14), as `taken_at_load`, the other way round.
    """
    if curve.count == 0:
        return 1.0
    factor, _ = factor_at(power_w, curve)
    return factor


@kernel
def power_for(taken_w: float, curve: LoadCurve) -> float:
    """Mechanical power for which motors that work all the time take a power: by bisection. [W]

    References
    ----------
    [Boullanger2009]_, eq. (2.14), as `taken_at_load`, solved for the motors' power.
    """
    if curve.count == 0 or taken_w <= 0.0:
        return taken_w
    lowest, highest = range_over_load(curve)
    low, high = lowest * taken_w, highest * taken_w
    for _ in range(MOST_HALVINGS):
        middle = 0.5 * (low + high)
        if taken_at_load(middle, 1.0, curve)[0] > taken_w:
            high = middle
        else:
            low = middle
    return low
