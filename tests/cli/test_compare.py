"""The command ``tpss compare``: a result beside measured series, printed and written."""

import numpy as np
import pandas as pd
import pytest

import tpss
from tpss.results.contents import REPORT_MARK

from pages import Page

WEST = "station_active_power:West"


@pytest.fixture
def demo(tpss_command, short_file, tmp_path):
    """A saved result of three minutes, and a file by a clock that is ahead of its own by 12 s."""
    short = ("--set", "simulation.duration_min=3", "--set", 'simulation.starts_at="06:00"')
    assert tpss_command("run", short_file, *short, "--out", "demo", "--quiet").code == 0
    data = tpss.load_result(tmp_path / "demo").dataset
    mw = data.station_active_power.sel(station="West").to_numpy()[:-1] / 1e6
    times = np.arange(len(mw)) * 3 + 12
    clock = [f"06:{at // 60:02d}:{at % 60:02d}" for at in times.tolist()]
    table = pd.DataFrame({"clock": clock, f"{WEST} [MW]": mw})
    table.to_csv(tmp_path / "measured.csv", index=False)
    return tmp_path / "demo"


def test_figures_windows_and_the_offset_are_printed(tpss_command, demo):
    said = tpss_command("compare", "demo", "measured.csv", "--find-offset", "0.5")
    assert (said.code, said.err) == (0, "")
    assert "measured.csv, whose time is 06:00:12 at minute 0 of the run" in said.out
    assert "Offset found: the clock of the file is 12.00 s ahead of the run's" in said.out
    assert f"{WEST} MW" in said.out
    assert "Worst means over windows" in said.out
    assert not (demo / "report.html").exists()


def test_no_offset_is_looked_for_unless_asked(tpss_command, demo):
    said = tpss_command("compare", "demo", "measured.csv")
    assert "Offset" not in said.out
    assert "whose time is 06:00:00 at minute 0 of the run" in said.out


def test_tables_figures_and_a_report_are_written_all_or_none(tpss_command, demo, tmp_path):
    call = ("compare", "demo", "measured.csv", "--find-offset", "0.5", "--out", "out", "--report")
    said = tpss_command(*call)
    assert said.code == 0, said.err
    names = {
        "aligned.csv", "figures.csv", "windows.csv", "durations.csv", "comparison.json", "report.html",
        "1-station_active_power-West-over-time.png", "1-station_active_power-West-duration.png",
    }  # fmt: skip
    assert {file.name for file in (tmp_path / "out").iterdir()} == names
    aligned = pd.read_csv(tmp_path / "out" / "aligned.csv")
    np.testing.assert_allclose(
        aligned[f"{WEST} measured [MW]"], aligned[f"{WEST} simulated [MW]"], rtol=1e-9
    )
    (tmp_path / "out" / "figures.csv").write_text("mine")
    (tmp_path / "out" / "aligned.csv").unlink()
    again = tpss_command(*call)
    assert (again.code, again.out) == (2, "")
    assert "exists already" in again.err
    assert not (tmp_path / "out" / "aligned.csv").exists()
    assert tpss_command(*call, "--force").code == 0


def test_a_report_alone_goes_into_the_result_folder(tpss_command, demo):
    said = tpss_command("compare", "demo", "measured.csv", "--report")
    assert said.out.endswith("Wrote demo/report.html")
    page = (demo / "report.html").read_text("utf-8")
    assert REPORT_MARK in page
    assert "Compared with measurements" in Page(page).text
    again = tpss_command("compare", "demo", "measured.csv", "--report")
    assert (again.code, "--force" in again.err) == (2, True)


def test_two_results_are_compared_by_another_command(tpss_command, demo):
    said = tpss_command("compare", "demo", "demo")
    assert (said.code, said.out) == (2, "")
    assert "tpss report demo demo compares results with each other" in said.err


def test_faults_of_the_file_are_told_without_a_traceback(tpss_command, demo, tmp_path):
    (tmp_path / "bad.csv").write_text("clock,current [A]\n06:00,1\n06:01,2\n")
    said = tpss_command("compare", "demo", "bad.csv")
    assert (said.code, said.out) == (2, "")
    assert "bad.csv: column 'current [A]'" in said.err
    assert "the column maps to nothing of the run" in said.err
    assert tpss_command("compare", "demo", "no.csv").code == 2


def test_columns_are_explained_by_a_file(tpss_command, demo, tmp_path):
    text = (tmp_path / "measured.csv").read_text().replace(f"{WEST} [MW]", "P1")
    (tmp_path / "p.csv").write_text(text)
    (tmp_path / "map.toml").write_text(
        '[columns.P1]\nquantity = "station_active_power"\nelement = "West"\nunit = "MW"\n'
    )
    assert tpss_command("compare", "demo", "p.csv", "--map", "map.toml").code == 0
