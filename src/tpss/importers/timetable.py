"""Timetables as importers write them: a CSV file with a row for each station of a train."""

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import timedelta
from typing import Any

HEADER = ("name", "train", "station", "arrival", "departure", "min_dwell_s", "kind")

DAY_S = 86_400
"""Length of a day. [s]"""
ROUND_S = 300
"""The clock of a simulation begins at such a multiple. [s]"""


_DURATION = re.compile(
    r"P(?:(?P<days>[\d.]+)D)?(?:T(?:(?P<hours>[\d.]+)H)?(?:(?P<minutes>[\d.]+)M)?"
    r"(?:(?P<seconds>[\d.]+)S)?)?"
)


@dataclass(frozen=True)
class Call:
    """A train at a station; times are counted from the midnight before the first train. [s]"""

    station: str
    kind: str = "pass"
    arrival_s: float | None = None
    departure_s: float | None = None
    min_dwell_s: float | None = None


@dataclass(frozen=True)
class Train:
    """A train of a timetable, with its calls in the order of travel."""

    name: str
    train_type: str
    calls: tuple[Call, ...]

    @property
    def departure_s(self) -> float:
        """When it departs at its origin. [s]"""
        return self.calls[0].departure_s or 0.0

    def renamed(self, stations: Mapping[str, str]) -> "Train":
        """The same with other names of its stations."""
        calls = (replace(call, station=stations[call.station]) for call in self.calls)
        return replace(self, calls=tuple(calls))


@dataclass(frozen=True)
class Window:
    """Departures every so often."""

    first_s: float
    last_s: float
    headway_s: float

    @property
    def departures_s(self) -> list[float]:
        """All of them. [s]"""
        count = round((self.last_s - self.first_s) / self.headway_s) + 1
        return [self.first_s + i * self.headway_s for i in range(count)]


@dataclass(frozen=True)
class Service:
    """A train that runs again and again; times at its calls are counted from each departure."""

    train: Train
    windows: tuple[Window, ...]

    @property
    def first_s(self) -> float:
        """The first departure. [s]"""
        return min(window.first_s for window in self.windows)

    @property
    def end_s(self) -> float:
        """When the last of its trains should arrive, as far as that is known. [s]"""
        last_s = max(window.last_s for window in self.windows)
        return last_s + (self.train.calls[-1].arrival_s or 0.0)


def clock(time_s: float) -> str:
    """A time as HH:MM:SS, which goes on beyond 24:00."""
    whole = round(time_s)
    return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def seconds_of(text: Any) -> Any:
    """Seconds of a duration such as PT1H30M; what is none of them is left to be refused."""
    match = _DURATION.fullmatch(text) if isinstance(text, str) else None
    if match is None or not any(match.groups()):
        return text
    parts = {unit: float(number) for unit, number in match.groupdict().items() if number}
    return timedelta(**parts).total_seconds()


def csv_text(trains: Iterable[Train], head: str = "") -> str:
    """Text of a timetable, in the order of departures; the head is comments."""
    text = io.StringIO()
    text.write(head)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    for train in sorted(trains, key=lambda each: each.departure_s):
        for i, call in enumerate(train.calls):
            times = [
                "" if each is None else clock(each) for each in (call.arrival_s, call.departure_s)
            ]
            dwell = "" if call.min_dwell_s is None else f"{call.min_dwell_s:g}"
            kind_of_train = "" if i else train.train_type
            writer.writerow([train.name, kind_of_train, call.station, *times, dwell, call.kind])
    return text.getvalue()


def ends_told(calls: Sequence[Call]) -> tuple[Call, ...]:
    """Calls whose first one is the start and whose last one the end, without what these have not."""
    first = replace(calls[0], kind="start", arrival_s=None, min_dwell_s=None)
    last = replace(calls[-1], kind="end", departure_s=None, min_dwell_s=None)
    return (first, *calls[1:-1], last)


def begin_of_day(trains: Sequence[Train]) -> float:
    """When the clock of a simulation of the trains begins: at the first departure, rounded down. [s]"""
    return min(train.departure_s for train in trains) // ROUND_S * ROUND_S


def end_of_day(trains: Sequence[Train]) -> float:
    """The last time that is scheduled. [s]"""
    times = [
        time
        for train in trains
        for call in train.calls
        for time in (call.arrival_s, call.departure_s)
        if time is not None
    ]
    return max(times)
