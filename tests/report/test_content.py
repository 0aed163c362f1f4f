"""What a report holds, without a browser."""

import re

import numpy as np
import pytest

import tpss
from tpss.report.html import comparison, report
from tpss.results.contents import HEAD_BYTES, REPORT_MARK

from pages import Page
from scenarios import run

LIMIT_BYTES = 8_000_000

PLOTS = ("moment", "graph", "journey", "powers", "converters", "losses")


def test_the_page_loads_nothing(page, compared):
    for text in (page, compared):
        assert [each for each in Page(text).loaded if not each.startswith("#")] == []
        assert not re.search(r"@import|url\(", text.partition("</style>")[0])


def test_the_page_forbids_itself_the_network(page):
    (policy,) = re.findall(r'Content-Security-Policy" content="(.*?)"', page)
    assert "default-src 'none'" in policy
    assert "http" not in policy


def test_the_page_says_what_it_is_in_its_first_bytes(page):
    assert REPORT_MARK in page[:HEAD_BYTES]


def test_it_holds_every_plot_table_and_section(page):
    read = Page(page)
    for plot in PLOTS:
        assert f'id="{plot}"' in page
    assert {"Key figures", "Trains", "Feeding stations"} <= set(read.captions)
    for section in ("Audit", "Scenario as run", "Limits of validity"):
        assert section in read.text


def test_it_tells_the_key_figures(page, short):
    read = Page(page).text
    assert f"trip time [min] {short.summary['trip_time_min']:.2f}" in read
    assert f"total energy [MWh] {short.summary['total_energy_mwh']:.3f}" in read
    assert f"lowest voltage [kV] {short.summary['lowest_voltage']['voltage_kv']:.3f}" in read
    assert "✓ The audit passed" in read


def test_limits_of_the_audit_stand_beside_its_figures_in_the_same_unit(page):
    """1e-10 of 10 MVA, and an order above that for what the audit finds by another way."""
    assert "power mismatch [VA] 0.01 " in Page(page).text


def test_a_sound_run_has_no_banner(page):
    assert "banner" not in Page(page).order


def test_a_collapse_stands_above_everything(collapsed):
    read = Page(report(collapsed))
    assert read.order.index("banner") < read.order.index("header")
    assert "✗ The line cannot carry its load" in read.text
    assert collapsed.summary["problem"] in read.text
    assert collapsed.summary["advice"] in read.text


def test_a_failed_audit_stands_above_everything_and_no_figure_of_the_run_is_shown(mistrusted):
    text = report(mistrusted)
    read = Page(text)
    assert read.order.index("banner") < read.order.index("header")
    assert "The audit failed" in read.text
    assert "power_mismatch_va is 3, limit 0.01" in read.text
    assert f"{mistrusted.summary['total_energy_mwh']:.3f}" not in read.text
    assert "plot" not in read.order


def test_a_comparison_has_a_column_a_run_and_tells_which_ended_early(compared):
    read = Page(compared)
    assert "figure every 10 min every 5 min collapsed" in read.text
    assert "status finished finished collapsed" in read.text
    assert "✗ collapsed: The line cannot carry its load" in read.text
    assert "collapsed: nothing to draw" in read.text


def test_a_comparison_says_first_what_differs_and_by_how_much_figures_do(compared):
    read = Page(compared)
    assert read.text.index("What differs") < read.text.index("Key figures")
    assert "traffic.eastbound.headway_min 10 5" in read.text
    assert re.search(r"total energy \[MWh\] [\d.]+ [\d.]+ \(\+[\d.]+\)", read.text)
    assert re.search(r"peak loading of West \[%\] [\d.]+", read.text)
    assert re.search(r"place of lowest voltage \[km\] [\d.]+ [\d.]+ –", read.text)


def test_runs_of_one_scenario_differ_in_nothing(short):
    assert "say the same" in Page(comparison({"a": short, "b": short})).text


def test_names_of_a_scenario_are_text_and_never_code():
    evil = "</script><b>x"
    result = run({"description": evil, "traffic.0.name": evil, "simulation.duration_min": 2.0})
    text = report(result)
    assert evil not in text
    assert "<b>x" not in text


@pytest.mark.parametrize("duration_min", [0.5, 1.0])
def test_a_run_of_a_step_or_two_is_reported(duration_min):
    text = report(run({"simulation.duration_min": duration_min}))
    assert 'id="moment"' in text


def test_a_run_without_a_train_is_reported():
    changes = {"traffic.0.first_departure_min": 50.0, "simulation.duration_min": 5.0}
    read = Page(report(run(changes)))
    assert "Trains" in read.captions
    assert "journey" not in read.order


def stretched(result: tpss.Result, times: int, trains: int) -> tpss.Result:
    """A result with its steps and trains repeated: as much to draw as of a long run."""
    data = result.dataset
    steps = np.tile(np.arange(data.sizes["time"] - 1), times)
    many = data.isel(time=steps, train=np.tile(np.arange(data.sizes["train"]), trains))
    many = many.assign_coords(
        time=np.arange(len(steps)) * float(data.attrs["time_step_s"]),
        train=[f"eastbound {i}" for i in range(many.sizes["train"])],
    )
    return tpss.Result(result.scenario, many, result.summary)


def test_a_day_with_hundreds_of_trains_stays_small_and_says_what_it_leaves_out(short):
    long = stretched(short, times=120, trains=130)
    assert long.dataset.sizes["time"] > 4_000
    assert long.dataset.sizes["train"] > 300
    text = report(long)
    assert len(text.encode()) < LIMIT_BYTES
    read = Page(text).text
    assert "drawn from a part of the time steps" in read
    assert "shows the lowest voltage of" in read


def test_a_short_run_is_drawn_whole_and_says_nothing_of_leaving_out(page):
    assert len(page.encode()) < LIMIT_BYTES
    assert "a part of the time steps" not in Page(page).text


def test_a_run_without_a_train_is_compared_with_one_that_has_some(short):
    empty = run({"traffic.0.first_departure_min": 50.0, "simulation.duration_min": 5.0})
    assert 'id="journey"' in comparison({"empty": empty, "some": short})
    assert 'id="journey"' not in comparison({"empty": empty, "empty too": empty})
