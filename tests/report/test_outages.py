"""What the report of a table of outages holds, without a browser."""

from dataclasses import replace

import pytest

import tpss
from tpss.outages.report import outages_report
from tpss.outages.row import Row, Verdict
from tpss.results.contents import HEAD_BYTES, REPORT_MARK

from pages import Page


def test_the_page_loads_nothing_and_says_what_it_is(table_page):
    assert [each for each in Page(table_page).loaded if not each.startswith("#")] == []
    assert REPORT_MARK in table_page[:HEAD_BYTES]
    assert "default-src 'none'" in table_page


def test_it_counts_the_outages_by_their_verdicts(table_page, found):
    text = Page(table_page).text
    for verdict in {row.verdict for row in found.rows[1:]}:
        names = [row.outage for row in found.rows[1:] if row.verdict == verdict]
        assert f"{len(names)} of 3 outages, {verdict.words}: {'; '.join(names)}." in text
    assert "Intact supply: limits kept." in text


def test_it_ranks_as_the_table_does_with_figures_and_differences(table_page, found):
    text = Page(table_page).text
    places = [text.index(f"{row.outage} {row.verdict_in_words}") for row in found.rows]
    assert places == sorted(places)
    intact, out = found.intact, next(row for row in found.rows if row.outage == "no East")
    lowest = out.figures["lowest_voltage_kv"]
    change = lowest - intact.figures["lowest_voltage_kv"]
    assert f"{lowest:.3f} ({change:+.3f})" in text
    assert "contact line 9-11 km out" in text
    assert "West out, East out, from 6 min to 12 min" in text


def test_names_are_text(table_page):
    assert "all &lt;b&gt;" in table_page
    assert "all <b>" not in table_page.replace("\\u003c", "")


def test_a_case_that_was_not_run_and_one_that_failed_its_audit_have_no_figures(found):
    """A verdict alone: nobody reads a number that is not to be trusted."""
    wrong = replace(found.rows[1], outage="wrong", verdict=Verdict.AUDIT_FAILED)
    unfed = Row("unfed", "all out", Verdict.NOT_FED, 0.0, lost=found.rows[1].lost)
    spoilt = replace(found, rows=(found.rows[0], wrong, unfed), cases=5)
    page = Page(outages_report(spoilt))
    assert "The audit failed: figures of wrong cannot be trusted" in page.text
    assert "wrong audit failed – – –" in page.text
    assert "unfed not fed, not run – – –" in page.text
    assert "Interrupted after 3 of 5 runs" in page.text


def test_a_report_is_not_replaced_unless_forced(found, tmp_path):
    place = found.write_report(tmp_path / "deep" / "table.html")
    assert REPORT_MARK in place.read_text(encoding="utf-8")[:HEAD_BYTES]
    with pytest.raises(tpss.ResultError, match="--force"):
        found.write_report(place)
    found.write_report(place, force=True)
