"""Runs on lines of direct current: what rectifiers give, what trains give back, and who refuses what."""

import numpy as np
import pytest

import tpss
from tpss import library
from tpss.results.regeneration import fed_back
from tpss.scenario.supply import rectifier_station
from tpss.sources import rectifier

from direct_scenarios import OHM_PER_KM, direct_document, direct_scenario

INVERTER = {"starts_at_kv": 0.84, "resistance_ohm": 0.02}
EAST = "supply.rectifier_stations.East"


@pytest.mark.parametrize("system", OHM_PER_KM)
def test_trains_run_and_all_balances_close(system):
    result = tpss.simulate(direct_scenario(system))
    nominal_kv = library.values("systems", system)["nominal_kv"]
    assert result.summary["status"] == "finished"
    assert result.audit["passed"]
    assert 0.7 * nominal_kv < result.summary["lowest_voltage"]["voltage_kv"] < 1.1 * nominal_kv
    for name in ("reactive_power", "station_reactive_power", "pantograph_angle"):
        values = np.nan_to_num(result.dataset[name].to_numpy())
        assert np.abs(values).max() == pytest.approx(0.0, abs=1e-9)


def test_a_station_without_an_inverter_takes_nothing():
    """Where its neighbours brake its voltage is above that without load; it takes less than a watt."""
    result = tpss.simulate(direct_scenario())
    power_w = result.dataset.station_active_power.to_numpy()
    voltage_v = np.nanmax(result.dataset.pantograph_voltage.to_numpy())
    assert voltage_v > 825.0
    assert -1.0 < power_w[:-1].min() <= 0.0
    braking = fed_back(result.dataset, result.scenario)
    assert braking["to_grid_mwh"] == pytest.approx(0.0, abs=1e-6)
    assert braking["refused_mwh"] > 0.0


def test_an_inverter_takes_what_would_be_refused():
    blocked = tpss.simulate(direct_scenario())
    without = fed_back(blocked.dataset, blocked.scenario)
    result = tpss.simulate(direct_scenario(**{f"{EAST}.inverter": INVERTER}))
    inverted = fed_back(result.dataset, result.scenario)
    assert result.audit["passed"]
    assert inverted["to_grid_mwh"] > 0.0
    assert inverted["refused_mwh"] < without["refused_mwh"]


def test_reactive_parts_of_trains_are_left_out_of_themselves():
    """Nobody says power_factor: it is 1, that of the auxiliaries too."""
    train = direct_scenario().trains["unit"]
    assert (train.power_factor, train.auxiliary_power_factor) == (1.0, 1.0)


def test_two_groups_are_one_of_half_the_resistance():
    halved = {"supply.rectifier_stations.*.type.resistance_ohm": 0.01,
              "supply.rectifier_stations.*.type.rated_current_a": 5_000.0}  # fmt: skip
    two = tpss.simulate(direct_scenario(**{"supply.rectifier_stations.*.groups": 2}))
    one = tpss.simulate(direct_scenario(**halved))
    np.testing.assert_allclose(
        two.dataset.pantograph_voltage, one.dataset.pantograph_voltage, rtol=1e-9
    )


def test_a_transformer_s_data_give_voltage_and_resistance():
    """6.6 MVA, 2 x 1300 V in series, 9 %: U0 = 2 x 1.3505 x 1300 V; X = 2 x 9 % x 1300² / 6.6e6 ohm.

    R = 2 x 3 X / pi = 0.0880 ohm, and of 66 kW at 6600 / 3.5112 = 1880 A another 0.0187 ohm.
    """
    kind = tpss.Scenario.from_document(direct_document("DC-3kV")).with_(
        {"supply.rectifier_stations.West.type": "3kV-6MW-12p"}
    ).supply.rectifier_stations[0].type  # fmt: skip
    (no_current_a, unloaded_kv), (current_a, voltage_kv), *_ = kind.points
    assert (no_current_a, unloaded_kv) == (0.0, pytest.approx(3.5112, abs=1e-4))
    ohm = (unloaded_kv - voltage_kv) * 1e3 / current_a
    assert ohm == pytest.approx(0.08803 + 0.01868, abs=2e-5)


def test_a_characteristic_has_as_many_points_as_the_law_has_room_for():
    assert rectifier_station.MOST_POINTS == rectifier.MOST_POINTS


def test_thyristors_hold_their_voltage_up_to_where_their_transformer_ends():
    """0.80 kV with 0.002 ohm below 0.825 kV with 0.02 ohm: they meet at 25 V / 0.018 ohm = 1388.9 A."""
    held = {"voltage_kv": 0.80, "droop_ohm": 0.002}
    scenario = direct_scenario(**{"supply.rectifier_stations.*.type.controlled": held})
    _, (meets_a, meets_kv), _ = scenario.supply.rectifier_stations[0].type.points
    assert meets_a == pytest.approx(25.0 / 0.018)
    assert meets_kv == pytest.approx(0.80 - 0.002 * 25.0 / 0.018 / 1e3)
    result = tpss.simulate(scenario)
    assert result.audit["passed"]


FAULTS = {
    "a converter station": (
        {"supply.converter_stations": [{"name": "C", "position_km": 3.0, "type": "Q48/Q49",
                                        "converters": 1}]},
        "C is no rectifier station, and the system DC-0.75kV is one of direct current",
    ),
    "another system": (
        {"supply.system": "25kV-50Hz", "supply.catenary.x_ohm_per_km": 0.2},
        "West is a rectifier station, and the system 25kV-50Hz is none of direct current",
    ),
    "a frequency": ({"supply.frequency_hz": 50.0}, "the system DC-0.75kV has no frequency"),
    "a reactance": ({"supply.catenary.x_ohm_per_km": 0.2}, "has a reactance or a capacitance"),
    "a power factor": ({"trains.unit.power_factor": 0.9}, "has no reactive power"),
    "a filter": ({"trains.unit.filter_reactance_ohm": -0.45}, "a filter for alternating current"),
    "an Rc4": ({"trains.unit": {"model": "Rc4-freight-1470t"}}, "a machine for 15 kV alternating"),
    "an inverter below": (
        {f"{EAST}.inverter": {"starts_at_kv": 0.8, "resistance_ohm": 0.02}},
        "is below the voltage without load, 0.825 kV, so that current would circulate",
    ),
    "two descriptions": (
        {f"{EAST}.type.curve": [{"current_a": 0.0, "voltage_kv": 0.8},
                                {"current_a": 100.0, "voltage_kv": 0.7}]},
        "give either no_load_voltage_kv with resistance_ohm, curve or transformer",
    ),
    "a curve that rises": (
        {f"{EAST}.type": {"rated_current_a": 100.0, "curve": [
            {"current_a": 0.0, "voltage_kv": 0.8}, {"current_a": 100.0, "voltage_kv": 0.9}]}},
        "let the current grow and the voltage fall from point to point",
    ),
    "a voltage that is held too high": (
        {f"{EAST}.type.controlled": {"voltage_kv": 0.9, "droop_ohm": 0.001}},
        "is not below the voltage without load, 0.825 kV",
    ),
    "a taper below the stations": (
        {"trains.unit.regeneration.full_until_kv": 0.8},
        "below the voltage of West without load, 0.825 kV",
    ),
    "a high-voltage line": (
        {"supply.high_voltage_line": {"type": "132kV", "transformers_km": [3.0]}},
        "a high-voltage line beside the system",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_what_to_do(name):
    changes, said = FAULTS[name]
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.simulate(direct_scenario(**changes))
    assert said in str(caught.value)
