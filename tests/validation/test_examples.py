"""The examples against an independent, slow implementation of the same model."""

import numpy as np
import pytest

import tpss
from tpss.results.stranded import stranded_trains

from conftest import EXAMPLE_SCENARIOS, EXAMPLES

REFERENCE = {
    # name: (trip or duration [min], station energies [MWh], lowest pantograph voltage [kV])
    "thesis_160km": (99.5, (24.423, 24.285), 14.571),
    "thesis_3_3": (101.6, (7.675, 7.771), 16.078),
    "thesis_3_7_2": (106.0, (27.688, 25.393), 14.020),
    "at_headway_3": (60.0, (17.143, 16.398), 14.286),
    "at_hv_headway_3": (60.0, (15.868, 15.660), 15.853),
}

STEPPED = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}


@pytest.mark.parametrize("name", REFERENCE)
def test_an_example_agrees_with_the_independent_figures(name):
    """Times equal, energies within 0.2 %, voltages within 5 V; the reference has three decimals.

    It moves trains in steps, and brakes them in whole ones.
    """
    minutes, energies, lowest_kv = REFERENCE[name]
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / f"{name}.toml", STEPPED))
    assert result.status == "finished"
    assert result.audit["passed"]
    assert result.summary["duration_min"] == pytest.approx(minutes, abs=1e-9)
    assert result.stations.energy_mwh.to_list() == pytest.approx(energies, rel=2e-3)
    assert result.summary["lowest_voltage"]["voltage_kv"] == pytest.approx(lowest_kv, abs=5e-3)


def test_the_overloaded_example_ends_without_a_solution():
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / "overloaded.toml"))
    assert result.status == "collapsed"
    assert result.summary["duration_min"] == 0.0
    assert "At 0.00 min the line cannot carry its load" in result.summary["problem"]


def test_the_example_of_own_trains_runs_within_what_its_files_say():
    """A multiple unit of 130 t, 2600 kW and η = 0.87; a freight train of 1500 A between two blocks."""
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / "own_trains.toml"))
    assert (result.status, result.audit["passed"]) == ("finished", True)
    regional = result.dataset.sel(train="regional 1")
    assert float(regional.acceleration.max()) == pytest.approx(1.0, rel=1e-12)
    motor_n = regional.tractive_force + 9000.0 * regional.acceleration
    assert float(motor_n.max()) <= 200e3
    assert float(regional.motor_power.max()) == pytest.approx(2600e3, rel=1e-6)
    freight = result.dataset.sel(train="freight 1")
    assert 180e3 < float(freight.tractive_force.max()) < 270e3


def test_the_example_of_25_kv_is_judged_by_the_limits_of_25_kv():
    """The load flow itself is held against pandapower; here force, power and limits of the EMUs."""
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / "emu_25kv.toml"))
    assert (result.status, result.audit["passed"]) == ("finished", True)
    assert result.scenario.standards.voltage_limits.un_kv == 25.0
    assert result.standards.violations.empty
    emu = result.dataset.sel(train="regional 1")
    assert float(emu.tractive_force.max()) <= 200e3
    assert float(emu.traction_power.max()) == pytest.approx(5000e3, rel=1e-6)
    assert float(emu.motor_power.max()) == pytest.approx(5000e3, rel=1e-6)
    voltage_kv = emu.pantograph_voltage / 1e3
    assert 25.0 < float(voltage_kv.min()) < float(voltage_kv.max()) < 27.5


def test_the_example_of_both_ways_keeps_its_schedule_until_the_voltage_sags():
    """Every 20 minutes each scheduled time is kept; every ten, the low voltage makes trains late."""
    scenario = tpss.load_scenario(EXAMPLES / "both_ways.toml")
    base = tpss.simulate(scenario)
    dense, tied = (tpss.simulate(scenario.variant(name)) for name in ("dense", "AT"))
    assert {each.status for each in (base, dense, tied)} == {"finished"}
    assert base.stops.late_min.max() < 0.1 < dense.stops.late_min.max()
    lowest = [each.summary["lowest_voltage"]["voltage_kv"] for each in (dense, base, tied)]
    assert lowest == sorted(lowest)
    assert len(scenario.variant("third-station").supply.stations) == 3


def test_the_network_s_forty_trains_keep_their_timetable():
    """All on time and within the limits; fed from one end, trains lose time and some are late."""
    scenario = tpss.load_scenario(EXAMPLES / "network.toml")
    result = tpss.simulate(scenario)
    assert (result.status, len(result.trips)) == ("finished", 40)
    assert result.trips.arrival_min.notna().all()
    assert result.stops.late_min.max() < 0.1
    assert result.standards.violations.empty
    assert (result.trips.distance_km.round(6) == 96.0).sum() == 4  # those over both lines


def test_the_metro_s_middle_station_takes_what_the_line_refuses():
    """No train leaves the limits of 750 V; an inverter takes some of what was refused, saving energy."""
    scenario = tpss.load_scenario(EXAMPLES / "metro_750v.toml")
    base, reversible = tpss.simulate(scenario), tpss.simulate(scenario.variant("reversible"))
    assert base.standards.violations.empty
    refused = [each.regeneration.refused_mwh.sum() for each in (base, reversible)]
    assert refused[1] < 0.7 * refused[0]
    energy = [each.summary["total_energy_mwh"] for each in (base, reversible)]
    assert energy[1] < 0.98 * energy[0]


def test_freight_over_a_hill_at_3_kv_needs_the_station_at_its_summit():
    """With it no train is below the knee of its limitation, 0.9 x 3 kV; without it trains lose minutes.

    An inverter there takes a third of what trains burn otherwise.
    """
    scenario = tpss.load_scenario(EXAMPLES / "freight_3kv.toml")
    base, inverted, without = (
        tpss.simulate(each, lost_time=True)
        for each in (scenario, *map(scenario.variant, ("reversible", "without-summit")))
    )
    for each in (base, inverted, without):
        assert (each.status, each.audit["passed"]) == ("finished", True)
        assert each.standards.violations.empty
        assert set(each.thermal.verdict) == {"within"}
    lowest = [each.summary["lowest_voltage"]["voltage_kv"] for each in (base, without)]
    assert 2.7 < lowest[0] < 2.9
    assert 2.0 < lowest[1] < 2.5
    lost_min = [each.summary["lost_time"]["total_min"] for each in (base, without)]
    assert lost_min[0] < 0.1
    assert lost_min[1] > 5.0
    burnt = [each.regeneration.rheostat_mwh.sum() for each in (base, inverted)]
    assert burnt[0] > 0.1
    assert burnt[1] < 0.7 * burnt[0]


def test_trams_run_through_the_old_town_from_their_stores():
    """Where there is no contact line they draw nothing; no store falls below a third, nobody strands."""
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / "tram_750v.toml"))
    assert (result.status, result.audit["passed"]) == ("finished", True)
    assert result.standards.violations.empty
    data = result.dataset.isel(time=slice(None, -1))
    bare = ((data.position > 2_570.0) & (data.position < 3_230.0)).to_numpy()
    assert (data.active_power.to_numpy()[bare] == 0.0).all()
    assert data.tractive_force.to_numpy()[bare].max() > 50e3
    assert result.storage.lowest_soc.min() > 0.33
    assert not stranded_trains(result.dataset)
    assert result.trips.trip_min.notna().sum() >= 9


def test_every_example_is_one_of_the_above():
    """`thesis_original` has tests of its own, and lines of 320 km as those of plans."""
    names = {file.stem for file in EXAMPLE_SCENARIOS}
    others = {
        "both_ways", "emu_25kv", "freight_3kv", "hs_2x25kv", "line_320km", "line_320km_losses",
        "metro_750v", "network", "neutral_section_25kv", "overloaded", "own_trains", "thesis_original",
        "tram_750v",
    }  # fmt: skip
    assert names == {*REFERENCE, *others}


def test_the_example_with_a_neutral_section_has_the_unbalance_of_its_connections():
    """Of one pair of phases u₂ ≈ S/S_k; on two pairs of a busbar it is half as much as on one.

    Between RS and ST stand √3 · 27.5 kV = 47.6 kV without load, a little more where trains feed back.
    """
    scenario = tpss.load_scenario(EXAMPLES / "neutral_section_25kv.toml")
    base = tpss.simulate(scenario)
    one, pair, scott = (
        tpss.simulate(scenario.variant(name)) for name in ("one-busbar", "one-pair", "scott")
    )
    assert all(each.audit["passed"] for each in (base, one, pair, scott))
    assert base.standards.violations.empty
    peaks_mva = np.hypot(
        base.dataset.station_active_power, base.dataset.station_reactive_power
    ).max(dim="time")
    shares = base.standards.unbalance.peak_percent.to_numpy()
    assert shares == pytest.approx(peaks_mva.to_numpy() / 1500e4, rel=0.05)
    alone, both, same, right = (
        each.standards.unbalance.mean_10_min_percent.max() for each in (base, one, pair, scott)
    )
    assert both == pytest.approx(alone, rel=0.1)
    assert same == pytest.approx(2.0 * both, rel=0.1)
    assert right < 0.3 * both
    assert 45.0 < base.standards.neutral_sections.mean_kv[0] < 47.6
    fed_back = base.transformer_losses.to_grid_mwh.sum()
    assert fed_back > 0.1


def test_the_example_of_autotransformers_has_rails_below_their_limit_and_neutral_currents():
    """A single conductor of the equivalent impedance has the same lowest voltage within 1 %."""
    scenario = tpss.load_scenario(EXAMPLES / "hs_2x25kv.toml")
    result = tpss.simulate(scenario)
    assert (result.status, result.audit["passed"]) == ("finished", True)
    assert 5.0 < result.rails.permanent_v.max() < 60.0
    units = result.autotransformers
    assert units.position_km.tolist() == [10.0, 20.0, 30.0, 40.0, 50.0]
    assert (units.highest_neutral_a == 2.0 * units.highest_winding_a).all()
    assert 0.1 < units.peak_loading.max() < 1.5
    one = tpss.simulate(scenario.variant("one_conductor"))
    lowest = [each.summary["lowest_voltage"]["voltage_kv"] for each in (result, one)]
    assert lowest[0] == pytest.approx(lowest[1], rel=0.01)
