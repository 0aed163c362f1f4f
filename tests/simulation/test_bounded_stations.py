"""Stations at the highest current of their converters, and stations that take no power back."""

import copy

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss import library
from tpss.sources.bounded import WIDTH

from properties.rules import keep_the_rules

Q48 = library.values("converters", "Q48/Q49")

STATIONS = {
    "West": {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2},
    "East": {"name": "East", "position_km": 40.0, "type": "Q48/Q49", "converters": 2},
}

DOWN = {
    "format": 1, "name": "down",
    "simulation": {"time_step_min": 0.05, "duration_min": 20.0},
    "line": {
        "length_km": 40.0, "gradients": [{"from_km": 0.0, "permille": -15.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 40.0}],
    },
    "supply": {"catenary": "BT", "converter_stations": [STATIONS["West"]]},
    "trains": {
        "unit": {
            "mass_t": 400.0, "adhesive_mass_t": 200.0, "max_speed_kmh": 140.0,
            "max_acceleration_m_s2": 0.5, "max_retardation_m_s2": 0.6, "resistance_a_n": 4_000.0,
            "resistance_b_n_s_per_m": 60.0, "resistance_c_n_s2_per_m2": 8.0, "power_factor": 1.0,
            "efficiency": 0.85, "auxiliary_power_kw": 50.0,
            "tractive_effort": {"max_force_kn": 250.0, "max_power_kw": 6_000.0},
            "regeneration": {"max_force_kn": 250.0, "max_power_kw": 6_000.0},
        }
    },
    "traffic": [
        {"name": "down", "train": "unit", "from": "A", "to": "B", "departures_min": [0.0, 4.0]}
    ],
}  # fmt: skip


def document(**changes) -> dict:
    """The line down which two trains hold their speed with their brakes, changed by key path."""
    changed = tpss.Scenario.from_document(copy.deepcopy(DOWN), "down")
    paths = {key.replace("__", "."): value for key, value in changes.items()}
    return changed.with_(paths)


def run(**changes) -> tpss.Result:
    result = tpss.simulate(document(**changes))
    keep_the_rules(result)
    return result


def powers_mw(result: tpss.Result) -> np.ndarray:
    return result.dataset.station_active_power.to_numpy()[:-1] / 1e6


def test_a_station_that_takes_nothing_lets_the_voltage_rise_until_trains_feed_back_no_more():
    """Two trains hold their speed down the line and feed back some 2 MW, which only the grid takes.
    With a station that takes nothing the voltage is near 18 kV, and friction brakes do the work."""
    given, refused = run(), run(supply__converter_stations__0__feedback="none")
    assert powers_mw(given).min() < -2.0
    assert powers_mw(refused).min() > -3.0 * WIDTH * 20.0
    voltage_v = refused.dataset.pantograph_voltage.to_numpy()
    assert 17.5e3 < np.nanmax(voltage_v) < 18.0e3
    totals = refused.regeneration.sum(numeric_only=True)
    assert totals.refused_mwh > 0.8 * given.regeneration.fed_back_mwh.sum()
    assert refused.trips.arrival_min.equals(given.trips.arrival_min)


def test_another_station_takes_what_one_does_not():
    """The angle of the one runs ahead; the other takes all of it, at voltages as ever."""
    both = [{**STATIONS["West"], "feedback": "none"}, STATIONS["East"]]
    result = run(supply__converter_stations=both)
    west, east = powers_mw(result).min(axis=0)
    assert west > -3.0 * WIDTH * 20.0
    assert east < -2.0
    assert result.regeneration.refused_mwh.sum() == pytest.approx(0.0, abs=1e-9)


def test_a_station_at_its_highest_current_leaves_the_rest_to_the_other():
    """Trains that start between both take more than 3.6 MVA of West, which may give 60 % of 6 MVA at
    16.5 kV, and 2 % more current at most.  Its voltage falls, and East gives what it does not."""
    up = {"line__gradients__0__permille": 5.0, "line__stations__0__position_km": 15.0}
    one = {**STATIONS["West"], "converters": 1}
    limited = {**one, "type": {**Q48, "rating_mva": 6.0, "current_limit_percent": 60.0}}
    free, bound = (
        run(**up, supply__converter_stations=[west, STATIONS["East"]]) for west in (one, limited)
    )
    limit = bound.summary["current_limits"]["West"]
    assert 99.5 < limit["highest_percent"] < 102.0
    assert limit["time_min"] > 0.1
    worst = powers_mw(free)[:, 0].argmax()
    gained = powers_mw(bound)[worst] - powers_mw(free)[worst]
    assert gained[0] < -0.1
    assert gained[1] > 0.1
    assert "current_limits" not in free.summary


def test_a_limit_that_is_not_reached_changes_nothing():
    far = {**STATIONS["West"], "type": {**Q48, "current_limit_percent": 1_000.0}}
    plain, bounded = run(), run(supply__converter_stations=[far])
    for name in ("pantograph_voltage", "station_active_power"):
        values = [result.dataset[name].to_numpy() for result in (plain, bounded)]
        assert values[1] == pytest.approx(values[0], rel=1e-9, nan_ok=True)


def test_limits_that_are_too_low_and_stations_of_several_types_are_faults():
    low = {"supply.converter_stations.0.type": {**Q48, "current_limit_percent": 10.0}}
    assert finding_at("supply.converter_stations.0.type.current_limit_percent", faults_of(low))
    units = [{"type": {**Q48, "current_limit_percent": 110.0}, "converters": 1}]
    mixed = {"name": "N", "position_km": 0.0, "units": units}
    found = faults_of({"supply.mixed_stations": [mixed]})
    assert any("current_limit_percent" in finding.remedy for finding in found)
