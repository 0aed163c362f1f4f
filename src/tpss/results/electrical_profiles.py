"""Electrical profiles for OSRD: what voltage a train finds on each stretch of track, in bands.

OSRD computes running times without a load flow; it takes the effort of a train at the voltage of such
a profile.  A stretch has the band that its voltage does not fall below, at most the nominal voltage.
Where no train ran there is no profile.

References
----------
https://osrd.fr: an ``electrical_profile_set`` is a public format.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.results.osrd_tracks import OsrdTrack
from tpss.results.places import train_lines
from tpss.results.result import Result
from tpss.results.standards.windows import step_values
from tpss.scenario.supply.system import system_named

ROUNDING = 1e-9
"""Share of a band by which a voltage may miss it."""

Floats = npt.NDArray[np.float64]


class Stretch(NamedTuple):
    """A stretch of a line and the band of its voltage."""

    line: str
    from_km: float
    to_km: float
    band_v: float


def electrical_profiles(
    result: Result,
    tracks: Sequence[OsrdTrack] = (),
    *,
    stretch_km: float = 1.0,
    band_v: float | None = None,
    lowest: bool = False,
    power_classes: Sequence[str] = ("1",),
) -> dict[str, Any]:
    """Profiles of a run, as the document of OSRD's ``electrical_profile_set``.

    Parameters
    ----------
    result : Result
    tracks : sequence of OsrdTrack
        Where they lie; without them each line is a track of its name, in metres from its beginning.
    stretch_km : float
        Length of the stretches. [km]
    band_v : float, optional
        Width of the bands; by default a tenth of the nominal voltage. [V]
    lowest : bool
        Whether the lowest voltage of a stretch counts, and not the mean over trains and time.
    power_classes : sequence of str
        Power classes of rolling stock that the profiles are for; they are alike.
    """
    nominal_v = 1e3 * system_named(result.scenario.supply.system).nominal_kv
    width_v = band_v or nominal_v / 10.0
    stretches = list(_stretches(result, stretch_km, nominal_v, width_v, lowest))
    on = list(tracks) or _lines_as_tracks(result)
    bands = sorted({stretch.band_v for stretch in stretches}, reverse=True)
    levels = []
    for power_class in power_classes:
        for band in bands:
            parts = [
                part
                for stretch in stretches
                for track in on
                if stretch.band_v == band and (part := _part(track, stretch)) is not None
            ]
            if parts:
                levels.append(
                    {"value": _volts(band), "power_class": power_class, "track_ranges": parts}
                )
    count = round((nominal_v - min(bands, default=nominal_v)) / width_v)
    order = [_volts(nominal_v - i * width_v) for i in range(count + 1)]
    return {"levels": levels, "level_order": {_volts(nominal_v): order}}


def _part(track: OsrdTrack, stretch: Stretch) -> dict[str, Any] | None:
    """What of a track lies on a stretch, as OSRD writes it."""
    if track.line != stretch.line:
        return None
    ends_m = track.part_m(stretch.from_km, stretch.to_km)
    return ends_m and {"track": track.track, "begin": ends_m[0], "end": ends_m[1]}


def _volts(voltage_v: float) -> str:
    return f"{voltage_v:.0f}V"


def _lines_as_tracks(result: Result) -> list[OsrdTrack]:
    tracks = []
    for name, line in result.scenario.lines_by_name.items():
        length_m = 1e3 * line.length_km
        tracks.append(OsrdTrack(name, line.begins_at_km, line.end_km, name, 0.0, length_m))
    return tracks


def _stretches(
    result: Result, stretch_km: float, nominal_v: float, width_v: float, lowest: bool
) -> Iterator[Stretch]:
    """Stretches of all lines where trains ran, neighbours of one band taken together."""
    for index, (name, line) in enumerate(result.scenario.lines_by_name.items()):
        count = math.ceil(line.length_km / stretch_km - ROUNDING)
        voltage = _voltage_v(result, index, line.begins_at_km, stretch_km, count, lowest)
        steps = np.floor((np.minimum(voltage, nominal_v) - nominal_v) / width_v + ROUNDING)
        for step, numbers in _runs(steps):
            begin_km = line.begins_at_km + numbers.start * stretch_km
            end_km = min(line.begins_at_km + numbers.stop * stretch_km, line.end_km)
            yield Stretch(name, begin_km, end_km, nominal_v + step * width_v)


def _runs(values: Floats) -> Iterator[tuple[float, range]]:
    """Equal values in a row, and their numbers; those that are NaN are left out."""
    begin = 0
    for value, run in groupby(values):
        end = begin + len(list(run))
        if math.isfinite(value):
            yield float(value), range(begin, end)
        begin = end


def _voltage_v(
    result: Result, line: int, begin_km: float, stretch_km: float, count: int, lowest: bool
) -> Floats:
    """Voltage of each stretch of a line, the mean or the lowest; NaN where no train was. [V]

    The mean is that over trains and steps; a step counts for all the stretches that a train is on in it.
    """
    dataset = result.dataset
    voltage = step_values(dataset, "pantograph_voltage")
    place = (dataset.position.to_numpy() / 1e3 - begin_km) / stretch_km
    here = train_lines(dataset) == line
    there = here[:-1] & np.isfinite(voltage)
    begin = place[:-1][there]
    stays = (here[1:] & np.isfinite(place[1:]))[there]
    end = np.where(stays, place[1:][there], begin)
    low = np.clip(np.floor(np.minimum(begin, end) + ROUNDING), 0, count - 1).astype(int)
    high = np.clip(np.ceil(np.maximum(begin, end) - ROUNDING) - 1, low, count - 1).astype(int)
    covered = high - low + 1
    first = np.cumsum(covered) - covered
    numbers = np.repeat(low - first, covered) + np.arange(covered.sum())
    values = np.repeat(voltage[there], covered)
    if lowest:
        found = np.full(count, np.inf)
        np.minimum.at(found, numbers, values)
        return np.where(np.isfinite(found), found, np.nan)
    times = np.bincount(numbers, minlength=count).astype(float)
    total = np.bincount(numbers, values, minlength=count)
    return np.asarray(total / np.where(times > 0.0, times, np.nan))
