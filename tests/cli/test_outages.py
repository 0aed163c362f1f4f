"""``tpss outages`` and ``tpss run --outage``."""

import copy

import pandas as pd
import pytest
import tomli_w

import tpss

from scenarios import SHORT_LINE

OUTAGES = [
    {"name": "no East", "stations": ["East"]},
    {"name": "West weak 1-3", "units": {"West": 1}, "from_min": 1.0, "to_min": 3.0},
]


@pytest.fixture
def file(tmp_path):
    document = {**copy.deepcopy(SHORT_LINE), "outages": OUTAGES}
    document["simulation"]["duration_min"] = 5.0
    path = tmp_path / "line.toml"
    path.write_text(tomli_w.dumps(document))
    return path


def test_a_run_with_an_outage_is_saved_under_both_names(tpss_command, file, tmp_path):
    said = tpss_command("run", file, "--outage", "no East")
    assert said.code == 0
    assert "outage no East: East out" in said.out
    result = tpss.load_result(tmp_path / "results" / "short-line-no-East-001")
    assert result.scenario.outage.name == "no East"


def test_an_outage_that_there_is_not_is_told(tpss_command, file):
    said = tpss_command("run", file, "--outage", "no Est")
    assert said.code == 2
    assert "did you mean no East?" in said.err


def test_check_lists_outages_and_their_faults(tpss_command, file):
    assert (
        "West weak 1-3: 1 of West's units out, from 1 min to 3 min"
        in tpss_command("check", file).out
    )
    said = tpss_command("check", file, "--set", "outages.0.stations=['Est']")
    assert said.code == 2
    assert "did you mean East?" in said.err


def test_named_outages_alone_are_run_without_n_1(tpss_command, file, tmp_path):
    said = tpss_command("outages", file)
    assert said.code == 0
    table = pd.read_csv(tmp_path / "results" / "short-line-outages-001.csv")
    assert set(table.outage) == {"intact", *(each["name"] for each in OUTAGES)}
    assert "Saved in results/short-line-outages-001.csv" in said.out


def test_n_1_is_one_ranked_table(tpss_command, file, tmp_path):
    said = tpss_command("outages", file, "--n-1", "--jobs", "2", "--out", tmp_path / "n1.csv")
    assert said.code == 0
    table = pd.read_csv(tmp_path / "n1.csv")
    assert table.outage[0] == "intact"
    assert set(table.outage[1:]) == {
        "no East", "West weak 1-3", "West out", "West, one unit out", "East, one unit out",
    }  # fmt: skip
    assert table.useful_voltage_kv[1:].is_monotonic_increasing
    assert all(name in said.out for name in table.outage)


def test_a_file_that_exists_is_not_replaced_unless_forced(tpss_command, file, tmp_path):
    place = tmp_path / "n1.csv"
    place.write_text("mine")
    said = tpss_command("outages", file, "--out", place)
    assert said.code == 2
    assert "--force" in said.err
    assert place.read_text() == "mine"
    assert tpss_command("outages", file, "--out", place, "--force", "--quiet").code == 0
    assert place.read_text().startswith("outage,")


def test_a_report_stands_beside_its_table(tpss_command, file, tmp_path):
    said = tpss_command("outages", file, "--report")
    assert said.code == 0
    place = tmp_path / "results" / "short-line-outages-001.html"
    assert "Wrote results/short-line-outages-001.html" in said.out
    assert "no East" in place.read_text(encoding="utf-8")
    own = tmp_path / "mine" / "n1.csv"
    assert tpss_command("outages", file, "--report", "--out", own, "--quiet").code == 0
    assert own.with_suffix(".html").exists()


def test_a_report_that_exists_is_not_replaced_unless_forced(tpss_command, file, tmp_path):
    report = tmp_path / "n1.html"
    report.write_text("mine")
    said = tpss_command("outages", file, "--report", "--out", tmp_path / "n1.csv")
    assert said.code == 2
    assert "n1.html" in said.err
    assert not (tmp_path / "n1.csv").exists()
    said = tpss_command("outages", file, "--report", "--out", tmp_path / "n2.html")
    assert said.code == 2
    assert "give --out a name that ends in .csv" in said.err


def test_tables_are_numbered(tpss_command, file, tmp_path):
    for _ in range(2):
        tpss_command("outages", file, "--quiet")
    names = sorted(each.name for each in (tmp_path / "results").iterdir())
    assert names == ["short-line-outages-001.csv", "short-line-outages-002.csv"]


def test_a_scenario_without_outages_is_told_what_to_do(tpss_command, short_file):
    said = tpss_command("outages", short_file)
    assert said.code == 2
    assert "--n-1" in said.err


def test_an_interrupted_table_holds_the_runs_that_were_done(file, tmp_path, monkeypatch):
    """After the second row a Ctrl-C has come: the rest is left out, the table is saved."""
    from tpss.scenario import load_scenario

    interrupted: list[int] = []
    found = tpss.compare_outages(
        load_scenario(file), every=True, threads=1, interrupted=interrupted,
        report=lambda done, _: interrupted.append(2) if done == 2 else None,
    )  # fmt: skip
    assert 2 <= len(found.rows) < found.cases
    assert found.rows[0].outage == "intact"
