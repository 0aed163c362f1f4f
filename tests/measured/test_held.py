"""Means over intervals keep the integral, whatever the steps.

Values of a minute, 2, 4 and 9 MW, over intervals of 1.5 min: the first holds a whole minute of 2 and
half a one of 4, (2 + 2) / 1.5 = 2.667 MW; the second half a minute of 4 and a whole one of 9,
11 / 1.5 = 7.333 MW.  Both integrals are 15 MW min.
"""

import numpy as np
import pytest

from tpss.measured.held import Held

nan = float("nan")


def held(values, step=1.0, begin=0.0):
    edges = begin + step * np.arange(len(values) + 1.0)
    return Held(edges[:-1], edges[1:], np.array(values, dtype=float))


def means(series, *edges):
    edges = np.array(edges, dtype=float)
    return series.means(edges[:-1], edges[1:])


def test_means_are_those_of_the_hand_calculation():
    found = means(held([2.0, 4.0, 9.0]), 0.0, 1.5, 3.0)
    np.testing.assert_allclose(found, [4.0 / 1.5, 11.0 / 1.5], rtol=1e-15)
    assert found.sum() * 1.5 == pytest.approx(15.0)


def test_a_finer_step_repeats_values():
    np.testing.assert_array_equal(means(held([2.0, 4.0]), 0.0, 0.5, 1.0, 1.5, 2.0), [2, 2, 4, 4])


@pytest.mark.parametrize("step", [0.3, 0.7, 1.0, 2.9, 5.8])
def test_energy_is_neither_made_nor_lost_by_any_step(step):
    """Intervals that follow each other, from 0 to 29: the integral is that of the series."""
    values = np.random.default_rng(7).normal(size=29)
    edges = np.append(np.arange(0.0, 29.0 - 1e-9, step), 29.0)
    found = means(held(values), *edges)
    assert found @ np.diff(edges) == pytest.approx(values.sum(), rel=1e-12)


def test_an_interval_that_a_gap_touches_is_not_known():
    found = means(held([2.0, nan, 4.0, 4.0]), 0.0, 0.5, 1.5, 2.5, 4.0)
    np.testing.assert_array_equal(found, [2.0, nan, nan, 4.0])


def test_nothing_is_known_between_values_and_beyond_them():
    series = Held(np.array([0.0, 3.0]), np.array([1.0, 4.0]), np.array([5.0, 7.0]))
    np.testing.assert_array_equal(means(series, -1, 0, 1, 2, 3, 4, 5), [nan, 5, nan, nan, 7, nan])


def test_roundings_of_times_are_no_gap():
    begins = 0.1 * np.arange(600)
    series = Held(begins, np.append(begins[1:], 60.0), np.ones(600))
    np.testing.assert_allclose(means(series, *np.linspace(0.0, 60.0, 13)), 1.0, rtol=1e-12)
