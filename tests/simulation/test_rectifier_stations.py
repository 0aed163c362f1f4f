"""What rectifier stations lose, how warm they get, and when they trip, by the current of a group."""

import numpy as np
import pytest

import tpss
from tpss import library
from tpss.results.grid_side import StationSide, powers_of, sides_of
from tpss.results.notes import notes
from tpss.scenario.supply import RectifierType

from direct_scenarios import direct_scenario

TYPE = "supply.rectifier_stations.*.type"
TRANSFORMER = {
    "rated_kva": 2_200.0, "secondary_v": 610.0, "short_circuit_percent": 6.0, "load_loss_kw": 20.0,
    "no_load_loss_kw": 4.0, "diode_loss_kw": 5.0,
}  # fmt: skip
GROUP = {"rated_current_a": 2_500.0, "transformer": TRANSFORMER}
OVERLOADS = [{"percent": 150.0, "minutes": 120.0}, {"percent": 300.0, "minutes": 1.0}]
BEARS = {"time_constant_min": 150.0, "overloads": OVERLOADS}


def run(**changes):
    return tpss.simulate(direct_scenario(**changes))


def current_a(power_w, kind):
    """Current of one group: the root of P = I U(I), found by halving."""
    amperes, kv = zip(*kind.points, strict=True)
    low, high = 0.0, amperes[1]
    for _ in range(200):
        middle = 0.5 * (low + high)
        power = middle * float(np.interp(middle, amperes, kv)) * 1e3
        low, high = (middle, high) if power < power_w else (low, middle)
    return low


def test_a_group_loses_what_its_transformer_and_its_diodes_do():
    """4 kW, 5 kW of the diodes at 2500 A, 20 kW of copper at 2200 kVA / 0.82378 kV = 2670.6 A.

    At 1500 A: 4 + 5 · 0.6 + 20 · (1500 / 2670.6)² = 13.310 kW.
    """
    kind = RectifierType.model_validate(GROUP)
    volts = float(np.interp(1_500.0, *zip(*kind.points, strict=True))) * 1e3
    (side, *_) = sides_of(direct_scenario(**{TYPE: GROUP}))
    one = np.ones(1)
    found = powers_of(1_500.0 * volts * one, 0.0 * one, one, side)
    expected = 4e3 + 5e3 * 0.6 + 20e3 * (1_500.0 / (2_200.0 / kind.unloaded_kv)) ** 2
    assert found.losses[0] == pytest.approx(expected, rel=1e-9)
    assert expected == pytest.approx(13.310e3, abs=5.0)
    two = powers_of(3_000.0 * volts * one, 0.0 * one, 2.0 * one, side)
    assert two.losses[0] == pytest.approx(2.0 * expected, rel=1e-9)


def test_energy_from_the_grid_is_what_is_fed_and_lost():
    result = run(**{TYPE: GROUP})
    table = result.converter_losses.set_index("station")
    hours = np.diff(result.dataset.time) / 3600.0
    kind = result.scenario.supply.rectifier_stations[0].type
    for s, name in enumerate(result.dataset.station.to_numpy()):
        fed_w = result.dataset.station_active_power.to_numpy()[:-1, s]
        lost_kw = []
        for power_w in fed_w:
            share = current_a(power_w, kind) / (2_200.0 / kind.unloaded_kv)
            diodes_kw = 5.0 * current_a(power_w, kind) / 2_500.0
            lost_kw.append(4.0 + diodes_kw + 20.0 * share**2)
        assert table.losses_mwh[name] == pytest.approx(np.dot(hours, lost_kw) / 1e3, rel=1e-6)
        assert table.idle_mwh[name] == pytest.approx(hours.sum() * 4e-3)
        balance_mwh = np.dot(hours, np.maximum(fed_w, 0.0)) / 1e6 + table.losses_mwh[name]
        assert table.from_grid_mwh[name] == pytest.approx(balance_mwh, rel=1e-6)
    assert result.summary["converter_losses"]["losses_mwh"] == pytest.approx(table.losses_mwh.sum())


def test_losses_of_ones_own_follow_the_current_over_the_rated_one():
    """2 kW idle and 1 % of 2500 A · 825 V at the rated current: 2 + 20.625 · 0.5² kW at half of it."""
    kind = {"no_load_voltage_kv": 0.825, "resistance_ohm": 0.02, "rated_current_a": 2_500.0,
            "losses": {"idle_kw": 2.0, "quadratic_percent": 1.0, "origin": "measurement"}}  # fmt: skip
    (side, *_) = sides_of(direct_scenario(**{TYPE: kind}))
    one = np.ones(1)
    found = powers_of(1_250.0 * (825.0 - 0.02 * 1_250.0) * one, 0.0 * one, one, side)
    assert found.losses[0] == pytest.approx(2e3 + 20.625e3 * 0.25, rel=1e-9)
    assert side.origin == "measurement"


def test_a_group_that_says_nothing_is_not_described():
    result = run()
    assert result.converter_losses.empty
    assert sides_of(result.scenario) == (StationSide("West"), StationSide("East"))


def test_what_an_inverter_takes_goes_to_the_grid_less_the_losses_without_load():
    east = "supply.rectifier_stations.East.inverter"
    inverter = {"starts_at_kv": 0.84, "resistance_ohm": 0.02}
    result = run(**{TYPE: GROUP, east: inverter})
    table = result.converter_losses.set_index("station")
    assert table.to_grid_mwh["East"] > 0.0
    assert table.to_grid_mwh["West"] == 0.0


def test_a_group_is_judged_by_its_current():
    """The r.m.s. of I / 2500 A over the windows of the class, with I = U0 - U over R."""
    kind = {"no_load_voltage_kv": 0.825, "resistance_ohm": 0.02, "rated_current_a": 2_500.0,
            "rating": BEARS}  # fmt: skip
    result = run(**{TYPE: kind, "simulation.duration_min": 20.0})
    windows = result.thermal_windows
    row = windows[(windows.element == "rectifier of West") & (windows.window_min == 1.0)].iloc[0]
    west = result.dataset.station_active_power.to_numpy()[:-1, 0]
    load = np.array([current_a(p, result.scenario.supply.rectifier_stations[0].type) for p in west])
    squares = np.repeat((load / 2_500.0) ** 2, 6)  # steps of 6 s: parts of 1 s, ten steps a minute
    sums = np.convolve(squares, np.ones(60), "valid") / 60.0
    assert row.highest_rms_percent == pytest.approx(100.0 * np.sqrt(sums.max()), rel=1e-3)
    assert row.allowed_rms_percent == 300.0
    (judged, *_) = result.thermal.to_dict("records")
    assert judged["kind"] == "rectifier"
    assert judged["verdict"] == "within"


def test_one_that_passes_what_it_bears_trips_and_the_run_goes_on():
    """Its group is too small by far; four groups of the other station feed the line alone then."""
    weak = {"no_load_voltage_kv": 0.825, "resistance_ohm": 0.02, "rated_current_a": 300.0,
            "rating": BEARS}  # fmt: skip
    strong = {"supply.rectifier_stations.East.groups": 8, "supply.catenary.r_ohm_per_km": 0.005}
    result = run(**strong, **{"supply.rectifier_stations.West.type": weak, "protection.trip": True})
    (trip,) = result.summary["trips"]
    assert "West" in str(trip)
    gone = result.dataset.active_converters.to_numpy()[:-1, 0] == 0.0
    assert gone.any()
    assert result.audit["passed"]


@pytest.mark.parametrize("name", library.entries("rectifiers"))
def test_groups_of_the_library_have_their_rated_voltage_at_their_rated_current(name):
    """Within 5 % of the nominal one, or of 3.3 kV, and hold it up to three times that current."""
    kind = RectifierType.model_validate(library.values("rectifiers", name))
    rated_kv = 0.75 if name.startswith("750V") else 1.5 if name.startswith("1.5") else 3.3
    at = [
        float(np.interp(k * kind.rated_current_a, *zip(*kind.points, strict=True))) for k in (1, 3)
    ]
    assert at[0] == pytest.approx(rated_kv, rel=0.06)
    assert at[1] > 0.75 * rated_kv
    rating = kind.rating
    assert rating is None or rating.overloads[-1].percent == 300.0


FAULTS = {
    "losses twice": (
        {f"{TYPE}": {**GROUP, "losses": {"idle_kw": 1.0}}},
        "losses are given twice, by losses and by transformer.no_load_loss_kw",
    ),
    "diodes alone": (
        {TYPE: {"rated_current_a": 2_500.0, "transformer": {
            **{k: v for k, v in TRANSFORMER.items() if k != "no_load_loss_kw"}}}},
        "diode_loss_kw without no_load_loss_kw",
    ),
    "a rating without time constant": (
        {f"{TYPE}.rating": {"overloads": []}}, "rating.time_constant_min",
    ),
    "overloads that fall": (
        {f"{TYPE}.rating": {**BEARS, "overloads": OVERLOADS[::-1]}}, "follows 300 % for 1 min",
    ),
    "a voltage held beyond the straight part": (
        {TYPE: {**GROUP, "controlled": {"voltage_kv": 0.5, "droop_ohm": 0.0001}}},
        "fall in a straight line up to",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_what_to_do(name):
    changes, said = FAULTS[name]
    with pytest.raises(tpss.ScenarioError, match=said):
        direct_scenario(**changes)


def test_thyristors_before_a_transformer_hold_their_voltage_and_bend_behind_it():
    """0.8 kV held with 0.5 mohm: then the straight part, the bent one, and the short circuit."""
    held = {**GROUP, "controlled": {"voltage_kv": 0.8, "droop_ohm": 0.0005}}
    kind = RectifierType.model_validate(held)
    natural = RectifierType.model_validate(GROUP)
    amperes, kv = zip(*kind.points, strict=True)
    assert len(amperes) == 6
    assert list(amperes) == sorted(amperes)
    assert list(kv) == sorted(kv, reverse=True)
    meets_a, meets_kv = kind.points[1]
    assert meets_kv == pytest.approx(np.interp(meets_a, *zip(*natural.points, strict=True)))
    assert kind.points[-1] == natural.points[-1]
    assert run(**{TYPE: held}).audit["passed"]


def test_one_that_is_judged_by_its_overloads_is_not_noted_besides():
    """Of 900 A it gives more for steps on end: without a rating a note says so, in MW."""
    kind = {"no_load_voltage_kv": 0.825, "resistance_ohm": 0.02, "rated_current_a": 900.0}
    without = [each for each in notes(run(**{TYPE: kind})) if "rating" in each]
    assert without
    assert all(" MW at " in each for each in without)
    with_rating = notes(run(**{TYPE: {**kind, "rating": BEARS}}))
    assert not [each for each in with_rating if "of its rating" in each]
