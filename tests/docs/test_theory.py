"""Figures in the pages of the theory are those of this program."""

import re
from functools import cache
from pathlib import Path

import pytest

import tpss

from conftest import EXAMPLES

IN_STEPS = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
CHOICES = {
    "default": {},
    "thesis": {
        **IN_STEPS,
        "simulation.power_sampling": "start",
        "simulation.gradient_sampling": "start",
        "simulation.adhesion_speed_unit": "km/h",
    },
    "whole steps": IN_STEPS,
    "within steps": {**IN_STEPS, "simulation.braking": "within-step"},
}

THEORY = Path(__file__).parents[2] / "docs" / "theory"


@pytest.fixture(scope="module")
def over_90_minutes():
    """Energy [MWh] and lowest voltage [V] of the 160 km example by its time step and choices."""
    scenario = tpss.load_scenario(EXAMPLES / "thesis_160km.toml", {"simulation.until": None})

    @cache
    def run(step_min, choices):
        changes = {"simulation.duration_min": 90.0, "simulation.time_step_min": step_min}
        summary = tpss.simulate(scenario.with_({**changes, **CHOICES[choices]})).summary
        return summary["total_energy_mwh"], 1e3 * summary["lowest_voltage"]["voltage_kv"]

    return run


def test_the_errors_of_long_steps_are_those_of_their_table(over_90_minutes):
    page = (THEORY / "time-step.md").read_text("utf-8")
    rows = re.findall(r"^\| (\d\.\d) \| (.*) \|$", page, re.MULTILINE)
    assert [step for step, _ in rows] == ["2.0", "1.0", "0.5", "0.2", "0.1"]
    for step, cells in rows:
        energies_percent, voltages_v = cells.split(" | ")[:4], cells.split(" | ")[4:]
        for choices, energy_percent in zip(CHOICES, energies_percent, strict=True):
            finest_mwh, _ = over_90_minutes(0.05, choices)
            energy_mwh, _ = over_90_minutes(float(step), choices)
            assert f"{100 * (energy_mwh / finest_mwh - 1):.2f}" == energy_percent
        for choices, voltage_v in zip(("default", "within steps"), voltages_v, strict=True):
            _, finest_v = over_90_minutes(0.05, choices)
            _, lowest_v = over_90_minutes(float(step), choices)
            assert f"{round(lowest_v - finest_v)}" == voltage_v


TRAM = {
    "mass_t": 60.0, "adhesive_mass_t": 40.0, "rotating_mass_factor": 0.08,
    "resistance_a_n": 900.0, "resistance_b_n_s_per_m": 20.0, "resistance_c_n_s2_per_m2": 4.0,
    "max_speed_kmh": 80.0, "max_acceleration_m_s2": 1.1, "max_retardation_m_s2": 1.0,
    "efficiency": 0.85, "power_factor": 0.98, "auxiliary_power_kw": 40.0,
    "tractive_effort": {"max_force_kn": 75.0, "max_power_kw": 500.0},
}  # fmt: skip
HOPS = 10
HILL = [{"from_km": km, "permille": permille} for km, permille in ((0, 0), (2, 20), (3, -20))]
CONVERTERS = [{"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}]
LIGHT_RAIL = {
    "format": 1,
    "name": "light-rail",
    "simulation": {"time_step_min": 0.5},
    "line": {
        "length_km": 0.45 * HOPS,
        "gradients": HILL,
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0}],
        "stations": [{"name": f"S{k}", "position_km": 0.45 * k} for k in range(HOPS + 1)],
    },
    "supply": {"catenary": "BT", "converter_stations": CONVERTERS},
    "trains": {"tram": TRAM},
    "traffic": [
        {
            "name": "tram",
            "train": "tram",
            "from": "S0",
            "to": f"S{HOPS}",
            "headway_min": 5.0,
            "stops": [{"station": f"S{k}", "dwell_min": 0.3} for k in range(1, HOPS)],
        }
    ],
}


def test_short_hops_take_as_long_in_long_steps_as_the_page_says():
    def trip(step_min, changes=None):
        scenario = tpss.Scenario.from_document(LIGHT_RAIL, "light-rail")
        result = tpss.simulate(
            scenario.with_({"simulation.time_step_min": step_min, **(changes or {})})
        )
        return result.trips.iloc[0]

    fine, coarse = trip(0.002), trip(0.5)
    stepped = trip(0.5, {"simulation.motion": "stepped"})
    assert coarse.trip_min == pytest.approx(fine.trip_min, rel=2e-4)
    assert coarse.energy_mwh == pytest.approx(fine.energy_mwh, rel=2e-4)
    assert stepped.trip_min / fine.trip_min == pytest.approx(1.42, abs=5e-3)


def test_a_trip_takes_as_long_as_the_page_says():
    def trip_min(step_min, choices):
        changes = {"simulation.time_step_min": step_min, **CHOICES[choices]}
        scenario = tpss.load_scenario(EXAMPLES / "thesis_160km.toml", changes)
        return f"{tpss.simulate(scenario).summary['trip_time_min']:.1f}"

    for step_min in (0.1, 0.2, 0.5, 1.0, 2.0):
        assert trip_min(step_min, "default") == "99.2"
        assert trip_min(step_min, "within steps") == "99.2"
    assert trip_min(1.0, "whole steps") == trip_min(2.0, "whole steps") == "100.0"
