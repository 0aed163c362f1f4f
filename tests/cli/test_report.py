"""The command ``tpss report``, and ``tpss run --report``: where reports go, and what is refused."""

from pathlib import Path

import pytest

from tpss.cli.labels import labels
from tpss.results.contents import HEAD_BYTES, REPORT_MARK

from conftest import EXAMPLES
from pages import Page

HEADWAY = EXAMPLES / "at_headway_3.toml"
SHORT = ("--set", "simulation.duration_min=3", "--quiet")


@pytest.fixture
def folder(tpss_command, tmp_path) -> Path:
    """A result folder named `a`."""
    assert tpss_command("run", HEADWAY, *SHORT, "--out", "a").code == 0
    return tmp_path / "a"


def is_report(file: Path) -> bool:
    return REPORT_MARK.encode() in file.read_bytes()[:HEAD_BYTES]


def test_a_report_goes_into_the_result_folder(tpss_command, folder):
    said = tpss_command("report", "a")
    assert (said.code, said.out, said.err) == (0, "Wrote a/report.html", "")
    assert is_report(folder / "report.html")


def test_a_report_may_begin_with_the_words_of_its_author(tpss_command, folder):
    words = {"title": "Line 90", "project": "Renewal 2030", "author": "A. Lind", "remarks": "Draft"}
    options = [part for name, text in words.items() for part in (f"--{name}", text)]
    assert tpss_command("report", folder, *options, "--force").code == 0
    page = (folder / "report.html").read_text("utf-8")
    assert all(text in page.split('id="summary"')[0] for text in words.values())


def test_a_comparison_has_no_first_page(tpss_command, folder):
    said = tpss_command("report", folder, folder, "--author", "A. Lind")
    assert (said.code, said.err) == (2, "a comparison has no use for --author; leave it out")


def test_out_names_another_file(tpss_command, folder, tmp_path):
    assert tpss_command("report", "a", "--out", "b.html").out == "Wrote b.html"
    assert is_report(tmp_path / "b.html")
    assert not (folder / "report.html").exists()


def test_a_run_writes_its_report_too(tpss_command, tmp_path):
    said = tpss_command("run", HEADWAY, *SHORT[:2], "--out", "b", "--report")
    assert said.code == 0
    assert "Wrote b/report.html" in said.out
    assert is_report(tmp_path / "b" / "report.html")


def test_a_quiet_run_writes_its_report_in_silence(tpss_command, tmp_path):
    said = tpss_command("run", HEADWAY, *SHORT, "--out", "b", "--report")
    assert (said.code, said.out, said.err) == (0, "", "")
    assert is_report(tmp_path / "b" / "report.html")


def test_a_run_that_collapses_has_a_report_and_keeps_its_exit_code(tpss_command, tmp_path):
    overloaded = EXAMPLES / "overloaded.toml"
    assert tpss_command("run", overloaded, "--quiet", "--out", "b", "--report").code == 3
    page = Page((tmp_path / "b" / "report.html").read_text("utf-8"))
    assert page.order.index("banner") < page.order.index("header")


def test_a_report_that_is_there_is_kept_unless_forced(tpss_command, folder):
    tpss_command("report", "a")
    file = folder / "report.html"
    file.write_bytes(file.read_bytes()[:HEAD_BYTES])
    said = tpss_command("report", "a")
    assert said.code == 2
    assert "a/report.html exists already" in said.err
    assert file.stat().st_size == HEAD_BYTES
    assert tpss_command("report", "a", "--force").code == 0
    assert file.stat().st_size > HEAD_BYTES


@pytest.mark.parametrize("out", ["a/result.nc", "a", "thesis.html"])
def test_force_replaces_nothing_but_reports(tpss_command, folder, tmp_path, out):
    (tmp_path / "thesis.html").write_text("<p>Years of work.</p>")
    said = tpss_command("report", "a", "--out", out, "--force")
    assert said.code == 2
    assert f"{out} is not a report" in said.err
    assert (tmp_path / "thesis.html").read_text() == "<p>Years of work.</p>"


def test_a_file_in_a_folder_that_does_not_exist_is_refused(tpss_command, folder):
    said = tpss_command("report", "a", "--out", "nowhere/b.html")
    assert said.code == 2
    assert "nowhere/b.html cannot be written: No such file or directory" in said.err


@pytest.mark.parametrize("name", ["nowhere", "empty"])
def test_a_folder_without_a_result_is_refused(tpss_command, tmp_path, name):
    (tmp_path / "empty").mkdir()
    said = tpss_command("report", name)
    assert said.code == 2
    assert f"{name} is not a result folder" in said.err


def test_a_damaged_result_is_refused_and_nothing_is_written(tpss_command, folder):
    (folder / "result.nc").write_bytes(b"rust")
    said = tpss_command("report", "a")
    assert said.code == 2
    assert "a is damaged" in said.err
    assert not (folder / "report.html").exists()


def test_several_results_are_compared_in_one_file_here(tpss_command, folder, tmp_path):
    tpss_command("run", HEADWAY, *SHORT, "--set", "traffic.0.headway_min=6", "--out", "b")
    said = tpss_command("report", "a", "b")
    assert (said.code, said.out) == (0, "Wrote comparison.html")
    page = Page((tmp_path / "comparison.html").read_text("utf-8"))
    assert "figure a b" in page.text


def test_a_result_beside_itself_is_told_apart(tpss_command, folder):
    assert tpss_command("report", "a", "a").code == 0


def test_compared_results_have_the_labels_that_they_are_given(tpss_command, folder, tmp_path):
    said = tpss_command("report", "a", "a", "--label", "before", "--label", "after")
    assert said.code == 0
    page = Page((tmp_path / "comparison.html").read_text("utf-8"))
    assert "figure before after" in page.text


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (("a", "--label", "x"), "leave --label out for a single one"),
        (("a", "a", "--label", "x"), "1 labels for 2 results; give --label once for each"),
        (("a", "a", "--label", "x", "--label", "x"), "two results have the label 'x'; give each"),
        (("a", "--from", "West"), "--from and --to belong together"),
        (("a", "--from", "West", "--to", "East", "--corridor", "West,East"), "leave one of them"),
        (("a", "--corridor", "West"), "West is one station; give those at both ends"),
        (("a", "--from", "West", "--to", "Est"), "there is no station 'Est'; did you mean East"),
    ],
    ids=["label of one", "too few", "twice", "one end", "both", "one station", "nowhere"],
)
def test_what_does_not_fit_the_results_is_refused(tpss_command, folder, tmp_path, asked, words):
    said = tpss_command("report", *asked, "--out", "b.html")
    assert said.code == 2
    assert words in said.err
    assert not (tmp_path / "b.html").exists()


def test_a_report_of_a_stretch_says_which(tpss_command, folder):
    assert tpss_command("report", "a", "--from", "East", "--to", "West").code == 0
    page = Page((folder / "report.html").read_text("utf-8"))
    assert "Time-distance graph: West – East" in page.text


class Named:
    """As much of a result as a label needs."""

    def __init__(self, name: str) -> None:
        self.scenario = self
        self.name = name


@pytest.mark.parametrize(
    ("folders", "names", "expected"),
    [
        (["x/1", "x/2"], ["bt", "at"], ["bt", "at"]),
        (["x/1", "x/2"], ["bt", "bt"], ["1", "2"]),
        (["x/1", "y/1"], ["bt", "bt"], ["x/1", "y/1"]),
        (["x/1", "x/1"], ["bt", "bt"], ["1: x/1", "2: x/1"]),
    ],
)
def test_results_are_named_by_scenario_or_folder_whatever_tells_them_apart(
    folders, names, expected
):
    assert labels([Path(each) for each in folders], [Named(each) for each in names]) == expected
