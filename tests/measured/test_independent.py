"""Means of values that are alike are known less well than their number says."""

import math

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import t

from tpss.measured.independent import correlation_time, mean_interval, student

nan = float("nan")


def autoregressive(count, phi, seed=0):
    """x_k = φ x_{k-1} + noise, whose correlation falls as φ^k: its time is (1 + φ) / (1 - φ)."""
    noise = np.random.default_rng(seed).normal(size=count + 500)
    return lfilter([1.0], [1.0, -phi], noise)[500:]


@pytest.mark.parametrize("phi", [0.0, 0.5, 0.9])
def test_the_correlation_time_is_that_of_the_closed_form(phi):
    """1, 3 and 19 steps."""
    found = correlation_time(autoregressive(400_000, phi))
    assert found == pytest.approx((1.0 + phi) / (1.0 - phi), rel=0.1)


def test_gaps_leave_the_correlation_as_it_is():
    values = autoregressive(40_000, 0.8)
    values[np.random.default_rng(1).random(40_000) < 0.2] = nan
    assert correlation_time(values) == pytest.approx(9.0, rel=0.12)


def test_values_without_spread_are_independent():
    assert correlation_time(np.full(20, 0.25)) == 1.0
    assert correlation_time(np.full(20, nan)) == 1.0


def test_values_that_go_up_and_down_are_never_more_than_they_are():
    assert correlation_time(np.tile([1.0, -1.0], 50)) == 1.0


def test_the_interval_holds_the_mean_about_as_often_as_it_says():
    """400 series of 500 values, φ = 0.8: 95 % of the intervals hold 0; as if independent, about 50 %."""
    held = alone = 0
    for seed in range(400):
        values = autoregressive(500, 0.8, seed)
        found = mean_interval(values)
        held += found.low <= 0.0 <= found.high
        alone += abs(values.mean()) <= 1.96 * values.std() / math.sqrt(500)
    assert 0.90 <= held / 400 <= 0.98
    assert alone / 400 < 0.65


def test_too_few_independent_values_have_no_interval():
    found = mean_interval(np.array([1.0, 2.0]))
    assert math.isnan(found.low)
    assert found.independent == 2.0


@pytest.mark.parametrize("freedom", [2.0, 3.5, 8.0, 60.0])
def test_the_quantile_of_student_is_that_of_scipy(freedom):
    assert student(freedom) == pytest.approx(t.ppf(0.975, freedom), rel=8e-3)
