"""Runs with a part of the supply out of service, throughout or for a time."""

import numpy as np
import pytest

import tpss

from scenarios import BUSY, COLD, run, short_line

CONTINUOUS = {"simulation.motion": None, "simulation.braking": None}


def with_outage(outage, changes=None):
    """Result of the short line with an outage, after a look at the rules of every run."""
    return run(
        {
            **(changes or {}),
            "outages": [{"name": "out", **outage}],
            "simulation.outage": "out",
        }
    )


def busy(outage=None, changes=None):
    """Result of the busy line, with an outage or none."""
    chosen = {} if outage is None else {"simulation.outage": "out"}
    scenario = tpss.Scenario.from_document(BUSY, "busy").with_(
        {
            **CONTINUOUS,
            "simulation.duration_min": 20.0,
            **({} if outage is None else {"outages": [{"name": "out", **outage}]}),
            **chosen,
            **(changes or {}),
        }
    )
    return tpss.simulate(scenario)


def test_a_station_that_is_out_is_as_if_it_were_not_there():
    """Its node is the end of the line then, as in a scenario without it."""
    out = with_outage({"stations": ["East"]})
    absent = run({"supply.converter_stations.1": None})
    for name in ("pantograph_voltage", "node_voltage", "position"):
        np.testing.assert_allclose(out.dataset[name], absent.dataset[name], rtol=1e-9)
    east = out.dataset.sel(station="East").isel(time=slice(-1))
    for name in ("station_active_power", "station_reactive_power", "converter_loading",
                 "active_converters", "station_losses"):  # fmt: skip
        assert (east[name] == 0.0).all(), name


def test_a_station_with_a_unit_out_is_one_with_fewer_units():
    out = with_outage({"units": {"West": 1}})
    fewer = run({"supply.converter_stations.0.converters": 1})
    xr = out.dataset.drop_attrs(), fewer.dataset.drop_attrs()
    assert xr[0].identical(xr[1])


def test_all_units_out_is_the_station_out():
    units, station = with_outage({"units": {"East": 2}}), with_outage({"stations": ["East"]})
    assert units.dataset.drop_attrs().identical(station.dataset.drop_attrs())


def test_a_transformer_that_is_out_is_as_if_it_were_not_there():
    """Its node on the contact line remains, and divides a section in two, which changes roundings."""
    out = busy({"transformers_km": [12.6]})
    absent = busy(changes={"supply.high_voltage_line.transformers_km": [5.0]})
    np.testing.assert_allclose(
        out.dataset.pantograph_voltage, absent.dataset.pantograph_voltage, rtol=1e-6
    )
    current = out.dataset.branch_current.sel(branch="transformer 12.6 km").isel(time=slice(-1))
    assert (current == 0.0).all()
    assert out.audit["passed"]


def test_a_transformer_station_with_one_of_two_out():
    station = {
        "name": "T", "position_km": 10.0, "no_load_voltage_kv": 16.5, "transformers": 2,
        "transformer": {"rated_mva": 10.0, "short_circuit_percent": 10.0, "load_loss_kw": 50.0},
    }  # fmt: skip
    stations = {"supply.transformer_stations": [station]}
    out = with_outage({"units": {"T": 1}}, stations)
    fewer = run({"supply.transformer_stations": [{**station, "transformers": 1}]})
    assert out.dataset.drop_attrs().identical(fewer.dataset.drop_attrs())
    without = with_outage({"stations": ["T"]}, stations)
    assert (without.dataset.station_losses.sel(station="T").isel(time=slice(-1)) == 0.0).all()


def test_an_outage_begins_and_ends_at_the_first_instant_at_or_after_its_times():
    """Steps of 0.05 min: 5.02 min is before the instant 5.05, step 101; 10 min is that of step 200."""
    out = with_outage({"stations": ["East"], "from_min": 5.02, "to_min": 10.0})
    fed = out.dataset.active_converters.sel(station="East").to_numpy()[:-1] > 0.0
    assert np.flatnonzero(np.diff(fed)).tolist() == [100, 199]
    intact = run()
    before = slice(None, 101)
    for name in ("pantograph_voltage", "node_voltage", "station_active_power"):
        own, other = out.dataset[name][before], intact.dataset[name][before]
        assert own.drop_attrs().equals(other.drop_attrs()), name
    gap = abs(out.dataset.pantograph_voltage - intact.dataset.pantograph_voltage)
    assert gap[101:200].min() > 0.0


def test_an_outage_that_begins_and_ends_within_a_step_changes_nothing():
    out = with_outage({"stations": ["East"], "from_min": 5.01, "to_min": 5.04})
    assert out.dataset.drop_attrs().identical(run().dataset.drop_attrs())


def test_an_outage_after_the_end_of_the_run_changes_nothing():
    out = with_outage({"stations": ["East"], "from_min": 500.0})
    assert out.dataset.drop_attrs().identical(run().dataset.drop_attrs())


def test_a_run_in_stretches_is_the_same():
    """Reports of progress divide the run into stretches, wherever they fall."""
    scenario = short_line(
        {
            "outages": [{"name": "out", "stations": ["West"], "from_min": 3.0, "to_min": 6.0}],
            "simulation.outage": "out",
        }
    )
    whole, watched = tpss.simulate(scenario), tpss.simulate(scenario, lambda _: None)
    assert whole.dataset.drop_attrs().identical(watched.dataset.drop_attrs())


@pytest.mark.parametrize("from_min", [3.0, 4.0])
def test_a_controlled_station_that_returns_runs_with_all_units_until_its_loading_is_known(from_min):
    """Control acts at 3, 6 and 9 min; the station is back at 6.5 min, and had been out at 6 min."""
    control = {f"supply.converter_stations.{i}.control": "loading" for i in range(2)}
    out = with_outage({"stations": ["East"], "from_min": from_min, "to_min": 6.5}, control)
    running = out.dataset.active_converters.sel(station="East").to_numpy()
    step = {minute: round(minute / 0.05) for minute in (from_min, 6.5, 9.0)}
    assert (running[step[from_min] : step[6.5]] == 0.0).all()
    assert (running[step[6.5] : step[9.0]] == 2.0).all()


def test_a_load_flow_survives_the_jump_of_a_weak_line():
    """A line whose capacitance counts, its stronger end lost at once and back at once."""
    scenario = tpss.Scenario.from_document(
        {
            **COLD,
            "simulation": {"time_step_min": 0.1, "outage": "out"},
            "outages": [{"name": "out", "stations": ["W"], "from_min": 12.0, "to_min": 15.0}],
        },
        "cold",
    )
    result = tpss.simulate(scenario)
    assert result.status == "finished"
    assert result.audit["passed"]


def test_what_trains_lost_is_known_with_an_outage_too():
    scenario = short_line(
        {"outages": [{"name": "out", "stations": ["East"]}], "simulation.outage": "out"}
    )
    result = tpss.simulate(scenario, lost_time=True)
    assert result.summary["lost_time"]["trains"] == 1


def test_a_forged_current_of_an_open_transformer_fails_the_audit():
    """The audit knows what is in service: with the intact network it finds a current that is not fed."""
    from tpss.results.key_figures import key_figures_of
    from tpss.run.run import advance_to_end, run_of

    scenario = tpss.Scenario.from_document(BUSY, "busy").with_(
        {
            **CONTINUOUS,
            "simulation.duration_min": 5.0,
            "outages": [{"name": "out", "transformers_km": [5.0], "from_min": 2.0}],
            "simulation.outage": "out",
        }
    )
    prepared = tpss.prepare(scenario)
    made = run_of(prepared.start)
    status = advance_to_end(made, prepared.start)
    assert key_figures_of(made, status, prepared.start, prepared.frame).audit.passed
    made.networks = made.networks[:1]
    assert not key_figures_of(made, status, prepared.start, prepared.frame).audit.passed
