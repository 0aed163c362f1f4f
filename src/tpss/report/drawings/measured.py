"""Measured against simulated series: over time, and as duration curves."""

from collections.abc import Sequence

import numpy as np

from tpss.measured.compare import MeasuredComparison
from tpss.measured.figures import Aligned, durations_of
from tpss.report.drawings.parts import DASHED, SOLID, TIME, Curve, Drawing, Item, Mark, Panel
from tpss.report.sampling import Floats

DURATION = "duration [min]"
"""Axis of duration curves: for how long a value is reached or exceeded."""

ERROR = 2
"""Colour of the error."""


def measured_over_time(comparison: MeasuredComparison, series: str | None = None) -> Drawing:
    """Means of measured and simulated series over the intervals in which they are compared.

    Parameters
    ----------
    comparison : MeasuredComparison
    series : str, optional
        Name of one series, which is drawn with its error, simulated less measured; by default all,
        without it.
    """
    edges_min = comparison.grid.edges_s / 60.0
    chosen = _chosen(comparison, series)
    panels = [
        Panel(_label(each, several=series is None), _pair(edges_min, each.measured, each.simulated))
        for each in chosen
    ]
    if series is not None:
        (only,) = chosen
        error = only.simulated - only.measured
        items: list[Item] = [Mark(0.0), Curve(edges_min, _held(error), "error", ERROR, held=True)]
        panels.append(Panel(f"error [{only.shown.unit}]", items))
    return Drawing(TIME, panels, panel_inch=2.0)


def measured_durations(comparison: MeasuredComparison, series: str | None = None) -> Drawing:
    """Duration curves of measured and simulated series: for how long a value is reached or exceeded.

    Parameters
    ----------
    comparison : MeasuredComparison
    series : str, optional
        Name of one series; by default all.
    """
    panels = []
    for each in _chosen(comparison, series):
        measured, simulated = durations_of(each)
        edges_min = np.arange(len(measured) + 1.0) * comparison.grid.step_s / 60.0
        panels.append(
            Panel(_label(each, several=series is None), _pair(edges_min, measured, simulated))
        )
    return Drawing(DURATION, panels, panel_inch=2.0 if series is None else 3.0)


def _chosen(comparison: MeasuredComparison, series: str | None) -> Sequence[Aligned]:
    return [each for each in comparison.series if series in (None, each.name)]


def _label(aligned: Aligned, several: bool) -> str:
    """Label of an axis: of several panels whose it is, as units tell powers and voltages apart."""
    words = aligned.quantity.removeprefix("station_").replace("_", " ")
    return f"{aligned.element if several else words} [{aligned.shown.unit}]"


def _pair(edges_min: Floats, measured: Floats, simulated: Floats) -> list[Curve]:
    return [
        Curve(edges_min, _held(measured), "measured", 0, SOLID, held=True),
        Curve(edges_min, _held(simulated), "simulated", 1, DASHED, held=True),
    ]


def _held(values: Floats) -> Floats:
    """Values at the beginnings of intervals, and the last one at its end."""
    return np.append(values, values[-1])
