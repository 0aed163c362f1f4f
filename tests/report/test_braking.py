"""Where braked energy goes, in reports, comparisons, variants and figures."""

from dataclasses import replace

import numpy as np
import pytest

import feeding_back
import tpss
from feeding_back import PLAIN
from tpss.cli.variants import COLUMNS, row_of
from tpss.report import tables
from tpss.report.drawings.braking import MOST_ROWS, _few, braking
from tpss.report.drawings.parts import Mark
from tpss.report.drawings.stations import station_powers
from tpss.report.figures.catalogue import applies
from tpss.report.html import comparison, report
from tpss.report.trains import NothingToDrawError
from tpss.results.regeneration import TOTALS, by_service, fed_back

from pages import Page


@pytest.fixture(scope="module")
def electric() -> tpss.Result:
    return tpss.simulate(feeding_back.scenario())


@pytest.fixture(scope="module")
def friction() -> tpss.Result:
    """The same with friction brakes only, and converters that do not say what they lose."""
    return tpss.simulate(feeding_back.scenario(PLAIN, {}))


def test_services_add_up_to_all_trains(electric):
    table, totals = by_service(electric.dataset, electric.scenario), fed_back(
        electric.dataset, electric.scenario
    )  # fmt: skip
    assert totals is not None
    assert table.index.tolist() == ["eastbound"]
    assert {name: table[name].sum() for name in TOTALS} == pytest.approx(totals)


def test_the_parts_of_a_bar_are_what_is_braked(electric):
    (panel,) = braking({"": electric}).panels
    assert panel.rows == ["eastbound"]
    ends = np.cumsum([bar.length for bar in panel.items])
    assert [bar.start for bar in panel.items] == pytest.approx([0.0, *ends[:-1]])
    braked = electric.regeneration.braked_mwh.sum()
    assert ends[-1] == pytest.approx(braked, rel=5e-3)  # parts too small to be seen are left out
    assert {"to the grid", "friction", "lost in machines"} <= {bar.name for bar in panel.items}


def test_bars_of_several_runs_stand_below_each_other_and_a_legend_names_a_part_once(electric):
    (panel,) = braking({"one": electric, "two": electric}).panels
    assert panel.rows == ["eastbound, one", "eastbound, two"]
    named = [bar.name for bar in panel.items if bar.name]
    assert len(set(named)) == len(named)


def test_of_many_services_the_last_bar_is_that_of_those_that_brake_least(electric):
    table = by_service(electric.dataset, electric.scenario)
    many = table.loc[["eastbound"] * 30] * np.arange(1.0, 31.0)[:, None]
    many.index = [f"s{k}" for k in range(30)]
    few = _few(many)
    assert few.index.tolist() == [*(f"s{k}" for k in range(19, 30)), "19 others"]
    assert len(few) == MOST_ROWS
    assert few.braked_mwh.sum() == pytest.approx(many.braked_mwh.sum())


def test_without_electric_brakes_all_is_friction(electric, friction):
    """Such a bar stands beside those of electric brakes; alone it is drawn only if asked for."""
    assert not applies("braking", friction)
    (bar,) = braking({"": friction}).panels[0].items
    assert bar.name == "friction"
    assert bar.length == pytest.approx(electric.regeneration.braked_mwh.sum(), rel=1e-6)


def test_without_a_train_nothing_is_drawn(friction):
    empty = replace(friction, dataset=friction.dataset.isel(train=slice(0)))
    with pytest.raises(NothingToDrawError, match="no train"):
        braking({"": empty})


def test_a_station_that_takes_power_back_is_marked_at_nothing(electric, friction):
    for result, marked in ((electric, True), (friction, False)):
        panel = station_powers({"": result}).panels[0]
        assert any(isinstance(item, Mark) for item in panel.items) == marked
        lowest = result.dataset.station_active_power.min() / 1e6
        assert (lowest < -1.0) == marked


def test_a_report_has_table_and_figure_where_trains_have_electric_brakes(electric, friction):
    page, plain = report(electric), report(friction)
    assert "Braked energy" in Page(page).text
    assert "Braked" in Page(page).captions
    assert "Braked" not in Page(plain).captions
    assert "Braked energy" not in Page(plain).text
    assert "fed back" not in Page(plain).text
    assert tables.of_regeneration(friction) == []
    (table,) = tables.of_regeneration(electric)
    assert len(table.rows) == len(electric.regeneration)


def test_a_comparison_has_lines_for_what_is_fed_back_and_lost(electric, friction):
    """Of the run without, the cells are empty."""
    figures = tables.of_figures({"electric": electric, "friction": friction})
    rows = {row[0].text: row[1:] for row in figures.rows}
    for name in ("fed back by trains [MWh]", "energy braked [MWh]"):
        assert float(rows[name][0].value) > 0.0
        assert rows[name][1].text == "–"
    assert rows["losses of converter stations by estimate [MWh]"][1].text == "–"
    assert "fed back by trains" in Page(comparison({"a": electric, "b": friction})).text
    silent = {row[0].text for row in tables.of_figures({"friction": friction}).rows}
    assert not [name for name in silent if "fed back" in name or "converter" in name]


def test_variants_side_by_side_have_columns_for_it(electric, friction):
    with_it, without = (
        dict(zip(COLUMNS, row_of(result).figures, strict=True)) for result in (electric, friction)
    )
    totals = fed_back(electric.dataset, electric.scenario)
    assert totals is not None
    assert with_it["fed back MWh"] == totals["fed_back_mwh"]
    assert with_it["converters lose MWh"] == electric.summary["converter_losses"]["losses_mwh"]
    for name in ("braked MWh", "fed back MWh", "converters lose MWh"):
        assert without[name] is None
