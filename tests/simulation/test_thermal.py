"""Whole runs whose equipment is judged: what loads it, by which trains, and that nothing else moves."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import double_track, line, network, run, service
from tpss.results.export import TABLES

WIRE = {"continuous_a": 300.0, "time_constant_min": 5.0, "reference_c": 80.0, "ambient_c": 40.0}
MOTOR = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
CONVERTER = {
    "rating_mva": 10.0, "no_load_voltage_kv": 16.5, "droop_kv_per_mvar": 0.05,
    "generator_reactance_pu": 0.53, "generator_base_mva": 10.0, "motor_reactance_pu": 0.49,
    "motor_base_mva": 10.7, "base_voltage_kv": 16.5,
}  # fmt: skip
UNITS = {
    "line_transformer": ({"r_ohm": 0.065, "x_ohm": 0.85}, {"rating_mva": 16.0, "cooling": "ONAF"}),
    "station_transformer": (
        {"r_ohm": 0.037, "x_ohm": 0.54},
        {"rating_mva": 25.0, "time_constant_min": 75.0},
    ),
}


def document(rated: bool = True, **more: Any) -> dict[str, Any]:
    """60 km between two stations, with a high-voltage line and a transformer between them."""
    made = line(60.0, {"A": 0.0, "M": 30.0, "B": 60.0})
    traffic = [service("up", "A", "B", departures_min=[0.0, 10.0])]
    found = network({"main": made}, traffic, **more)
    found["trains"] = {"freight": {"model": "Rc4-freight-1470t"}}
    ends = {"A": 0.0, "B": 60.0}
    found["supply"] = {
        "catenary": {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2},
        "high_voltage_line": {
            "type": "132kV",
            "transformers_km": [30.0],
            **{name: dict(unit) for name, (unit, _) in UNITS.items()},
        },
        "converter_stations": [
            {
                "name": name,
                "line": "main",
                "position_km": km,
                "type": dict(CONVERTER),
                "converters": 2,
            }
            for name, km in ends.items()
        ],
    }
    found["simulation"] = {"time_step_min": 0.2, "duration_min": 60.0}
    return rate(found) if rated else found


def rate(found: dict[str, Any]) -> dict[str, Any]:
    """Give all of it a rating."""
    supply = found["supply"]
    supply["catenary"]["rating"] = WIRE
    for name, (_, rating) in UNITS.items():
        supply["high_voltage_line"][name]["rating"] = rating
    for station in supply["converter_stations"]:
        station["type"]["rating"] = {"time_constant_min": 30.0}
    found["trains"]["freight"]["motor_rating"] = MOTOR
    return found


@pytest.fixture(scope="module")
def judged() -> tpss.Result:
    return run(document())


@pytest.fixture(scope="module")
def bare() -> tpss.Result:
    return run(document(rated=False))


def test_ratings_change_nothing_of_a_run(judged, bare):
    assert judged.dataset.identical(bare.dataset.assign_attrs(judged.dataset.attrs))
    differing = {"simulation_s", "provenance", "thermal"}
    one, other = (
        {key: value for key, value in result.summary.items() if key not in differing}
        for result in (judged, bare)
    )
    assert one == other


def test_without_ratings_there_is_nothing_to_judge(bare):
    assert "thermal" not in bare.summary
    assert len(bare.thermal) == len(bare.thermal_windows) == 0


def test_all_that_has_a_rating_is_judged_once(judged):
    assert judged.thermal.element.tolist() == [
        "converter of A", "converter of B",
        "transformer 0 km", "transformer 30 km", "transformer 60 km",
        "contact line 0-30 km, start", "contact line 0-30 km, end",
        "contact line 30-60 km, start", "contact line 30-60 km, end",
        "motors of up 1", "motors of up 2",
    ]  # fmt: skip
    assert judged.thermal.position_km.tolist()[:9] == [
        0.0,
        60.0,
        0.0,
        30.0,
        60.0,
        0.0,
        30.0,
        30.0,
        60.0,
    ]
    assert judged.summary["thermal"]["judged"] == 11


def loads(result: tpss.Result) -> dict[str, np.ndarray]:
    own = result.equipment
    return {element.name: own.load[:, k] for k, element in enumerate(own.elements)}


def test_loads_are_recorded_currents_and_powers_over_rated_ones(judged):
    """A contact line by its current over 300 A, a transformer of 16 MVA by 16e6 / 16.5e3 = 969.7 A, a
    converter by its loading, a motor by its current over 1250 A.
    """
    data, found = judged.dataset, loads(judged)
    current_a = data.branch_current.sel(branch="contact line 0-30 km, start").to_numpy()[:-1]
    np.testing.assert_allclose(found["contact line 0-30 km, start"], current_a / 300.0)
    current_a = data.branch_current.sel(branch="transformer 30 km").to_numpy()[:-1]
    np.testing.assert_allclose(found["transformer 30 km"], current_a * 16.5e3 / 16e6)
    loading = data.converter_loading.sel(station="A").to_numpy()[:-1]
    np.testing.assert_allclose(found["converter of A"], loading)
    motor_a = data.motor_current.sel(train="up 1").to_numpy()[:-1]
    np.testing.assert_allclose(found["motors of up 1"], motor_a / 1250.0)


def test_the_state_is_that_of_one_step_after_the_other(judged):
    """The slow twin of the contact line at A, from the mean of its squares on."""
    load, h = loads(judged)["contact line 0-30 km, start"], 0.2
    state = [float(np.mean(load**2))]
    for k in load:
        state.append(k * k + (state[-1] - k * k) * np.exp(-h / 5.0))
    row = judged.thermal.set_index("element").loc["contact line 0-30 km, start"]
    assert row.highest_state_percent == pytest.approx(100.0 * max(state), rel=1e-9)
    assert row.highest_temperature_c == pytest.approx(40.0 + 40.0 * max(state), rel=1e-9)
    assert row.state_at_min == pytest.approx(int(np.argmax(state)) * h)


def test_trains_to_blame_are_those_between_the_feeding_points(judged):
    """The contact line at A is hottest while up 1 and up 2 leave; both draw between 0 and 30 km."""
    data, rows = judged.dataset, judged.thermal.set_index("element")
    row = rows.loc["contact line 30-60 km, end"]
    named = row.trains.split(", ")
    at = int(row.state_at_min / 0.2) - 1
    last_km = data.position.to_numpy()[at] / 1e3
    present = [
        str(name)
        for name, km in zip(data.train.to_numpy(), last_km, strict=True)
        if 30.0 <= km <= 60.0
    ]
    assert set(present) <= set(named) <= {"up 1", "up 2"}
    assert rows.loc["motors of up 2"].trains == "up 2"


def test_tracks_that_are_tied_share_the_current():
    """The line of two tracks tied everywhere is one conductor of twice the continuous current."""
    together = double_track("everywhere")
    together["supply"]["catenary"]["rating"] = WIRE
    apart = copy.deepcopy(together)
    apart["supply"]["tracks_tied"] = "no"
    result, single = run(together), run(apart)
    current_a = result.dataset.branch_current.sel(branch="contact line 0-40 km, start").to_numpy()[
        :-1
    ]
    np.testing.assert_allclose(loads(result)["contact line 0-40 km, start"], current_a / 600.0)
    assert "contact line 0-40 km, track 2, start" in loads(single)
    # Each track is loaded by its own trains.
    rows, data = single.thermal.set_index("element"), single.dataset
    on_first = data.train.to_numpy()[(data.train_track.to_numpy() == 1).any(axis=0)]
    named = rows.loc["contact line 0-40 km, track 1, start"].trains.split(", ")
    assert named
    assert set(named) <= set(on_first)


def test_the_former_model_adds_up_four_motors():
    found = document()
    found["trains"]["freight"]["motor_current"] = "former"
    result = run(found)
    motor_a = result.dataset.motor_current.sel(train="up 1").to_numpy()[:-1]
    np.testing.assert_allclose(loads(result)["motors of up 1"], motor_a / 5000.0)


def test_a_transformer_station_is_judged_by_its_cooling():
    found = document(rated=False)
    rating = {"cooling": "ONAN", "ambient_c": 30.0}
    found["supply"] = {
        "catenary": "BT",
        "transformer_stations": [
            {
                "name": "A", "line": "main", "position_km": 0.0, "no_load_voltage_kv": 16.5,
                "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0, "rating": rating},
            }
        ],
    }  # fmt: skip
    result = run(found)
    row = result.thermal.iloc[0]
    assert (row.element, row.allowed_temperature_c) == ("transformer of A", pytest.approx(120.0))
    assert 30.0 < row.highest_temperature_c < 120.0
    assert row.loss_of_life_min > 0.0


def test_a_loaded_result_is_judged_alike(judged, tmp_path):
    loaded = tpss.load_result(judged.save(tmp_path / "it"))
    assert loaded.summary["thermal"] == judged.summary["thermal"]
    assert loaded.thermal.equals(judged.thermal)


def test_both_tables_are_exported(judged):
    assert len(TABLES["thermal"](judged)) == 11
    assert len(TABLES["thermal_windows"](judged)) == 11 * 6 + 2  # motors: 6 min too


def test_other_criteria_of_standards_keep_the_judgement(judged):
    other = judged.with_standards({"peak_from_min": 10.0})
    assert other.summary["thermal"] == judged.summary["thermal"]


def test_motors_of_trains_that_never_come_are_nothing_to_judge():
    """Only motors have a rating, and the first train would depart after the end."""
    found = document(rated=False)
    found["trains"]["freight"]["motor_rating"] = MOTOR
    found["traffic"] = [service("up", "A", "B", departures_min=[100.0])]
    result = run(found)
    assert len(result.thermal) == 0
    assert "thermal" not in result.summary


def test_a_run_without_a_step_has_nothing_to_judge(judged):
    found = tpss.Result(judged.scenario, judged.dataset.isel(time=slice(1)), judged.figures)
    assert len(found.thermal) == 0


def test_with_regard_to_lines_elements_say_on_which_they_are():
    lines = {
        "main": line(60.0, {"West": 0.0, "Fork": 40.0, "East": 60.0}),
        "branch": line(30.0, {"Fork": 100.0, "Mine": 130.0}, begins_at_km=100.0),
    }
    found = network(lines, [service("ore", "West", "Mine")])
    found["supply"]["catenary"] = {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2, "rating": WIRE}
    result = run(found)
    rows = result.thermal.set_index("element")
    assert rows.loc["contact line main 0-40 km, start"].line == "main"
    assert rows.loc["contact line branch 100-130 km, end"].line == "branch"
    # At the fork the branch has no feeding point: all that is there loads it, to its end.
    assert rows.loc["contact line branch 100-130 km, start"].trains == "ore 1"
