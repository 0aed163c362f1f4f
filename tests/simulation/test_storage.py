"""Runs with stores of energy at the line: what they save, and that an idle one changes nothing."""

import numpy as np
import pytest

import tpss
from tpss.report.drawings.energy import energy_flow
from tpss.results.notes import notes
from tpss.results.regeneration import fed_back

from direct_scenarios import direct_scenario
from slow_audit import assert_agree, audit_of

BETWEEN = {
    "name": "Middle",
    "position_km": 3.0,
    "kind": "supercapacitor",
    "capacitance_f": 128.0,
    "max_voltage_v": 500.0,
    "min_voltage_v": 250.0,
    "max_current_a": 1900.0,
    "power_kw": 800.0,
    "efficiency": 0.95,
    "charges_above_kv": 0.84,
    "discharges_below_kv": 0.79,
    "charge_kw_per_v": 40.0,
    "discharge_kw_per_v": 25.0,
}
FLYWHEEL = {
    "name": "Wheel", "position_km": 5.5, "kind": "flywheel", "capacity_kwh": 4.0, "power_kw": 500.0,
    "charge_efficiency": 0.93, "discharge_efficiency": 0.9, "standby_kw": 5.0, "soc_start": 0.2,
    "charges_above_kv": 0.83, "discharges_below_kv": 0.8, "charge_kw_per_v": 30.0,
    "discharge_kw_per_v": 30.0,
}  # fmt: skip


def stored(*stores, **changes):
    step = {"simulation.time_step_min": 1.0 / 60.0}
    return direct_scenario(**{**step, "supply.storage": list(stores), **changes})


@pytest.fixture(scope="module")
def without():
    return tpss.simulate(stored())


@pytest.fixture(scope="module")
def both():
    return tpss.simulate(stored(BETWEEN, FLYWHEEL))


def test_stores_take_what_the_line_would_refuse(without, both):
    before, after = (fed_back(run.dataset, run.scenario) for run in (without, both))
    assert before["refused_mwh"] > 0.01
    assert after["refused_mwh"] < 0.9 * before["refused_mwh"]
    assert after["to_stores_mwh"] > 0.0
    parts = ("used_by_others_mwh", "to_stores_mwh", "to_grid_mwh", "burnt_in_stations_mwh")
    assert sum(after[each] for each in parts) == pytest.approx(after["fed_back_mwh"], rel=1e-12)


def test_all_balances_close(both):
    """Energy of the stations = trains + stores + losses; a store keeps what it took, less losses."""
    assert both.audit["passed"]
    assert both.audit["network_balance"] < 1e-9
    held = both.summary["storage"]["at the line"]
    assert held["start_kwh"] == both.storage.start_kwh.sum()
    assert held["end_kwh"] == both.storage.end_kwh.sum()
    for _, row in both.storage.iterrows():
        kept_kwh = row.charged_kwh - row.discharged_kwh - row.losses_kwh
        assert row.end_kwh - row.start_kwh == pytest.approx(kept_kwh, abs=1e-9)
        assert 0.0 <= row.lowest_soc <= row.highest_soc <= 1.0


def test_the_slow_audit_agrees():
    scenario = stored(BETWEEN, FLYWHEEL)
    expected, limits = audit_of(scenario)
    told = tpss.simulate(scenario).audit
    found = type(expected)(**{name: told[name] for name in vars(expected)})
    assert found.passed
    assert_agree(found, expected, limits)


@pytest.mark.parametrize(
    "idle",
    [
        {"charge_kw_per_v": 0.0, "discharge_kw_per_v": 0.0},
        {"soc_start": 1.0, "discharge_kw_per_v": 0.0},
        {"soc_start": 0.0, "charge_kw_per_v": 0.0},
    ],
    ids=["slopes of 0", "full, and never gives", "empty, and never takes"],
)
def test_a_store_that_does_nothing_changes_nothing(idle, without):
    """The line has a node more, at 3 km, and the same voltages but for roundings."""
    run = tpss.simulate(stored({**BETWEEN, **idle}))
    row = run.storage.iloc[0]
    assert row.charged_kwh == row.discharged_kwh == row.losses_kwh == 0.0
    assert row.start_kwh == row.end_kwh
    for name in ("pantograph_voltage", "active_power", "speed"):
        np.testing.assert_allclose(run.dataset[name], without.dataset[name], rtol=1e-6, atol=1e-4)


def test_an_island_of_which_only_a_store_is_left_has_no_voltage():
    """Both stations out: nothing is a reference, so the store rests, and a flywheel runs down."""
    outage = [{"name": "both", "stations": ["West", "East"], "from_min": 4.0}]
    run = tpss.simulate(
        stored(BETWEEN, FLYWHEEL, **{"outages": outage, "simulation.outage": "both"})
    )
    assert run.audit["passed"]
    after = run.dataset.sel(time=slice(241.0, None))
    assert (np.nan_to_num(after.pantograph_voltage) == 0.0).all()
    assert (after.store_power[:-1] == 0.0).all()
    middle_j, wheel_j = after.stored_energy.to_numpy().T
    assert np.ptp(middle_j) == 0.0
    assert wheel_j[60] == pytest.approx(max(0.0, wheel_j[0] - 60 * 5e3))


def test_a_run_says_what_is_left_in_store_and_that_it_was_more(both):
    emptier = tpss.simulate(stored({**BETWEEN, "soc_start": 1.0, "charge_kw_per_v": 0.0}))
    (note,) = (each for each in notes(emptier) if "the stores hold" in each)
    row = emptier.storage.iloc[0]
    assert f"{row.start_kwh - row.end_kwh:.2f} kWh less at the end" in note
    assert both.storage.end_kwh.sum() > both.storage.start_kwh.sum()
    assert not any("the stores hold" in each for each in notes(both))


def test_a_step_that_moves_much_of_the_capacity_is_noted():
    """0.1 kWh and 500 kW: a step of a second moves 139 Wh at most, all of it."""
    small = {**FLYWHEEL, "capacity_kwh": 0.1, "standby_kw": 0.0}
    run = tpss.simulate(stored(small))
    assert run.audit["passed"]
    assert any("% of the capacity of Wheel" in each for each in notes(run))


def test_a_store_at_a_station_shares_its_node(without):
    run = tpss.simulate(stored({**BETWEEN, "position_km": 5.5}))
    assert run.audit["passed"]
    assert run.dataset.sizes["node"] == without.dataset.sizes["node"]
    assert run.storage.iloc[0].charged_kwh > 0.0


STORAGE = "supply.storage"
FAULTS = {
    "an alternating current": (
        {"supply.system": "25kV-50Hz"},
        "supply.storage.0",
        "which follows the voltage of a direct current",
    ),
    "no capacitance": ({f"{STORAGE}.Middle.capacitance_f": None}, f"{STORAGE}.0",
                       "a supercapacitor without capacitance_f"),
    "a capacity of its own": ({f"{STORAGE}.Middle.capacity_kwh": 3.0}, f"{STORAGE}.0",
                              "capacity_kwh of a supercapacitor"),
    "a battery without a capacity": ({f"{STORAGE}.Middle.kind": "battery"}, f"{STORAGE}.0",
                                     "a battery without capacity_kwh"),
    "voltages the wrong way": ({f"{STORAGE}.Middle.min_voltage_v": 600.0}, f"{STORAGE}.0",
                               "min_voltage_v (600 V) is not below max_voltage_v (500 V)"),
    "two efficiencies": ({f"{STORAGE}.Middle.charge_efficiency": 0.9}, f"{STORAGE}.0",
                         "give either efficiency or charge_efficiency and discharge_efficiency"),
    "one efficiency of two": (
        {f"{STORAGE}.Middle.efficiency": None, f"{STORAGE}.Middle.charge_efficiency": 0.9},
        f"{STORAGE}.0", "charge_efficiency and discharge_efficiency belong together"),
    "thresholds the wrong way": ({f"{STORAGE}.Middle.charges_above_kv": 0.7}, f"{STORAGE}.0",
                                 "is not above discharges_below_kv"),
    "charging at no load": ({f"{STORAGE}.Middle.charges_above_kv": 0.82},
                            f"{STORAGE}.0.charges_above_kv",
                            "not above the voltage of West without load, 0.825 kV"),
    "charging too late": ({f"{STORAGE}.Middle.charges_above_kv": 0.95},
                          f"{STORAGE}.0.charges_above_kv",
                          "not below the voltage up to which the line takes all that unit feeds back"),
    "discharging at no load": (
        {f"{STORAGE}.Middle.discharges_below_kv": 0.83}, f"{STORAGE}.0.discharges_below_kv",
        "not below the voltage of West without load, 0.825 kV"),
    "beside the line": ({f"{STORAGE}.Middle.position_km": 7.0}, f"{STORAGE}.0.position_km",
                        "outside the line"),
    "a hair beside a station": ({f"{STORAGE}.Middle.position_km": 0.5003},
                                f"{STORAGE}.0.position_km", "closer than a metre"),
    "conductors of their own": (
        {"supply.conductors": {"leakage_s_per_km": 0.1}}, f"{STORAGE}.0",
        "stores are known between a single conductor and earth only"),
    "an unknown station": ({f"{STORAGE}.Middle.at": "Z"},
                           f"{STORAGE}.0.at", "no such station"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_its_place_and_what_to_do(name):
    changes, key, said = FAULTS[name]
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.simulate(stored(BETWEEN).with_(changes))
    own = [each for each in caught.value.findings if each.key.startswith(STORAGE)]
    assert [each.key for each in own] == [key]
    assert said in own[0].problem
    assert own[0].remedy


def test_the_bars_of_the_energy_have_one_length_with_stores_at_the_line(both):
    ends = {}
    for bar in energy_flow(both).panels[0].items:
        ends[bar.row] = bar.start + bar.length
    assert list(ends.values()) == pytest.approx([ends[0]] * 3, rel=5e-3)
