"""The command `tpss spare-time`."""

import pandas as pd
import pytest

from conftest import EXAMPLES

EMU = str(EXAMPLES / "emu_25kv.toml")


def test_it_prints_what_each_manner_saves_and_writes_table_and_picture(tpss_command, tmp_path):
    """Both together never save less than either; more time saves more."""
    table, picture = tmp_path / "saved.csv", tmp_path / "saved.svg"
    files = ("--out", str(table), "--plot", str(picture))
    said = tpss_command("spare-time", EMU, "--percent", "2", "--percent", "10", *files)
    assert said.code == 0
    assert "regional (emu)" in said.out
    assert "held-speed" in said.out
    assert picture.read_text("utf-8").startswith("<?xml")
    saved = pd.read_csv(table).pivot(
        index="spare_percent", columns="manner", values="saved_percent"
    )
    assert list(saved.index) == [2.0, 10.0]
    assert (saved.diff().iloc[1] > 0.0).all()
    best = saved["least-energy"] + 1e-6
    assert (best >= saved["held-speed"]).all()
    assert (best >= saved["coasting"]).all()


def test_existing_files_need_force_and_pictures_a_known_kind(tpss_command, tmp_path):
    table = tmp_path / "saved.csv"
    table.write_text("mine")
    said = tpss_command("spare-time", EMU, "--percent", "2", "--out", str(table))
    assert said.code == 2
    assert "--force" in said.err
    assert table.read_text() == "mine"
    said = tpss_command("spare-time", EMU, "--plot", str(tmp_path / "saved.odd"))
    assert said.code == 2
    assert "ends in .png, .svg, .pdf" in said.err


def test_trains_that_do_not_reach_their_destination_have_nothing_to_save(tpss_command):
    """On 100 per mille nothing starts."""
    steep = "line.gradients=[{ from_km = 0.0, permille = 100.0 }]"
    said = tpss_command("spare-time", EMU, "--set", steep)
    assert said.code == 2
    assert "no train reaches its destination" in said.err


@pytest.mark.parametrize("percent", ["-1", "300"])
def test_times_beyond_the_range_are_refused(tpss_command, percent):
    assert tpss_command("spare-time", EMU, "--percent", percent).code == 2
