"""Curves of a scenario as points in one array."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tpss.numerics.curve import CurvePoint, Points, hermite, slope_at

Array = npt.NDArray[np.float64]


class CurveBook:
    """Collects the points of curves; each curve is known by its first point and their number."""

    def __init__(self) -> None:
        self._points: list[tuple[float, float, float]] = []

    def add(self, at: Sequence[float], value: Sequence[float]) -> tuple[int, int]:
        """Add a curve through points, ascending, and return its place."""
        first, count = len(self._points), len(at)
        where, what = np.array(at, dtype=float), np.array(value, dtype=float)
        slopes = [float(slope_at(k, count, where, what)) for k in range(count)]
        self._points += zip(where.tolist(), what.tolist(), slopes, strict=True)
        return first, count

    def add_constant(self, value: float) -> tuple[int, int]:
        """Add a curve that has the same value everywhere."""
        self._points.append((0.0, value, 0.0))
        return len(self._points) - 1, 1

    def points(self) -> Points:
        """Points of all curves."""
        return CurvePoint.array(self._points)


def interpolate(x: float, at: Array, value: Array) -> Array:
    """Values at `x`, between the first point and the last, of many curves through the same places.

    Parameters
    ----------
    at : Array, shape (n,)
        Places, ascending.
    value : Array, shape (n, ...)
        What the curves are there.
    """
    k = int(np.clip(np.searchsorted(at, x, side="right") - 1, 0, len(at) - 2))
    values_at_x = np.empty(value.shape[1:])
    for place in np.ndindex(values_at_x.shape):
        curve = np.ascontiguousarray(value[(slice(None), *place)])
        slopes = [slope_at(i, len(at), at, curve) for i in (k, k + 1)]
        values_at_x[place], _ = hermite(
            x - at[k], at[k + 1] - at[k], curve[k], curve[k + 1], slopes[0], slopes[1]
        )
    return values_at_x
