"""What comes of edits: findings beside fields, or a run; the newest counts."""

import shutil
import threading

import numpy as np
import pytest

import tpss
from tpss.studio import live as live_module
from tpss.studio import runs
from tpss.studio.charts import CHARTS
from tpss.studio.newest import DroppedError, Newest

from conftest import EXAMPLES
from studio_page import Page, numbers

HEADWAY = ("traffic.0.headway_min", 30.0)


def test_what_is_opened_tells_all_that_a_page_has_to_know(page, file):
    told = page.ask("opened")
    assert told["name"] == "line.toml"
    assert told["command"] == f"tpss studio {file}"
    assert told["document"]["traffic"][0]["headway_min"] == 60.0
    assert told["labels"]["headway_min"] == ["headway", "min"]
    assert told["charts"]["voltage"] == {"title": "Voltage along the line", "over": "line"}
    assert told["draft"]["edits"] == []


def test_a_run_is_that_of_the_command_line(page, file):
    told = page.see(HEADWAY, charts=("voltage", "graph"))["result"]
    result = tpss.simulate(tpss.load_scenario(file, dict([HEADWAY])))
    figures = {words: value for words, _, value, _ in told["figures"]}
    assert figures["total energy"] == result.summary["total_energy_mwh"]
    assert figures["lowest voltage"] == result.summary["lowest_voltage"]["voltage_kv"]
    assert told["audit"]["passed"] is True
    assert told["violation_count"] == len(result.standards.violations)


def test_curves_are_those_of_the_report(page):
    from tpss.report.contact_line import line_voltage

    (panel,) = page.see(charts=("voltage",))["result"]["charts"]["voltage"]["panels"]
    lowest = next(each for each in panel["items"] if each.get("name") == "lowest")
    result = tpss.simulate(page.live.desk.scenario(page.live.desk.document([])))
    expected = line_voltage(result.dataset).lowest_kv
    np.testing.assert_array_equal(numbers(lowest["y"]), expected.astype("<f4"))


def test_only_charts_that_are_shown_are_drawn(page):
    told = page.see(charts=("powers", "thermal", "no-such-chart"))["result"]
    assert list(told["charts"]) == ["powers"]
    assert set(told["offered"]) < set(CHARTS)


def test_a_fault_is_told_by_the_path_of_its_field(page):
    told = page.see(
        ("traffic.0.headway_min", "zwei"), ("supply.converter_stations.West.converters", 0)
    )
    found = {each["path"]: each["problem"] for each in told["findings"]}
    assert found["traffic.0.headway_min"] == "not a number"
    assert found["supply.converter_stations.0.converters"] == "out of range"
    assert "result" not in told
    assert told["document"]["traffic"][0]["headway_min"] == "zwei"


def test_an_edit_that_leads_nowhere_is_told(page):
    (finding,) = page.see(("traffic.7.headway_min", 3.0))["findings"]
    assert finding["problem"] == "no such place in the scenario"


def test_a_line_that_collapses_is_a_result(page_of, tmp_path):
    for name in ("overloaded.toml", "gradients_a_160km.csv"):
        shutil.copy(EXAMPLES / name, tmp_path)
    told = page_of(tmp_path / "overloaded.toml").see()
    assert told["findings"] == []
    assert told["result"]["status"] == "collapsed"
    assert told["result"]["problem"]


def test_the_plan_has_places_and_the_paths_that_move_them(page):
    plan = page.see()["plan"]
    places = {(each["kind"], each["name"]): (each["km"], each["path"]) for each in plan["places"]}
    assert places["station", "Middle"] == (10.0, "line.stations.1.position_km")
    assert places["feeding", "East"] == (20.0, "supply.converter_stations.1.position_km")
    assert places["transformer", "transformer 2"] == (
        14.0,
        "supply.high_voltage_line.transformers_km.1",
    )
    assert plan["lines"][0]["gradients"] == [[0.0, 0.0]]
    assert plan["lines"][0]["limits"] == [[0.0, 60.0]]


def test_what_is_spaced_equally_is_not_moved(page):
    edits = (
        ("supply.high_voltage_line.transformers_km", None),
        ("supply.high_voltage_line.transformers", 1),
    )
    places = page.see(*edits)["plan"]["places"]
    assert [(e["km"], e["path"]) for e in places if e["kind"] == "transformer"] == [(10.0, None)]


def test_the_check_tells_the_error_of_the_step(page):
    told = page.ask("check", page="one", number=1, edits=[])
    assert told["within"] is True
    assert told["step_lines"][0].startswith("At half the step (0.025 min)")


def test_a_scenario_that_leaves_its_step_open_keeps_the_one_chosen(page):
    edits = (("simulation", None),)
    first = page.see(*edits)["result"]
    assert first["chosen_step"] is True
    assert page.live.chosen_step_min == first["step_min"]
    assert page.see(*edits, HEADWAY)["result"]["step_min"] == first["step_min"]


def test_a_newer_run_ends_the_one_before():
    newest = Newest()
    first = newest.begin("one", 1)
    other = newest.begin("two", 1)
    newest.begin("one", 2)
    assert first
    assert not other
    with pytest.raises(DroppedError):
        newest.begin("one", 1)


def test_a_run_that_was_overtaken_is_dropped(page: Page):
    began, done = threading.Event(), []
    prepare = live_module.built

    def slowly(scenario):
        prepared = prepare(scenario)
        began.set()
        assert overtaken.wait(30.0)
        return prepared

    overtaken = threading.Event()
    live_module.built = slowly
    try:
        slow = threading.Thread(
            target=lambda: done.append(page.ask("see", page="one", number=1, edits=[]))
        )
        slow.start()
        assert began.wait(30.0)
        live_module.built = prepare
        newer = page.ask("see", page="one", number=2, edits=[])
        overtaken.set()
        slow.join(30.0)
    finally:
        live_module.built = prepare
    assert newer["result"]["status"] == "finished"
    assert done[0]["dropped"] is True


def test_a_run_that_takes_too_long_is_told(page, monkeypatch):
    monkeypatch.setattr(runs, "LONGEST_S", 0.0)
    edits = (("simulation.time_step_min", 0.001), ("traffic.0.headway_min", 1.0))
    (finding,) = page.see(*edits)["findings"]
    assert "takes too long" in finding["problem"]


@pytest.mark.parametrize(
    ("edits", "path", "value"),
    [
        ([("traffic.0.headway_min", 0.01)], "traffic.0", "about 4,001 trains"),
        (
            [("simulation.duration_min", 100_000.0), ("simulation.time_step_min", 0.001)],
            "simulation.time_step_min",
            "100,000,000 steps",
        ),
    ],
)
def test_more_than_a_page_can_wait_for_is_refused(page, edits, path, value):
    (finding,) = page.see(*edits)["findings"]
    assert (finding["path"], finding["value"]) == (path, value)
    assert "while editing" in finding["problem"]


def test_changes_are_told_in_three_ways(page, file):
    told = page.ask("changes", edits=[list(HEADWAY)])
    assert told["count"] == 1
    assert told["options"] == "--set traffic.0.headway_min=30.0"
    assert '"traffic.0.headway_min": 30.0' in told["python"]
    assert "+headway_min = 30.0  # one an hour" in told["toml"]


def test_what_is_saved_is_told(page, file):
    digest = page.ask("opened")["digest"]
    told = page.ask("save", edits=[list(HEADWAY)], digest=digest)
    assert told["document"]["traffic"][0]["headway_min"] == 30.0
    assert told["digest"] != digest
    assert "not overwritten" in page.ask("save", edits=[], digest=digest)["refused"]
