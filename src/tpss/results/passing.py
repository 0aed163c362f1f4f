"""Trains that passed through each other: on one track, away from stations where trains may cross.

A train that waits with its head where it comes to a track is not in the way there: it has its length on
the track before, or stands beside the line at its origin.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.results.places import line_names, train_lines, train_tracks
from tpss.results.result import Result
from tpss.results.standards.windows import Floats
from tpss.units import on_line

STATION_M = 500.0
"""Trains that meet no further than this from a station of several tracks cross there. [m]"""

STANDS_M = 0.01
"""A train that goes no further than this from where it came to a track stands there. [m]"""


class Passing(NamedTuple):
    """Two trains that passed through each other within a step."""

    one: str
    other: str
    line: str
    place_km: float
    time_min: float

    @property
    def in_words(self) -> str:
        """Who, where and when."""
        place = on_line(self.line, f"{self.place_km:.1f} km")
        return f"{self.one} and {self.other} near {place} at {self.time_min:.1f} min"


def passings(result: Result) -> list[Passing]:
    """All pairs of trains that passed through each other, by time."""
    data, names = result.dataset, line_names(result.dataset)
    lines, tracks = train_lines(data), train_tracks(data)
    position_m = np.where(stand_before(result), np.nan, data.position.to_numpy())
    found = []
    for number, line in enumerate(result.scenario.lines_by_name.values()):
        crossing_m = np.array([1e3 * s.position_km for s in line.stations if s.tracks > 1])
        for track in range(1, line.most_tracks + 1):
            here = (lines == number) & (tracks == track)
            place_m = np.where(here, position_m, np.nan)
            for step, one, other in _of_track(place_m):
                meeting_m = _meeting_m(place_m[step : step + 2, [one, other]])
                if (np.abs(crossing_m - meeting_m) > STATION_M).all():
                    first, second = (str(name) for name in data.train.to_numpy()[[one, other]])
                    time_min = float(data.time[step]) / 60.0
                    place = names[number], meeting_m / 1e3, time_min
                    found.append(Passing(first, second, *place))
    return sorted(found, key=lambda each: each.time_min)


def stand_before(result: Result) -> npt.NDArray[np.bool_]:
    """Trains that stand for a step where they came to a track, shape (time, train).

    Those that were placed on the line at the start stand on it.
    """
    data = result.dataset
    place_m, placed = data.position.to_numpy(), np.isnan(data.departure_time.to_numpy())
    there, lines, tracks = np.isfinite(place_m), train_lines(data), train_tracks(data)
    came = there.copy()
    came[1:] &= ~there[:-1] | (np.diff(lines, axis=0) != 0) | (np.diff(tracks, axis=0) != 0)
    since = np.maximum.accumulate(np.where(came, np.arange(len(came))[:, None], 0), axis=0)
    with np.errstate(invalid="ignore"):
        stands = np.abs(place_m - np.take_along_axis(place_m, since, axis=0)) <= STANDS_M
    stands &= ~(placed & (since == 0))
    stands[:-1] &= stands[1:]
    return np.asarray(stands)


def _of_track(place_m: Floats) -> Iterator[tuple[int, int, int]]:
    """Steps and pairs of trains whose order on a track turns in them."""
    for step in _steps_of_another_order(place_m):
        there = np.flatnonzero(np.isfinite(place_m[step]) & np.isfinite(place_m[step + 1]))
        ordered = there[np.argsort(place_m[step, there], kind="stable")]
        after_m = place_m[step + 1, ordered]
        for one, other in np.argwhere(np.triu(after_m[:, None] > after_m)):
            yield int(step), int(ordered[one]), int(ordered[other])


def _meeting_m(place_m: Floats) -> float:
    """Where two trains meet that run evenly from one instant to the next, shape (2, 2). [m]"""
    before_m, after_m = place_m[0, 1] - place_m[0, 0], place_m[1, 1] - place_m[1, 0]
    share = before_m / (before_m - after_m)
    return float(place_m[0, 0] + share * (place_m[1, 0] - place_m[0, 0]))


def _steps_of_another_order(place_m: Floats) -> Floats:
    """Steps after which the trains present may stand in another order than before."""
    here, after = place_m[:-1], place_m[1:]
    order = np.argsort(np.where(np.isfinite(here), here, np.inf), axis=1, kind="stable")
    moved = np.take_along_axis(after, order, axis=1)
    with np.errstate(invalid="ignore"):  # trains that are not there
        turned = (np.diff(moved, axis=1) < 0.0).any(axis=1)
    left = (np.isfinite(here) & ~np.isfinite(after)).any(axis=1)
    return np.asarray(np.flatnonzero(turned | left))
