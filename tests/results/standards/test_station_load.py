"""What converter stations carry.

Steps of 1 min, active power of West 2, 8, 6, 4 MW, two converters at first and three from then on.

    peak 8 MW in the step from 1 min; over 3 min (8 + 6 + 4) / 3 = 6 MW from 1 min
    load duration: 8 MW for 1 min, 6 for 2, 4 for 3, 2 for 4
"""

import numpy as np
import pytest

from tpss.results.standards.station_load import converter_table, load_duration_table, power_table

from made_up import made_up

DATASET = made_up(
    station_mw={"West": [2.0, 8.0, 6.0, 4.0], "East": [1.0] * 4},
    converters={"West": [2, 3, 3, 3], "East": [1] * 4},
)


def test_mean_powers_are_the_highest_of_any_window():
    table = power_table(DATASET, (3.0, 60.0))
    west = table[table.station == "West"].set_index("window_min")
    assert west.highest_mean_mw[[1.0, 3.0]].tolist() == pytest.approx([8.0, 6.0])
    assert west.from_min[[1.0, 3.0]].tolist() == [1.0, 1.0]
    assert np.isnan(west.highest_mean_mw[60.0])


def test_the_load_duration_curve_says_for_how_long_a_power_is_reached():
    table = load_duration_table(DATASET)
    west = table[table.station == "West"]
    assert west.power_mw.tolist() == [8.0, 6.0, 4.0, 2.0]
    assert west.duration_min.tolist() == [1.0, 2.0, 3.0, 4.0]


def test_the_area_below_the_load_duration_curve_is_the_energy():
    """(2 + 8 + 6 + 4) MW min; curves fall from step to step of one minute."""
    table = load_duration_table(DATASET)
    assert table[table.station == "West"].power_mw.sum() == pytest.approx(20.0)


def test_converters_are_told_by_how_long_how_many_ran():
    assert converter_table(DATASET).to_numpy().tolist() == [
        ["West", 2, 1.0],
        ["West", 3, 3.0],
        ["East", 1, 4.0],
    ]
