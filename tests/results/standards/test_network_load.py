"""Losses by kind of branch, and RMS currents.

Steps of 30 min. A transformer of 0.1 Ω carries 1000 and 2000 A: 100 and 400 kW, 250 kWh. A
high-voltage line of 2 Ω carries 100 A: 20 kW, 20 kWh. All losses are 200 and 600 kW, 400 kWh, so 130 kWh
arise in the contact line.

RMS over 60 min of 1000 and 2000 A: √((1 + 4) / 2) · 1000 A = 1581.1 A.
"""

import pytest

from tpss.results.standards.network_load import current_table, losses_table

from made_up import made_up, nan

DATASET = made_up(
    step_min=30.0,
    losses_kw=[200.0, 600.0],
    current_a={"transformer": [1000.0, 2000.0], "hv": [100.0, 100.0], "start": [300.0, 0.0]},
    branches={
        "transformer": ("transformer", 0.1),
        "hv": ("high-voltage line", 2.0),
        "start": ("contact line", nan),
    },
)


def test_losses_are_split_by_where_they_arise():
    losses = losses_table(DATASET).set_index("branch_kind")
    assert losses.energy_mwh.to_dict() == pytest.approx(
        {"contact line": 0.13, "transformer": 0.25, "high-voltage line": 0.02}
    )
    assert losses.share.sum() == pytest.approx(1.0)
    assert losses.share["transformer"] == pytest.approx(0.625)


def test_currents_are_root_mean_squares_over_windows():
    table = current_table(DATASET, (60.0, 90.0))
    transformer = table[table.branch == "transformer"].set_index("window_min")
    assert transformer.highest_rms_a[[30.0, 60.0]].tolist() == pytest.approx([2000.0, 1581.1388])
    assert transformer.highest_rms_a.isna().tolist() == [False, False, True]
    assert table.branch_kind.tolist()[::3] == ["transformer", "high-voltage line", "contact line"]
