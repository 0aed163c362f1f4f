"""The offset of a clock: where the measured series fit the simulated ones best."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tpss.measured.held import WHOLE, Held
from tpss.measured.independent import correlation_time
from tpss.measured.quantities import Floats

RESOLUTION_S = 0.01
"""An offset is told in hundredths of a second. [s]"""

MOST_TRIED = 20_000
"""Offsets on either side that are tried at most before the best is refined."""

LEAST_SHARE = 0.5
"""Share of the most measured time that any offset lets compare: with less, an offset does not count."""

INTERPOLATED = 0.1
"""Share of the finer step by which the lowest point of a parabola between whole steps may be wrong."""

LIKELY = 3.841
"""By how much twice the logarithm of the likelihood falls to the ends of an interval of 95 %."""


class Offset(NamedTuple):
    """An offset that was looked for, and how sharply it is found.

    Attributes
    ----------
    seconds : float
        What the clock of the file shows more than that of the run. [s]
    range_s : float
        It was looked for up to this on both sides. [s]
    unexplained : float
        Share of the variance of the measured series that remains in their difference to the run there.
    low_s, high_s : float
        Ends of its interval of confidence, 95 %. [s]
    next_s, next_unexplained : float
        The next best offset, of another valley, and what it leaves unexplained; NaN: there is none. [s]
    at_end : bool
        Whether it lies at an end of the range, so that a better one may lie beyond.
    """

    seconds: float
    range_s: float
    unexplained: float
    low_s: float
    high_s: float
    next_s: float
    next_unexplained: float
    at_end: bool

    @property
    def in_words(self) -> str:
        """The offset in a sentence."""
        side = "behind" if self.seconds < 0.0 else "ahead of"
        where = f"is {abs(self.seconds):.2f} s {side} the run's" if self.seconds else "is the run's"
        text = (
            f"Offset found: the clock of the file {where} (95 %: {self.low_s:+.2f} to "
            f"{self.high_s:+.2f} s; tried: ±{self.range_s:g} s), {100.0 * self.unexplained:.2f} % "
            "unexplained"
        )
        if not math.isnan(self.next_s):
            text += f"; next best {self.next_s:+.2f} s, {100.0 * self.next_unexplained:.1f} %"
        return text


class Misfit:
    """What an offset leaves unexplained: least squares with a free constant for each series.

    Each series counts by its variance, so that units and sizes do not matter, and a constant difference
    does not move the offset.

    Parameters
    ----------
    pairs : sequence of (Held, Held)
        Measured series at no offset, and the simulated ones.
    of_file : bool
        Whether means are taken over the intervals of the file, or over those of the run: of the two
        the longer ones.
    """

    def __init__(self, pairs: Sequence[tuple[Held, Held]], of_file: bool) -> None:
        self.of_file = of_file
        self.pairs = [
            (measured, simulated, float(np.var(measured.known.values)))
            for measured, simulated in pairs
            if len(measured.known.values) > 1 and np.ptp(measured.known.values) > 0.0
        ]

    def differences(self, offset_s: float) -> list[tuple[Floats, Floats]]:
        """Simulated less measured means of each series, and the measured ones, where both are known."""
        found = []
        for measured, simulated, _ in self.pairs:
            if self.of_file:
                values = measured.values
                run = simulated.means(measured.begin_s - offset_s, measured.end_s - offset_s)
            else:
                run = simulated.values
                values = measured.means(simulated.begin_s + offset_s, simulated.end_s + offset_s)
            there = np.isfinite(run) & np.isfinite(values)
            found.append((run[there] - values[there], values[there]))
        return found

    def at(self, offset_s: float) -> tuple[float, int]:
        """Unexplained share at an offset, and how many values are compared; infinite for none."""
        left = total = 0.0
        count = 0
        for (difference, values), (_, _, variance) in zip(
            self.differences(offset_s), self.pairs, strict=True
        ):
            if len(values):
                left += float(np.var(difference)) * len(values) / variance
                total += float(np.var(values)) * len(values) / variance
                count += len(values)
        return (left / total if total > 0.0 else math.inf), count

    def independent(self, offset_s: float) -> float:
        """Most independent values of a series' difference at an offset: series may tell the same."""
        return max(
            (len(d) / correlation_time(d) for d, _ in self.differences(offset_s) if len(d)),
            default=1.0,
        )


def find_offset(
    pairs: Sequence[tuple[Held, Held]], range_s: float, file_step_s: float, run_step_s: float
) -> Offset | None:
    """Offset within a range at which the measured series fit best; None if none of them varies.

    Whole finer steps are tried over the range, with means over the intervals of the longer step.  A
    parabola through what is unexplained within half a longer step of the best one has the offset as its
    lowest point.  Between whole finer steps the means would average more noise away, which would draw
    the offset there.  The ends of its interval are where the logarithm of the parabola has risen by 3.84
    over the number of independent values, a likelihood ratio for normal differences, and a tenth of the
    finer step away at least.

    Parameters
    ----------
    pairs : sequence of (Held, Held)
        Measured series in the run's time at no offset, and the simulated ones.
    range_s : float
        Offsets up to this on both sides are tried, at least a finer step. [s]
    file_step_s, run_step_s : float
        Steps of the two. [s]
    """
    near = [(_within(file, run, range_s), run) for file, run in pairs]
    misfit = Misfit(near, file_step_s >= run_step_s)
    finer_s, longer_s = sorted((file_step_s, run_step_s))
    apart_s = finer_s * max(math.ceil(range_s / finer_s / MOST_TRIED), 1)
    half = math.floor(range_s / apart_s + WHOLE)
    tried_s = apart_s * np.arange(-half, half + 1)
    found = [misfit.at(float(offset_s)) for offset_s in tried_s]
    counts = np.array([count for _, count in found])
    shares = np.array([share for share, _ in found])
    shares[counts < LEAST_SHARE * counts.max(initial=0)] = math.inf
    if not np.isfinite(shares).any():
        return None
    # Of equally good ones that which is nearest to none.
    best = min(range(len(shares)), key=lambda k: (shares[k], abs(tried_s[k])))
    reach = max(round(max(longer_s / 2.0, apart_s) / finer_s), 1)
    seconds, curvature = _lowest(misfit, float(tried_s[best]), finer_s, reach)
    unexplained, _ = misfit.at(seconds)
    rise = math.expm1(LIKELY / misfit.independent(float(tried_s[best])))
    width_s = math.sqrt(unexplained * rise / curvature) if curvature > 0.0 else math.inf
    width_s = math.hypot(width_s, INTERPOLATED * finer_s)
    other = _next_valley(shares, best)
    return Offset(
        seconds, range_s, unexplained, seconds - width_s, seconds + width_s,
        math.nan if other is None else float(tried_s[other]),
        math.nan if other is None else float(shares[other]),
        best in (0, len(shares) - 1),
    )  # fmt: skip


def _within(file: Held, run: Held, range_s: float) -> Held:
    """Those values of a file that some offset within the range brings into the run."""
    begin_s, end_s = run.begin_s[0] - range_s, run.end_s[-1] + range_s
    near = (file.end_s > begin_s) & (file.begin_s < end_s)
    return Held(file.begin_s[near], file.end_s[near], file.values[near])


def _lowest(misfit: Misfit, best_s: float, finer_s: float, reach: int) -> tuple[float, float]:
    """Lowest point of a parabola through the misfit around an offset [s], and its curvature [1/s²].

    Where it has none within its reach, or does not open upwards, the offset itself.
    """
    away_s = finer_s * np.arange(-reach, reach + 1)
    shares = np.array([misfit.at(best_s + float(each_s))[0] for each_s in away_s])
    there = np.isfinite(shares)
    if there.sum() < 3:
        return best_s, 0.0
    curvature, slope, _ = (float(each) for each in np.polyfit(away_s[there], shares[there], 2))
    if curvature <= 0.0 or abs(slope / (2.0 * curvature)) > away_s[-1]:
        return best_s, max(curvature, 0.0)
    lowest_s = best_s - slope / (2.0 * curvature)
    lowest_s = round(lowest_s / RESOLUTION_S) * RESOLUTION_S
    return (lowest_s if misfit.at(lowest_s)[0] < shares[reach] else best_s), curvature


def _next_valley(shares: Floats, best: int) -> int | None:
    """The lowest local minimum beyond a ridge half as high as the highest share, if it is below that."""
    ridge = (shares[best] + shares[np.isfinite(shares)].max()) / 2.0
    high = np.flatnonzero(shares >= ridge)
    left = high[high < best].max(initial=-1)
    right = high[high > best].min(initial=len(shares))
    padded = np.concatenate([[math.inf], shares, [math.inf]])
    valleys = np.flatnonzero((shares < ridge) & (shares < padded[:-2]) & (shares <= padded[2:]))
    others = [int(k) for k in valleys if not left < k < right]
    return min(others, key=lambda k: shares[k], default=None)
