"""The result of a run: its dataset, tables and summary, and what is saved of them.

Runs used below: the AT line with a train every 3 minutes, 6 minutes long, without and with its
high-voltage line; and the thesis's main line until its studied train has gone 160 km.
"""

import hashlib
import json
import shutil

import numpy as np
import pytest
import xarray as xr

from tpss import ResultError, load_result, load_scenario, simulate
from tpss.results import store

from conftest import EXAMPLES
from scenarios import short_line

SIX_MINUTES = {"simulation.duration_min": 6.0}

STATES = {
    "position": (("time", "train"), "m"),
    "speed": (("time", "train"), "m/s"),
}
OF_TRAINS = {
    "acceleration": (("time", "train"), "m/s2"),
    "tractive_force": (("time", "train"), "N"),
    "braking_force": (("time", "train"), "N"),
    "running_resistance": (("time", "train"), "N"),
    "gradient_force": (("time", "train"), "N"),
    "motor_current": (("time", "train"), "A"),
    "pantograph_voltage": (("time", "train"), "V"),
    "pantograph_angle": (("time", "train"), "rad"),
    "active_power": (("time", "train"), "W"),
    "reactive_power": (("time", "train"), "var"),
    "holding_time": (("time", "train"), "s"),
}
OF_THE_SUPPLY = {
    "node_voltage": (("time", "node"), "V"),
    "node_angle": (("time", "node"), "rad"),
    "station_active_power": (("time", "station"), "W"),
    "station_reactive_power": (("time", "station"), "var"),
    "active_converters": (("time", "station"), "1"),
    "converter_loading": (("time", "station"), "1"),
    "network_losses": (("time",), "W"),
    "branch_current": (("time", "branch"), "A"),
}

WAITING, MOTORING, COASTING, BRAKING, DWELLING, ARRIVED = range(6)
ABSENT = -1


@pytest.fixture(scope="module")
def at_line():
    """Trains every 3 minutes on an AT line, for 6 minutes: 30 steps of 12 s."""
    return simulate(load_scenario(EXAMPLES / "at_headway_3.toml", SIX_MINUTES))


@pytest.fixture(scope="module")
def high_voltage():
    """The same with a high-voltage line."""
    return simulate(load_scenario(EXAMPLES / "at_hv_headway_3.toml", SIX_MINUTES))


@pytest.fixture(scope="module")
def main_line():
    """The thesis's main line until the studied train arrives, in steps of 30 s."""
    return simulate(load_scenario(EXAMPLES / "thesis_160km.toml"))


@pytest.fixture
def folder(at_line, tmp_path):
    """A saved result."""
    return at_line.save(tmp_path / "result")


@pytest.mark.parametrize("name", [*STATES, *OF_TRAINS, *OF_THE_SUPPLY])
def test_a_variable_has_its_dimensions_unit_and_a_long_name(at_line, name):
    dims, unit = {**STATES, **OF_TRAINS, **OF_THE_SUPPLY}[name]
    variable = at_line.dataset[name]
    assert variable.dims == dims
    assert variable.dtype == np.float64
    assert variable.attrs["units"] == unit
    assert variable.attrs["long_name"]


def test_train_state_is_a_small_number_with_its_meanings(at_line):
    state = at_line.dataset.train_state
    assert (state.dims, state.dtype) == (("time", "train"), np.int8)
    assert state.attrs["long_name"]
    assert list(state.attrs["flag_values"]) == [0, 1, 2, 3, 4, 5]
    meanings = "waiting motoring coasting braking dwelling arrived"
    assert state.attrs["flag_meanings"] == meanings


def test_time_has_an_instant_more_than_there_are_steps(at_line):
    time = at_line.dataset.time
    assert time.attrs["units"] == "s"
    assert time.to_numpy() == pytest.approx(12.0 * np.arange(31))


def test_stations_are_listed_in_file_order():
    """Here against the direction of the line."""
    stations = short_line().as_document()["supply"]["converter_stations"]
    result = simulate(short_line({"supply.converter_stations": stations[::-1]}))
    assert result.dataset.station.to_numpy().tolist() == ["East", "West"]
    assert result.dataset.station_position.to_numpy().tolist() == [20e3, 0.0]
    assert result.stations.station.tolist() == ["East", "West"]
    assert list(result.summary["station_energy_mwh"]) == ["East", "West"]


def test_coordinates_say_where_and_when(main_line):
    dataset = main_line.dataset
    for name in ("departure_time", "arrival_time"):
        assert (dataset[name].dims, dataset[name].attrs["units"]) == (("train",), "s")
    for name in ("node", "station"):
        position = dataset[f"{name}_position"]
        assert (position.dims, position.attrs["units"]) == ((name,), "m")
    assert set(dataset.service.to_numpy()) == {"eastbound"}


def present(result):
    """Whether a train is recorded, by time and train."""
    return np.isfinite(result.dataset.position.to_numpy())


def on_line(result):
    """Whether a train is on the line for the step that begins, by time and train."""
    return present(result) & (result.dataset.train_state.to_numpy() != ARRIVED)


@pytest.mark.parametrize("name", [*OF_TRAINS, *OF_THE_SUPPLY])
def test_what_holds_for_an_interval_is_not_a_number_at_the_last_instant(main_line, name):
    assert np.isnan(main_line.dataset[name].to_numpy()[-1]).all()


@pytest.mark.parametrize("name", list(OF_THE_SUPPLY))
def test_the_supply_is_known_in_every_step(main_line, name):
    assert np.isfinite(main_line.dataset[name].to_numpy()[:-1]).all()


@pytest.mark.parametrize("name", list(OF_TRAINS))
def test_a_train_s_intervals_are_known_while_it_is_on_the_line(main_line, name):
    known = np.isfinite(main_line.dataset[name].to_numpy()[:-1])
    assert (known == on_line(main_line)[:-1]).all()


def test_states_are_known_at_the_last_instant_too(main_line):
    dataset = main_line.dataset
    assert present(main_line)[-1].any()
    assert (np.isfinite(dataset.speed.to_numpy()) == present(main_line)).all()


def test_trains_are_absent_before_their_departure_and_after_their_arrival(main_line):
    dataset = main_line.dataset
    time = dataset.time.to_numpy()[:, None]
    departed = time >= np.nan_to_num(dataset.departure_time.to_numpy(), nan=0.0)
    # Until the first instant at which it has arrived, or a little before it.
    before = np.concatenate([[[0.0]], time[:-1]])
    gone = before >= np.nan_to_num(dataset.arrival_time.to_numpy(), nan=np.inf)
    assert (present(main_line) == departed & ~gone).all()


def test_the_state_of_an_absent_train_is_minus_one(main_line):
    state = main_line.dataset.train_state.to_numpy()
    assert (state[~present(main_line)] == ABSENT).all()
    assert (state[:-1][present(main_line)[:-1]] != ABSENT).all()
    assert set(np.unique(state[-1])) == {ABSENT, ARRIVED}


def test_the_instant_of_arrival_is_recorded(main_line):
    dataset = main_line.dataset
    arrived = dataset.sel(train="eastbound 1").isel(time=-1)
    assert (int(arrived.train_state), float(arrived.speed)) == (ARRIVED, 0.0)
    assert float(arrived.position) == pytest.approx(160e3, abs=1e-3)
    assert float(arrived.arrival_time) == pytest.approx(float(arrived.time), abs=1e-3)


def test_attributes_carry_the_totals(main_line):
    attributes, summary = main_line.dataset.attrs, main_line.summary
    assert attributes["status"] == main_line.status == "finished"
    assert attributes["trip_time_min"] == summary["trip_time_min"]
    assert summary["trip_time_min"] == pytest.approx(float(main_line.dataset.time[-1]) / 60.0)
    energies = list(summary["station_energy_mwh"].values())
    assert attributes["station_energy_mwh"].tolist() == energies
    assert attributes["losses_mwh"] == summary["losses_mwh"]
    assert attributes["time_step_s"] == 30.0
    assert attributes["result_format"] == summary["result_format"] == 2
    assert json.loads(attributes["audit"]) == main_line.audit


def test_a_studied_train_that_has_not_arrived_has_no_trip_time(at_line):
    assert np.isnan(at_line.dataset.attrs["trip_time_min"])
    assert at_line.summary["trip_time_min"] is None


def test_energies_are_powers_summed_over_the_steps(main_line):
    """1 MWh = 3.6e9 W s; the steps last 30 s, but the last one, which ends with the arrival."""
    dataset, summary = main_line.dataset, main_line.summary
    duration_s = np.diff(dataset.time.to_numpy())
    assert duration_s[:-1] == pytest.approx(30.0)
    assert 0.0 < duration_s[-1] < 30.0
    for station in ("West", "East"):
        watts = dataset.station_active_power.sel(station=station).to_numpy()[:-1]
        energy = (watts * duration_s).sum() / 3.6e9
        assert summary["station_energy_mwh"][station] == pytest.approx(energy, rel=1e-12)
    drawn_w = np.nansum(dataset.active_power.to_numpy()[:-1], axis=1)
    assert summary["total_energy_mwh"] == pytest.approx(
        (drawn_w * duration_s).sum() / 3.6e9 + summary["losses_mwh"], rel=1e-9
    )


def test_the_lowest_voltage_is_found_where_it_was(main_line):
    lowest, dataset = main_line.summary["lowest_voltage"], main_line.dataset
    assert lowest["voltage_kv"] == float(dataset.pantograph_voltage.min()) / 1e3
    there = dataset.sel(train=lowest["train"], time=lowest["time_min"] * 60.0)
    assert float(there.pantograph_voltage) == lowest["voltage_kv"] * 1e3
    assert float(there.position) == pytest.approx(lowest["position_km"] * 1e3)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, "finished"),
        ({"simulation.duration_min": 1.0}, "finished"),
        ({"traffic.0.first_departure_min": 30.0, "simulation.duration_min": 10.0}, "finished"),
        ({"line.gradients": [{"from_km": 0.0, "permille": 30.0}]}, "stalled"),
    ],
    ids=["arrived", "on the way", "no train at all", "stalled"],
)
def test_the_summary_is_plain_json(changes, status):
    summary = simulate(short_line(changes)).summary
    assert summary["status"] == status
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_figures_of_the_standards_are_made_when_they_are_asked_for_or_saved(tmp_path):
    result = simulate(short_line(SIX_MINUTES))
    assert "standards" not in result.figures
    result.save(tmp_path / "saved")
    assert list(result.summary) == [*result.figures, "standards"]
    assert result.summary["standards"] == result.standards.as_dict()
    again = load_result(tmp_path / "saved")
    assert list(again.summary.items()) == list(result.summary.items())


def test_the_summary_of_a_collapsed_run_is_plain_json():
    summary = simulate(load_scenario(EXAMPLES / "overloaded.toml")).summary
    assert summary["status"] == "collapsed"
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary
    assert {"problem", "advice"} <= set(summary)


def test_the_summary_says_by_what_it_was_made(at_line):
    provenance = at_line.summary["provenance"]
    assert {"tpss_version", "numba_version", "platform", "created"} <= set(provenance)


def test_trips_have_a_row_for_each_train(main_line):
    trips = main_line.trips.set_index("train")
    assert trips.index.tolist() == main_line.dataset.train.to_numpy().tolist()
    studied = trips.loc["eastbound 1"]
    end_min = float(main_line.dataset.time[-1]) / 60.0
    times_min = (studied.departure_min, studied.arrival_min, studied.trip_min)
    assert times_min == pytest.approx((0.0, end_min, end_min))
    assert studied.distance_km == pytest.approx(160.0)
    assert studied.mean_speed_kmh == pytest.approx(160.0 / end_min * 60.0)
    assert trips.energy_mwh.sum() == pytest.approx(
        main_line.summary["total_energy_mwh"] - main_line.summary["losses_mwh"], rel=1e-9
    )
    lowest = main_line.summary["lowest_voltage"]
    assert trips.lowest_voltage_kv.min() == lowest["voltage_kv"]
    assert trips.lowest_voltage_km[lowest["train"]] == pytest.approx(lowest["position_km"])


def test_trips_leave_out_what_did_not_happen(main_line):
    trips = main_line.trips.set_index("train")
    placed, late = trips.loc["eastbound initial 1"], trips.loc["eastbound 10"]
    assert np.isnan(placed.departure_min)
    assert np.isnan(placed.trip_min)
    assert np.isfinite(placed.arrival_min)
    assert late.departure_min == 90.0
    assert np.isnan(late.arrival_min)
    assert np.isnan(late.trip_min)


def test_stations_have_a_row_each(main_line):
    """The converters of a station carry √(P² + Q²) of 6 · 10 MVA."""
    dataset, table = main_line.dataset, main_line.stations.set_index("station")
    assert table.index.tolist() == ["West", "East"]
    west = table.loc["West"]
    active = dataset.station_active_power.sel(station="West").to_numpy()[:-1]
    reactive = dataset.station_reactive_power.sel(station="West").to_numpy()[:-1]
    loading = np.hypot(active, reactive) / 60e6
    assert west.position_km == 0.0
    assert west.energy_mwh == main_line.summary["station_energy_mwh"]["West"]
    duration_s = np.diff(dataset.time.to_numpy())
    assert west.reactive_energy_mvarh == pytest.approx((reactive * duration_s).sum() / 3.6e9)
    assert west.peak_power_mw == pytest.approx(active.max() / 1e6)
    assert west.mean_loading == pytest.approx(loading.mean())
    assert west.peak_loading == pytest.approx(loading.max())
    assert west.mean_converters == 6.0


def test_nodes_of_the_high_voltage_line_are_recorded_at_its_level(high_voltage):
    """The line is loaded lightly: within 3 % of 132 kV."""
    dataset = high_voltage.dataset
    high = (dataset.node_kind == "high-voltage line").to_numpy()
    voltage = dataset.node_voltage.to_numpy()[:-1]
    assert high.sum() == 5
    assert voltage[:, high] == pytest.approx(132e3, rel=0.03)
    assert voltage[:, ~high] == pytest.approx(16.5e3, rel=0.05)


def test_branches_of_the_high_voltage_line_are_recorded_at_its_level(high_voltage):
    """At the line's ends all current comes through a transformer of 132 : 16.5 = 8 : 1."""
    current = high_voltage.dataset.branch_current.isel(time=slice(None, -1))
    for transformer, line in (
        ("transformer 0 km", "high-voltage line 0-40 km"),
        ("transformer 160 km", "high-voltage line 120-160 km"),
    ):
        low, high = current.sel(branch=transformer), current.sel(branch=line)
        assert low.to_numpy() == pytest.approx(8.0 * high.to_numpy(), rel=1e-6)


def test_losses_are_those_of_the_high_voltage_line_too(high_voltage):
    """40 km of 0.051 Ω/km at the line's own level, R I²; a part of all losses."""
    dataset = high_voltage.dataset.isel(time=slice(None, -1))
    current = dataset.branch_current.sel(branch="high-voltage line 0-40 km").to_numpy()
    losses = 40.0 * 0.051 * current**2
    assert (losses > 0.0).all()
    assert (losses < dataset.network_losses.to_numpy()).all()


def test_branches_name_transformers_and_the_ends_of_sections(high_voltage):
    branches = high_voltage.dataset.branch.to_numpy().tolist()
    for name in ("connection West", "transformer 40 km", "contact line 0-40 km, start"):
        assert name in branches


@pytest.mark.parametrize("name", ["at_line", "high_voltage", "main_line"])
def test_a_saved_result_is_loaded_identical(request, tmp_path, name):
    result = request.getfixturevalue(name)
    again = load_result(result.save(tmp_path / "a" / "b"))
    xr.testing.assert_identical(again.dataset, result.dataset)
    assert again.summary == result.summary
    assert again.scenario == result.scenario
    assert again.trips.equals(result.trips)
    assert again.stations.equals(result.stations)


def test_a_collapsed_run_is_saved_and_loaded_too(tmp_path):
    result = simulate(load_scenario(EXAMPLES / "overloaded.toml"))
    again = load_result(result.save(tmp_path / "a"))
    xr.testing.assert_identical(again.dataset, result.dataset)
    assert again.status == "collapsed"


def test_a_folder_holds_dataset_summary_and_scenario(folder, at_line):
    assert {file.name for file in folder.iterdir()} == {
        "result.nc",
        "summary.json",
        "scenario.toml",
    }
    saved = json.loads((folder / "summary.json").read_text("utf-8"))
    content = (folder / "result.nc").read_bytes()
    checksums = saved.pop("sha256")
    assert checksums["result.nc"] == hashlib.sha256(content).hexdigest()
    assert sorted(checksums) == ["result.nc", "scenario.toml", "summary.json"]
    assert saved == at_line.summary


def test_the_saved_scenario_runs_again_to_the_same_energies(main_line, tmp_path):
    saved = main_line.save(tmp_path / "result") / "scenario.toml"
    again = simulate(load_scenario(saved))
    assert again.summary["station_energy_mwh"] == main_line.summary["station_energy_mwh"]
    assert again.summary["trip_time_min"] == main_line.summary["trip_time_min"]


def test_the_loaded_scenario_runs_again_to_the_same_dataset(folder, at_line):
    again = simulate(load_result(folder).scenario)
    for name, variable in at_line.dataset.data_vars.items():
        xr.testing.assert_equal(again.dataset[name], variable)


def contents(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def test_an_existing_folder_is_not_overwritten(folder, high_voltage):
    before = contents(folder)
    with pytest.raises(ResultError, match="exists already; give another --out, or --force"):
        high_voltage.save(folder)
    assert contents(folder) == before


def test_a_result_may_be_replaced(folder, high_voltage):
    high_voltage.save(folder, force=True)
    assert load_result(folder).scenario == high_voltage.scenario


def test_a_folder_that_is_no_result_is_never_replaced(tmp_path, at_line):
    (tmp_path / "letter.txt").write_text("Dear")
    with pytest.raises(ResultError, match="is not a result folder, so it is not replaced"):
        at_line.save(tmp_path, force=True)
    assert contents(tmp_path) == {"letter.txt": b"Dear"}


def fail(*_, **__):
    raise OSError(28, "No space left on device")


def interrupt(*_, **__):
    raise KeyboardInterrupt


BREAKS = [(xr.Dataset, "dump_to_store"), (store.tomli_w, "dumps"), (store.json, "dumps")]


@pytest.mark.parametrize(("owner", "name"), BREAKS, ids=["dataset", "scenario", "summary"])
def test_a_failed_save_leaves_nothing_behind(at_line, tmp_path, monkeypatch, owner, name):
    monkeypatch.setattr(owner, name, fail)
    with pytest.raises(ResultError, match=r"cannot be written: No space left.*another --out"):
        at_line.save(tmp_path / "result")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("owner", "name"), BREAKS, ids=["dataset", "scenario", "summary"])
def test_an_interrupted_save_leaves_nothing_behind(at_line, tmp_path, monkeypatch, owner, name):
    monkeypatch.setattr(owner, name, interrupt)
    with pytest.raises(KeyboardInterrupt):
        at_line.save(tmp_path / "result")
    assert list(tmp_path.iterdir()) == []


def test_a_failed_save_leaves_the_former_result(folder, high_voltage, monkeypatch):
    before = contents(folder)
    monkeypatch.setattr(xr.Dataset, "dump_to_store", fail)
    with pytest.raises(ResultError):
        high_voltage.save(folder, force=True)
    assert contents(folder) == before
    assert list(folder.parent.iterdir()) == [folder]


@pytest.mark.parametrize("name", ["result.nc", "summary.json", "scenario.toml"])
def test_a_folder_that_lacks_a_file_is_no_result(folder, name):
    (folder / name).unlink()
    with pytest.raises(ResultError, match=f"{name} missing; name a folder that tpss run"):
        load_result(folder)


def test_no_folder_is_no_result(tmp_path):
    with pytest.raises(ResultError, match=r"nowhere is not a result folder.*name a folder"):
        load_result(tmp_path / "nowhere")


def test_a_file_is_no_result(folder):
    with pytest.raises(ResultError, match="is not a result folder"):
        load_result(folder / "result.nc")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("result.nc", b""),
        ("result.nc", b"not a dataset"),
        ("summary.json", b""),
        ("summary.json", b"{"),
        ("summary.json", b"\xff"),
        ("scenario.toml", b"format = "),
        ("scenario.toml", b"format = 1"),
    ],
)
def test_a_damaged_result_says_to_run_it_again(folder, name, content):
    (folder / name).write_bytes(content)
    with pytest.raises(ResultError, match=r"(?s)result is damaged.*run the scenario again"):
        load_result(folder)


def test_a_truncated_dataset_is_damaged(folder):
    whole = (folder / "result.nc").read_bytes()
    (folder / "result.nc").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ResultError, match="run the scenario again"):
        load_result(folder)


def test_a_result_may_be_moved(folder, tmp_path, at_line):
    moved = shutil.move(folder, tmp_path / "elsewhere")
    assert load_result(moved).summary == at_line.summary


def test_folders_are_numbered_from_the_first_that_is_free(tmp_path):
    assert store.next_folder("line", tmp_path) == tmp_path / "line-001"
    (tmp_path / "line-001").mkdir()
    (tmp_path / "line-003").mkdir()
    assert store.next_folder("line", tmp_path) == tmp_path / "line-002"
