"""Mean useful voltage of zones and trains, and the dimensioning train.

The mean useful voltage of a zone is the mean of the voltage at the pantograph over all trains and time
steps in that zone, whatever the trains do.  That of a train is the mean over the steps in which its
tractive effort is positive.  The train with the lowest one is the dimensioning train.  All of them are
evaluated in the peak window.

References
----------
[EN50388]_
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.places import lines_of, train_lines, where_told
from tpss.results.standards.windows import TOLERANCE, Floats, step_values
from tpss.results.tables import step_s
from tpss.units import kilometres, on_line

LEAST_PRESENCE_S = 60.0
"""A train that is present for less is not a dimensioning train. [s]"""

FAST_KMH = 200.0
"""A line with speeds above it is judged by a higher mean useful voltage. [km/h]"""

REACHED, MISSED = "reached", "below the minimum"


class Section(NamedTuple):
    """A zone of the line."""

    name: str
    line: str
    from_km: float
    to_km: float


Ends = Mapping[str, tuple[float, float]]
"""Beginnings and ends of the lines by their names, an empty one for a single line. [km]"""


def feeding_sections(dataset: xr.Dataset, ends: Ends) -> list[Section]:
    """Sections of line between feeding stations, and from the outer ones to the ends of lines."""
    stations_km = dataset.station_position.to_numpy() / 1e3
    stations, owners = dataset.station.to_numpy(), lines_of(dataset, "station")
    sections = []
    for index, (line, ends_km) in enumerate(ends.items()):
        own = owners == index
        named = dict.fromkeys(ends_km, "") | dict(zip(stations_km[own], stations[own], strict=True))
        points = sorted(named)
        label = {km: str(named[km]) or on_line(line, f"{kilometres(km)} km") for km in points}
        sections += [
            Section(f"{label[begin]}-{label[end]}", line, float(begin), float(end))
            for begin, end in zip(points, points[1:], strict=False)
        ]
    return sections


def steps_in_window(dataset: xr.Dataset, from_min: float, to_min: float | None) -> slice | None:
    """Steps that begin within a window; None if the run does not cover it."""
    return window_steps(dataset.sizes["time"] - 1, step_s(dataset), from_min, to_min)


def window_steps(steps: int, step_s: float, from_min: float, to_min: float | None) -> slice | None:
    """Steps of a run that begin within a window; None if the run does not cover it."""
    h = step_s / 60.0
    begin = math.ceil(from_min / h - TOLERANCE)
    end = steps if to_min is None else math.ceil(to_min / h - TOLERANCE)
    return slice(begin, end) if begin < end <= steps else None


def zone_table(
    dataset: xr.Dataset,
    zones: Iterable[Section],
    ends: Ends,
    window: slice | None,
    least_kv: float | None,
) -> pd.DataFrame:
    """One row per zone: its mean useful voltage, from how many trains, against the minimum.

    A zone includes its beginning, and a line's end belongs to the last zone before it.
    """
    chosen = slice(0) if window is None else window
    voltage = step_values(dataset, "pantograph_voltage")[chosen] / 1e3
    position_km = dataset.position.to_numpy()[:-1][chosen] / 1e3
    lines, index = train_lines(dataset)[:-1][chosen], list(ends).index
    rows = []
    for zone in zones:
        upto = np.inf if zone.to_km >= ends[zone.line][1] else zone.to_km
        inside = np.isfinite(voltage) & (position_km >= zone.from_km) & (position_km < upto)
        inside &= lines == index(zone.line)
        mean = float(voltage[inside].mean()) if inside.any() else math.nan
        rows.append((*zone, int(inside.any(axis=0).sum()), mean))
    names, owners, begins, until, trains, means = zip(*rows, strict=True)
    columns = {"zone": names, "line": owners, "from_km": begins, "to_km": until, "trains": trains}
    columns = where_told(columns, list(ends))
    return pd.DataFrame({**columns, **_judged(np.array(means), least_kv)})


def train_table(dataset: xr.Dataset, window: slice | None, least_kv: float | None) -> pd.DataFrame:
    """One row per train: time present and in traction, mean useful voltage, against the minimum.

    A train that does not count has no verdict.
    """
    chosen, h = slice(0) if window is None else window, step_s(dataset) / 60.0
    voltage = step_values(dataset, "pantograph_voltage")[chosen] / 1e3
    present = np.isfinite(voltage)
    pulls = present & (step_values(dataset, "tractive_force")[chosen] > 0.0)
    steps = pulls.sum(axis=0)
    total = np.where(pulls, voltage, 0.0).sum(axis=0)
    mean: Floats = total / np.where(steps > 0, steps, np.nan)
    present_min = present.sum(axis=0) * h
    counts = present_min >= LEAST_PRESENCE_S / 60.0 - TOLERANCE
    judged = _judged(mean, least_kv)
    judged["verdict"][~counts] = ""
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy(),
            "present_min": present_min,
            "traction_min": steps * h,
            "counts": counts,
            **judged,
        }
    )


def _judged(means_kv: Floats, least_kv: float | None) -> dict[str, Any]:
    """Means, minimum and a verdict, which is empty where there is nothing to judge."""
    least = math.nan if least_kv is None else least_kv
    verdict = np.where(means_kv >= least, REACHED, np.where(means_kv < least, MISSED, ""))
    return {"mean_useful_kv": means_kv, "minimum_kv": least, "verdict": verdict.astype(object)}


def dimensioning_train(trains: pd.DataFrame) -> tuple[str, float] | None:
    """The train with the lowest mean useful voltage [kV] of those that count, if any is in traction."""
    means = np.where(trains.counts.to_numpy(), trains.mean_useful_kv.to_numpy(), np.nan)
    if not np.isfinite(means).any():
        return None
    i = int(np.nanargmin(means))
    return str(trains.train.to_numpy()[i]), float(means[i])
