"""Hand-worked profile used below: +10 ‰ from 0 m, -5 ‰ from 1000 m, +2 ‰ from 3000 m.

from 500 m over 3000 m: 500 · 0.010 - 2000 · 0.005 + 500 · 0.002 = 5 - 10 + 1 = -4 m
"""

import numpy as np
import pytest

from tpss.numerics.staircase import index_at
from tpss.physics.gradient import mean_gradient

from alternatives import climb

FROM_M = np.array([0.0, 1000.0, 3000.0])
GRADIENT = np.array([0.010, -0.005, 0.002])


def mean_over(as_run, position_m, way_m, from_m, gradient):
    stair = as_run(index_at)(position_m, from_m)
    return as_run(mean_gradient)(stair, position_m, way_m, from_m, gradient)


@pytest.mark.parametrize(
    ("position_m", "way_m", "climb_m"),
    [
        (500.0, 3000.0, -4.0),  # over three stairs
        (1200.0, 300.0, -1.5),  # within one
        (1000.0, 2000.0, -10.0),  # one from end to end
        (-400.0, 600.0, 6.0),  # begins before the profile
        (2900.0, 1100.0, 1.5),  # ends beyond it
    ],
)
def test_mean_gradient_is_the_climb_over_the_way(as_run, position_m, way_m, climb_m):
    mean = mean_over(as_run, position_m, way_m, FROM_M, GRADIENT)
    assert mean == pytest.approx(climb_m / way_m, rel=1e-12)


def test_mean_over_no_way_is_the_gradient_at_the_point(as_run):
    assert mean_over(as_run, 1000.0, 0.0, FROM_M, GRADIENT) == -0.005


def test_mean_over_less_than_a_rounding_of_the_position_is_the_gradient_at_the_point(as_run):
    """At 7 km a position rounds to 1e-12 m, over which a train that creeps goes 5e-13 m."""
    from_m, gradient = np.array([0.0, 7062.4069]), np.array([0.005, 0.001])
    assert mean_over(as_run, 7062.4, 5.4e-13, from_m, gradient) == 0.005
    assert mean_over(as_run, 7062.4, 9e-7, from_m, gradient) == 0.005


def test_single_stair_holds_everywhere(as_run):
    uniform = mean_over(as_run, -7.0, 1e5, np.array([0.0]), np.array([0.004]))
    assert uniform == pytest.approx(0.004)


def test_mean_gradient_is_the_altitude_difference_on_random_profiles(as_run):
    random = np.random.default_rng(1)
    for _ in range(300):
        stairs = random.integers(1, 30)
        from_m = np.sort(random.uniform(0.0, 1e5, stairs))
        gradient = random.uniform(-0.03, 0.03, stairs)
        position_m, way_m = random.uniform(-1e4, 1.1e5), random.uniform(0.1, 3e4)
        mean = mean_over(as_run, position_m, way_m, from_m, gradient)
        expected_m = climb(position_m, way_m, from_m, gradient)
        assert mean * way_m == pytest.approx(expected_m, abs=1e-9)
