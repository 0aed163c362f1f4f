"""Figures of a series: means, errors, windows, duration curves, energies; all from aligned means."""

import math
from typing import NamedTuple

import numpy as np

from tpss.measured.independent import mean_interval
from tpss.measured.quantities import QUANTITIES, SHOWN, Floats, Quantity, Shown
from tpss.results.standards.windows import highest_means

WINDOWS_MIN = (1.0, 5.0, 15.0, 60.0)
"""Windows of the highest mean powers, and the lowest mean voltages. [min]"""

QUANTILES = (0.05, 0.95)
"""Of the error."""


class Aligned(NamedTuple):
    """A measured series and the simulated one: their means over the same intervals.

    Attributes
    ----------
    column : str
        Heading of the measured one in its file.
    quantity, element : str
    measured, simulated : Floats, shape (intervals,)
        In the unit in which they are shown; NaN: not known all through.
    """

    column: str
    quantity: str
    element: str
    measured: Floats
    simulated: Floats

    @property
    def name(self) -> str:
        """Name of the series."""
        return f"{self.quantity}:{self.element}"

    @property
    def kind(self) -> Quantity:
        """What it is."""
        return QUANTITIES[self.quantity]

    @property
    def shown(self) -> Shown:
        """How it is shown."""
        return SHOWN[self.kind.unit]

    @property
    def both(self) -> tuple[Floats, Floats]:
        """Measured and simulated means of all intervals, NaN where one of them is not known."""
        known = np.isfinite(self.measured) & np.isfinite(self.simulated)
        return np.where(known, self.measured, np.nan), np.where(known, self.simulated, np.nan)

    @property
    def compared(self) -> int:
        """Number of the intervals in which both are known."""
        return int(np.isfinite(self.both[0]).sum())


class Figures(NamedTuple):
    """Figures of a series; the error is simulated less measured.

    Attributes
    ----------
    series, quantity, element, unit : str
        Name of the series, its parts, and the unit of all that has no other.
    compared_min, left_out_min : float
        Time that is compared, and that of the intervals in which one of the two is not known. [min]
    measured_mean, simulated_mean : float
    bias, bias_low, bias_high : float
        Mean error, and the ends of its interval of confidence, 95 %; NaN: too little is independent.
    bias_percent : float
        Mean error in per cent of the measured mean's size; NaN if that is 0. [%]
    independent : float
        Independent values that tell as much as those that are compared.
    rms_error, error_5, error_95 : float
        Root of the mean square of the error, and its quantiles of 5 and 95 %.
    measured_energy, simulated_energy : float
        Over the compared time; NaN of a voltage.
    energy_unit : str
    """

    series: str
    quantity: str
    element: str
    unit: str
    compared_min: float
    left_out_min: float
    measured_mean: float
    simulated_mean: float
    bias: float
    bias_low: float
    bias_high: float
    bias_percent: float
    independent: float
    rms_error: float
    error_5: float
    error_95: float
    measured_energy: float
    simulated_energy: float
    energy_unit: str


def figures_of(aligned: Aligned, step_s: float) -> Figures:
    """Figures of a series.

    Parameters
    ----------
    aligned : Aligned
        With an interval at least in which both are known.
    step_s : float
        Length of an interval. [s]
    """
    measured, simulated = aligned.both
    error = simulated - measured
    known = error[np.isfinite(error)]
    interval = mean_interval(error)
    bias, base = float(known.mean()), float(np.nanmean(measured))
    hours = len(known) * step_s / 3600.0 if aligned.shown.energy else math.nan
    low, high = (float(each) for each in np.quantile(known, QUANTILES))
    return Figures(
        series=aligned.name,
        quantity=aligned.quantity,
        element=aligned.element,
        unit=aligned.shown.unit,
        compared_min=len(known) * step_s / 60.0,
        left_out_min=(len(error) - len(known)) * step_s / 60.0,
        measured_mean=base,
        simulated_mean=float(np.nanmean(simulated)),
        bias=bias,
        bias_low=interval.low,
        bias_high=interval.high,
        bias_percent=100.0 * bias / abs(base) if base else math.nan,
        independent=interval.independent,
        rms_error=float(np.sqrt(np.mean(known**2))),
        error_5=low,
        error_95=high,
        measured_energy=base * hours,
        simulated_energy=float(np.nanmean(simulated)) * hours,
        energy_unit=aligned.shown.energy,
    )


class Window(NamedTuple):
    """Highest mean power, or lowest mean voltage, over a window that is compared all through.

    Attributes
    ----------
    series, unit : str
    window_min : float
    which : str
        highest or lowest.
    measured, measured_from_min, simulated, simulated_from_min : float
        The means, and the minutes of the run at which their windows begin; NaN: no such time is known
        without a gap.
    """

    series: str
    unit: str
    window_min: float
    which: str
    measured: float
    measured_from_min: float
    simulated: float
    simulated_from_min: float


def windows_of(aligned: Aligned, begin_s: float, step_s: float) -> list[Window]:
    """Worst means over windows of a series, of those windows that are not shorter than an interval.

    Parameters
    ----------
    aligned : Aligned
    begin_s, step_s : float
        Where the first interval begins in the run, and how long they are. [s]
    """
    sign = -1.0 if aligned.kind.worst == "lowest" else 1.0
    values = sign * np.column_stack(aligned.both)
    found = []
    for window_min in WINDOWS_MIN:
        if 60.0 * window_min < step_s * (1.0 - 1e-9):
            continue
        means, begins = _highest_known(values, 60.0 * window_min / step_s)
        minutes = (begin_s + begins * step_s) / 60.0
        found.append(
            Window(
                aligned.name, aligned.shown.unit, window_min, aligned.kind.worst,
                sign * means[0], minutes[0], sign * means[1], minutes[1],
            )
        )  # fmt: skip
    return found


def _highest_known(values: Floats, width: float) -> tuple[Floats, Floats]:
    """Highest means over windows without a gap, and where they begin, in intervals."""
    known = np.isfinite(values).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    best, begin = np.full(2, np.nan), np.full(2, np.nan)
    for first, end in edges.reshape(-1, 2):
        means, begins = highest_means(values[first:end], width)
        better = np.isfinite(means) & ~(means <= best)
        best = np.where(better, means, best)
        begin = np.where(better, first + begins, begin)
    return best, begin


def durations_of(aligned: Aligned) -> tuple[Floats, Floats]:
    """Duration curves: measured and simulated means of the compared intervals, each from the highest."""
    measured, simulated = (values[np.isfinite(values)] for values in aligned.both)
    return np.sort(measured)[::-1], np.sort(simulated)[::-1]
