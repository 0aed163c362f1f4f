"""Where no station reaches the line: trains coast, brake, stand, and go on when it is fed again."""

import numpy as np
import pytest

import tpss
from tpss import ScenarioError
from tpss.cli.run import NO_SOLUTION, exit_code
from tpss.outages.row import Verdict
from tpss.results.notes import notes
from tpss.results.stranded import stranded_trains

from scenarios import gradients, run, stops

BLACKOUT = {
    "simulation.motion": None,
    "simulation.braking": None,
    "outages": [{"name": "all", "stations": ["West", "East"], "from_min": 6.0, "to_min": 12.0}],
    "simulation.outage": "all",
}
THROUGHOUT = {**BLACKOUT, "outages": [{"name": "all", "stations": ["West", "East"]}]}


def of_train(result, name):
    """Values of the only train, step by step."""
    return result.dataset[name].sel(train="eastbound 1").to_numpy()[:-1]


def test_a_train_without_power_coasts_by_its_resistance_and_draws_nothing():
    """On the level M a = -R(v): at the start of the blackout it holds 60 km/h, 16.667 m/s.

    From its running resistance, recorded as the mean of a step, follows each step's acceleration:
    the 1470 t of the freight train, which counts no rotating masses.
    """
    result = run(BLACKOUT)
    out = slice(120, 240)
    for name in ("pantograph_voltage", "tractive_force", "active_power", "reactive_power",
                 "motor_power", "braking_force"):  # fmt: skip
        assert (of_train(result, name)[out] == 0.0).all(), name
    resistance, a = (
        of_train(result, "running_resistance")[out],
        of_train(result, "acceleration")[out],
    )
    moving = of_train(result, "speed")[out] > 1.0
    assert of_train(result, "speed")[120] == pytest.approx(60.0 / 3.6)
    inertia_kg = -resistance[moving] / a[moving]
    np.testing.assert_allclose(inertia_kg, 1.47e6, rtol=1e-9)


def test_it_goes_on_when_power_returns():
    result, intact = run(BLACKOUT), run({**BLACKOUT, "simulation.outage": None})
    assert result.status == "finished"
    assert of_train(result, "tractive_force")[240] > 0.0
    assert result.trips.arrival_min[0] > intact.trips.arrival_min[0]


def test_it_brakes_for_a_stop_without_power():
    """Downhill it would roll on; its stop at 6.6 km is met all the same."""
    result = run(BLACKOUT | gradients((0.0, -5.0)) | stops((6.6, 1.0)))
    call = result.stops[result.stops.station == "0"].iloc[0]
    assert 6.0 < call.arrival_min < 12.0
    assert of_train(result, "braking_force")[120:240].max() > 0.0


def test_once_it_stands_it_stays_also_on_a_gradient():
    result = run(BLACKOUT | gradients((0.0, 8.0)))
    (stood,) = stranded_trains(result.dataset)
    assert stood.train == "eastbound 1"
    assert 6.0 < stood.from_min < 12.0
    assert stood.from_min + stood.duration_min == pytest.approx(12.0)
    assert not stood.to_the_end
    assert any("stranded without power: eastbound 1" in note for note in notes(result))


def test_voltages_of_trains_without_power_do_not_count():
    """No limit is violated, and the lowest and mean useful voltages are those of fed trains."""
    result = run(BLACKOUT)
    volts = of_train(result, "pantograph_voltage")
    lowest_kv = volts[volts > 0.0].min() / 1e3
    assert result.summary["lowest_voltage"]["voltage_kv"] == pytest.approx(lowest_kv)
    assert result.trips.lowest_voltage_kv[0] == pytest.approx(lowest_kv)
    assert result.audit["lowest_voltage_v"] == pytest.approx(1e3 * lowest_kv, rel=0.01)
    zones = result.standards.useful_voltage_zones
    assert zones.mean_useful_kv[0] == pytest.approx(volts[volts > 0.0].mean() / 1e3)
    assert result.standards.violations.empty


def test_nodes_without_power_are_at_zero_and_stations_feed_nothing():
    result = run(BLACKOUT)
    steps = result.dataset.isel(time=slice(120, 240))
    for name in ("node_voltage", "station_active_power", "branch_current", "network_losses"):
        assert (steps[name] == 0.0).all(), name


def test_a_run_of_a_line_that_is_never_fed_ends_and_says_why():
    result = run(THROUGHOUT)
    assert result.status == "stalled"
    assert exit_code(result) == NO_SOLUTION
    assert "stands without power" in result.summary["problem"]
    assert (of_train(result, "speed") == 0.0).all()


def test_a_run_of_a_given_time_goes_on_to_its_end():
    result = run({**THROUGHOUT, "simulation.duration_min": 5.0})
    assert (result.status, len(result.dataset.time)) == ("finished", 101)
    assert stranded_trains(result.dataset)[0].to_the_end


def test_stepped_motion_is_refused():
    with pytest.raises(ScenarioError, match="continuous"):
        run({"outages": THROUGHOUT["outages"], "simulation.outage": "all"})


def test_a_high_voltage_line_without_transformers_is_at_zero_beside_a_line_that_is_fed():
    out = {
        "supply.high_voltage_line": {"type": "132kV", "transformers_km": [10.0]},
        "outages": [{"name": "all", "transformers_km": [0.0, 10.0, 20.0]}],
    }
    result = run(BLACKOUT | out)
    without = run({"simulation.motion": None, "simulation.braking": None})
    high = result.dataset.node_kind == "high-voltage line"
    volts = result.dataset.node_voltage.isel(time=slice(-1))
    assert (volts[:, high.to_numpy()] == 0.0).all()
    np.testing.assert_allclose(
        result.dataset.pantograph_voltage, without.dataset.pantograph_voltage, rtol=1e-7
    )


def test_a_row_of_the_table_counts_stranded_trains():
    from scenarios import short_line

    scenario = short_line(BLACKOUT | gradients((0.0, 8.0)) | {"simulation.outage": None})
    found = tpss.compare_outages(scenario)
    assert found.rows[1].verdict == Verdict.STRANDED
    assert found.rows[1].figures["stranded"] == 1


def test_beyond_an_open_break_there_is_no_power_and_behind_it_there_is():
    """The middle of the line is cut out: a train coasts through it, and pulls again in the east."""
    breaks = [{"name": f"B{km:g}", "position_km": km, "closed": False} for km in (9.0, 11.0)]
    plain = {"simulation.motion": None, "simulation.braking": None}
    result = run({**plain, "supply.section_breaks": breaks})
    assert result.status == "finished"
    at_m, volts = of_train(result, "position"), of_train(result, "pantograph_voltage")
    inside = (at_m > 9.0e3) & (at_m < 11.0e3)
    np.testing.assert_array_equal(volts[inside], 0.0)
    assert (volts[~inside] > 14e3).all()
    assert of_train(result, "tractive_force")[at_m > 11.1e3].max() > 0.0
