"""What must hold of every run, whatever the scenario; an AssertionError says which rule is broken."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from tpss import Result, library
from tpss.model.build import steps_of
from tpss.results.passing import stand_before
from tpss.results.places import train_tracks
from tpss.run.delays import Delays
from tpss.scenario.machine import RetardationBands
from tpss.scenario.supply.feeds import feeds_of, places_on
from tpss.scenario.traffic import Traffic
from tpss.step.state import TrainState

from .given_tracks import judge_given_tracks
from .roundings import excess_of_braking
from .single_tracks import judge_single_tracks
from .ways import along_way

ROUNDING_M_S = 2e-9
ROUNDING_M = 1e-6
STOP_ERROR_M = 1e-3


def keep_the_rules(result: Result) -> None:
    """The audit, the values, the departures, and the way of every train."""
    assert result.audit["passed"], result.audit["failures"]
    judge_values(result)
    judge_departures(result)
    judge_converters(result)
    judge_separation(result)
    judge_single_tracks(result)
    judge_given_tracks(result)
    judge_outage(result)
    for train in result.dataset.train.to_numpy():
        Journey(result, str(train)).judge()


def judge_values(result: Result) -> None:
    """Finite values where there is a train, a node, a station; none where there is no train."""
    data = result.dataset
    steps = data.sizes["time"] - 1
    state = data.train_state.to_numpy()[:steps]
    present, driven = state >= 0, (state >= 0) & (state != TrainState.ARRIVED)
    for name in {"train_line", "train_track"} & set(data.data_vars):
        assert ((data[name].to_numpy()[:steps] >= 0) == present).all(), f"{name} is not told"
    codes = {"train_state", "load_flow_passes", "train_line", "train_track", "waits_for"}
    for name in set(data.data_vars) - codes:
        values = data[name].to_numpy()[:steps]
        if data[name].dims == ("time", "train"):
            expected = present if name in ("position", "route_position", "speed") else driven
            if name == "motor_current":
                expected = driven & knows_its_current(result)
            assert (np.isfinite(values) == expected).all(), f"{name} is not where the trains are"
        else:
            assert np.isfinite(values).all(), f"{name} is not finite"


def judge_separation(result: Result) -> None:
    """On a line alone, nobody comes nearer than the margin behind the rear of a train of his direction,
    on his track.

    Those that were placed nearer come no nearer; where they cannot brake in time, nothing is said.
    """
    signalling, data = result.scenario.signalling, result.dataset
    if signalling.separation == "none" or len(result.scenario.lines_by_name) > 1:
        return
    if result.summary["limited"]["too_near"] or data.sizes["train"] < 2:
        return
    trains, services = result.scenario.trains_by_service(), data.service.to_numpy()
    length_m = np.array([trains[str(service)].length_m for service in services])
    place_m, along_m = data.position.to_numpy(), data.route_position.to_numpy()
    moving, tracks = data.speed.to_numpy() > 0.0, train_tracks(data)
    beside = stand_before(result)
    (line,) = result.scenario.lines_by_name.values()
    stations_m = np.array([1e3 * s.position_km for s in line.stations])
    several = np.array([s.tracks > 1 for s in line.stations])

    def have_tracks(pair_m: Any, stands: bool) -> bool:
        """Whether one of two trains may wait beside the other: at an origin, or on several tracks."""
        around = (stations_m >= pair_m.min() - 1e3) & (stations_m <= pair_m.max() + 1e3)
        return bool((around & (several | stands)).any())

    for sign in (1.0, -1.0):
        with np.errstate(invalid="ignore"):
            own = np.isfinite(along_m) & (
                np.abs(along_m - sign * place_m) <= 1e-6 * np.abs(along_m)
            )
        for step in range(len(along_m)):
            here = np.flatnonzero(own[step])
            order = here[np.argsort(along_m[step, here], kind="stable")]
            order = order[np.argsort(tracks[step, order], kind="stable")]
            for behind, ahead in zip(order, order[1:], strict=False):
                if tracks[step, behind] != tracks[step, ahead] or beside[step, ahead]:
                    continue
                room_m = along_m[step, ahead] - length_m[ahead] - along_m[step, behind]
                if step and moving[step, behind] and own[step - 1, [behind, ahead]].all():
                    before_m = (
                        along_m[step - 1, ahead] - length_m[ahead] - along_m[step - 1, behind]
                    )
                    if signalling.has_gates and have_tracks(
                        place_m[step, [behind, ahead]], not moving[step, ahead]
                    ):
                        continue
                    assert room_m >= min(signalling.margin_m, before_m) - 0.01, (
                        f"{data.train.to_numpy()[behind]} is {room_m} m behind another at step {step}"
                    )


def knows_its_current(result: Result) -> np.ndarray:
    """Trains whose motors' voltage is known, and so their current."""
    train_of = {entry.name: entry.train for entry in result.scenario.traffic}
    services = result.dataset.service.to_numpy()
    trains = [result.scenario.trains[train_of[service]] for service in services]
    return np.array([train.base_speed_kmh is not None for train in trains], dtype=bool)


def judge_departures(result: Result) -> None:
    """A train departs at its time; in stepped motion, at the first instant no more than 1 µs before."""
    data, h = result.dataset, result.dataset.attrs["time_step_s"]
    continuous = result.scenario.simulation.how_trains_move == "continuous"
    begun = data.sizes["time"] - 1 + (result.status in ("collapsed", "stalled", "deadlocked"))
    for entry in result.scenario.traffic:
        asked_min = entry.listed_departures_min
        if asked_min is None:
            last_min = begun * h / 60.0 + entry.headway_min
            count = max(0, math.ceil((last_min - entry.first_departure_min) / entry.headway_min))
            asked_min = [entry.first_departure_min + k * entry.headway_min for k in range(count)]
        if entry.delays is not None:
            asked_min = delayed(asked_min, entry)
        mine = data.departure_time.to_numpy()[data.service.to_numpy() == entry.name]
        departed_s = mine[np.isfinite(mine)]
        if continuous:
            step_of = [math.floor((60.0 * minute + 1e-6) / h) for minute in asked_min]
            end_s = float(data.time[-1]) if result.status == "finished" else math.inf
            due_s = [
                60.0 * minute
                for minute, step in zip(asked_min, step_of, strict=True)
                if step < max(begun, 1) and (begun == 0 or 60.0 * minute < end_s)
            ]
            if result.status != "finished":  # a step that was to end with an arrival is shorter
                left_out = due_s[len(departed_s) :]
                assert all(time_s >= h * (begun - 1) for time_s in left_out), entry.name
                due_s = due_s[: len(departed_s)]
            assert departed_s.tolist() == pytest.approx(due_s, rel=0.0, abs=2e-6), entry.name
            continue
        due = [max(0, math.ceil((60.0 * minute - 1e-6) / h)) for minute in asked_min]
        departed = np.rint(departed_s / h)
        assert departed.tolist() == [step for step in due if step < max(begun, 1)], entry.name


def delayed(scheduled_min: Sequence[float], entry: Traffic) -> list[float]:
    """Times of departure of trains that are delayed, ascending. [min]"""
    drawn = Delays(60.0 * entry.delays.mean_min, entry.delays.share, entry.delays.seed)
    alone = entry.departure_min is not None
    names = [entry.name if alone else f"{entry.name} {k}" for k in range(1, len(scheduled_min) + 1)]
    return sorted(
        minute + drawn.of(name) / 60.0 for minute, name in zip(scheduled_min, names, strict=True)
    )


def motor_force_n(speed_kmh: float, voltage_kv: float, current_a: float) -> float:
    """Largest force of all motors: the network as it is printed, (C.1)-(C.17)."""
    net = library.networks()["tractive_effort"]
    low, high = np.array(net["input_min"]), np.array(net["input_max"])
    scaled = 2.0 * (np.array([speed_kmh, voltage_kv, current_a]) - low) / (high - low) - 1.0
    hidden = np.tanh(np.array(net["b1"]) + np.array(net["W1"]) @ scaled)
    output = net["b2"] + np.array(net["w2"]) @ hidden
    return float(net["output_min"] + (output + 1.0) / 2.0 * (net["output_max"] - net["output_min"]))


def judge_converters(result: Result) -> None:
    """As many converters run as carry 85 % of the mean loading since the last action, three-minutely.

    At the first instant at or past each multiple of three minutes; where all are to run, all run.
    """
    data, h = result.dataset, result.dataset.attrs["time_step_s"]
    steps = data.sizes["time"] - 1
    for s, station in enumerate(result.scenario.supply.converter_stations):
        loading = data.converter_loading.to_numpy()[:steps, s]
        recorded = data.active_converters.to_numpy()[:, s]
        controlled = station.control == "loading"
        there = units_in_service(result, station, 0)
        running, carried, since, period = there, 0.0, 0, 1
        for k in range(steps):
            if there != (there := units_in_service(result, station, k)):
                was, running = running, min(running, there) if controlled and running else there
                carried *= was / running if running else 0.0
                if was == 0:
                    carried = 0.85 * (k - since)
            if controlled and k * h >= 180.0 * period - 1e-6:
                needed = math.ceil(carried / (k - since) * running / 0.85 - 1e-9)
                running = min(there, max(1, needed))
                carried, since, period = 0.0, k, math.floor((k * h + 1e-6) / 180.0) + 1
            assert recorded[k] == running, f"{station.name}, step {k}"
            carried += loading[k]


def judge_outage(result: Result) -> None:
    """What is out of service feeds nothing and carries nothing, and all that is not runs."""
    data, supply, outage = result.dataset, result.scenario.supply, result.scenario.outage
    unfed = data.pantograph_voltage.to_numpy()[:-1] == 0.0
    for name in ("tractive_force", "active_power", "reactive_power", "motor_power"):
        assert (data[name].to_numpy()[:-1][unfed] == 0.0).all(), f"{name} without power"
    fed = np.hypot(data.station_active_power, data.station_reactive_power).to_numpy()[:-1]
    for s, station in enumerate(supply.stations):
        units = [units_in_service(result, station, k) for k in range(len(fed))]
        out, recorded = np.array(units) == 0, data.active_converters.to_numpy()[:-1, s]
        assert (fed[out, s] == 0.0).all(), f"{station.name} is out, and feeds"
        assert (data.converter_loading.to_numpy()[:-1][out, s] == 0.0).all(), station.name
        assert ((recorded > 0) == ~out).all(), f"{station.name} runs where it is out, or does not"
        if station in supply.transformer_stations:
            assert recorded.tolist() == units, station.name
    current = data.branch_current.to_numpy()[:-1]
    out = np.array([is_out(outage, k, result) for k in range(len(fed))], dtype=bool)
    transformers = np.flatnonzero(data.branch_kind.to_numpy() == "transformer")
    places_km = np.array([float(name.split()[-2]) for name in data.branch.to_numpy()[transformers]])
    for km in outage.transformers_km if outage is not None else ():
        nearest = transformers[np.abs(places_km - km).argmin()]
        assert (current[out, nearest] == 0.0).all(), f"the one at {km} km carries a current"

    if outage is not None:
        judge_parted(result, out)


def judge_parted(result: Result, out: Any) -> None:
    """Trains under a section that is out have no voltage, and a station without a feed feeds nothing."""
    data, outage, scenario = result.dataset, result.scenario.outage, result.scenario
    lines = list(scenario.lines_by_name.items())
    km, volts = data.position.to_numpy()[:-1] / 1e3, data.pantograph_voltage.to_numpy()[:-1]
    on_line = data.train_line.to_numpy()[:-1] if "train_line" in data else np.zeros(km.shape)
    on_track = data.train_track.to_numpy()[:-1] if "train_track" in data else np.ones(km.shape)
    for section in outage.sections:
        number = next(i for i, (name, _) in enumerate(lines) if section.line in (None, name))
        begin, end = section.ends_km(lines[number][1].begins_at_km, lines[number][1].end_km)
        inside = (on_line == number) & (km > begin + 1e-6) & (km < end - 1e-6) & out[:, None]
        inside &= (on_track == section.track) | (section.track is None)
        assert (volts[inside & np.isfinite(volts)] == 0.0).all(), (
            f"{section.in_words} has a voltage"
        )
    places = places_on(scenario.lines_by_name)
    for s, station in enumerate(scenario.supply.stations):
        if {feed.name for feed in feeds_of(station, places)} <= set(outage.opens):
            fed = np.hypot(data.station_active_power, data.station_reactive_power)[:-1, s]
            alone = scenario.supply.high_voltage_line is None
            assert not alone or (fed.to_numpy()[out] < 10.0).all(), f"{station.name} feeds nothing"


def is_out(outage: Any, step: int, result: Result) -> bool:
    """Whether an outage holds in a step: from the first instant at or after its time."""
    if outage is None:
        return False
    time_min = step * result.dataset.attrs["time_step_s"] / 60.0 + 1e-9
    end_min = math.inf if outage.to_min is None else outage.to_min
    return bool(outage.from_min <= time_min < end_min)


def units_in_service(result: Result, station: Any, step: int) -> int:
    """Units of a station that are in service in a step."""
    outage = result.scenario.outage
    out = outage.units_of(station) if is_out(outage, step, result) else 0
    return int(station.installed - out)


class Journey:
    """The way of one train, and the rules that it has to keep."""

    def __init__(self, result: Result, name: str) -> None:
        data = result.dataset
        i = data.train.to_numpy().tolist().index(name)
        self.name = name
        self.step_s = float(data.attrs["time_step_s"])
        self.driver = result.scenario.simulation.driver
        self.kept_apart = result.scenario.signalling.separation != "none"
        self.continuous = result.scenario.simulation.how_trains_move == "continuous"
        self.brakes_within_steps = result.scenario.simulation.braking == "within-step"
        calls = data.isel(train=i)
        self.arrived_s = calls.call_arrival_time.to_numpy()
        self.went_on_s = calls.call_departure_time.to_numpy()
        # Where trains may be late, their times stay those of the schedule.
        self.departed_s = float(calls.departure_time - calls.departure_delay)
        rows = np.flatnonzero(np.isfinite(data.position.to_numpy()[:, i]))
        assert (np.diff(rows) == 1).all(), f"{self.name} is away for a while"
        self.time_s = data.time.to_numpy()[rows]
        self.x, self.v, self.braking, self.a, self.state = (
            data[name].to_numpy()[rows, i]
            for name in ("route_position", "speed", "braking_force", "acceleration", "train_state")
        )
        service = str(data.service.to_numpy()[i])
        self.entry = next(entry for entry in result.scenario.traffic if entry.name == service)
        self.train = result.scenario.trains[self.entry.train]
        way = along_way(result.scenario, self.entry)
        self.stops_m, self.end_m = way.stops_m, way.end_m
        self.limit_m = np.array([from_m for from_m, _ in way.limits])
        limits = [min(speed_kmh, self.train.max_speed_kmh) for _, speed_kmh in way.limits]
        self.limit = np.array(limits) / 3.6
        self.keep_limits_until_the_tail_has_passed()
        self.force, self.volts, resistance, climb = (
            data[name].to_numpy()[rows, i]
            for name in (
                "tractive_force", "pantograph_voltage", "running_resistance", "gradient_force"
            )
        )  # fmt: skip
        self.opposing = resistance + climb
        self.wet = result.scenario.simulation.rail == "wet"
        self.adhesion_in_km_h = result.scenario.simulation.adhesion_speed_unit == "km/h"

    def keep_limits_until_the_tail_has_passed(self) -> None:
        """Replace the limits by the lowest ones under the train."""
        length_m = self.train.length_m
        if length_m == 0.0:
            return
        ends_m = [*(self.limit_m[1:] + length_m), math.inf]
        limits = list(zip(self.limit_m, ends_m, self.limit, strict=True))
        self.limit_m = np.array(sorted({*self.limit_m.tolist(), *ends_m[:-1]}))
        self.limit = np.array(
            [min(limit for begin, end, limit in limits if begin <= x < end) for x in self.limit_m]
        )

    def judge(self) -> None:
        """All rules; the aggressive driver does not keep to limits, nor aims at them.

        Full effort is known here for the network's machine; tables and limits have closed forms in
        their own tests.
        """
        regulated = self.driver == "regulated"
        if regulated:
            self.keeps_to_the_limits()
        self.moves_forwards()
        self.brakes_no_harder_than_it_may()
        free = self.train.tractive_effort == "Rc4" and self.train.current_limitation is None
        free &= not self.kept_apart
        if regulated and free and self.continuous:
            self.gives_all_it_can_between_two_speeds()
        elif regulated and free:
            self.gives_all_it_can()
        if self.continuous:
            self.stops_and_dwells_to_the_second()
        else:
            self.stops_and_dwells()

    def keeps_to_the_limits(self) -> None:
        """At every instant; a step that passes a limit's position begins and ends at or below it.

        In continuous motion a train brakes to a limit, and goes on from it, within a step.
        """
        holds = self.limit[np.searchsorted(self.limit_m, self.x, side="right") - 1]
        excess = (self.v - holds).max()
        assert excess <= ROUNDING_M_S, f"{self.name} is {excess} m/s above its limit"
        if self.continuous:
            return
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
        from_m_s, retardation = self.retardation
        brakes, excess = self.braking[:-1] > 0.0, np.zeros(self.x.size)
        if self.brakes_within_steps and not self.continuous:
            excess = excess_of_braking(self.x, np.array([*self.stops_m, self.end_m]), brakes)
        for k in np.flatnonzero(brakes):
            hardest = -self.a[k]
            slower = min(
                self.v[k], self.v[k + 1]
            )  # within a long step it may be faster than at its ends
            highest = retardation[np.append(from_m_s[1:], np.inf) >= slower].max()
            assert hardest <= highest * (1.0 + 1e-9 + excess[k]) + 1e-12, (
                f"{self.name} brakes by {hardest} m/s²"
            )

    @property
    def retardation(self) -> tuple[Any, Any]:
        """Speeds from which its highest retardations hold, and these. [m/s], [m/s²]"""
        given = self.train.max_retardation_m_s2
        if isinstance(given, RetardationBands):
            return np.array(given.from_speed_kmh) / 3.6, np.array(given.retardation_m_s2)
        return np.zeros(1), np.array([given])

    def gives_all_it_can(self) -> None:
        """Well before its next stop and lower limits, a train reaches its limit, or gives all it can.

        That is what adhesion allows at its speed, and the machine at its voltage.
        """
        ends = [*self.stops_m, self.end_m]
        for k in np.flatnonzero((self.state[:-1] >= 0) & (self.state[:-1] != TrainState.DWELLING)):
            limit = self.limit[np.searchsorted(self.limit_m, self.x[k], side="right") - 1]
            if abs(self.v[k + 1] - limit) < ROUNDING_M_S:
                continue
            well_m = limit * (8.0 * self.step_s + 2.0 * limit / self.retardation[1].min())
            ahead = (self.limit_m > self.x[k]) & (self.limit_m < self.x[k] + well_m)
            # A train may begin within a rounding of its last stop.
            to_stop_m = min((end for end in ends if end > self.x[k]), default=self.x[k]) - self.x[k]
            if to_stop_m < well_m or (self.limit[ahead] < limit).any():
                continue
            most = self.largest_force_n(k)
            assert self.force[k] == pytest.approx(most, rel=1e-9, abs=1e-6), (
                f"{self.name} gives {self.force[k]} N of {most} N at {self.x[k]} m"
            )

    def gives_all_it_can_between_two_speeds(self) -> None:
        """In a step that accelerates below the limit, the mean force is one that belongs to its speeds.

        Adhesion and machine fall with the speed, but for the ripples of the network; resistances, which
        the rotors add a little of, change too.
        """
        for k in np.flatnonzero(self.state[:-1] == TrainState.MOTORING):
            here = np.searchsorted(self.limit_m, self.x[k : k + 2], side="right") - 1
            v, after = self.v[k], self.v[k + 1]
            if (
                not 0.0 < v < after
                or here[0] != here[1]
                or after >= self.limit[here[0]] - ROUNDING_M_S
            ):
                continue
            if self.near_a_stop(k) or self.braking[k] > 0.0:
                continue
            speeds = np.linspace(v, after, 21)
            most = [self.largest_force_n(k, speed) for speed in speeds]
            slack = 1e-3 * max(most) + 1.0
            assert min(most) - slack <= self.force[k] <= max(most) + slack, (
                f"{self.name} gives {self.force[k]} N of {min(most)} to {max(most)} N at {self.x[k]} m"
            )

    def near_a_stop(self, k: int) -> bool:
        """Whether a train may brake for a stop or limit, or have stood at one, in step `k`."""
        ends = [*self.stops_m, self.end_m]
        fastest = self.limit.max()
        room_m = fastest * (2.0 * self.step_s + fastest / self.retardation[1].min())
        ahead = (self.limit_m > self.x[k]) & (self.limit_m < self.x[k] + room_m)
        at_stop = any(self.x[k] <= end <= self.x[k] + room_m for end in ends)
        return at_stop or bool((self.limit[ahead] < fastest).any())

    def largest_force_n(self, k: int, speed_m_s: float | None = None) -> float:
        """Force at the wheel rim in step `k` with full effort: adhesion, machine, never negative."""
        speed_m_s = self.v[k] if speed_m_s is None else speed_m_s
        train, v = self.train, speed_m_s * (3.6 if self.adhesion_in_km_h else 1.0)
        share = 3.78 / (23.6 + v) if self.wet else 0.161 + 7.5 / (44.0 + 3.6 * v)
        if isinstance(train.adhesion, float):
            share = train.adhesion
        elif train.adhesion is not None:  # through two points it is a line
            share = np.interp(3.6 * speed_m_s, train.adhesion.speed_kmh, train.adhesion.value)
        motors = motor_force_n(3.6 * speed_m_s, self.volts[k] / 1e3, train.max_motor_current_a)
        hauled_kg = 1e3 * (train.mass_t - train.adhesive_mass_t)
        inertia_kg = 1e3 * train.adhesive_mass_t + hauled_kg * (1.0 + train.rotating_mass_factor)
        if train.rotating_mass_share is not None:
            inertia_kg = 1e3 * train.mass_t * (1.0 + train.rotating_mass_share)
        rotors = train.motor_inertia_kg * (1.0 + train.slip) / inertia_kg
        machine = (max(0.0, motors) + rotors * self.opposing[k]) / (1.0 + rotors)
        return max(0.0, min(1e3 * train.adhesive_mass_t * 9.81 * share, machine))

    def stops_and_dwells_to_the_second(self) -> None:
        """At each stop it meets: within a millimetre at the instants, and for its dwell."""
        for call, stop in enumerate(self.entry.stops):
            place, dwell_s = self.stops_m[call], 60.0 * max(stop.dwell_min, stop.turn_min or 0.0)
            if self.x[0] >= place - ROUNDING_M or self.x[-1] <= place + STOP_ERROR_M:
                continue
            stood_s = self.went_on_s[call] - self.arrived_s[call]
            if stop.depart_after_min is not None:
                if math.isnan(self.departed_s):  # it was on the line at the start
                    assert stood_s >= dwell_s - 1e-6, f"{self.name} dwells {stood_s} s at {place} m"
                    continue
                leaves_s = self.departed_s + 60.0 * stop.depart_after_min
                dwell_s = max(dwell_s, leaves_s - self.arrived_s[call])
            assert stood_s == pytest.approx(dwell_s, rel=1e-9, abs=1e-6), (
                f"{self.name} dwells {stood_s} s at {place} m"
            )
        dwelling = (self.state == TrainState.DWELLING) & (not self.kept_apart)
        dwelling &= self.volts != 0.0
        places = np.array(self.stops_m)
        for x in self.x[dwelling]:
            assert np.abs(places - x).min(initial=math.inf) < STOP_ERROR_M, (
                f"{self.name} stands at {x}"
            )

    def stops_and_dwells(self) -> None:
        """At each stop it meets: within a millimetre, for the steps of its dwell."""
        stops = [
            (
                place_m,
                steps_of(60.0 * max(stop.dwell_min, stop.turn_min or 0.0), self.step_s),
                60.0 * (stop.depart_after_min or 0.0),
            )
            for stop, place_m in zip(self.entry.stops, self.stops_m, strict=True)
        ]
        for place, dwell, leaves_s in [*stops, (self.end_m, 0, 0.0)]:
            stood = (np.abs(self.x - place) < STOP_ERROR_M) & (self.v == 0.0)
            left = self.x[-1] > place + STOP_ERROR_M
            if self.x[0] >= place - ROUNDING_M or not (left or stood.any()):
                continue
            assert stood.any(), f"{self.name} runs through its stop at {place} m"
            if left:
                dwelled = int((self.state[stood] == TrainState.DWELLING).sum())
                if leaves_s > 0.0:
                    if math.isnan(self.departed_s):
                        assert dwelled >= dwell, f"{self.name} dwells {dwelled} steps at {place} m"
                        continue
                    arrived_s = float(self.time_s[np.flatnonzero(stood)[0]])
                    early_s = self.departed_s + leaves_s - arrived_s
                    dwell = max(dwell, steps_of(early_s, self.step_s))
                assert dwelled == dwell, f"{self.name} dwells {dwelled} steps at {place} m"
