"""Times at stops: when each train came to stand at its stations, and when it went on."""

import math
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.model.routes import Route, routes_of
from tpss.results.standards.windows import Floats, table_of
from tpss.results.tables import step_s
from tpss.scenario.clock import clock_at
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
    arrival_min: float
    departure_min: float
    dwell_min: float
    scheduled_arrival_min: float
    scheduled_departure_min: float
    late_min: float
    """How much later than scheduled it arrived, or departed where no arrival is scheduled."""


TIMES = ("arrival", "departure", "scheduled_arrival", "scheduled_departure")
"""Times that are also shown by the clock."""


def stops(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per train and station where it begins, stops or ends: arrival, departure, dwell.

    Scheduled times count from the train's own departure at its origin, and are NaN where none are given.
    A train that brakes within a step arrives when it stands, not at the next instant.  What it has not
    done within the run is NaN, and so is what it did before, if it was on the line at the start.  Where
    the simulation has a clock, columns with its times come behind the others.
    """
    entries = {entry.name: entry for entry in scenario.traffic}
    calls = {
        entry.name: _calls(route, len(scenario.lines_by_name) > 1)
        for entry, route in zip(scenario.traffic, routes_of(scenario), strict=True)
    }
    names, services = dataset.train.to_numpy(), dataset.service.to_numpy()
    rows = []
    for i, (name, service) in enumerate(zip(names, services, strict=True)):
        entry, train = entries[str(service)], dataset.isel(train=i)
        for call, place in enumerate(calls[str(service)], -1):
            times = _times_at(call, place.position_m, entry, train)
            scheduled = _scheduled_at(call, entry, float(train.departure_time) / 60.0)
            late_min = times[0] - scheduled[0]
            if math.isnan(scheduled[0]):
                late_min = times[1] - scheduled[1]
            rows.append(
                StopTimes(
                    str(name),
                    place.station,
                    place.line,
                    place.place_km,
                    *times,
                    *scheduled,
                    late_min,
                )
            )
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


class _Place(NamedTuple):
    """Where trains of a service begin, stop or end."""

    station: str
    line: str
    place_km: float
    position_m: float
    """Along their route. [m]"""


def _calls(route: Route, several: bool) -> list[_Place]:
    """Places where trains of a service begin, stop and end; with lines, if there are several."""
    hops = route.way.hops
    ends = [hops[i] for i in (*route.way.stops, -1)]
    return [
        _Place(hops[0].begin, hops[0].line if several else "", hops[0].begin_km, route.start_m),
        *(
            _Place(hop.end, hop.line if several else "", hop.end_km, position_m)
            for hop, position_m in zip(ends, route.stops_m, strict=True)
        ),
    ]


def _scheduled_at(call: int, entry: Traffic, departed_min: float) -> tuple[float, float]:
    """Scheduled arrival and departure at a call of a train that departed then. [min]"""
    arrive_min = depart_min = None
    if 0 <= call < len(entry.stops):
        stop = entry.stops[call]
        arrive_min, depart_min = stop.arrive_after_min, stop.depart_after_min
    elif call == len(entry.stops):
        arrive_min = entry.arrive_after_min
    arrival = math.nan if arrive_min is None else departed_min + arrive_min
    departure = math.nan if depart_min is None else departed_min + depart_min
    return arrival, departure


def _times_at(
    call: int, place_m: float, entry: Traffic, train: xr.Dataset
) -> tuple[float, float, float]:
    """Arrival, departure and dwell of a train at its stop of this number. [min]"""
    if call < 0:
        return np.nan, float(train.departure_time) / 60.0, np.nan
    if call == len(entry.stops):
        return float(train.arrival_time) / 60.0, np.nan, np.nan
    if (arrival_s := float(train.call_arrival_time[call])) == arrival_s:
        departure_s = float(train.call_departure_time[call])
        return arrival_s / 60.0, departure_s / 60.0, (departure_s - arrival_s) / 60.0
    position_m, speed_m_s = train.route_position.to_numpy(), train.speed.to_numpy()
    stands = (np.abs(position_m - place_m) <= AT_STOP_M) & (speed_m_s == 0.0)
    if not stands.any():
        return np.nan, np.nan, np.nan
    first, h = int(stands.argmax()), step_s(train)
    arrival_min = _arrival_s(first, position_m, speed_m_s, train.holding_time.to_numpy(), h) / 60.0
    goes_on = np.flatnonzero(train.train_state.to_numpy()[first:-1] != TrainState.DWELLING)
    departure_min = (first + int(goes_on[0])) * h / 60.0 if len(goes_on) else np.nan
    return arrival_min, departure_min, departure_min - arrival_min


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
