"""Energy of trains, consumed and regenerated apart, in blocks of five minutes.

A train of 500 t goes 10 km in five steps of 2 min: 6, 6, -3, 0, 3 MW and 3, 0, 0, -3, 0 Mvar.

    consumed       (6 + 6 + 3) MW · 2/60 h = 0.5 MWh       regenerated  3 · 2/60 = 0.1 MWh
    reactive       3 · 2/60 = 0.1 Mvarh                    ... and as much back
    a kilometre    400 kWh / 10 km = 40 kWh/km; over 500 t, 80 Wh/t km

    0 to 5 min     two steps and half of the third: consumed 0.4, regenerated 0.05 MWh
    5 to 10 min    the rest: consumed 0.1, regenerated 0.05 MWh
"""

import numpy as np
import pytest

from tpss.results.standards.energy import energy_blocks, energy_table

from made_up import made_up, nan

DATASET = made_up(
    step_min=2.0,
    voltage_kv={"a": [15.0] * 5, "late": [nan, nan, nan, 15.0, nan]},
    power_mw={"a": [6.0, 6.0, -3.0, 0.0, 3.0], "late": [nan, nan, nan, 3.0, nan]},
    reactive_mvar={"a": [3.0, 0.0, 0.0, -3.0, 0.0], "late": [nan, nan, nan, 0.0, nan]},
    position_km={
        "a": [0.0, 2.0, 4.0, 6.0, 8.0, 10.0],
        "late": [nan, nan, nan, 0.0, 0.0, nan],
    },
)
ENERGIES = [
    "consumed_mwh",
    "regenerated_mwh",
    "reactive_consumed_mvarh",
    "reactive_regenerated_mvarh",
]


def test_energies_go_each_direction_apart():
    row = energy_table(DATASET, np.array([500.0, 500.0])).set_index("train").loc["a"]
    assert row[ENERGIES].tolist() == pytest.approx([0.5, 0.1, 0.1, 0.1])


def test_energy_is_told_a_train_kilometre_and_a_gross_tonne_kilometre():
    row = energy_table(DATASET, np.array([500.0, 500.0])).set_index("train").loc["a"]
    assert row.distance_km == 10.0
    assert row.energy_kwh_per_km == pytest.approx(40.0)
    assert row.energy_wh_per_t_km == pytest.approx(80.0)


def test_a_train_that_stands_has_no_energy_a_kilometre():
    row = energy_table(DATASET, np.array([500.0, 500.0])).set_index("train").loc["late"]
    assert row.consumed_mwh == pytest.approx(0.1)
    assert np.isnan(row.energy_kwh_per_km)


def test_a_step_over_the_end_of_a_block_is_shared_out():
    blocks = energy_blocks(DATASET)
    own = blocks[blocks.train == "a"]
    assert own[["from_min", "to_min"]].to_numpy().tolist() == [[0.0, 5.0], [5.0, 10.0]]
    assert own.consumed_mwh.tolist() == pytest.approx([0.4, 0.1])
    assert own.regenerated_mwh.tolist() == pytest.approx([0.05, 0.05])


def test_a_train_has_blocks_while_it_is_on_the_line():
    blocks = energy_blocks(DATASET)
    assert blocks[blocks.train == "late"].from_min.tolist() == [5.0]


def test_the_last_block_ends_with_the_run():
    blocks = energy_blocks(DATASET, block_min=8.0)
    assert blocks[blocks.train == "a"].to_min.tolist() == [8.0, 10.0]


def test_blocks_sum_up_to_the_energy_of_the_run():
    total = energy_table(DATASET, np.array([500.0, 500.0]))[ENERGIES].sum()
    assert energy_blocks(DATASET, 3.0)[ENERGIES].sum().tolist() == pytest.approx(total.tolist())
