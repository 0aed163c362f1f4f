"""Gradients from altitudes, smoothed or not; and the lowest of values over stretches."""

import pytest

from tpss.tables.altitudes import gradients_of, smoothed
from tpss.tables.stretches import Stretch, lowest_of


def test_gradients_are_rise_over_run_and_the_last_one_goes_on():
    """5 m on 0.5 km are 10 ‰, -3 m on 1 km -3 ‰."""
    assert gradients_of([10.0, 10.5, 11.5], [100.0, 105.0, 102.0]) == [10.0, -3.0, -3.0]


def test_smoothing_keeps_the_ends_and_a_straight_slope():
    positions, altitudes = smoothed([0.0, 1.0, 4.0], [0.0, 10.0, 40.0], 1.0)
    assert positions == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert altitudes == pytest.approx([0.0, 10.0, 20.0, 30.0, 40.0])


def test_smoothing_averages_over_its_length():
    """A step of 8 m within 1 mm at km 2: half of it is the mean over 2 km around that place.

    At km 1 and 3 the window of 2 km ends at the step.
    """
    positions, altitudes = smoothed([0.0, 2.0, 2.000001, 4.0], [0.0, 0.0, 8.0, 8.0], 2.0)
    assert positions == [0.0, 2.0, 4.0]
    assert altitudes == pytest.approx([0.0, 4.0, 8.0], abs=1e-4)


def test_smoothing_over_more_than_the_line_leaves_one_slope():
    positions, altitudes = smoothed([0.0, 1.0, 2.0], [0.0, 50.0, 10.0], 10.0)
    assert (positions, altitudes) == ([0.0, 2.0], [0.0, 10.0])


def values(stretches):
    return [(each.begin_km, each.end_km, each.value) for each in stretches]


def test_where_stretches_overlap_the_lowest_holds():
    """A restriction to 40 from km 3 to 4, on a line of 100 to km 5, then 80."""
    found, gaps = lowest_of(
        [Stretch(0.0, 5.0, 100.0, 0), Stretch(5.0, 9.0, 80.0, 1), Stretch(3.0, 4.0, 40.0, 2)]
    )
    assert values(found) == [
        (0.0, 3.0, 100.0),
        (3.0, 4.0, 40.0),
        (4.0, 5.0, 100.0),
        (5.0, 9.0, 80.0),
    ]
    assert [each.row for each in found] == [0, 2, 0, 1]
    assert gaps == []


def test_what_nothing_covers_is_a_gap():
    found, gaps = lowest_of([Stretch(0.0, 1.0, 100.0, 0), Stretch(2.0, 3.0, 100.0, 1)])
    assert values(found) == [(0.0, 1.0, 100.0), (2.0, 3.0, 100.0)]
    assert gaps == [(1.0, 2.0)]


def test_neighbours_of_one_value_are_one():
    found, _ = lowest_of([Stretch(0.0, 2.0, 50.0, 0), Stretch(1.0, 3.0, 50.0, 1)])
    assert values(found) == [(0.0, 3.0, 50.0)]
