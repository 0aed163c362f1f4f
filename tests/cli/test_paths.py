"""Faults name files as the user named them, of scenarios, studies and plans alike."""

import copy
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from scenarios import SHORT_LINE
from small_plans import LINE, PLAN

STUDY: dict[str, Any] = {
    "format": 1,
    "name": "headways",
    "scenario": "../lines/line.toml",
    "design": "grid",
    "vary": {"traffic.0.headway_min": [60.0]},
}
PLAN_ELSEWHERE = {**PLAN, "scenario": "../lines/line.toml"}
LINE_FILE, STUDY_FILE, PLAN_FILE = "lines/line.toml", "studies/study.toml", "plans/plan.toml"


def write(file: str, document: dict[str, Any], place: str = "", value: Any = None) -> None:
    """Write a document with a value at a place, if one is given."""
    made = copy.deepcopy(document)
    *above, last = place.split("/")
    table = made
    for key in above:
        table = table.setdefault(key, {})
    if last:
        table[last] = value
    Path(file).parent.mkdir(exist_ok=True)
    Path(file).write_text(tomli_w.dumps(made), "utf-8")


@pytest.mark.parametrize(
    ("command", "named"),
    [
        (["run", LINE_FILE], [LINE_FILE]),
        (["sweep", STUDY_FILE, "--dry-run"], [STUDY_FILE, "studies/../lines/line.toml"]),
        (["plan", "check", PLAN_FILE], [PLAN_FILE, "plans/../lines/line.toml"]),
    ],
)
def test_faults_of_a_scenario(tpss_command, tmp_path, command, named) -> None:
    """Of a study and a plan they stand below the line that names the scenario there."""
    write(LINE_FILE, LINE, "line/length_km", -1.0)
    write(STUDY_FILE, STUDY)
    write(PLAN_FILE, PLAN_ELSEWHERE)
    said = tpss_command(*command)
    assert said.code == 2
    for file in named:
        assert f" {file}: " in said.err
    assert str(tmp_path) not in said.err


@pytest.mark.parametrize(
    ("place", "value", "key"),
    [
        ("vary/traffic.0.headway_min", [-5.0], "vary.traffic.0.headway_min"),
        ("vary/supply.catenary", ["none.toml"], "vary.supply.catenary"),
        ("vary/traffic.0.headway_min", {"low": 5.0, "high": 9.0}, "vary.traffic.0.headway_min"),
        ("set/traffic.0.headway_min", -5.0, "set.traffic.0.headway_min"),
    ],
)
def test_faults_of_a_study(tpss_command, tmp_path, place, value, key) -> None:
    write(LINE_FILE, SHORT_LINE)
    write(STUDY_FILE, STUDY, place, value)
    said = tpss_command("sweep", STUDY_FILE, "--dry-run")
    assert said.code == 2
    assert f" {STUDY_FILE}: {key} = " in said.err
    assert str(tmp_path) not in said.err


@pytest.mark.parametrize(
    ("place", "value", "key"),
    [
        ("measures/AT/cost", -1.0, "measures.AT.cost"),
        ("measures/AT/set", {"supply.catenary": "ATT"}, "measures.AT"),
        ("measures/AT/set", {"supply.catenary": "none.toml"}, "measures.AT"),
        ("measures/AT/set", {"supply.nothing": 1.0}, "measures.AT"),
        ("scenarios/high/traffic.eastbound.headway_min", [-5.0, 9.0], "scenarios"),
        ("scenarios/high/traffic.westbound.headway_min", [5.0, 9.0], "scenarios.high.traffic"),
        ("evaluate", {"most_cases": 1}, "evaluate.most_cases"),
    ],
)
def test_faults_of_a_plan(tpss_command, tmp_path, place, value, key) -> None:
    write(LINE_FILE, LINE)
    write(PLAN_FILE, PLAN_ELSEWHERE, place, value)
    said = tpss_command("plan", "check", PLAN_FILE)
    assert said.code == 2
    assert f" {PLAN_FILE}: {key}" in said.err
    assert str(tmp_path) not in said.err


def test_a_plan_from_its_folder_names_files_from_the_working_folder(tpss_command, tmp_path) -> None:
    """Nobody has named its file: it is told from here."""
    write(LINE_FILE, LINE)
    write(PLAN_FILE, PLAN_ELSEWHERE)
    assert tpss_command("plan", "run", PLAN_FILE, "--out", "out", "--workers", 1).code == 0
    said = tpss_command("plan", "price", "out", "--set", "measures.AT.cost=-1")
    assert said.code == 2
    assert f" {PLAN_FILE}: measures.AT.cost = -1" in said.err
    assert str(tmp_path) not in said.err
