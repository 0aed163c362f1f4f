"""Faults of a study are told before the first case: file, place, value, remedy."""

from typing import Any

import pytest

import tpss
from sweep.studies import study, write_study
from tpss.sweep.campaign import estimate
from tpss.sweep.check import check
from tpss.sweep.design import design_of
from tpss.sweep.study import load_study

from conftest import EXAMPLES

DRAWN = {"mean_permille": 0.0, "standard_deviation_permille": 1.0}
SOBOL = {"design": "sobol", "cases": 8}


def told(tmp_path, changes: dict[str, Any]) -> str:
    """What is said of a faulty study."""
    with pytest.raises(tpss.ScenarioError) as caught:
        estimate(study(tmp_path, changes))
    return str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {**SOBOL, "vary": {"traffic.0.headway_min": {"low": 30.0, "high": 5.0}}},
            ["vary.traffic.0.headway_min", "an empty range, 30 to 5", "set low below high"],
        ),
        (
            {"gradients": DRAWN, "vary": {"line": [True]}},
            ["vary.line = True", "not a table"],
        ),
        (
            {"gradients": DRAWN, "vary": {"line.length_km": [1e300]}},
            ["vary.line.length_km = 1e+300", "out of range"],
        ),
        (
            {"gradients": {"mean_permille": 0.0, "standard_deviation_permille": 10**400}},
            ["gradients.standard_deviation_permille", "out of range", "numbers from 0 to 100"],
        ),
        ({"vary": {"traffic.0.headway_min": []}}, ["vary.traffic.0.headway_min", "an empty list"]),
        (
            {"vary": {"traffic.0.headway_min": {"low": 5.0, "high": 30.0}}},
            ["without a number of values", "add steps = 5"],
        ),
        (
            {"vary": {"traffic.0.headway_min": {"low": 5.0, "hihg": 30.0}}},
            ["vary.traffic.0.headway_min.hihg", "unknown key", "did you mean high?"],
        ),
        (
            {"vary": {"traffic.0.headwey_min": [5.0]}},
            ["vary.traffic.0.headwey_min = 5.0", "unknown key", "did you mean headway_min?"],
        ),
        (
            {"vary": {"supply.convertor_stations.*.converters": [1]}},
            ["supply.convertor_stations.*.converters", "there is no such place", "name tables"],
        ),
        (
            {"vary": {"traffic.7.headway_min": [5.0]}},
            ["traffic.7.headway_min = 5.0", "no such place in the base scenario", "name one of"],
        ),
        (
            {"vary": {"supply.catenary": ["BT", "ATT"]}},
            ["vary.supply.catenary = 'ATT'", "the library has no such entry", "did you mean AT?"],
        ),
        (
            {**SOBOL, "vary": {"supply.converter_stations.*.converters": {"low": 1, "high": 3}}},
            ["vary.supply.converter_stations.*.converters = 1.0", "add whole = true"],
        ),
        (
            {"vary": {"supply.high_voltage_line.transformers": [1]}},
            [
                "vary.supply.high_voltage_line.transformers = 1",
                "the scenario is not valid: supply.high_voltage_line.type: it is missing",
            ],
        ),
        (
            {"vary": {"line.length_km": [10.0, 3000.0]}},
            ["vary.line.length_km = 3000.0", "less than or equal to 2000 km"],
        ),
        ({"vary": None}, ["nothing varies", "add a table vary, choices or gradients"]),
        ({"cases": 5}, ["a grid has as many cases as combinations", "leave cases out"]),
        ({"design": "sobol"}, ["the sobol needs a number of cases", "add cases = 256"]),
        ({"design": "random"}, ["design = 'random'", "choose from grid, latin-hypercube, sobol"]),
        ({"scenario": "long_line.toml"}, ["long_line.toml", "there is no such file"]),
        (
            {"set": {"simulation.time_step_mim": 1.0}},
            ["set.simulation.time_step_mim", "unknown key", "did you mean time_step_min?"],
        ),
        (
            {"gradients": {"mean_permille": 0.0, "standard_deviation_permille": 90.0}},
            ["gradients", "less than or equal to 100"],
        ),
        (
            {
                "gradients": {
                    "mean_permille": 0.0,
                    "standard_deviation_permille": 1.0,
                    "piece_km": 50.0,
                }
            },
            ["gradients.piece_km", "one piece, which has no standard deviation"],
        ),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_a_faulty_study_is_told_by_its_place_and_remedy(tmp_path, changes, words):
    message = told(tmp_path, changes)
    assert "study.toml" in message
    for word in words:
        assert word in message


def test_values_that_do_not_go_together_are_told_with_each_other(tmp_path):
    """A train is placed at 60 km/h on a line of 90 km/h; its own highest speed may be lower."""
    changes = {
        **SOBOL,
        "set": {"simulation.duration_min": 5.0},
        "vary": {
            "trains.freight.max_speed_kmh": {"low": 50.0, "high": 100.0},
            "line.speed_limits.*.speed_kmh": {"low": 90.0, "high": 95.0},
        },
        "choices": {
            "placed": {
                "none": {},
                "one": {"traffic.0.initial_trains": [{"position_km": 1.0, "speed_kmh": 60.0}]},
            }
        },
    }
    message = told(tmp_path, changes)
    assert "faster than the limit here" in message


def test_a_scenario_in_place_of_a_study_is_told_and_the_other_way_round():
    for load, example, words in (
        (load_study, "thesis_160km.toml", "a scenario, not a study"),
        (tpss.load_scenario, "study_converters.toml", "a study, not a scenario"),
    ):
        with pytest.raises(tpss.ScenarioError) as caught:
            load(EXAMPLES / example)
        (finding,) = caught.value.findings
        assert finding.problem == words
        assert finding.remedy.startswith("run it with tpss")


def test_all_faults_of_the_base_scenario_are_told(tmp_path):
    file = write_study(tmp_path, {"set": {}})
    base = tmp_path / "short_line.toml"
    base.write_text(base.read_text("utf-8").replace("= 60.0", "= 6000.0"), "utf-8")
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.load_study(file)
    message = str(caught.value)
    assert "scenario = 'short_line.toml'" in message
    assert "the base scenario has 1 fault(s), listed below" in message
    assert "line.speed_limits.0.speed_kmh = 6000.0" in message


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("study_*.toml")), ids=lambda file: file.stem)
def test_studies_of_the_examples_are_sound(file):
    names = check(design_of(tpss.load_study(file)))
    stations = ("Western", "Eastern") if file.stem == "study_network" else ("West", "East")
    assert names.stations == stations


def test_a_study_that_is_no_toml_is_told(tmp_path):
    (tmp_path / "study.toml").write_text("format = ", "utf-8")
    with pytest.raises(tpss.ScenarioError, match="not TOML"):
        tpss.load_study(tmp_path / "study.toml")
