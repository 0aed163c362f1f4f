"""A study tells what converters lose and where braked energy goes, where its lines describe that."""

import pandas as pd
import pytest

import feeding_back
import tpss
from feeding_back import LOSING, PLAIN
from tpss.results.regeneration import TOTALS, fed_back
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.outcome import load_outcome
from tpss.sweep.report import study_report
from tpss.sweep.summary import summarise

COLUMNS = [f"braking.{name}" for name in TOTALS]

LABELS = {
    "losses of converters [MWh]",
    "drawn from the grid [MWh]",
    "fed back to the grid [MWh]",
    "braked [MWh]",
    "braked by friction [MWh]",
    "refused by the line [MWh]",
    "burnt in rheostats of trains [MWh]",
    "fed back by trains [MWh]",
    "of it used by others [MWh]",
    "of it burnt in stations [MWh]",
}


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Study and folder of a line whose converters and trains tell all of it."""
    place = tmp_path_factory.mktemp("told")
    small = feeding_back.study(place, feeding_back.document())
    tpss.run_study(small, place / "out", workers=1)
    return small, place / "out"


@pytest.fixture(scope="module")
def silent(tmp_path_factory):
    """Folder of a study of the same line with friction brakes and a type without losses."""
    place = tmp_path_factory.mktemp("silent")
    small = feeding_back.study(place, feeding_back.document(PLAIN, {}))
    tpss.run_study(small, place / "out", workers=1)
    return place / "out"


def test_its_columns_are_what_the_runs_tell(told):
    """They come from the recording alone; those of a run, from its dataset."""
    small, folder = told
    for row in tpss.load_table(folder).to_dict("records"):
        result = tpss.simulate(scenario_of(design_of(small), row["case"]))
        totals = fed_back(result.dataset, result.scenario)
        assert totals is not None
        assert [row[name] for name in COLUMNS] == pytest.approx(list(totals.values()), rel=1e-9)
        grid = result.summary["converter_losses"]
        told_mwh = (row["converter_losses_mwh"], row["drawn_from_grid_mwh"])
        assert told_mwh == pytest.approx((grid["losses_mwh"], grid["from_grid_mwh"]), rel=1e-9)
        assert row["fed_back_to_grid_mwh"] == pytest.approx(grid["to_grid_mwh"], rel=1e-9)
        assert row["braking.fed_back_mwh"] > 0.1


def test_summary_and_report_show_them(told):
    _, folder = told
    assert set(summarise(tpss.load_table(folder), 2).spread.index) >= LABELS
    page = study_report(load_outcome(folder), folder)
    assert all(label in page for label in LABELS)


def test_they_are_absent_where_no_case_has_them(silent):
    table = tpss.load_table(silent)
    assert table[[*COLUMNS, "converter_losses_mwh", "fed_back_to_grid_mwh"]].isna().all().all()
    assert LABELS.isdisjoint(summarise(table, 2).spread.index)
    page = study_report(load_outcome(silent), silent)
    assert not any(label in page for label in LABELS)


def test_cases_that_do_not_tell_them_have_none(tmp_path):
    """One choice of two describes losses: its energy from the grid stands beside nothing."""
    key = "supply.converter_stations.*.type"
    choices = {"converters": {"silent": {key: PLAIN}, "losing": {key: LOSING}}}
    small = feeding_back.study(tmp_path, feeding_back.document(), choices)
    tpss.run_study(small, tmp_path / "out", workers=1)
    table = tpss.load_table(tmp_path / "out").set_index("set.converters")
    assert table.converter_losses_mwh.notna().tolist() == (table.index == "losing").tolist()
    assert table["braking.fed_back_mwh"].notna().all()


def test_export_has_them(told, tmp_path):
    from tpss.cli.study import export_study
    from tpss.results.file_kinds import Kind

    export_study(told[1], Kind.CSV, tmp_path, force=False)
    exported = pd.read_csv(tmp_path / "cases.csv")
    table = tpss.load_table(told[1])
    for name in (*COLUMNS, "converter_losses_mwh"):
        (found,) = [each for each in exported if _plain(each) == _plain(name)]
        assert exported[found].tolist() == pytest.approx(table[name].tolist(), rel=1e-9)


def _plain(name):
    """A name, or a heading, in letters."""
    return "".join(c for c in name.lower() if c.isalpha())
