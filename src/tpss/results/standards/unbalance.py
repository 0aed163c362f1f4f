"""Unbalance of the grid's busbars: highest means, against the limit."""

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from tpss.results.standards.violations import Violation
from tpss.results.standards.windows import highest_means
from tpss.results.tables import step_s
from tpss.results.three_phase import Busbar, busbars
from tpss.scenario.scenario import Scenario

WINDOW_MIN = 10.0
"""Window of the means that are judged. [min]"""

GRID = "grid"
"""Names the limit among those of the standards."""

KEPT, EXCEEDED = "kept", "exceeded"


class Unbalance(NamedTuple):
    """Unbalance at a busbar: negative-sequence voltage over positive-sequence voltage."""

    busbar: str
    stations: str
    peak_r_a: float
    peak_s_a: float
    peak_t_a: float
    peak_percent: float
    mean_10_min_percent: float
    from_min: float
    limit_percent: float
    verdict: str


def unbalance_of(dataset: xr.Dataset, scenario: Scenario) -> list[Unbalance]:
    """Unbalance of all busbars whose stations tell their phases.

    The mean is the highest one over 10 min; of a shorter run, that over all of it.
    """
    h_min = step_s(dataset) / 60.0
    return [_judged(each, h_min) for each in busbars(dataset, scenario) if len(each.unbalance)]


def _judged(busbar: Busbar, h_min: float) -> Unbalance:
    steps = len(busbar.unbalance)
    width = min(max(WINDOW_MIN / h_min, 1.0), float(steps))
    mean, begin = highest_means(busbar.unbalance[:, None], width)
    currents_a = np.abs(busbar.phase_currents_a).max(axis=0)
    return Unbalance(
        busbar.name,
        ", ".join(busbar.stations),
        float(currents_a[0]),
        float(currents_a[1]),
        float(currents_a[2]),
        peak_percent=100.0 * float(busbar.unbalance.max()),
        mean_10_min_percent=100.0 * float(mean[0]),
        from_min=float(begin[0]) * h_min,
        limit_percent=100.0 * busbar.limit,
        verdict=KEPT if mean[0] <= busbar.limit else EXCEEDED,
    )


def unbalance_violations(found: Iterable[Unbalance]) -> Iterator[Violation]:
    """Busbars whose unbalance is above the limit, the worst first."""
    grave = [each for each in found if each.verdict == EXCEEDED]
    for each in sorted(grave, key=lambda own: -own.mean_10_min_percent):
        yield Violation(
            GRID, "unbalance", f"busbar {each.busbar}", math.nan, math.nan, WINDOW_MIN,
            each.from_min, "", math.nan,
            f"busbar {each.busbar}: unbalance of {each.mean_10_min_percent:.2f} % as a mean over "
            f"{WINDOW_MIN:g} min from {each.from_min:.1f} min on, above {each.limit_percent:g} %",
        )  # fmt: skip


def unbalance_in_words(found: Iterable[Unbalance]) -> str:
    """A sentence on the busbar closest to its limit; empty if there is none."""
    worst = max(found, key=lambda each: each.mean_10_min_percent / each.limit_percent, default=None)
    if worst is None:
        return ""
    return (
        f"busbar {worst.busbar} {worst.mean_10_min_percent:.2f} % as the highest mean over "
        f"{WINDOW_MIN:g} min, peak {worst.peak_percent:.2f} % (limit {worst.limit_percent:g} %)"
    )
