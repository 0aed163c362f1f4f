"""The thermal state of equipment as it is drawn and reported."""

from typing import Any

import numpy as np
import pytest

import tpss
from tpss.report.drawings.thermal import MOST_OF_A_KIND, thermal
from tpss.report.html import comparison, report
from tpss.report.render import interactive, static
from tpss.report.trains import NothingToDrawError

from pages import Page
from scenarios import run

CATENARY = {
    "r_ohm_per_km": 0.21,
    "x_ohm_per_km": 0.2,
    "rating": {
        "continuous_a": 300.0,
        "time_constant_min": 4.7,
        "reference_c": 80.0,
        "ambient_c": 40.0,
    },
}
MOTOR = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
CAPTION = "Thermal state of equipment"


def rated(**changes: Any) -> tpss.Result:
    return run({"traffic.0.headway_min": 5.0, "supply.catenary": CATENARY, **changes})


@pytest.fixture(scope="module")
def warm() -> tpss.Result:
    return rated(**{"trains.freight.motor_rating": MOTOR})


def test_states_are_drawn_in_percent_and_temperatures_below(warm):
    states, temperatures = thermal({"": warm}).panels
    own = warm.equipment
    hottest = own.hottest[0]
    assert states.items[0].name == own.elements[hottest].name
    np.testing.assert_array_equal(states.items[0].y, 100.0 * own.states.state[:, hottest])
    wires = [each for each in states.items[:-1] if each.name.startswith("contact line")]
    assert [each.name for each in wires] == [each.name for each in temperatures.items]
    np.testing.assert_allclose(temperatures.items[0].y, 40.0 + 0.4 * wires[0].y)


def test_one_piece_alone_is_named():
    """A curve without a name would leave open what gets hot."""
    alone = rated(**{
        "supply.catenary": "BT", "trains.freight.motor_rating": MOTOR,
        "traffic.0.headway_min": 1000.0, "traffic.0.initial_trains": [],
    })  # fmt: skip
    drawing = thermal({"": alone})
    (name,) = alone.thermal.element
    assert [each.name for each in drawing.panels[0].items[:-1]] == [name]
    assert interactive.render(drawing, 300).layout.showlegend
    (shown,) = static.render(drawing).legends
    assert [text.get_text() for text in shown.get_texts()] == [name]


def test_of_many_trains_few_are_drawn(warm):
    states = thermal({"": warm}).panels[0]
    motors = [each for each in states.items[:-1] if each.name.startswith("motors of")]
    assert warm.thermal.kind.tolist().count("motors") > MOST_OF_A_KIND == len(motors)


def test_a_report_has_plot_and_table_only_where_something_has_a_rating(warm, page):
    text = report(warm)
    assert 'id="thermal"' in text
    assert CAPTION in Page(text).captions
    assert 'id="thermal"' not in page
    assert CAPTION not in Page(page).captions


def test_a_comparison_draws_the_runs_that_have_ratings(warm, short):
    assert 'id="thermal"' in comparison({"rated": warm, "bare": short})
    assert {each.name.rpartition(", ")[2] for each in thermal({"rated": warm}).panels[1].items} == {
        "rated"
    }


def test_without_a_rating_there_is_nothing_to_draw(short):
    with pytest.raises(NothingToDrawError, match="no equipment has a rating"):
        thermal({"": short})
