"""Tables in narrow terminals: whatever a wide one shows is there, every number whole.

Columns that do not fit follow in a second table, or texts are broken; run is in ``test_run.py``.
"""

import re
from unittest.mock import patch

import numpy as np
import pandas as pd
import pytest
import tomli_w

import tpss
from tpss.approximator import fit
from tpss.approximator.train import train_approximator
from tpss.cli.plan_tables import print_frame
from tpss.cli.sweep import _print_summary
from tpss.cli.terminal import Console
from tpss.sweep.summary import Summary

from conftest import EXAMPLES
from made_up_studies import SMALL, made_up_table, write_study
from scenarios import SHORT_LINE

NARROW = (60, 50)

NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*(?:\.\d+)?(?![\w.])")


def numbers(text: str) -> set[str]:
    """Numbers that stand by themselves."""
    return set(NUMBER.findall(text))


@pytest.fixture
def alike(tpss_command, monkeypatch):
    """Calls a command in a wide and in narrow terminals; they say the same numbers."""

    def call(*arguments: object) -> None:
        wide = tpss_command(*arguments)
        assert wide.code == 0
        for columns in NARROW:
            monkeypatch.setenv("COLUMNS", str(columns))
            narrow = tpss_command(*arguments)
            assert narrow.code == 0
            assert "…" not in narrow.out
            assert numbers(wide.out) <= numbers(narrow.out)

    return call


@pytest.mark.parametrize(
    "arguments",
    [
        ("library",),
        ("library", "converters", "static 15 MVA with losses (estimate)"),
        ("check", EXAMPLES / "network.toml"),
        ("line-constants", EXAMPLES / "geometry_2x25kv_double.toml"),
        ("spare-time", EXAMPLES / "emu_25kv.toml"),
        ("converters", EXAMPLES / "line_320km_losses.toml", "--set", "simulation.duration_min=5"),
    ],
    ids=lambda arguments: " ".join(map(str, arguments[:1])),
)
def test_commands_that_print_tables(alike, arguments):
    alike(*arguments)


def test_outages_of_a_line(alike, tmp_path):
    outages = [{"name": "no East at all, for the whole of the evening", "stations": ["East"]}]
    document = {**SHORT_LINE, "outages": outages}
    document["simulation"] = {**SHORT_LINE["simulation"], "duration_min": 2.0}
    (tmp_path / "line.toml").write_text(tomli_w.dumps(document), encoding="utf-8")
    alike("outages", "line.toml", "--out", "table.csv", "--force")


def test_a_comparison_with_measurements(alike, tpss_command, short_file, tmp_path):
    short = ("--set", "simulation.duration_min=3")
    assert tpss_command("run", short_file, *short, "--out", "demo", "--quiet").code == 0
    data = tpss.load_result(tmp_path / "demo").dataset
    mw = data.station_active_power.sel(station="West").to_numpy()[:-1] / 1e6
    measured = {
        "time [min]": np.arange(len(mw)) * 0.05,
        "station_active_power:West [MW]": mw + 1234.5,
    }
    pd.DataFrame(measured).to_csv(tmp_path / "measured.csv", index=False)
    alike("compare", "demo", "measured.csv")


def test_an_approximator(alike, tmp_path):
    write_study(tmp_path / "study", made_up_table(400))
    with patch.dict(fit.NEURONS, SMALL):
        train_approximator(tmp_path / "study").save(tmp_path / "model.json")
    alike("approximate", "check", "model.json")


def in_both(print_it, capsys, monkeypatch) -> None:
    """What is printed says the same numbers in a wide and in narrow terminals."""
    said = {}
    for columns in (200, *NARROW):
        monkeypatch.setenv("COLUMNS", str(columns))
        print_it(Console())
        said[columns] = capsys.readouterr().out
        assert "…" not in said[columns]
        assert numbers(said[columns]) == numbers(said[200])


def test_the_spread_of_a_study(capsys, monkeypatch, tmp_path):
    labels = ("trip time [min]", "lowest voltage [kV]", "peak loading [%]", "energy [MWh]")
    spread = pd.DataFrame({end: dict.fromkeys(labels, 1234.0) for end in ("lowest", "highest")})
    summary = Summary(2, {"finished": 2}, spread.T, 0, {}, 1.0)
    in_both(lambda _: _print_summary(summary, tmp_path, ""), capsys, monkeypatch)


def test_the_decisions_of_a_plan(capsys, monkeypatch):
    frame = pd.DataFrame(
        {
            "ordered": [2031, 2044],
            "if": ["traffic grows as was foreseen, or by more", "traffic falls"],
            "spent": [1_234_567.8, 7_654_321.9],
            "a year": [123_456.7, 765_432.1],
            "builds": [
                "a station at a place with a long name",
                "an autotransformer at Averylongname",
            ],
            "more": [12_345.6, 65_432.1],
        }
    )
    columns = {name: name for name in frame}
    in_both(lambda to: print_frame(frame, "Decisions", columns, to), capsys, monkeypatch)
