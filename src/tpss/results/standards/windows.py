"""Means over windows of time, of values that apply from an instant to the next.

The integral of such values is a straight line between two instants, so every mean here is exact, whether
or not a window is a whole number of time steps.
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from tpss.results.places import LINE

Floats = npt.NDArray[np.float64]

WINDOWS_MIN = (1.0, 3.0, 15.0, 60.0)
"""Windows of the highest mean powers and currents. [min]"""

TOLERANCE = 1e-9
"""Share of a time step by which a window may miss an instant."""


def step_values(dataset: xr.Dataset, name: str) -> Floats:
    """Values of an interval variable, shape (steps, ...), without the last instant.

    A train that no station reaches has no voltage: not 0, which would count as a low one.
    """
    values = np.asarray(dataset[name].to_numpy()[:-1], dtype=float)
    return np.where(values == 0.0, np.nan, values) if name == "pantograph_voltage" else values


def table_of(rows: Sequence[tuple[Any, ...]], kind: type[Any]) -> pd.DataFrame:
    """Table of rows that are named tuples of a kind, its columns typed even without a row.

    A column with lines is left out where none is told, as in a run of one line.
    """
    types = {"str": object, "float": float, "int": int, "bool": bool}
    return pd.DataFrame(
        {
            name: np.array([row[i] for row in rows], dtype=types[annotation.__name__])
            for i, (name, annotation) in enumerate(kind.__annotations__.items())
            if name != LINE or any(row[i] for row in rows)
        }
    )


def integrals(values: Floats) -> Floats:
    """Integral from the start to every instant, in values times steps, shape (steps + 1, columns)."""
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])


def between_instants(integral: Floats, steps: Floats) -> Floats:
    """An integral at times that are given in steps and need not be whole, shape (times, columns)."""
    before = np.clip(steps.astype(int), 0, max(len(integral) - 2, 0))
    after = np.minimum(before + 1, len(integral) - 1)
    part = (steps - before)[:, None]
    return np.asarray((1.0 - part) * integral[before] + part * integral[after])


def highest_means(values: Floats, width: float) -> tuple[Floats, Floats]:
    """Highest mean of each column over a moving window, and where that window begins.

    The mean over a window is a straight line between the positions where an end of the window meets an
    instant, so it is highest at one of them.

    Parameters
    ----------
    values : Floats, shape (steps, columns)
        Values that hold for a time step.
    width : float
        Width of the window, in steps.

    Returns
    -------
    highest, begin : Floats, shape (columns,)
        Begin in steps. NaN where the window is wider than there are steps.
    """
    steps, columns = values.shape
    if steps == 0 or width > steps + TOLERANCE:
        return np.full(columns, np.nan), np.full(columns, np.nan)
    integral, whole = integrals(values), round(width)
    if abs(width - whole) <= TOLERANCE:  # both ends meet instants together
        areas = integral[whole:] - integral[:-whole]
        first = areas.argmax(axis=0)
        return areas[first, np.arange(columns)] / whole, first.astype(float)
    width = min(width, float(steps))
    instants = np.arange(steps + 1.0)
    begins = np.concatenate([instants, instants - width])
    begins = np.unique(begins[(begins >= -TOLERANCE) & (begins + width <= steps + TOLERANCE)])
    begins = np.clip(begins, 0.0, steps - width)
    areas = between_instants(integral, begins + width) - between_instants(integral, begins)
    first = areas.argmax(axis=0)
    return areas[first, np.arange(columns)] / width, begins[first]


def highest_mean_table(
    values: Floats, names: dict[str, Sequence[str]], step_s: float, windows_min: Iterable[float]
) -> pd.DataFrame:
    """Highest mean of each column over a step and over windows: one row per column and window.

    Parameters
    ----------
    values : Floats, shape (steps, columns)
    names : dict of str to sequence
        Columns of the table that name the columns of the values.
    step_s : float
        Length of a time step. [s]
    windows_min : iterable of float
        Windows in addition to the time step itself. [min]
    """
    widths = sorted({step_s / 60.0, *windows_min})
    highest = [highest_means(values, width * 60.0 / step_s) for width in widths]
    table = {key: np.repeat(list(column), len(widths)) for key, column in names.items()}
    return pd.DataFrame(
        {
            **table,
            "window_min": np.tile(widths, values.shape[1]),
            "highest": np.array([means for means, _ in highest]).T.ravel(),
            "from_min": np.array([begins for _, begins in highest]).T.ravel() * step_s / 60.0,
        }
    )


def highest_means_between(
    values: Floats, instants: Floats, widths: Sequence[float]
) -> list[tuple[Floats, Floats]]:
    """Highest mean of each column over moving windows, of steps that need not be of one length.

    Parameters
    ----------
    values : Floats, shape (steps, columns)
        Values that hold from an instant to the next; there is a step at least.
    instants : Floats, shape (steps + 1,)
        Ascending, in any unit of time.
    widths : sequence of float
        Widths of the windows, in that unit.

    Returns
    -------
    list of (highest, begin)
        For each width as of `highest_means`, in the unit of the instants.
    """
    integral = integrals(values * np.diff(instants)[:, None])
    return [_highest_mean_between(values, integral, instants, width) for width in widths]


def _highest_mean_between(
    values: Floats, integral: Floats, instants: Floats, width: float
) -> tuple[Floats, Floats]:
    """Highest means over windows of one width, and their beginnings.

    Windows of which both ends meet instants are many, and differences of the integral; the others, few
    if steps divide the window, are interpolated.
    """
    each = np.arange(values.shape[1])
    rounding = TOLERANCE * width
    if instants[-1] - instants[0] < width - rounding:
        return np.full(len(each), np.nan), np.full(len(each), np.nan)
    whole = min(max(1, round(width / float(instants[1] - instants[0]))), len(values))
    meets = np.abs(instants[whole:] - instants[:-whole] - width) <= rounding
    lone_begins = instants[np.append(~meets, np.ones(whole, dtype=bool))]
    lone_ends = instants[np.append(np.ones(whole, dtype=bool), ~meets)]
    lone = np.concatenate([lone_begins, lone_ends - width])
    # One that ends with the run begins where it does but for a rounding, and so may end behind it.
    within = (lone >= instants[0] - rounding) & (lone + width <= instants[-1] + rounding)
    lone = np.clip(lone[within], instants[0], None)
    areas = integral[whole:] - integral[:-whole]
    begins = instants[:-whole]
    if not meets.all():
        areas, begins = areas[meets], begins[meets]
    if len(lone):
        areas = np.concatenate([areas, _until(lone + width, values, integral, instants)])
        areas[-len(lone) :] -= _until(lone, values, integral, instants)
        begins = np.concatenate([begins, lone])
    first = areas.argmax(axis=0)
    return areas[first, each] / width, begins[first]


def _until(times: Floats, values: Floats, integral: Floats, instants: Floats) -> Floats:
    """An integral over time until some times, shape (times, columns)."""
    before = np.clip(np.searchsorted(instants, times, "right") - 1, 0, len(values) - 1)
    return np.asarray(integral[before] + values[before] * (times - instants[before])[:, None])
