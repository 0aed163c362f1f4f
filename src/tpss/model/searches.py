"""Searches of one number: a root, and the place of a lowest value."""

import math
from collections.abc import Callable

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
"""Share by which a section of the golden ratio shortens an interval. [1]"""


def root_between(
    function: Callable[[float], float], low: float, high: float, close: float
) -> float:
    """Root of a function between two places at which its values have opposite signs.

    By secants within bounds; of a bound that stays, half the value is taken (the Illinois rule), so that
    both of them close in [Dowell1971]_.

    Parameters
    ----------
    function : callable
        Finite at both places.
    low, high : float
        The places.
    close : float
        Places that are closer to each other are the same.

    References
    ----------
    [Dowell1971]_
    """
    at_low, at_high, side = function(low), function(high), 0
    while abs(high - low) > close and at_low != 0.0 and at_high != 0.0:
        middle = high - at_high * (high - low) / (at_high - at_low)
        if not low < middle < high:  # a rounding, next to a bound
            middle = (low + high) / 2.0
        value = function(middle)
        if (value > 0.0) == (at_high > 0.0):
            high, at_high = middle, value
            at_low, side = (at_low / 2.0 if side > 0 else at_low), 1
        else:
            low, at_low = middle, value
            at_high, side = (at_high / 2.0 if side < 0 else at_high), -1
    return low if abs(at_low) < abs(at_high) else high


def lowest_between(
    function: Callable[[float], float], low: float, high: float, close: float
) -> float:
    """Place of the lowest value of a function with one valley, by sections of the golden ratio.

    Parameters are those of `root_between`.
    """
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    while high - low > close:
        if at_left <= at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = function(right)
    return left if at_left <= at_right else right
