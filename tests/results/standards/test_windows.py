"""Means over moving windows of values that hold for a time step each.

Hand-worked values: 0, 6, 2, 4 over four steps.

    one step                        highest 6, from step 1
    two steps    3, 4, 3            highest 4, from step 1
    1.5 steps    [1, 2.5]: (6 + 2/2) / 1.5 = 4.667; [0.5, 2]: (0/2 + 6) / 1.5 = 4
    half a step  a step's own value, highest 6
    four steps   all of it, 3
"""

import numpy as np
import pytest

from tpss.results.standards.windows import (
    highest_mean_table,
    highest_means,
    highest_means_between,
)

VALUES = np.array([[0.0, 6.0, 2.0, 4.0]]).T


@pytest.mark.parametrize(
    ("width", "highest", "begin"),
    [(1.0, 6.0, 1.0), (2.0, 4.0, 1.0), (1.5, 7.0 / 1.5, 1.0), (0.5, 6.0, 1.0), (4.0, 3.0, 0.0)],
)
def test_the_highest_mean_is_the_hand_worked_one(width, highest, begin):
    found, where = highest_means(VALUES, width)
    assert found == pytest.approx([highest])
    assert where == pytest.approx([begin])


def test_a_window_may_begin_between_two_instants():
    """Of 0, 2, 4 the last one and a half steps have the highest mean, (2/2 + 4) / 1.5."""
    found, where = highest_means(np.array([[0.0, 2.0, 4.0]]).T, 1.5)
    assert (found[0], where[0]) == (pytest.approx(5.0 / 1.5), 1.5)


def test_a_window_wider_than_the_run_has_no_mean():
    for values in (VALUES, VALUES[:0]):
        found, where = highest_means(values, 4.5)
        assert np.isnan([*found, *where]).all()


def test_a_window_as_wide_as_the_run_up_to_rounding_has_one():
    assert highest_means(VALUES, 4.0 * (1.0 + 1e-12))[0] == pytest.approx([3.0])


@pytest.mark.parametrize("width", [0.3, 1.0, 2.7, 10.0, 33.3])
def test_it_is_that_of_a_slow_search(width):
    """A fine grid of windows finds none that is higher, and one that is nearly as high."""
    values = np.random.default_rng(0).normal(size=(40, 3))
    found, _ = highest_means(values, width)
    parts = 200
    fine = np.repeat(values, parts, axis=0)
    count = round(width * parts)
    sums = np.cumsum(np.vstack([np.zeros((1, 3)), fine]), axis=0)
    slow = ((sums[count:] - sums[:-count]) / count).max(axis=0)
    assert found == pytest.approx(slow, abs=1e-9)


def test_a_table_has_a_row_a_column_and_window_and_the_time_step_as_the_first():
    table = highest_mean_table(np.tile(VALUES, 2), {"name": ["a", "b"]}, 30.0, (1.0, 3.0))
    assert table.name.tolist() == ["a", "a", "a", "b", "b", "b"]
    assert table.window_min.tolist() == [0.5, 1.0, 3.0] * 2
    assert table.highest.tolist()[:2] == [6.0, 4.0]
    assert table.from_min.tolist()[:2] == [0.5, 0.5]
    assert np.isnan(table.highest[2])


def test_a_window_of_the_time_step_is_not_listed_twice():
    table = highest_mean_table(VALUES, {"name": ["a"]}, 60.0, (1.0, 3.0))
    assert table.window_min.tolist() == [1.0, 3.0]


def test_the_window_that_ends_with_the_run_is_not_lost_in_a_rounding():
    """Load in the last step alone, windows that do not begin at instants: h / w each.  The end less the
    width, and the width again, is behind the end for a third of them."""
    step, steps = 48.660329190297026, 60
    instants = np.arange(steps + 1) * step
    load = np.append(np.zeros(steps - 1), 1.0)[:, None]
    widths = [step * (2.0 + k / 97.0) for k in range(1, 97)]
    rounded = [instants[-1] - width + width > instants[-1] for width in widths]
    assert any(rounded)
    for width, (highest, _) in zip(
        widths, highest_means_between(load, instants, widths), strict=True
    ):
        assert highest[0] == pytest.approx(step / width, rel=1e-9)
