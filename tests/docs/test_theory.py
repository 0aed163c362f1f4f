"""Figures in the pages of the theory are those of this program."""

import re
from functools import cache
from pathlib import Path

import pytest

import tpss

from conftest import EXAMPLES

CHOICES = {
    "thesis": {
        "simulation.power_sampling": "start",
        "simulation.gradient_sampling": "start",
        "simulation.adhesion_speed_unit": "km/h",
    },
    "defaults": {},
    "within steps": {"simulation.braking": "within-step"},
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
    number = r" (-?\d+\.\d\d) \|"
    rows = re.findall(rf"^\| (\d\.\d) \|{3 * number} (-?\d+) \|$", page, re.MULTILINE)
    assert [step for step, *_ in rows] == ["2.0", "1.0", "0.5", "0.2", "0.1"]
    for step, *energies_percent, voltage_v in rows:
        for choices, energy_percent in zip(CHOICES, energies_percent, strict=True):
            finest_mwh, finest_v = over_90_minutes(0.05, choices)
            energy_mwh, lowest_v = over_90_minutes(float(step), choices)
            assert f"{100 * (energy_mwh / finest_mwh - 1):.2f}" == energy_percent
        assert f"{lowest_v - finest_v:.0f}" == voltage_v
