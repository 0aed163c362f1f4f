"""Kernels for lanes give what the same kernels give of each case, compiled and in plain Python."""

import math

import numba
import numpy as np
import pytest

from tpss.driving.braking import braking_plan
from tpss.lanes import functions
from tpss.lanes.compile import lane_version
from tpss.lanes.masks import all_lanes
from tpss.lanes.records import new_lanes
from tpss.lanes.types import LANES
from tpss.numerics.exponential import exponential
from tpss.physics.adhesion import adhesion_limit

from branching import KERNELS

ROUNDING = 1e-15
RANDOM = np.random.default_rng(7)
PAIRS = np.round(RANDOM.uniform(-3.0, 3.0, (40, 2, LANES)), 1)


def in_lanes(function):
    """A function of two numbers a lane that calls one of lanes."""

    @numba.njit
    def call(given, found):
        found[0] = function(given[0], given[1])

    def of_arrays(pair):
        given, found = new_lanes(np.float64, (2,)), new_lanes(np.float64, (1,))
        given.words.view(np.float64)[:, 0] = pair
        call(given, found)
        return found.words.view(np.float64)[0, 0].copy()

    return of_arrays


@pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: kernel.__name__)
def test_every_form_of_a_branch_is_that_of_each_case(kernel):
    version, takes_mask = lane_version(kernel)
    assert takes_mask

    @numba.njit
    def with_all(x, y):
        return version(x, y, all_lanes())

    call = in_lanes(with_all)
    for pair in PAIRS:
        alone = [kernel(float(x), float(y)) for x, y in pair.T]
        plain = [kernel.py_func(float(x), float(y)) for x, y in pair.T]
        assert call(pair) == pytest.approx(alone, rel=ROUNDING, abs=ROUNDING)
        assert alone == pytest.approx(plain, rel=ROUNDING, abs=ROUNDING)


def test_braking_plans_are_those_of_each_case():
    """With whole and broken numbers of steps, in distances from the shortest one on."""
    version, _ = lane_version(braking_plan)

    @numba.njit
    def total(speed, slack):
        reach = speed * speed / 1.7 + 0.5 * speed
        hold, first, full, last = version(speed, reach + slack, 0.85, 1.0, all_lanes())
        return hold + 10.0 * full + 100.0 * first + 1000.0 * last

    call = in_lanes(total)
    for pair in RANDOM.uniform(0.5, 40.0, (20, 2, LANES)):
        expected = []
        for speed, slack in pair.T:
            reach = speed * speed / 1.7 + 0.5 * speed
            hold, first, full, last = braking_plan(speed, reach + slack, 0.85, 1.0)
            expected.append(hold + 10.0 * full + 100.0 * first + 1000.0 * last)
        assert call(pair) == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize(
    ("function", "expected", "low", "high"),
    [
        (functions.sin, math.sin, -4.0, 4.0),
        (functions.cos, math.cos, -4.0, 4.0),
        (lane_version(exponential)[0], math.exp, -30.0, 30.0),
    ],
    ids=["sin", "cos", "exp"],
)
def test_functions_without_branches_are_exact(function, expected, low, high):
    """To two units in the last place; an angle of a load flow is a fraction of a turn."""

    @numba.njit
    def of_first(x, _):
        return function(x)

    call = in_lanes(of_first)
    for x in RANDOM.uniform(low, high, (50, LANES)):
        found = call(np.array([x, x]))
        assert found == pytest.approx([expected(each) for each in x], rel=5e-16, abs=5e-16)


def test_angles_of_all_quadrants_are_exact():
    call = in_lanes(functions.atan2)
    for pair in RANDOM.uniform(-2.0, 2.0, (50, 2, LANES)):
        expected = [math.atan2(y, x) for y, x in pair.T]
        assert call(pair) == pytest.approx(expected, rel=5e-16)


def test_what_is_the_same_in_all_cases_stays_a_branch():
    """The state of the rails is one of the simulation: both lanes of the other law are not evaluated."""
    version, takes_mask = lane_version(adhesion_limit)
    assert takes_mask

    @numba.njit
    def wet(mass, speed):
        return version(mass, speed, 1, all_lanes())

    pair = RANDOM.uniform(1.0, 50.0, (2, LANES))
    expected = [adhesion_limit(mass, speed, 1) for mass, speed in pair.T]
    assert in_lanes(wet)(pair) == pytest.approx(expected, rel=ROUNDING)
