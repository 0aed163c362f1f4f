"""Runs of trains with stores on board: braking, a cap, stops, and stretches without contact line."""

import numpy as np
import pytest

import tpss
from tpss.report.drawings.energy import used_by_trains
from tpss.results.notes import notes
from tpss.results.regeneration import fed_back
from tpss.results.stranded import stranded_trains

from direct_scenarios import direct_scenario
from slow_audit import assert_agree, audit_of

BATTERY = {
    "kind": "battery",
    "capacity_kwh": 12.0,
    "power_kw": 1_500.0,
    "efficiency": 0.95,
    "soc_start": 0.6,
}
GAP = [{"from_km": 2.3, "to_km": 3.7}]
"""Between B at 2 km and C at 4 km."""


def running(gap=(), **fields):
    own = {"trains.unit.storage": {**BATTERY, **fields}}
    step = {"simulation.time_step_min": 1.0 / 60.0}
    return direct_scenario(**{**step, **own, "supply.without_contact_line": list(gap)})


@pytest.fixture(scope="module")
def without():
    return tpss.simulate(direct_scenario(**{"simulation.time_step_min": 1.0 / 60.0}))


@pytest.fixture(scope="module")
def capped():
    return tpss.simulate(running(line_power_cap_kw=1_200.0, standing_current_a=300.0))


@pytest.fixture(scope="module")
def gap():
    return tpss.simulate(running(GAP, standing_current_a=500.0))


def test_a_train_that_brakes_with_a_store_is_refused_less(without, capped):
    before, after = (fed_back(run.dataset, run.scenario) for run in (without, capped))
    assert before["refused_mwh"] > 0.01
    assert after["refused_mwh"] < 0.2 * before["refused_mwh"]
    assert after["own_storage_mwh"] > 0.01
    parts = ("friction", "machine_losses", "refused", "own_use", "own_storage", "fed_back")
    total = sum(after[f"{each}_mwh"] for each in parts)
    assert total == pytest.approx(after["braked_mwh"], rel=1e-9)


def test_the_line_gives_no_more_than_the_cap_while_the_store_can_help(without, capped):
    drawn_w = np.nan_to_num(capped.dataset.active_power.to_numpy()[:-1])
    holds_j = capped.dataset.train_stored_energy.to_numpy()[:-1]
    helps = np.nan_to_num(holds_j) > 1.5e6 / 0.95 + 1.0
    assert np.nan_to_num(without.dataset.active_power).max() > 1.9e6
    assert drawn_w[helps].max() == pytest.approx(1.2e6, rel=1e-9)
    assert (
        capped.summary["lowest_voltage"]["voltage_kv"]
        > (without.summary["lowest_voltage"]["voltage_kv"])
    )


def test_a_train_at_a_stop_charges_with_its_standing_current(capped):
    data = capped.dataset
    taken = data.train_storage_power.to_numpy()[:-1]
    dwells = (data.train_state.to_numpy()[:-1] == 4) & (data.speed.to_numpy()[1:] == 0.0)
    current_a = (data.active_power / data.pantograph_voltage).to_numpy()[:-1]
    charging = dwells & (taken > 0.0)
    assert charging.any()
    assert current_a[charging].max() == pytest.approx(300.0, rel=1e-6)
    rolls = ~dwells & (data.braking_power.to_numpy()[:-1] == 0.0)
    assert (taken[rolls] <= 0.0).all()


def test_all_balances_close(capped, gap):
    for run in (capped, gap):
        assert run.audit["passed"]
        kept = run.storage.charged_kwh - run.storage.discharged_kwh - run.storage.losses_kwh
        np.testing.assert_allclose(run.storage.end_kwh - run.storage.start_kwh, kept, atol=1e-9)
        assert run.storage.lowest_soc.min() >= 0.0
        assert run.storage.highest_soc.max() <= 1.0


@pytest.mark.parametrize("gap", [(), GAP], ids=["contact line", "without contact line"])
def test_the_slow_audit_agrees(gap):
    scenario = running(gap, line_power_cap_kw=1_200.0, standing_current_a=300.0)
    expected, limits = audit_of(scenario)
    told = tpss.simulate(scenario).audit
    found = type(expected)(**{name: told[name] for name in vars(expected)})
    assert found.passed
    assert_agree(found, expected, limits)


def test_trains_run_from_their_stores_where_there_is_no_contact_line(gap):
    """From 2.3 to 3.7 km nothing is drawn, and the motors' power is what the store gives."""
    data = gap.dataset.isel(time=slice(None, -1))
    inside = (data.position > 2_300.0) & (data.position < 3_700.0)
    assert int(inside.sum()) > 100
    unfed = data.pantograph_voltage.to_numpy() == 0.0
    assert unfed[inside.to_numpy()].all()
    assert (data.active_power.to_numpy()[unfed] == 0.0).all()
    given = -data.train_storage_power.to_numpy()
    pulls = unfed & (data.traction_power.to_numpy() > 0.0)
    assert pulls.any()
    np.testing.assert_allclose(
        given[pulls], data.motor_power.to_numpy()[pulls] / 0.85 + 100e3, rtol=1e-9
    )
    assert gap.trips.trip_min.notna().sum() >= 2
    assert not stranded_trains(gap.dataset)
    assert not any("contact line" in each for each in notes(gap))


def test_motion_knows_what_the_store_can_give(gap):
    """With 300 kW, 100 of them for auxiliaries, a train gets through the gap more slowly."""
    weak = tpss.simulate(running(GAP, power_kw=300.0, standing_current_a=500.0))
    assert weak.audit["passed"]
    unfed = weak.dataset.pantograph_voltage.to_numpy()[:-1] == 0.0
    given = -weak.dataset.train_storage_power.to_numpy()[:-1][unfed]
    assert given.max() == pytest.approx(300e3, rel=1e-9)
    inside = [
        float(((run.dataset.position > 2_300.0) & (run.dataset.position < 3_700.0)).sum())
        for run in (gap, weak)
    ]
    assert inside[1] > inside[0]


def test_a_train_whose_store_is_empty_coasts_and_is_listed_as_stranded():
    """0.3 kWh at 50 % do not feed auxiliaries of 100 kW for a kilometre."""
    run = tpss.simulate(running(GAP, capacity_kwh=0.3, soc_start=0.5, power_kw=250.0))
    assert run.audit["passed"]
    assert run.storage.lowest_soc.min() < 0.1
    stood = stranded_trains(run.dataset)
    data = run.dataset.isel(time=slice(None, -1))
    unfed = data.pantograph_voltage.to_numpy() == 0.0
    empty = unfed & (data.train_storage_power.to_numpy() == 0.0)
    assert empty.any()
    assert (data.tractive_force.to_numpy()[empty] == 0.0).all()
    for each in stood:
        assert 2.3 <= each.position_km <= 3.7


def test_a_train_without_a_store_coasts_through_and_that_is_noted():
    scenario = direct_scenario(
        **{"simulation.time_step_min": 1.0 / 60.0, "supply.without_contact_line": GAP}
    )
    run = tpss.simulate(scenario)
    assert run.audit["passed"]
    (note,) = (each for each in notes(run) if "contact line" in each)
    assert note.startswith("there is no contact line along 2.3-3.7 km, and unit has no store")


def test_a_store_without_energy_or_room_changes_nothing(without):
    """Empty, without a current to charge with, and of hardly any power: 1 W."""
    idle = {"soc_start": 0.0, "power_kw": 0.001, "line_power_cap_kw": 1e6}
    run = tpss.simulate(running(**idle))
    for name in ("pantograph_voltage", "active_power", "speed"):
        np.testing.assert_allclose(run.dataset[name], without.dataset[name], rtol=1e-5, atol=2.0)


FAULTS = {
    "stepped motion": (
        {"simulation.motion": "stepped", "trains.unit.regeneration": None},
        "trains.unit.storage", 'does not go with motion = "stepped"'),
    "no kind": ({"trains.unit.storage.kind": None}, "trains.unit.storage.kind", "it is missing"),
    "a gap that ends before it begins": (
        {"supply.without_contact_line": [{"from_km": 3.7, "to_km": 2.3}]},
        "supply.without_contact_line.0", "the stretch ends at 2.3 km, and begins at 3.7 km"),
    "a station in the gap": (
        {"supply.without_contact_line": [{"from_km": 0.3, "to_km": 2.3}]},
        "supply.without_contact_line.0.from_km", "fed, tied or broken at 0.5 km"),
    "gaps that overlap": (
        {"supply.without_contact_line": [{"from_km": 1.0, "to_km": 2.3},
                                         {"from_km": 2.0, "to_km": 3.0}]},
        "supply.without_contact_line.1", "overlaps supply.without_contact_line.0"),
    "a gap beyond the line": (
        {"supply.without_contact_line": [{"from_km": 5.6, "to_km": 7.0}]},
        "supply.without_contact_line.0.to_km", "outside the line"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_its_place_and_what_to_do(name):
    changes, key, said = FAULTS[name]
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.simulate(running().with_(changes))
    assert [each.key for each in caught.value.findings] == [key]
    assert said in caught.value.findings[0].problem
    assert caught.value.findings[0].remedy


def test_the_bars_of_the_energy_have_one_length_with_stores_on_board(capped):
    used = used_by_trains(capped)
    assert sum(used.values()) == pytest.approx(capped.trips.energy_mwh.sum(), rel=1e-9)
    taken = capped.storage.charged_kwh.sum() - capped.storage.discharged_kwh.sum()
    assert used["stores on board"] == pytest.approx(taken / 1e3, rel=1e-9)
