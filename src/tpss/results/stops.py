"""Times at stops: when each train came to stand at its stations, and when it went on or passed."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.model.routes import Route, routes_of
from tpss.results.standards.windows import Floats, table_of
from tpss.results.tables import step_s
from tpss.scenario.clock import clock_at
from tpss.scenario.routes import calls_on
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic
from tpss.step.state import TrainState

AT_STOP_M = 0.01
"""A standing train is at a stop that is no further away. [m]"""

LATE_MIN = 0.1
"""A train that is later counts as late. [min]"""


class StopTimes(NamedTuple):
    """A train at a station of its route."""

    train: str
    station: str
    line: str
    position_km: float
    kind: str
    """Whether it begins there (start), stops, passes or ends."""
    arrival_min: float
    departure_min: float
    dwell_min: float
    scheduled_arrival_min: float
    scheduled_departure_min: float
    late_min: float
    """How much later than scheduled it arrived, or departed where no arrival is scheduled."""


class Call(NamedTuple):
    """A station of a service, with its times counted from the departure at the origin."""

    station: str
    line: str
    """Empty where there is one only."""
    place_km: float
    kind: str
    position_m: float
    """Along the route. [m]"""
    number: int = -1
    """Of the stop among the stops."""
    arrive_min: float | None = None
    depart_min: float | None = None


class Times(NamedTuple):
    """What a dataset says of a train: times [s], and its way over the instants, NaN where it is away."""

    time_s: Floats
    step_s: float
    departure_s: float
    delay_s: float
    arrival_s: float
    call_arrival_s: Floats
    call_departure_s: Floats
    position_m: Floats
    speed_m_s: Floats
    holding_s: Floats
    state: Floats


TIMES = ("arrival", "departure", "scheduled_arrival", "scheduled_departure")
"""Times that are also shown by the clock."""


def stops(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per train and station where it begins, stops, passes or ends: arrival, departure, dwell.

    Scheduled times count from the train's own departure at its origin, of single trains and where there
    are delays from the scheduled one, and are NaN where none are given.
    A train that brakes within a step arrives when it stands, not at the next instant.  What it has not
    done within the run is NaN, and so is what it did before, if it was on the line at the start.  Where
    the simulation has a clock, columns with its times come behind the others.
    """
    several = len(scenario.lines_by_name) > 1
    calls = {
        entry.name: calls_of(entry, route, several)
        for entry, route in zip(scenario.traffic, routes_of(scenario), strict=True)
    }
    names, services = dataset.train.to_numpy().tolist(), dataset.service.to_numpy().tolist()
    rows = []
    for name, service, train in zip(names, services, _trains_of(dataset), strict=True):
        for call in calls[service]:
            times = _times_at(call, train)
            scheduled = _scheduled_at(call, (train.departure_s - train.delay_s) / 60.0)
            late_min = times[0] - scheduled[0]
            if math.isnan(scheduled[0]):
                late_min = times[1] - scheduled[1]
            rows.append(StopTimes(name, *call[:4], *times, *scheduled, late_min))
    return _with_clock(table_of(rows, StopTimes), scenario.simulation.start_s)


def _with_clock(table: pd.DataFrame, start_s: float | None) -> pd.DataFrame:
    """The table with its times by the clock, if that is known."""
    if start_s is None:
        return table
    clocks = {
        f"{time}_clock": [clock_at(minute, start_s) for minute in table[f"{time}_min"].tolist()]
        for time in TIMES
    }
    return table.assign(**clocks)


def punctuality(stops: pd.DataFrame) -> list[str]:
    """How the schedule was kept, in a line; none where no scheduled time has come."""
    late_min = stops.late_min.to_numpy()
    known, late = int(np.isfinite(late_min).sum()), int((late_min > LATE_MIN).sum())
    if known == 0:
        return []
    text = f"Timetable: {late} of {known} scheduled times missed by more than {LATE_MIN:g} min"
    if late:
        worst = int(np.nanargmax(late_min))
        train, station = stops.train.to_numpy()[worst], stops.station.to_numpy()[worst]
        text += f", most by {train} at {station}, {late_min[worst]:.2f} min"
        if "arrival_clock" in stops:
            text += f" ({stops.arrival_clock[worst] or stops.departure_clock[worst]})"
    return [text]


def calls_of(entry: Traffic, route: Route, several: bool) -> list[Call]:
    """Stations of a service in the order of travel, those that it passes with them.

    Parameters
    ----------
    entry : Traffic
    route : Route
        Of its trains.
    several : bool
        Whether there are several lines, so that a call names its own.
    """
    way = route.way

    def at_end(hop: int, kind: str, **times: Any) -> Call:
        """Call at the end of a hop of the way."""
        _, _, station, _, place_km = way.hops[hop]
        line, position_m = way.hops[hop].line, route.course_of(hop).position_m(1e3 * place_km)
        return Call(station, line if several else "", place_km, kind, position_m, **times)

    between = {
        hop: at_end(
            hop, "stop", number=number, arrive_min=s.arrive_after_min, depart_min=s.depart_after_min
        )
        for number, (hop, s) in enumerate(zip(way.stops, entry.stops, strict=True))
    }
    passed = calls_on(way.hops, [each.station for each in entry.passes], "passes")
    for hop, each in zip(passed, entry.passes, strict=True):
        between[hop] = at_end(hop, "pass", arrive_min=each.after_min)
    first = way.hops[0]
    return [
        Call(
            first.begin,
            first.line if several else "",
            first.begin_km,
            "start",
            route.start_m,
            depart_min=0.0 if entry.departs_by_schedule else None,
        ),
        *(between[hop] for hop in sorted(between)),
        at_end(len(way.hops) - 1, "end", arrive_min=entry.arrive_after_min),
    ]


def _trains_of(dataset: xr.Dataset) -> Iterator[Times]:
    """What the dataset says of each train; arrays once, as reading a dataset takes long."""
    time_s, h = dataset.time.to_numpy(), step_s(dataset)
    trains = dataset.sizes["train"]
    # Earlier results have no delays, nor calls.
    absent = {"departure_delay": np.zeros(trains)}
    unknown = np.full((trains, 0), np.nan)
    columns = [
        dataset[name].to_numpy() if name in dataset.coords else absent.get(name, unknown)
        for name in ("departure_time", "departure_delay", "arrival_time", "call_arrival_time",
                     "call_departure_time")
    ]  # fmt: skip
    for name in ("route_position", "speed", "holding_time", "train_state"):
        columns.append(dataset[name].to_numpy().T)
    for values in zip(*columns, strict=True):
        yield Times(time_s, h, *values)


def _scheduled_at(call: Call, departed_min: float) -> tuple[float, float]:
    """Scheduled arrival and departure at a call of a train that departed then. [min]"""
    arrival = math.nan if call.arrive_min is None else departed_min + call.arrive_min
    departure = math.nan if call.depart_min is None else departed_min + call.depart_min
    return arrival, departure


def _times_at(call: Call, train: Times) -> tuple[float, float, float]:
    """Arrival, departure and dwell of a train at a call. [min]"""
    if call.kind == "start":
        return np.nan, train.departure_s / 60.0, np.nan
    if call.kind == "end":
        return train.arrival_s / 60.0, np.nan, np.nan
    if call.kind == "pass":
        passed_min = _passing_s(call.position_m, train) / 60.0
        return passed_min, passed_min, passed_min - passed_min
    if np.isfinite(train.call_arrival_s[call.number : call.number + 1]).any():
        arrival_s, departure_s = (
            float(each[call.number]) for each in (train.call_arrival_s, train.call_departure_s)
        )
        return arrival_s / 60.0, departure_s / 60.0, (departure_s - arrival_s) / 60.0
    stands = (np.abs(train.position_m - call.position_m) <= AT_STOP_M) & (train.speed_m_s == 0.0)
    if not stands.any():
        return np.nan, np.nan, np.nan
    first, h = int(stands.argmax()), train.step_s
    arrival_min = _arrival_s(first, train.position_m, train.speed_m_s, train.holding_s, h) / 60.0
    goes_on = np.flatnonzero(train.state[first:-1] != TrainState.DWELLING)
    departure_min = (first + int(goes_on[0])) * h / 60.0 if len(goes_on) else np.nan
    return arrival_min, departure_min, departure_min - arrival_min


def _passing_s(place_m: float, train: Times) -> float:
    r"""When a train passes a place, between two instants; NaN if it does not within the run. [s]

    Between them its speed is taken to change evenly over time.  At a share f of its way the square of
    its speed is then v_0² + f (v_1² - v_0²), and the share of the time is way over mean speed,

    .. math:: \frac{f (v_0 + v_1)}{v_0 + \sqrt{v_0^2 + f (v_1^2 - v_0^2)}}.
    """
    there = np.flatnonzero(np.isfinite(train.position_m))
    ahead_m = place_m - train.position_m[there]
    passed = np.flatnonzero((ahead_m[:-1] * ahead_m[1:] <= 0.0) & (ahead_m[:-1] != ahead_m[1:]))
    if not len(passed):
        return math.nan
    k = int(passed[0])
    share = float(ahead_m[k] / (ahead_m[k] - ahead_m[k + 1]))
    before, after = (float(train.speed_m_s[there[k + i]]) for i in (0, 1))
    here = before + math.sqrt(before**2 + share * (after**2 - before**2))
    time = share * (before + after) / here if here > 0.0 else share
    begin_s, end_s = (float(train.time_s[there[k + i]]) for i in (0, 1))
    return begin_s + time * (end_s - begin_s)


def _arrival_s(
    instant: int, position_m: Floats, speed_m_s: Floats, holding_s: Floats, step_s: float
) -> float:
    """When a train that stands at an instant came to stand, in the step before or at its end. [s]

    Within that step it holds its speed v for a time t, and then brakes evenly over what is left of its
    way s: for 2 (s - v t) / v.
    """
    before = instant - 1
    if before < 0 or not np.isfinite(position_m[before]):
        return np.nan  # it was on the line at the start, or stands where it begins
    speed, held_s = float(speed_m_s[before]), float(holding_s[before])
    if speed <= 0.0:
        return instant * step_s
    way_m = abs(float(position_m[instant] - position_m[before]))
    braking_s = 2.0 * (way_m - speed * held_s) / speed
    return before * step_s + min(step_s, held_s + braking_s)
