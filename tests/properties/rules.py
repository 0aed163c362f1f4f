"""What must hold of every run, whatever the scenario; an AssertionError says which rule is broken."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from tpss import Result, Scenario
from tpss.results.passing import stand_before
from tpss.results.places import train_tracks
from tpss.results.stranded import feed_themselves
from tpss.run.delays import Delays
from tpss.scenario.supply.feeds import feeds_of, places_on
from tpss.scenario.traffic import Traffic
from tpss.step.state import TrainState

from .given_tracks import judge_given_tracks
from .journeys import Journey
from .losses import judge_losses
from .ratings import judge_ratings
from .single_tracks import judge_single_tracks
from .trips import judge_trips


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
    judge_losses(result)
    judge_ratings(result)
    judge_trips(result)
    for train in result.dataset.train.to_numpy():
        Journey(result, str(train)).judge()


STATES = ("position", "route_position", "speed", "train_stored_energy")
"""Variables of trains that hold at instants."""


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
            expected = present if name in STATES else driven
            if name == "motor_current":
                expected = driven & knows_its_current(result)
            if name in ("rail_voltage", "rail_angle"):  # not told where no source reaches a train
                expected = driven & (data.pantograph_voltage.to_numpy()[:steps] != 0.0)
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
    asked = asked_departures(result.scenario, begun * h / 60.0)
    for entry, asked_min in zip(result.scenario.traffic, asked, strict=True):
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


def asked_departures(scenario: Scenario, until_min: float) -> list[list[float]]:
    """When trains of each service are to depart, some beyond a time too, ascending. [min]

    Of trains that begin at one station each waits until the one before it has been gone for a while.
    """
    asked = []
    for entry in scenario.traffic:
        times_min = entry.listed_departures_min
        if times_min is None:
            last_min = until_min + entry.headway_min
            count = max(0, math.ceil((last_min - entry.first_departure_min) / entry.headway_min))
            times_min = [entry.first_departure_min + k * entry.headway_min for k in range(count)]
        asked.append(list(times_min) if entry.delays is None else delayed(times_min, entry))
    apart_min, free_min = scenario.signalling.starts_apart_s / 60.0, dict[str, float]()
    if apart_min == 0.0:
        return asked
    starts: list[list[float]] = [[] for _ in asked]
    for minute, number in sorted((m, k) for k, times_min in enumerate(asked) for m in times_min):
        origin = scenario.traffic[number].origin
        start_min = max(minute, free_min.get(origin, minute))
        free_min[origin] = start_min + apart_min
        starts[number].append(start_min)
    return starts


def delayed(scheduled_min: Sequence[float], entry: Traffic) -> list[float]:
    """Times of departure of trains that are delayed, ascending. [min]"""
    drawn = Delays(60.0 * entry.delays.mean_min, entry.delays.share, entry.delays.seed)
    alone = entry.departure_min is not None
    names = [entry.name if alone else f"{entry.name} {k}" for k in range(1, len(scheduled_min) + 1)]
    return sorted(
        minute + drawn.of(name) / 60.0 for minute, name in zip(scheduled_min, names, strict=True)
    )


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
    unfed = (data.pantograph_voltage.to_numpy()[:-1] == 0.0) & ~feed_themselves(data)
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
    """Units of a station that are in service in a step; none from its trip on."""
    h = result.dataset.attrs["time_step_s"] / 60.0
    for trip in result.summary.get("trips", []):
        if trip["element"] == station.name and step * h >= trip["time_min"] - 1e-9:
            return 0
    outage = result.scenario.outage
    out = outage.units_of(station) if is_out(outage, step, result) else 0
    return int(station.installed - out)
