"""Bounds of a converter station, steep parts of its law: a highest current, and no power back."""

import cmath
import math

import pytest

from tpss.sources.bounded import (
    AHEAD,
    FALL,
    WIDTH,
    Bounds,
    blocked,
    bounded_is_plausible,
    bounded_residual,
    fall,
)
from tpss.sources.converter import ConverterLaw, converter_residual

from alternatives import pair_by_differences

CONVERTER = (16_500.0, 50e-6, 14.42925, 12.467523, 16_500.0, 0.0, 0.0, 0.1)
LIMIT_A = 700.0


LAW = ConverterLaw.array([CONVERTER])[0]


def bounds(limit_a=math.inf, blocks=False):
    width_w = WIDTH * 10e6 if blocks else math.inf
    return Bounds.array([(limit_a, width_w)])[0]


def test_without_bounds_it_is_a_converter_station(as_run):
    state = 15.8e3 - 2.1e3j, 900.0 - 420.0j
    found = as_run(bounded_residual)(*state, 2.0, LAW, bounds())
    asked = as_run(converter_residual)(*state, 2.0, LAW, True)
    assert found[0] == pytest.approx(asked[0], abs=1e-8)
    for own, of_converters in zip(found[1:], asked[1:], strict=True):
        assert own == pytest.approx(of_converters, rel=1e-12)


def test_the_voltage_falls_to_nothing_within_two_percent_of_the_highest_current(as_run):
    """16.5 kV over 14 A; the corner is round from 696.5 to 703.5 A; at 700 A a quarter of 3.5."""
    assert as_run(fall)(0.99 * LIMIT_A, LAW, bounds(LIMIT_A))[0] == 0.0
    slope = 16_500.0 / (FALL * LIMIT_A)
    assert as_run(fall)(LIMIT_A, LAW, bounds(LIMIT_A)) == pytest.approx(
        (slope * 0.875, slope / 2.0)
    )
    assert as_run(fall)(1.02 * LIMIT_A, LAW, bounds(LIMIT_A)) == pytest.approx((16_500.0, slope))


def test_power_that_comes_back_turns_the_angle_then_raises_the_voltage(as_run):
    """Of 10 MVA: at 1 kW half of the angle, all of it from 2 kW on; from 4 kW on 8.25 kV each kW."""
    own = LAW, bounds(blocks=True)
    assert as_run(blocked)(-5e6, *own) == (0.0, 0.0, 0.0, 0.0)
    assert as_run(blocked)(1e3, *own)[0] == pytest.approx(AHEAD / 2.0)
    assert as_run(blocked)(3e3, *own) == (AHEAD, 0.0, 0.0, 0.0)
    assert as_run(blocked)(6e3, *own)[2] == pytest.approx(16_500.0)


STATES = {
    "below the limit": (15.8e3 - 2.1e3j, 900.0 - 420.0j),
    "in its corner": (14.8e3 - 2.1e3j, cmath.rect(1_402.0, -0.4)),
    "beyond it": (9e3 - 2.1e3j, cmath.rect(1_420.0, -0.4)),
    "taking a little": (16.4e3 + 1e3j, -0.1 + 30j),
    "taking more than it can": (16.4e3 + 1e3j, -0.9 + 30j),
}


@pytest.mark.parametrize("state", STATES)
def test_derivatives_are_those_of_differences(state, as_run):
    (voltage, current), own = STATES[state], (LAW, bounds(LIMIT_A, blocks=True))
    off = as_run(bounded_residual)
    _, by_voltage, by_current = off(voltage, current, 2.0, *own)
    asked = pair_by_differences(lambda v: off(v, current, 2.0, *own)[0], voltage, 1e-3)
    assert by_voltage == pytest.approx(asked, rel=1e-5, abs=1e-7)
    asked = pair_by_differences(lambda j: off(voltage, j, 2.0, *own)[0], current, 1e-5)
    assert by_current == pytest.approx(asked, rel=1e-5, abs=1e-5)


def test_a_voltage_of_turned_sign_is_no_state_of_a_station(as_run):
    """At 1,450 A of two converters the fall, 29 kV, is more than there is."""
    plausible = as_run(bounded_is_plausible)
    assert plausible(9e3 + 0j, cmath.rect(1_410.0, -0.4), 2.0, LAW, bounds(LIMIT_A))
    assert not plausible(-9e3 + 0j, cmath.rect(1_450.0, math.pi - 0.4), 2.0, LAW, bounds(LIMIT_A))
