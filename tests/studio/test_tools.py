"""Variants, outages, what-if and reports of the open scenario."""

import io

import openpyxl
import pytest

import tpss
from tpss.studio.respond import MOST_RUNS
from tpss.studio.variants import edits_of

from studio_page import TOKEN

HEADWAY = ["traffic.0.headway_min", 20.0]


@pytest.fixture
def ask(page):
    """Asks what takes longer, each time with a higher number."""

    def asked(name, *edits, **more):
        page.number += 1
        return page.ask(name, page="one", what=name, number=page.number, edits=list(edits), **more)

    return asked


def test_the_tray_has_the_file_and_what_was_edited(ask, file):
    before, after = ask("variants", HEADWAY)["rows"]
    assert (before["name"], before["changes"]) == ("the file", 0)
    assert (after["name"], after["changes"]) == ("edited", 1)
    expected = tpss.simulate(tpss.load_scenario(file, dict([HEADWAY]))).summary
    assert after["energy_mwh"] == expected["total_energy_mwh"]


def test_edits_become_a_variant_that_makes_them(ask, page):
    edits = [
        HEADWAY,
        ["supply.high_voltage_line.transformers_km.+", 18.0],
        ["line.stations.1.tracks", 2],
    ]
    variant = ask("keep-variant", *edits)["variant"]
    assert variant == {
        "set": {"traffic.0.headway_min": 20.0, "line.stations.1.tracks": 2},
        "add": {"supply.high_voltage_line.transformers_km": [18.0]},
    }
    desk = page.live.desk
    assert desk.document(edits_of(variant)) == desk.document(edits)


def test_a_kept_variant_is_a_row_of_its_own(ask):
    edits = [
        [
            "variants.dense",
            {"description": "more", "set": {"traffic": {"0": {"headway_min": 20.0}}}},
        ]
    ]
    rows = {row["name"]: row for row in ask("variants", *edits)["rows"]}
    dense = rows["dense"]
    assert dense["is_variant"] is True
    assert dense["edits"] == [HEADWAY]
    assert dense["energy_mwh"] > rows["the file"]["energy_mwh"]


def test_a_variant_with_faults_is_told(ask):
    edits = [["variants.odd", {"set": {"traffic.0.headway_min": 0.0}}]]
    assert "out of range" in ask("variants", *edits)["rows"][-1]["fault"]


def test_single_outages_are_ranked_and_can_be_shown(ask, page):
    found = ask("outages")
    names = [row[0] for row in found["rows"]]
    assert names[0] == "intact"
    assert {"West out", "East out", "transformer 6 km out"} <= set(names)
    edits = found["edits"][names.index("East out")]
    told = page.see(*edits)
    assert told["result"]["outage"] == "East out"
    out = {
        each["name"] for each in told["plan"]["places"] if each["out"] and each["kind"] == "feeding"
    }
    assert out == {"East"}


def test_a_response_curve_has_the_figures_of_single_runs(ask, file):
    values = [10.0, 20.0, 0.0]
    found = ask("respond", path=HEADWAY[0], values=values)
    energy = found["figures"]["energy"]
    assert energy["unit"] == "MWh"
    for value, mwh in zip(values[:2], energy["values"], strict=False):
        expected = tpss.simulate(tpss.load_scenario(file, {HEADWAY[0]: value}))
        assert mwh == pytest.approx(expected.summary["total_energy_mwh"], rel=1e-12)
    assert energy["values"][2] is None
    assert found["ended"][2] == "not a scenario"


def test_a_response_has_so_many_runs_at_most(ask):
    found = ask("respond", path=HEADWAY[0], values=[10.0] * (MOST_RUNS + 1))
    assert f"more than {MOST_RUNS} values" in found["refused"]


def test_the_fewest_units_keep_the_limits_and_one_fewer_does_not(ask):
    found = ask(
        "fewest", ["traffic.0.headway_min", 6.0], path="supply.converter_stations.*.converters",
        lowest_kv=12.0, loading_percent=40.0,
    )  # fmt: skip
    kept = {row[0]: row[2] for row in found["rows"]}
    assert kept[found["fewest"]] is True
    assert kept[found["fewest"] - 1] is False


def test_limits_that_no_number_keeps_are_told(ask):
    path = "supply.converter_stations.0.converters"
    assert ask("fewest", path=path, lowest_kv=20.0)["fewest"] is None


WORDS = {
    "title": "The line <b>tomorrow</b>",
    "project": "A project",
    "author": "An author",
    "remarks": "At first.\n\nAnd then.",
}


def test_a_report_begins_with_what_its_author_says(ask, page):
    told = ask("report", HEADWAY, kind="html", words=WORDS)
    answer = page.client.get(f"/{TOKEN}/{told['address']}")
    cover = answer.text[: answer.text.index('id="summary"')]
    assert "The line &lt;b&gt;tomorrow&lt;/b&gt;" in cover
    for words in ("A project", "An author", "At first.", "And then.", "Lowest voltage:", "<svg"):
        assert words in cover
    assert ">edited<" in cover
    assert "sandbox" in answer.headers["Content-Security-Policy"]


def test_a_workbook_has_the_scenario_as_edited(ask, page):
    told = ask("report", HEADWAY, kind="xlsx", words={})
    content = page.client.get(f"/{TOKEN}/{told['address']}").content
    assert told["name"] == "short-line.xlsx"
    sheet = openpyxl.load_workbook(io.BytesIO(content))["scenario"]
    rows = {row[0].value: row[1].value for row in sheet.iter_rows(min_row=1)}
    assert rows["traffic.0.headway_min"] == 20.0 or 20.0 in rows.values()


def test_a_file_that_is_no_longer_kept_is_told(page):
    answer = page.client.get(f"/{TOKEN}/files/7/report.html")
    assert answer.status_code == 404
    assert "make it again" in answer.text


def test_other_kinds_of_files_are_refused(ask):
    assert "kinds: html, xlsx" in ask("report", kind="exe", words={})["refused"]
