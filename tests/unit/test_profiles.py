"""The line under a train: the lowest limit, the mean gradient."""

import numpy as np
import pytest

from tpss.driving.data import Profile
from tpss.model.profiles import (
    PIECES,
    climb_to,
    lowest_under_train,
    mean_under_train,
    with_curves,
)
from tpss.scenario.line import TrackCurve

from alternatives import climb


def staircase(*stairs):
    return Profile(*(np.array(column, dtype=float) for column in zip(*stairs, strict=True)))


def value_at(position_m, profile):
    return profile.value[max(0, np.searchsorted(profile.from_m, position_m, side="right") - 1)]


def test_limits_rise_a_train_s_length_later_and_fall_where_they_fall():
    """The last rise, by a train longer than the stretch before it, never comes."""
    line = staircase((0, 25), (4000, 10), (4300, 25), (9000, 15), (9200, 20), (9500, 5))
    seen = lowest_under_train(line, 700.0)
    assert seen.from_m.tolist() == [0.0, 4000.0, 5000.0, 9000.0, 9500.0]
    assert seen.value.tolist() == [25.0, 10.0, 25.0, 15.0, 5.0]


def test_lowest_limit_is_that_of_all_places_under_the_train():
    random = np.random.default_rng(2)
    for _ in range(50):
        count, length_m = random.integers(1, 12), random.uniform(1.0, 800.0)
        line = Profile(np.sort(random.uniform(0.0, 5e3, count)), random.uniform(5.0, 30.0, count))
        seen = lowest_under_train(line, length_m)
        for head_m in random.uniform(-100.0, 7e3, 20):
            under_m = np.append(line.from_m, (head_m - length_m, head_m))
            under_m = under_m[(under_m >= head_m - length_m) & (under_m <= head_m)]
            assert value_at(head_m, seen) == min(value_at(x, line) for x in under_m)


def test_mean_gradient_changes_over_the_length():
    """From 0 to 8 per mille at 1000 m under 800 m: stairs of 50 m, of 0.5 per mille."""
    seen = mean_under_train(staircase((0, 0.0), (1000, 0.008)), 800.0)
    assert seen.from_m.tolist() == [0.0, *(1000.0 + 50.0 * k for k in range(PIECES + 1))]
    stairs = [0.0, *((k + 0.5) * 0.5e-3 for k in range(PIECES)), 0.008]
    assert seen.value == pytest.approx(np.array(stairs), abs=1e-15)


def test_climb_is_that_of_the_train_s_mass_spread_over_its_length():
    """Between two changes, against the mean of the altitudes of 20,000 places under the train."""
    random = np.random.default_rng(3)
    for _ in range(20):
        count, length_m = random.integers(2, 10), random.uniform(5.0, 800.0)
        line = Profile(np.sort(random.uniform(0.0, 5e3, count)), random.uniform(-0.03, 0.03, count))
        seen = mean_under_train(line, length_m)
        begin, end = (seen.from_m[k] for k in (0, -1))
        places = (np.arange(20_000) + 0.5) / 20_000 * length_m
        rise = climb_to(end - places, line).mean() - climb_to(begin - places, line).mean()
        assert climb(begin, end - begin, *seen) == pytest.approx(rise, abs=1e-4)


def test_one_gradient_is_the_same_under_any_train():
    assert mean_under_train(staircase((0, 0.004)), 300.0) == staircase((0, 0.004))


def test_curves_are_added_to_the_gradients_under_them():
    """650/(380 - 55) = 2 per mille, 500/(280 - 30) = 2 per mille too."""
    curves = [
        TrackCurve(from_km=0.0, to_km=0.5, radius_m=380.0),
        TrackCurve(from_km=0.8, to_km=1.2, radius_m=280.0),
    ]
    seen = with_curves(staircase((0, 0.004), (1000, -0.005)), curves)
    assert seen.from_m.tolist() == [-1.0, 0.0, 500.0, 800.0, 1000.0, 1200.0]
    assert seen.value == pytest.approx([0.004, 0.006, 0.004, 0.006, -0.003, -0.005])
