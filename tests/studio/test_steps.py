"""Trains step by step, and the equations behind the charts."""

import numpy as np
import pytest

import tpss
from tpss.scenario.load import load_scenario
from tpss.studio.charts import CHARTS
from tpss.studio.corridor_plan import plan_of
from tpss.studio.equations import BEHIND, behind

from conftest import EXAMPLE_SCENARIOS
from studio_page import numbers


@pytest.fixture
def ask(page):
    def asked(train, *edits):
        page.number += 1
        return page.ask(
            "train-steps", page="one", what="s", number=page.number, edits=list(edits), train=train
        )

    return asked


def test_the_table_has_every_step_of_a_train(ask, file):
    told = ask("")
    table = tpss.simulate(load_scenario(file)).train_steps
    own = table[table.train == "eastbound 1"]
    assert told["train"] == "eastbound 1"
    assert len(told["rows"]) == len(own)
    speed = told["headings"].index("speed")
    assert told["units"][speed] == "km/h"
    assert told["rows"][40][speed] == own.speed_kmh.iloc[40]


def test_a_train_that_there_is_not_is_told(ask):
    assert "no such train: 'westbound 1'" in ask("westbound 1")["refused"]


def test_trains_move_where_the_recording_has_them(page, file):
    told = page.see(charts=("moving",))["result"]["moving"]
    data = tpss.simulate(load_scenario(file)).dataset
    assert told["steps"] == data.sizes["time"] - 1
    train = told["trains"][0]
    steps = numbers(train["step"]).astype(int)
    expected = data.position.sel(train=train["name"]).to_numpy()[steps] / 1e3
    np.testing.assert_allclose(numbers(train["km"]), expected, atol=1e-3)


def test_trains_are_not_sent_unless_they_are_shown(page):
    assert page.see()["result"]["moving"] is None


@pytest.mark.parametrize("chart", BEHIND)
def test_every_equation_is_told_from_its_source(chart):
    assert chart in CHARTS
    for each in behind(chart):
        assert sum(len(text) for piece in each["pieces"] for text in piece.values()) > 60


def test_charts_without_equations_are_told(page):
    assert "no equations are told" in page.ask("equations", chart="rails")["refused"]


@pytest.mark.parametrize("example", EXAMPLE_SCENARIOS, ids=lambda path: path.stem)
def test_every_example_has_a_plan(example, page_of):
    """Its lines, and places on them; those that are given by a number have a key path."""
    desk = page_of(example).live.desk
    scenario = desk.scenario(desk.document([]))
    plan = plan_of(scenario, desk.content.document)
    lines = {line["name"]: line for line in plan["lines"]}
    assert set(lines) == set(scenario.lines_by_name)
    for place in plan["places"]:
        line = lines[place["line"]]
        assert line["begin_km"] <= place["km"] <= line["end_km"]
    assert {each["name"] for each in plan["places"]} >= {s.name for s in scenario.supply.stations}
