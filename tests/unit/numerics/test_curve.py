"""Curves through points, against hand values and scipy's PCHIP.

Hand-worked curve through (0, 0), (1, 1), (3, 2): steps 1 and 2, secants 1 and 0.5.

    slope at 1: w1 = 2·2 + 1 = 5, w2 = 2 + 2·1 = 4;  9/m = 5/1 + 4/0.5 = 13;  m = 9/13
    slope at 0: ((2·1 + 2)·1 - 1·0.5)/(1 + 2) = 3.5/3
    half-way between 0 and 1: (0 + 1)/2 + 1·(3.5/3 - 9/13)/8 = 0.5592949
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from tpss.model.curves import CurveBook, interpolate
from tpss.numerics.curve import (
    Curve,
    curve_at,
    hermite,
    outside_curve,
    slope_at,
    steepest_between,
)

from alternatives import central_difference
from conftest import plain

AT, VALUE = np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, 2.0])

SHAPES = {
    "two points": ([0.0, 40.0], [0.9, 0.7]),
    "hand-worked": (AT, VALUE),
    "with a peak": ([0.0, 10.0, 30.0, 35.0, 80.0], [0.2, 0.9, 0.95, 0.4, 0.3]),
    "flat in the middle": ([0.0, 1.0, 2.0, 3.0, 7.0], [0.5, 0.7, 0.7, 0.7, 0.1]),
    "steep end": ([0.0, 1.0, 1.1, 5.0], [0.0, 0.01, 1.0, 0.99]),
    "turns at once": ([0.0, 1.0, 1.5, 9.0], [0.0, 1.0, 0.0, 1.0]),
}


@pytest.fixture(params=SHAPES.values(), ids=SHAPES.keys())
def shape(request):
    at, value = request.param
    return np.array(at), np.array(value)


def curve(at, value):
    book = CurveBook()
    book.add([-5.0, 5.0], [7.0, 7.0])  # another curve before it
    place = book.add(at, value)
    book.add_constant(9.0)
    return place, book.points()


def test_slopes_and_value_of_the_hand_worked_curve(as_run):
    assert as_run(slope_at)(0, 3, AT, VALUE) == pytest.approx(3.5 / 3)
    assert as_run(slope_at)(1, 3, AT, VALUE) == pytest.approx(9 / 13)
    (first, count), points = curve(AT, VALUE)
    assert as_run(curve_at)(0.5, first, count, points) == pytest.approx(0.5592949, abs=1e-7)


def test_a_curve_is_scipys_pchip(as_run, shape):
    at, value = shape
    (first, count), points = curve(at, value)
    places = np.linspace(at[0], at[-1], 97)
    found = [as_run(curve_at)(x, first, count, points) for x in places]
    assert found == pytest.approx(PchipInterpolator(at, value)(places), rel=1e-12, abs=1e-14)


def test_slopes_are_scipys_and_those_of_the_values(as_run, shape):
    at, value = shape
    twin = PchipInterpolator(at, value).derivative()
    for k in range(len(at) - 1):
        m = [as_run(slope_at)(i, len(at), at, value) for i in (k, k + 1)]
        step = at[k + 1] - at[k]
        for share in (0.0, 0.3, 0.8):

            def cubic(way, k=k, m=m, step=step):
                return as_run(hermite)(way, step, value[k], value[k + 1], *m)

            way = share * step
            slope = cubic(way)[1]
            assert slope == pytest.approx(twin(at[k] + way), rel=1e-9, abs=1e-12)
            around = central_difference(lambda x: cubic(x)[0], way, 1e-5 * step)
            assert slope == pytest.approx(around, rel=1e-5, abs=1e-9)


def test_no_slope_passes_the_bound(as_run, shape):
    at, value = shape
    twin = PchipInterpolator(at, value).derivative()
    for k in range(len(at) - 1):
        m = [as_run(slope_at)(i, len(at), at, value) for i in (k, k + 1)]
        bound = as_run(steepest_between)(at[k + 1] - at[k], value[k], value[k + 1], *m)
        steepest = np.abs(twin(np.linspace(at[k], at[k + 1], 200))).max()
        assert steepest <= bound * (1 + 1e-12)
        assert bound <= 3.0 * abs(value[k + 1] - value[k]) / (at[k + 1] - at[k]) + 1e-12


def test_outer_values_hold_beyond_the_ends_and_that_is_noticed(as_run):
    place, points = curve(AT, VALUE)
    record = Curve.array([place])[0]
    for x, value, beyond in (
        (-1.0, 0.0, True),
        (0.0, 0.0, False),
        (3.0, 2.0, False),
        (9.0, 2.0, True),
    ):
        assert as_run(curve_at)(x, *place, points) == value
        assert as_run(outside_curve)(x, record, points) == beyond


def test_one_point_is_a_constant_that_never_ends(as_run):
    book = CurveBook()
    first, count = book.add_constant(0.8)
    for x in (-1e9, 0.0, 1e9):
        assert as_run(curve_at)(x, first, count, book.points()) == 0.8
    assert as_run(slope_at)(0, 1, np.array([0.0]), np.array([0.8])) == 0.0


@given(
    st.lists(st.floats(0.01, 1.0), min_size=2, max_size=8),
    st.lists(st.floats(0.1, 50.0), min_size=8, max_size=8),
    st.floats(0.0, 1.0),
)
@settings(max_examples=300, deadline=None)
def test_a_curve_lies_between_its_neighbouring_points(values, steps, share):
    """No overshoot, not even by a rounding: a power factor stays at 1 or below."""
    at = np.concatenate([[0.0], np.cumsum(steps[: len(values) - 1])])
    (first, count), points = curve(at, values)
    x = share * at[-1]
    k = min(int(np.searchsorted(at, x, side="right")) - 1, len(at) - 2)
    found = plain(curve_at)(x, first, count, points)
    assert min(values[k : k + 2]) <= found <= max(values[k : k + 2])


def test_many_curves_through_the_same_places_are_interpolated_at_once():
    """Forces over currents: the axis comes first, and what is over speed and voltage stays."""
    at, random = np.array([500.0, 900.0, 1250.0, 2080.0]), np.random.default_rng(3)
    value = random.uniform(0.0, 1.0, (4, 2, 3))
    for x in (500.0, 777.0, 1250.0, 2080.0):
        twin = PchipInterpolator(at, value, axis=0)(x)
        assert interpolate(x, at, value) == pytest.approx(twin, rel=1e-12)
