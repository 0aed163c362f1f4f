"""The time-distance graph, coloured by the voltage."""

import numpy as np
import numpy.typing as npt

from tpss.errors import ResultError
from tpss.report.contact_line import LineVoltage
from tpss.report.corridor import is_corridor, landmarks, span_km
from tpss.report.drawings import parts
from tpss.report.palette import BLACK
from tpss.report.sampling import Floats
from tpss.results.result import Result

LEAST_SPAN_KV = 2.0
"""Span of a scale of voltages at least, so that a small drop does not look like a large one."""

LEAST_SHARE = 0.2
"""The same of lower voltages, as of direct current: a share of the highest one. [1]"""


def time_distance(
    result: Result,
    voltage: LineVoltage | None = None,
    from_min: float | None = None,
    to_min: float | None = None,
) -> parts.Drawing:
    """Paths of all trains over time, coloured by the voltage at their pantographs.

    Stations of the line are named at the right.

    Parameters
    ----------
    result : Result
    voltage : LineVoltage, optional
        Of this run: it is shown in colours below paths in black.
    from_min, to_min : float, optional
        Minutes of the run that are shown, by default all of them.

    Raises
    ------
    ResultError
        The run has no such minutes.
    """
    data = result.dataset
    minutes, km = data.time.to_numpy() / 60.0, data.position.to_numpy() / 1e3
    kv, trains = data.pantograph_voltage.to_numpy() / 1e3, data.train.to_numpy().astype(str)
    span = _shown_minutes(float(minutes[0]), float(minutes[-1]), from_min, to_min)
    # One train after another, each over its time on the line, with a gap after it, and in between where
    # it is off a corridor.
    below = ((0, 1), (0, 0))
    train, step = np.nonzero(np.pad(_shown(km, is_corridor(result)), below, constant_values=True).T)
    km, kv = (np.pad(all_, below, constant_values=np.nan)[step, train] for all_ in (km, kv))
    minutes, names = np.append(minutes, np.nan)[step], trains[train].tolist()
    items: list[parts.Item] = [parts.Mark(km, name) for name, km in landmarks(result).items()]
    if voltage is None:
        colours = parts.Colours(kv, "voltage at the pantograph [kV]", *colour_range(kv))
        items.append(parts.Curve(minutes, km, width=1.3, words=names, colours=colours))
    else:
        middle_min = voltage.time_min + voltage.steps_a_column * data.attrs["time_step_s"] / 120.0
        label, kv = "voltage of the contact line [kV]", voltage.map_kv
        colours = parts.Colours(kv, label, *colour_range(kv))
        items.insert(0, parts.Map(middle_min, voltage.position_km, colours))
        items.append(parts.Curve(minutes, km, colour=BLACK, width=0.6, words=names))
    panel = parts.Panel(parts.POSITION, items, span=span_km(result))
    return parts.Drawing(parts.TIME, [panel], span, panel_inch=4.6)


def _shown_minutes(
    begin_min: float, end_min: float, from_min: float | None, to_min: float | None
) -> tuple[float, float]:
    """First and last minute that are shown of those of a run."""
    first = begin_min if from_min is None else from_min
    last = end_min if to_min is None else to_min
    if not begin_min <= first < last <= end_min:
        raise ResultError(
            f"there are no minutes {first:g} to {last:g} to draw; give some of {begin_min:g} to "
            f"{end_min:g}, the earlier first"
        )
    return first, last


def _shown(km: Floats, with_gaps: bool) -> npt.NDArray[np.bool_]:
    """Where trains have a position, and, of a corridor, where a gap of it begins that ends again."""
    there = np.isfinite(km)
    if not with_gaps:
        return np.asarray(there)
    again = np.logical_or.accumulate(there[::-1], axis=0)[::-1]
    gap = ~there & again
    gap[1:] &= there[:-1]
    gap[:1] = False
    return np.asarray(there | gap)


def colour_range(kv: Floats) -> tuple[float, float]:
    """Lowest and highest voltage of the colour scale. [kV]"""
    highest = float(np.nanmax(kv))
    span = min(LEAST_SPAN_KV, LEAST_SHARE * highest)
    return min(float(np.nanmin(kv)), highest - span), highest
