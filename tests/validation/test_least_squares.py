"""Least squares of the mismatches against the system of equations, over whole runs."""

import numpy as np
import pytest

import tpss
from tpss import extras

from conftest import EXAMPLES
from scenarios import short_line

BY_SQUARES = {"simulation.load_flow": "least-squares"}

SCALE = {"V": 16.5e3, "W": 10e6, "var": 10e6, "rad": 1.0}
"""Per unit of 16.5 kV and 10 MVA."""

AGREEMENT = 1e-6
"""What the two formulations owe each other; they come to 1e-9."""

CASES = {
    "Table 3-3": ("thesis_3_3", {"simulation.until": None, "simulation.duration_min": 60.0,
                                 "simulation.time_step_min": 1.0}),
    "AT with high-voltage line": ("at_hv_headway_3", {"simulation.duration_min": 4.0}),
    "stops, converters that are switched, the original driver": (
        "thesis_3_7_2", {"simulation.driver": "aggressive"}),
    "stops, braking within steps": ("thesis_3_7_2", {
        "simulation.motion": "stepped", "simulation.braking": "within-step"}),
}  # fmt: skip


@pytest.mark.parametrize(("name", "changes"), CASES.values(), ids=CASES)
def test_least_squares_agree_with_the_equations_at_every_step(name, changes):
    """Every voltage and power; in between, plans, converters and positions are the same."""
    scenario = tpss.load_scenario(EXAMPLES / f"{name}.toml", changes)
    equations = tpss.simulate(scenario)
    squares = tpss.simulate(scenario.with_(BY_SQUARES))
    assert squares.status == equations.status == "finished"
    assert squares.audit["passed"], squares.audit["failures"]
    for variable, expected in equations.dataset.data_vars.items():
        if expected.units in SCALE:
            found = squares.dataset[variable]
            difference = np.abs(found.to_numpy() - expected.to_numpy()) / SCALE[expected.units]
            assert np.nanmax(difference) < AGREEMENT, variable
            assert (found.isnull() == expected.isnull()).all()
    for variable in ("train_state", "active_converters"):
        assert squares.dataset[variable].variable.equals(equations.dataset[variable].variable)
    arrivals_s = [result.dataset.arrival_time.to_numpy() for result in (squares, equations)]
    assert arrivals_s[0] == pytest.approx(arrivals_s[1], abs=1e-6, nan_ok=True)


def test_a_line_that_cannot_carry_its_load_collapses_at_the_same_step_and_share():
    weak = {
        "simulation.time_step_min": 0.5,
        "line.length_km": 100.0, "line.stations.2.position_km": 100.0,
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
        ],
        "traffic.0.headway_min": 5.0,
    }  # fmt: skip
    equations, squares = (tpss.simulate(short_line({**weak, **c})) for c in ({}, BY_SQUARES))
    assert squares.status == "collapsed"
    assert squares.summary["problem"] == equations.summary["problem"]
    assert squares.summary["duration_min"] == equations.summary["duration_min"] > 10.0
    assert squares.audit["passed"]


def test_without_scipy_the_finding_says_how_to_install_it(monkeypatch):
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.simulate(short_line(BY_SQUARES))
    (finding,) = caught.value.findings
    assert finding.key == "simulation.load_flow"
    assert "not installed" in finding.problem
    assert 'pip install "tpss[least-squares]"' in finding.remedy
