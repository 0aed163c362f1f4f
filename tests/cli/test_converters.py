"""`tpss converters`: two runs, a table, a figure, and what is refused."""

import pandas as pd
import pytest

ROTARY = "supply.converter_stations.*.type=Q48/Q49 with losses (estimate)"
SHORT = ("--set", "simulation.duration_min=10", "--set", "supply.converter_stations.*.converters=3")


@pytest.fixture
def said(tpss_command, short_file):
    return tpss_command(
        "converters",
        short_file,
        *SHORT,
        "--set",
        ROTARY,
        "--out",
        "saved.csv",
        "--plot",
        "saved.svg",
    )


def test_the_tables_are_printed_and_saved(said, tmp_path):
    assert (said.code, said.err) == (0, "")
    for words in ("Losses of converter stations", "losses by estimate", "One converter less loses"):
        assert words in said.out
    table = pd.read_csv(tmp_path / "saved.csv")
    assert (table.saved_mwh - (table.all_on_mwh - table.by_loading_mwh)).abs().max() < 1e-9
    assert (tmp_path / "saved.svg").read_text().startswith("<?xml")


def test_an_existing_file_is_refused_before_anything_runs(tpss_command, short_file, tmp_path):
    (tmp_path / "mine.csv").write_text("mine")
    said = tpss_command("converters", short_file, *SHORT, "--set", ROTARY, "--out", "mine.csv")
    assert said.code == 2
    assert "mine.csv" in said.err
    assert (tmp_path / "mine.csv").read_text() == "mine"


def test_types_without_losses_are_refused(tpss_command, short_file):
    said = tpss_command("converters", short_file, *SHORT)
    assert said.code == 2
    assert "supply.converter_stations" in said.err
    assert "idle_kw" in said.err


def test_runs_that_do_not_finish_are_not_compared(tpss_command, short_file, tmp_path):
    heavy = ("--set", "traffic.0.headway_min=0.2", "--set", "simulation.duration_min=60")
    said = tpss_command("converters", short_file, "--set", ROTARY, *heavy, "--out", "a.csv")
    assert said.code == 3
    assert 'control = "all-on":' in said.err
    assert not (tmp_path / "a.csv").exists()
