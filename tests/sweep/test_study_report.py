"""What a study's folder shows: a report, figures, tables, and any case as a scenario."""

import json
import re

import numpy as np
import pytest

import tpss
from sweep.studies import study, study_with_stalls
from tpss.report.drawings.parts import Curve
from tpss.report.drawings.study import Axis, parallel, trade_off
from tpss.sweep import figures
from tpss.sweep.outcome import KEPT, LOST, OVERLOADED, load_outcome
from tpss.sweep.report import study_report


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return study_with_stalls(tmp_path_factory.mktemp("report"))


def test_an_axis_runs_from_the_lowest_value_to_the_highest():
    axis = Axis("energy [MWh]", np.array([2.0, np.nan, 4.0, 10.0]))
    assert axis.ends == (2.0, 10.0)
    np.testing.assert_equal(axis.shares, [0.0, np.nan, 0.25, 1.0])
    assert axis.written == [(0.0, "2"), (1.0, "10")]


def test_an_axis_of_texts_has_a_place_for_each():
    axis = Axis("catenary", np.array([0.0, 2.0, 1.0]), ["AT", "BT", "own"])
    assert axis.written == [(0.0, "AT"), (0.5, "BT"), (1.0, "own")]
    assert Axis("catenary", np.zeros(2), ["AT"]).written == [(0.5, "AT")]


def test_each_case_is_a_line_over_the_axes_in_the_colour_of_its_group():
    """Cases 4 and 7 with two quantities: the second has a gap where case 7 has no figure."""
    axes = [Axis("a", np.array([0.0, 1.0])), Axis("b", np.array([5.0, np.nan]))]
    drawing = parallel(np.array([4.0, 7.0]), axes, {"one": np.array([0]), "other": np.array([1])})
    one, other = drawing.panels[0].items[:2]
    np.testing.assert_equal(one.x, [0.0, 1.0, np.nan])
    np.testing.assert_equal(one.y, [0.0, 0.5, np.nan])
    np.testing.assert_equal(other.y, [1.0, np.nan, np.nan])
    assert set(other.words) == {"case 7"}
    assert (one.colour, other.colour) == (0, 1)


def test_cases_without_a_figure_are_no_points_of_a_trade_off():
    across, up = Axis("x", np.array([1.0, 2.0, 3.0])), Axis("y", np.array([1.0, np.nan, 2.0]))
    (points,) = trade_off(np.array([0.0, 1.0, 2.0]), across, up, across).panels[0].items
    assert points.x.tolist() == [1.0, 3.0]
    assert [words.partition("<br>")[0] for words in points.words] == ["case 0", "case 2"]


def test_cases_are_told_apart_by_what_came_of_them(folder):
    """A train of 4000 t stalls on 20 ‰, whatever the converters."""
    outcome = load_outcome(folder)
    groups = {name: outcome.ran["case"][rows].tolist() for name, rows in outcome.groups.items()}
    lost = outcome.ran[outcome.ran["set.load"] == "heavy"]["case"].tolist()
    assert groups.pop(LOST) == lost
    beyond = outcome.ran[(outcome.ran.status == "finished") & (outcome.ran.peak_loading > 1.0)]
    assert groups.get(OVERLOADED, []) == beyond["case"].tolist()
    assert len(groups[KEPT]) == 9 - 3 - len(beyond)
    assert outcome.varied == ["set.supply.converter_stations.*.converters", "set.load"]


def test_a_line_that_was_not_carried_has_no_figures_in_the_plots(folder):
    outcome = load_outcome(folder)
    stalled = (outcome.ran["status"] != "finished").to_numpy()
    assert np.isnan(outcome.axis("total_energy_mwh").values[stalled]).all()
    assert np.isfinite(outcome.axis("total_energy_mwh").values[~stalled]).all()


def test_the_page_holds_every_case_and_loads_nothing(folder):
    page = study_report(load_outcome(folder), folder)
    assert "Study of 9 cases" in page
    assert "3 of 9 cases do not carry their load" in page
    data = json.loads(re.search(r'id="report-data">(.*?)</script>', page, re.S)[1])
    assert data["run"]["study"]["cases"] == list(range(9))
    assert set(data["plots"]) == {"parallel", "trade-offs"}
    table = re.search(r'<table id="cases".*?</table>', page, re.S)[0]
    assert table.count("<tr>") == 10
    assert not re.findall(r'(?:src|href)="(?!#)[^"]*"', page.split("<script>")[0])


def test_of_very_many_cases_a_part_is_drawn_and_that_is_told(folder, monkeypatch):
    """Of nine cases every third one, counted in each group."""
    monkeypatch.setattr(figures, "MOST_LINES", 4)
    outcome = load_outcome(folder)
    drawn = figures.coordinates(outcome).panels[0].items
    cases = {words for item in drawn if isinstance(item, Curve) for words in item.words}
    assert figures.one_in(outcome) == 3
    assert 0 < len(cases) < 9
    assert "One case in 3 is drawn" in study_report(outcome, folder)


def test_a_study_of_cases_that_are_all_alike_has_a_page_too(tmp_path):
    tpss.run_study(study(tmp_path, {"vary": {"traffic.0.headway_min": [5.0]}}), tmp_path / "out")
    outcome = load_outcome(tmp_path / "out")
    assert figures.drawable(outcome) == []
    assert "Too little differs among the cases" in study_report(outcome, tmp_path / "out")


def test_a_page_holds_a_part_of_very_many_cases_and_says_so(folder, monkeypatch):
    monkeypatch.setattr("tpss.sweep.report.MOST_SHOWN", 5)
    page = study_report(load_outcome(folder), folder)
    assert "4 cases are left out of the plots" in page
    assert "Study of 9 cases" in page


def test_names_in_a_page_are_text(tmp_path):
    """What a study calls its options is no markup."""
    choices = {"load": {"<b>bold</b>": {}, "other": {"trains.freight.mass_t": 900.0}}}
    small = study(tmp_path, {"vary": None, "choices": choices})
    tpss.run_study(small, tmp_path / "out", workers=1)
    page = study_report(load_outcome(tmp_path / "out"), tmp_path / "out")
    assert "<b>bold</b>" not in page
