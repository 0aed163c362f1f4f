"""The original version of the program, beside an independent implementation and the documentation."""

import re
from pathlib import Path

import pytest

import tpss

from conftest import EXAMPLES

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "original.md"
ROWS = re.findall(
    r"^\| ([\d.]+) \| ([\d.]+) \| ([\d.]+), ([\d.]+) \| [\d.]+ \| [\d.]+, [\d.]+ \|$",
    PAGE.read_text("utf-8"),
    re.MULTILINE,
)


def run(step_min, changes=None):
    changes = {"simulation.time_step_min": step_min, **(changes or {})}
    result = tpss.simulate(tpss.load_scenario(EXAMPLES / "thesis_original.toml", changes))
    assert result.status == "finished"
    assert result.audit["passed"], result.audit["failures"]
    return result


@pytest.mark.parametrize(("unit", "energy_mwh"), [("km/h", 44.4), ("m/s", 38.7)])
def test_energy_agrees_with_the_independent_figure(unit, energy_mwh):
    """Steps of 0.05 min; figures with one decimal."""
    result = run(0.05, {"simulation.adhesion_speed_unit": unit})
    assert result.summary["total_energy_mwh"] == pytest.approx(energy_mwh, abs=0.06)


@pytest.mark.parametrize(("step", "trip", "west", "east"), ROWS, ids=[row[0] for row in ROWS])
def test_figures_of_the_page_are_those_of_this_program(step, trip, west, east):
    result = run(float(step))
    assert f"{result.summary['trip_time_min']:.1f}" == trip
    assert [f"{e:.2f}" for e in result.stations.energy_mwh] == [west, east]


def test_the_page_has_the_thesis_s_five_steps():
    assert [float(row[0]) for row in ROWS] == [1.0, 0.5, 0.2, 0.1, 0.05]


def test_all_or_nothing_takes_a_seventh_more_energy_than_holding_the_limit():
    """14 % here, 17 % in the thesis."""
    regulated = run(0.1, {"simulation.driver": "regulated"}).summary["total_energy_mwh"]
    assert run(0.1).summary["total_energy_mwh"] / regulated == pytest.approx(1.14, abs=5e-3)
