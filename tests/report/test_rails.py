"""The voltage of rails as it is drawn and reported."""

import numpy as np
import pytest

import tpss
from tpss.report.drawings.parts import Curve, Mark
from tpss.report.drawings.rails import rail_voltage
from tpss.report.figures import draw
from tpss.report.html import report
from tpss.report.render import interactive
from tpss.report.trains import NothingToDrawError

from direct_scenarios import direct_scenario

PARTS = {"contact_line": {"r_ohm_per_km": 0.008}, "rails": {"r_ohm_per_km": 0.012}}


@pytest.fixture(scope="module")
def leaking():
    return tpss.simulate(
        direct_scenario(**{"supply.catenary": PARTS, "supply.conductors.leakage_s_per_km": 0.2})
    )


def test_rails_are_drawn_from_the_lowest_to_the_highest_voltage_at_each_place(leaking):
    (panel,) = rail_voltage(leaking).panels
    curves = {item.name: item.y for item in panel.items if isinstance(item, Curve)}
    np.testing.assert_array_equal(curves["highest"], leaking.rails.highest_v)
    np.testing.assert_array_equal(curves["lowest"], leaking.rails.lowest_v)
    figure = interactive.render(rail_voltage(leaking), 400)
    assert len(figure.data) == len(curves)
    assert draw("rails", leaking).get_suptitle() == "direct"


def test_only_limits_near_what_is_drawn_are_marked(leaking):
    """Of 120 and 160 V none is near; one of 1 V is, on both sides."""
    assert not any(isinstance(item, Mark) for item in rail_voltage(leaking).panels[0].items)
    strict = leaking.with_standards({"rails.permanent_v": 1.0})
    marks = [item.value for item in rail_voltage(strict).panels[0].items if isinstance(item, Mark)]
    assert marks == [1.0, -1.0]


def test_a_report_shows_rails_only_where_there_are_any(leaking, short):
    text = report(leaking)
    assert 'id="rails"' in text
    assert "Stray current" in text
    assert 'id="rails"' not in report(short)
    with pytest.raises(NothingToDrawError, match="no conductors of their own"):
        rail_voltage(short)
