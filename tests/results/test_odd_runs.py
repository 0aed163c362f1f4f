"""Runs at the edge: nothing on the line, one station, odd names, damaged files."""

import json

import pytest
import xarray as xr

import tpss

from scenarios import run, short_line

ONE_STATION = [{"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}]


def test_an_idle_line_passes_its_audit():
    """Nobody departs within the run: all that is fed is rounding, and the charging of an AT line."""
    result = run(
        {
            "supply.catenary": "AT",
            "simulation.duration_min": 5.0,
            "traffic.0.first_departure_min": 30.0,
        }
    )
    assert len(result.trips) == 0
    assert result.summary["lowest_voltage"] is None


def test_a_result_of_one_station_comes_back_as_it_was(tmp_path):
    result = run({"supply.converter_stations": ONE_STATION, "simulation.duration_min": 2.0})
    result.save(tmp_path / "one")
    xr.testing.assert_identical(tpss.load_result(tmp_path / "one").dataset, result.dataset)


def test_a_train_due_at_the_last_instant_has_not_departed():
    """Headway 5 min, 10 min in all: departures at 0 and 5, not at 10."""
    result = run({"simulation.duration_min": 10.0, "traffic.0.headway_min": 5.0})
    assert result.trips.train.to_list() == ["eastbound 1", "eastbound 2"]


def test_a_damaged_or_foreign_file_is_called_that(tmp_path):
    folder = run({"simulation.duration_min": 2.0}).save(tmp_path / "sound")
    data = (folder / "result.nc").read_bytes()
    (folder / "result.nc").write_bytes(data[: len(data) // 2])
    with pytest.raises(tpss.ResultError, match="damaged"):
        tpss.load_result(folder)
    xr.Dataset({"other": ("x", [1.0])}).to_netcdf(folder / "result.nc", engine="netcdf4")
    with pytest.raises(tpss.ResultError, match="not as it was written"):
        tpss.load_result(folder)
    summary = json.loads((folder / "summary.json").read_text())
    del summary["sha256"]  # as earlier versions saved it
    (folder / "summary.json").write_text(json.dumps(summary))
    with pytest.raises(tpss.ResultError, match="not the dataset of a run"):
        tpss.load_result(folder)
    (folder / "summary.json").write_text(json.dumps([]))
    with pytest.raises(tpss.ResultError, match="not the summary of a run"):
        tpss.load_result(folder)


def test_two_services_whose_trains_would_share_names_are_refused():
    services = [
        {"name": name, "train": "freight", "from": "West", "to": "East", "headway_min": 60.0}
        for name in ("a", "a initial")
    ]
    with pytest.raises(tpss.ScenarioError, match="names of another service"):
        short_line({"traffic": services})


def test_names_with_brackets_are_printed_as_they_are(tmp_path, monkeypatch, capsys):
    from tpss.cli.run import run_scenario

    monkeypatch.chdir(tmp_path)
    scenario = short_line({"simulation.duration_min": 1.0}).as_document()
    scenario["description"], scenario["traffic"][0]["name"] = "a [/b] c", "x [y]"
    import tomli_w

    (tmp_path / "odd.toml").write_text(tomli_w.dumps(scenario))
    assert run_scenario(tmp_path / "odd.toml", None, [], False, False, "x [y] 1", False, False) == 0
    printed = capsys.readouterr().out
    assert "a [/b] c" in printed
    assert "x [y] 1" in printed
