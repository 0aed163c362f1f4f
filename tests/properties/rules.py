"""What must hold of every run, whatever the scenario; an AssertionError says which rule is broken."""

import math

import numpy as np

from tpss import Result
from tpss.model.build import steps_of
from tpss.simulation.state import STATE_ARRIVED, STATE_DWELLING

ROUNDING_M_S = 2e-9
ROUNDING_M = 1e-6
STOP_ERROR_M = 1e-3


def keep_the_rules(result: Result) -> None:
    """The audit, the values, the departures, and the way of every train."""
    assert result.audit["passed"], result.audit["failures"]
    judge_values(result)
    judge_departures(result)
    for train in result.dataset.train.to_numpy():
        Journey(result, str(train)).judge()


def judge_values(result: Result) -> None:
    """Finite values where there is a train, a node, a station; none where there is no train."""
    data = result.dataset
    steps = data.sizes["time"] - 1
    state = data.train_state.to_numpy()[:steps]
    present, driven = state >= 0, (state >= 0) & (state != STATE_ARRIVED)
    for name in set(data.data_vars) - {"train_state", "load_flow_passes"}:
        values = data[name].to_numpy()[:steps]
        if data[name].dims == ("time", "train"):
            expected = present if name in ("position", "speed") else driven
            if name == "motor_current":
                expected = driven & knows_its_current(result)
            assert (np.isfinite(values) == expected).all(), f"{name} is not where the trains are"
        else:
            assert np.isfinite(values).all(), f"{name} is not finite"


def knows_its_current(result: Result) -> np.ndarray:
    """Trains whose motors' voltage is known, and so their current."""
    train_of = {entry.name: entry.train for entry in result.scenario.traffic}
    services = result.dataset.service.to_numpy()
    trains = [result.scenario.trains[train_of[service]] for service in services]
    return np.array([train.base_speed_kmh is not None for train in trains], dtype=bool)


def judge_departures(result: Result) -> None:
    """A train departs at the first instant no more than a microsecond before its time."""
    data, h = result.dataset, result.dataset.attrs["time_step_s"]
    begun = data.sizes["time"] - 1 + (result.status in ("collapsed", "stalled"))
    for entry in result.scenario.traffic:
        asked_min = entry.departures_min
        if asked_min is None:
            last_min = begun * h / 60.0 + entry.headway_min
            count = max(0, math.ceil((last_min - entry.first_departure_min) / entry.headway_min))
            asked_min = [entry.first_departure_min + k * entry.headway_min for k in range(count)]
        due = [max(0, math.ceil((60.0 * minute - 1e-6) / h)) for minute in asked_min]
        mine = data.departure_time.to_numpy()[data.service.to_numpy() == entry.name]
        departed = np.rint(mine[np.isfinite(mine)] / h)
        assert departed.tolist() == [step for step in due if step < max(begun, 1)], entry.name


class Journey:
    """The way of one train, and the rules that it has to keep."""

    def __init__(self, result: Result, name: str) -> None:
        data, line = result.dataset, result.scenario.line
        i = data.train.to_numpy().tolist().index(name)
        self.name = name
        self.step_s = float(data.attrs["time_step_s"])
        self.driver = result.scenario.simulation.driver
        rows = np.flatnonzero(np.isfinite(data.position.to_numpy()[:, i]))
        assert (np.diff(rows) == 1).all(), f"{self.name} is away for a while"
        self.x, self.v, self.braking, self.a, self.state = (
            data[name].to_numpy()[rows, i]
            for name in ("position", "speed", "braking_force", "acceleration", "train_state")
        )
        service = str(data.service.to_numpy()[i])
        self.entry = next(entry for entry in result.scenario.traffic if entry.name == service)
        self.train = result.scenario.trains[self.entry.train]
        self.limit_m = np.array([limit.from_km * 1e3 for limit in line.speed_limits])
        limits = [min(item.speed_kmh, self.train.max_speed_kmh) for item in line.speed_limits]
        self.limit = np.array(limits) / 3.6
        self.place_m = {station.name: station.position_km * 1e3 for station in line.stations}

    def judge(self) -> None:
        """All rules; the aggressive driver does not keep to limits."""
        if self.driver == "regulated":
            self.keeps_to_the_limits()
        self.moves_forwards()
        self.brakes_no_harder_than_it_may()
        self.stops_and_dwells()

    def keeps_to_the_limits(self) -> None:
        """At every instant; a step that passes a limit's position begins and ends at or below it."""
        holds = self.limit[np.searchsorted(self.limit_m, self.x, side="right") - 1]
        excess = (self.v - holds).max()
        assert excess <= ROUNDING_M_S, f"{self.name} is {excess} m/s above its limit"
        for place, limit in zip(self.limit_m, self.limit, strict=True):
            passes = (self.x[:-1] < place - ROUNDING_M) & (self.x[1:] > place + ROUNDING_M)
            speeds = np.maximum(self.v[:-1], self.v[1:])[passes]
            assert speeds.max(initial=0.0) <= limit + ROUNDING_M_S, (
                f"{self.name} passes {place} m, limited to {limit} m/s, at {speeds} m/s"
            )

    def moves_forwards(self) -> None:
        """No reversal."""
        assert self.v.min() >= 0.0, f"{self.name} runs backwards"
        assert np.diff(self.x).min(initial=0.0) >= 0.0, f"{self.name} moves backwards"

    def brakes_no_harder_than_it_may(self) -> None:
        """Where its brakes act; a gradient may be steeper than they are strong."""
        hardest = -self.a[self.braking > 0.0].min(initial=0.0)
        highest = self.train.max_retardation_m_s2
        assert hardest <= highest * (1.0 + 1e-9) + 1e-12, f"{self.name} brakes by {hardest} m/s²"

    def stops_and_dwells(self) -> None:
        """At each stop it meets: within a millimetre, for the steps of its dwell."""
        stops = [
            (self.place_m[stop.station], steps_of(60.0 * stop.dwell_min, self.step_s))
            for stop in self.entry.stops
        ]
        for place, dwell in [*stops, (self.place_m[self.entry.destination], 0)]:
            stood = (np.abs(self.x - place) < STOP_ERROR_M) & (self.v == 0.0)
            left = self.x[-1] > place + STOP_ERROR_M
            if self.x[0] >= place or not (left or stood.any()):
                continue
            assert stood.any(), f"{self.name} runs through its stop at {place} m"
            if left:
                dwelled = int((self.state[stood] == STATE_DWELLING).sum())
                assert dwelled == dwell, f"{self.name} dwells {dwelled} steps at {place} m"
