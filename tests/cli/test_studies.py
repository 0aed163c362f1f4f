"""``tpss report``, ``plot``, ``export`` and ``sweep --case`` of a study's folder."""

import openpyxl
import pandas as pd
import pytest

import tpss
from sweep.studies import study, study_with_stalls


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return study_with_stalls(tmp_path_factory.mktemp("study"))


def test_any_case_is_written_as_the_scenario_that_ran(folder, tpss_command, tmp_path):
    table = tpss.load_table(folder)
    said = tpss_command("sweep", folder, "--case", 5, "--out", tmp_path / "five.toml")
    assert said.code == 0
    assert "case 5" in said.out
    assert tpss.load_scenario(tmp_path / "five.toml").digest() == table.scenario_hash[5]
    again = tpss_command("sweep", folder, "--case", 5, "--out", tmp_path / "five.toml")
    assert again.code == 2
    assert "--force" in again.err
    of_file = tpss_command("sweep", folder.parent / "study.toml", "--case", 0)
    assert of_file.code == 0
    assert "Wrote small-0.toml" in of_file.out


def test_a_case_that_there_is_not_is_told(folder, tpss_command):
    said = tpss_command("sweep", folder, "--case", 9)
    assert said.code == 2
    assert "small has no case 9; give a number from 0 to 8" in said.err


def test_report_plot_and_export_know_a_study(folder, tpss_command, tmp_path):
    said = tpss_command("report", folder, "--out", tmp_path / "study.html")
    assert said.code == 0
    assert "Study of 9 cases" in (tmp_path / "study.html").read_text("utf-8")
    plotted = tpss_command("plot", folder, "--out", tmp_path / "figures")
    assert plotted.code == 0
    assert {file.name for file in (tmp_path / "figures").iterdir()} == {
        "parallel.png",
        "trade-offs.png",
    }
    one = tpss_command("plot", folder, "--figure", "parallel", "--out", tmp_path / "one.svg")
    assert one.code == 0
    assert (tmp_path / "one.svg").read_bytes().startswith(b"<?xml")
    exported = tpss_command("export", folder, "--out", tmp_path / "tables")
    assert exported.code == 0
    cases = pd.read_csv(tmp_path / "tables" / "cases.csv")
    assert len(cases) == 9
    assert "total energy [MWh]" in cases
    tpss_command("export", folder, "--to", "xlsx", "--out", tmp_path / "tables")
    book = openpyxl.load_workbook(tmp_path / "tables" / "study.xlsx")
    assert book["cases"].max_row == 10


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (("plot", "--figure", "journey"), "there is no such figure of a study"),
        (("plot", "--train", "east 1"), "a study has no use for --train"),
        (("report", "--label", "a"), "a study has no use for --label"),
    ],
)
def test_what_a_study_does_not_have_is_told(folder, tpss_command, command, words):
    name, *options = command
    said = tpss_command(name, folder, *options)
    assert said.code == 2
    assert words in said.err


def test_a_study_without_cases_is_told(tpss_command, tmp_path):
    small = study(tmp_path, {"vary": {"traffic.0.headway_min": [5.0]}})
    tpss.run_study(small, tmp_path / "out", workers=1)
    for file in (tmp_path / "out" / "cases").iterdir():
        file.unlink()
    said = tpss_command("report", tmp_path / "out")
    assert said.code == 2
    assert "has no cases yet" in said.err
