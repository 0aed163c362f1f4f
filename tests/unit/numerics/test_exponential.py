"""The branch-free exponential against the library's, in units of the last place."""

import math

import numpy as np
import pytest

from tpss.numerics.exponential import exponential


def test_it_is_exact_to_two_units_in_the_last_place(as_run):
    """Rounding of the polynomial (one unit) and of 2^k e^r (none) leave less than 4.5e-16 relative."""
    for x in np.random.default_rng(7).uniform(-690.0, 690.0, 3_000):
        assert as_run(exponential)(x) == pytest.approx(math.exp(x), rel=4.5e-16, abs=0.0)


@pytest.mark.parametrize("k", [-900, -1, 0, 1, 2, 900])
def test_it_is_exact_where_the_reduction_changes_over(as_run, k):
    """At x = (k + ½) ln 2, the polynomial is furthest from its middle, on either side."""
    for x in ((k + 0.5 - 1e-9) * math.log(2.0), (k + 0.5 + 1e-9) * math.log(2.0)):
        assert as_run(exponential)(x) == pytest.approx(math.exp(x), rel=4.5e-16, abs=0.0)


def test_one_at_zero_and_bounded_far_out(as_run):
    run = as_run(exponential)
    assert run(0.0) == 1.0
    assert run(1e9) == run(700.0) == pytest.approx(math.exp(700.0), rel=1e-15)
    assert run(-math.inf) == run(-700.0) == pytest.approx(math.exp(-700.0), rel=1e-15)


def test_not_a_number_stays_one(as_run):
    assert math.isnan(as_run(exponential)(math.nan))
