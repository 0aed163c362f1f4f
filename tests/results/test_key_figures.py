"""Key figures of many runs are those of the full results, however many threads make them."""

import math
from collections import Counter
from itertools import count, islice
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, given, settings

import tpss
from tpss.many import key_figures
from tpss.results.key_figures import KeyFigures
from tpss.results.regeneration import fed_back

from conftest import EXAMPLE_SCENARIOS, SHARED
from properties.judge import is_long
from properties.strategies import sound_scenarios
from scenarios import gradients, short_line
from slow_audit import assert_agree, audit_of

FILES = sorted((SHARED / "scenarios").glob("*.toml")) or EXAMPLE_SCENARIOS
STALL = {"trains.freight.mass_t": 4000.0, **gradients((0.0, 0.0), (5.0, 30.0))}

SUMS = 1e-12
"""Sums of some thousand numbers, added in another order, differ by rounding alone."""


def close(found: float, expected: float | None, size: float = 0.0) -> bool:
    """Whether two figures agree, NaN and None with each other."""
    if expected is None or math.isnan(expected):
        return math.isnan(found)
    return abs(found - expected) <= SUMS * max(abs(expected), size)


def assert_same(found: KeyFigures, result: tpss.Result) -> None:
    """Assert that key figures are those of a full result."""
    summary, trips, stations = result.summary, result.trips, result.stations
    assert (found.name, found.status) == (summary["name"], summary["status"])
    assert found.steps == result.dataset.sizes["time"] - 1
    assert found.duration_min == summary["duration_min"]
    assert close(found.trip_time_min, summary["trip_time_min"])
    studied = trips[trips.train == summary["studied_train"]]
    arrived = studied[studied.arrival_min.notna()]
    if len(arrived):
        # A trip is the difference of two clock times, so it has the rounding of the later one.
        (_, arrival), *_ = arrived.iterrows()
        clocks = arrival.mean_speed_kmh * arrival.arrival_min / arrival.trip_min
        assert close(found.mean_speed_kmh, arrival.mean_speed_kmh, clocks)
    else:
        assert math.isnan(found.mean_speed_kmh)
    for service in found.services:
        own = trips[trips.service == service.name].trip_min.dropna()
        assert service.arrived == len(own)
        assert close(service.mean_trip_min, own.mean())
        assert close(service.longest_trip_min, own.max())
    for station, (_, expected) in zip(found.stations, stations.iterrows(), strict=True):
        # What a station takes and gives may cancel: rounding is that of what it moves.
        moved = expected.peak_power_mw * found.duration_min / 60.0
        assert station.name == expected.station
        assert close(station.energy_mwh, expected.energy_mwh, moved)
        assert close(station.reactive_energy_mvarh, expected.reactive_energy_mvarh, moved)
        assert close(station.mean_loading, expected.mean_loading)
        assert close(station.peak_loading, expected.peak_loading)
        assert close(station.peak_power_mw, expected.peak_power_mw)
    assert close(found.total_energy_mwh, summary["total_energy_mwh"], found.losses_mwh)
    assert close(found.losses_mwh, summary["losses_mwh"])
    converters = summary.get("converter_losses")
    assert close(found.converter_losses_mwh, converters and converters["losses_mwh"])
    braking = fed_back(result.dataset, result.scenario) or {}
    assert found.braking == pytest.approx(braking, rel=1e-9)
    lowest = found.lowest_voltage
    assert (lowest and lowest.as_dict()) == summary["lowest_voltage"]
    useful = summary["standards"]["mean_useful_voltage"]
    zones = [kv for kv in useful["zones_kv"].values() if kv is not None]
    assert close(found.mean_useful_voltage_kv, min(zones, default=None))
    assert close(found.dimensioning_train_kv, useful["dimensioning_train_kv"])
    assert close(found.mean_passes, summary["load_flow_passes"]["mean"])
    assert found.most_passes == summary["load_flow_passes"]["most"]
    assert found.limited == summary["limited"]
    assert_same_as_recorded(found, result.dataset)
    assert found.audit.as_dict() == result.audit
    # The slow twin knows one network a run, in which nothing is out or trips.
    if result.scenario.simulation.outage is None and not found.tripped:
        assert_agree(found.audit, *audit_of(result.scenario))


def assert_same_as_recorded(found: KeyFigures, dataset: xr.Dataset) -> None:
    """Assert that figures of the whole run are those of what was recorded."""
    per_mwh = np.append(np.diff(dataset.time.to_numpy()), 0.0) / 3.6e9
    moved = found.losses_mwh + sum(abs(station.energy_mwh) for station in found.stations)
    fed = float(np.nansum(dataset.station_active_power.to_numpy().sum(axis=1) * per_mwh))
    lost = float(np.nansum(dataset.network_losses.to_numpy() * per_mwh))
    assert close(found.total_energy_mwh, fed, moved)
    assert close(found.losses_mwh, lost)
    voltage, lowest = dataset.pantograph_voltage.to_numpy(), found.lowest_voltage
    voltage = np.where(voltage == 0.0, np.nan, voltage)  # without power there is none
    if not np.isfinite(voltage).any():
        assert lowest is None
    else:
        k, i = np.unravel_index(np.nanargmin(voltage), voltage.shape)
        assert lowest is not None
        assert lowest.voltage_kv == voltage[k, i] / 1e3
        assert lowest.train == dataset.train[i]
        assert lowest.position_km == float(dataset.position[k, i]) / 1e3
        assert lowest.time_min == float(dataset.time[k]) / 60.0
    passes = dataset.load_flow_passes.to_numpy()
    assert close(found.mean_passes, passes[: max(found.steps, 1)].mean())
    assert found.most_passes == passes.max()
    if found.studied_train is not None:
        train = dataset.sel(train=found.studied_train)
        departure_min, arrival_min = (
            float(train[clock]) / 60.0 for clock in ("departure_time", "arrival_time")
        )
        # The rounding of a difference of clock times is that of the clock.
        assert close(found.trip_time_min, arrival_min - departure_min, arrival_min)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_figures_of_the_examples_are_those_of_their_results(file):
    scenario = tpss.load_scenario(file)
    assert_same(key_figures(scenario), tpss.simulate(scenario))


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, "finished"),
        (STALL, "stalled"),
        ({"trains.freight.mass_t": 20_000.0, **gradients((0.0, 100.0))}, "stalled"),
        ({"traffic.0.headway_min": 0.2, "supply.catenary": "BT"}, "collapsed"),
        ({"simulation.duration_min": 30.0, "standards.peak_from_min": 10.0}, "finished"),
        ({"simulation.duration_min": 5.0, "standards.peak_from_min": 10.0}, "finished"),
        ({"simulation.braking": "within-step"}, "finished"),
        ({"simulation.driver": "aggressive", "simulation.time_step_min": 0.5}, "finished"),
        ({"supply.high_voltage_line": {"type": "132kV", "transformers": 2}}, "finished"),
        ({"traffic.0.first_departure_min": 7.0, "simulation.duration_min": 3.0}, "finished"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_figures_of_every_end_are_those_of_the_result(changes, status):
    scenario = short_line(changes)
    found = key_figures(scenario)
    assert found.status == status
    assert_same(found, tpss.simulate(scenario))


def test_figures_of_random_scenarios_are_those_of_their_results():
    ends: Counter[str] = Counter()

    @settings(
        max_examples=150,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(sound_scenarios())
    def look(document: dict[str, Any]) -> None:
        try:
            scenario = tpss.Scenario.from_document(document)
            if is_long(scenario):
                return
            found = key_figures(scenario)
        except (tpss.ScenarioError, tpss.TpssError):
            return  # trains placed too fast
        ends[found.status] += 1
        assert_same(found, tpss.simulate(scenario))

    look()
    assert min(ends[status] for status in ("finished", "collapsed", "stalled")) >= 2, ends


def varied() -> list[tpss.Scenario]:
    """Different scenarios of different lengths, a collapse and a stall among them."""
    headways = [short_line({"traffic.0.headway_min": 0.2 * 1.5**n}) for n in range(12)]
    steps = [short_line({"simulation.time_step_min": 0.5**n}) for n in range(5)]
    return [*headways, short_line(STALL), *steps]


def test_the_number_of_threads_changes_nothing_and_order_is_kept():
    """Bit by bit, as each run does the same in any thread, whatever was in its memory before."""
    scenarios = varied()
    expected = [repr(key_figures(scenario)) for scenario in scenarios]
    for threads in (1, 2, 5):
        found = tpss.simulate_many(scenarios, threads, lanes=False)
        assert [repr(each) for each in found] == expected
    backwards = [repr(each) for each in tpss.simulate_many(reversed(scenarios), 3, lanes=False)]
    assert backwards[::-1] == expected


def test_a_prepared_scenario_is_run_again_and_again():
    prepared = tpss.prepare(short_line())
    first, *others = tpss.simulate_many([prepared] * 4, threads=2, lanes=False)
    assert [repr(other) for other in others] == [repr(first)] * 3
    assert_same(first, prepared.run())


def test_scenarios_are_taken_as_they_are_needed():
    """Of an endless supply no more is taken than the threads work on and hold ready."""
    taken = count()
    endless = (short_line({"simulation.duration_min": 1.0}) for _ in taken)
    found = list(islice(tpss.simulate_many(endless, threads=2, lanes=False), 5))
    assert len(found) == 5
    assert next(taken) <= 5 + 2 * 4 + 1


def test_a_faulty_scenario_is_told_in_its_turn():
    placed = {"position_km": 1.0, "speed_kmh": 300.0}
    faulty = short_line({"traffic.0.initial_trains": [placed]})
    figures = tpss.simulate_many([short_line(), faulty, short_line()], threads=2)
    assert next(figures).status == "finished"
    with pytest.raises(tpss.ScenarioError, match="faster than the limit"):
        next(figures)


@pytest.mark.parametrize("place", ["trains", "nodes", "stations"])
def test_a_value_that_is_not_a_number_fails_the_audit(place, monkeypatch):
    """As if the solver had left a NaN in one record of one step."""
    from tpss.results import key_figures as module

    def spoil(*others):
        run, status = run_to_end(*others)
        field = {"trains": "active_power", "nodes": "node_real"}.get(place, "station_active_power")
        getattr(run.recording, place)[field][3, 0] = np.nan
        return run, status

    run_to_end = module.run_to_end
    monkeypatch.setattr(module, "run_to_end", spoil)
    audit = key_figures(short_line()).audit
    assert math.isnan(audit.power_mismatch_va)
    assert not audit.passed
