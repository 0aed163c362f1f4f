"""Series of values that hold for a while, and their exact means over any intervals."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tpss.measured.quantities import Floats

WHOLE = 1e-6
"""Share of an interval that may be lacking although it counts as known: roundings of times."""


@dataclass(frozen=True, eq=False)
class Held:
    """Values, each of which holds from a beginning to an end; between them nothing is known.

    Attributes
    ----------
    begin_s, end_s : Floats, shape (n,)
        Times, rising; no value begins before the one before it ends. [s]
    values : Floats, shape (n,)
        NaN: not known.
    """

    begin_s: Floats
    end_s: Floats
    values: Floats

    @property
    def known(self) -> "Held":
        """Those of the values that are known."""
        there = np.isfinite(self.values)
        return Held(self.begin_s[there], self.end_s[there], self.values[there])

    @cached_property
    def _integrals(self) -> tuple[Floats, Floats, Floats]:
        """Times, and the integrals of the values and of the time in which they are known up to these."""
        width_s = self.end_s - self.begin_s
        there = np.isfinite(self.values)
        areas = np.where(there, self.values, 0.0) * width_s
        known_s = np.where(there, width_s, 0.0)
        times_s = np.column_stack([self.begin_s, self.end_s]).ravel()
        return times_s, _stairs(areas), _stairs(known_s)

    def means(self, begin_s: Floats, end_s: Floats) -> Floats:
        """Means over intervals, integral over length; NaN unless the series is known all through.

        Where the series is constant between two times, its integral is a straight line, so the means are
        exact, and intervals that follow each other keep the integral: energy is neither made nor lost.
        """
        times_s, area, known_s = self._integrals
        length_s = end_s - begin_s
        integral = np.interp(end_s, times_s, area) - np.interp(begin_s, times_s, area)
        known = np.interp(end_s, times_s, known_s) - np.interp(begin_s, times_s, known_s)
        return np.where(known >= (1.0 - WHOLE) * length_s, integral / length_s, np.nan)


def _stairs(parts: Floats) -> Floats:
    """Sums at the beginning and the end of each part, which are level between two parts."""
    after = np.cumsum(parts)
    return np.column_stack([after - parts, after]).ravel()
