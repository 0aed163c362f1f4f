"""Braking that begins and ends in the midst of a step, against hand calculation and against motion.

Hand-worked train used below: v = 20 m/s, b = 1 m/s², so it brakes for 20 s over 200 m.

    300 m before its stop it holds its speed for 5 s, and stands after 25 s
    in a step of 60 s:    5 s, 20 s, then it stands for 35 s
    in a step of 10 s:    5 s, 5 s of braking to 15 m/s; 100 + 87.5 = 187.5 m, 112.5 m = 15²/2 are left
    in a step of 2 s:     held all along
    evenly, 300 m take β = 400/600 = 2/3 m/s² and 30 s
"""

import math

import numpy as np
import pytest

from tpss.driving.course import (
    distance_of_part,
    even_braking,
    highest_speed_that_stops,
    latest_braking,
    mean_braking_force,
    part_of_step,
    stopping_distance,
)


def random_stops(count, seed):
    """Speed, distance, retardation, step; some of them at the last moment."""
    random = np.random.default_rng(seed)
    for case in range(count):
        speed, b = random.uniform(0.01, 60.0), random.uniform(0.05, 1.5)
        room = 1.0 if case % 4 == 0 else random.uniform(1.0, 3.0)
        yield speed, room * speed**2 / (2.0 * b), b, float(10.0 ** random.uniform(-0.3, 2.5))


def test_the_stopping_distance_is_200_m(as_run):
    assert as_run(stopping_distance)(20.0, 1.0) == 200.0


def test_a_train_holds_its_speed_for_as_long_as_it_can(as_run):
    assert as_run(latest_braking)(20.0, 300.0, 1.0) == (5.0, 20.0)
    assert as_run(latest_braking)(20.0, 200.0, 1.0) == (0.0, 20.0)


def test_the_brakes_make_up_for_a_shortage_by_rounding(as_run):
    hold_s, brake_s = as_run(latest_braking)(20.0, 200.0 - 1e-10, 1.0)
    assert hold_s == 0.0
    assert 20.0 * brake_s / 2.0 == pytest.approx(200.0 - 1e-10, abs=1e-13)


@pytest.mark.parametrize("distance_m", [-1e-10, 0.0, 1e-10])
def test_over_less_than_a_nanometre_the_brakes_take_what_they_need(as_run, distance_m):
    """1e-5 m/s stop in 5e-11 m, which no position resolves."""
    assert as_run(latest_braking)(1e-5, distance_m, 1.0)[1] == pytest.approx(1e-5)


def test_even_braking_takes_the_whole_way(as_run):
    assert as_run(even_braking)(20.0, 300.0, 1.0) == 30.0


@pytest.mark.parametrize(
    ("step_s", "part", "way_m"),
    [
        (60.0, (5.0, 20.0, 0.0), 300.0),
        (25.0, (5.0, 20.0, 0.0), 300.0),
        (10.0, (5.0, 5.0, 15.0), 187.5),
        (5.0, (5.0, 0.0, 20.0), 100.0),
        (2.0, (2.0, 0.0, 20.0), 40.0),
    ],
)
def test_a_step_sees_its_part_of_the_course(as_run, step_s, part, way_m):
    found = as_run(part_of_step)(20.0, 5.0, 20.0, step_s)
    assert found == pytest.approx(part)
    hold_s, brake_s, next_speed = found
    assert as_run(distance_of_part)(20.0, next_speed, hold_s, brake_s) == pytest.approx(way_m)


def test_a_course_that_is_longer_than_the_step_by_a_rounding_ends_with_it(as_run):
    assert as_run(part_of_step)(20.0, 5.0, 20.0, 25.0 * (1.0 - 1e-12)) == (5.0, 20.0, 0.0)


def test_the_course_found_anew_after_every_step_ends_at_the_stop(as_run):
    """Whatever the step; and no step brakes harder than it may, but for roundings."""
    for speed, distance_m, b, step_s in random_stops(400, seed=8):
        v, d, time_s = speed, distance_m, 0.0
        while v > 0.0:
            course = as_run(latest_braking)(v, d, b)
            hold_s, brake_s, next_speed = as_run(part_of_step)(v, *course, step_s)
            d -= as_run(distance_of_part)(v, next_speed, hold_s, brake_s)
            assert v - next_speed <= b * brake_s * (1.0 + 1e-9) + 1e-12
            v, time_s = next_speed, time_s + hold_s + brake_s
        assert abs(d) < 1e-9
        held_s = (distance_m - speed**2 / (2.0 * b)) / speed
        assert time_s == pytest.approx(held_s + speed / b, rel=1e-9)


def test_mean_forces_and_momentum_balance(as_run):
    """100 t, 10 kN of resistance, 300 m before the stop, in 60 s: the motors give 10 kN for 5 s, the
    brakes 90 kN for 20 s, that is 30 kN; 10/12 - 30 - 10 · 25/60 = -33.33 kN = 100 t · 20/60 m/s²."""
    brakes_n = as_run(mean_braking_force)(20.0, 5.0, 20.0, 60.0, 10e3, 100e3)
    assert brakes_n == pytest.approx(30e3)
    assert 10e3 / 12 - brakes_n - 10e3 * 25 / 60 == pytest.approx(-100e3 * 20 / 60)


def test_downhill_the_brakes_hold_the_speed_too(as_run):
    """-10 kN of resistance: the brakes give 10 kN for 5 s and 110 kN for 20 s."""
    brakes_n = as_run(mean_braking_force)(20.0, 5.0, 20.0, 60.0, -10e3, 100e3)
    assert brakes_n == pytest.approx((10e3 * 5 + 110e3 * 20) / 60)


def test_a_train_that_has_to_be_driven_does_not_brake(as_run):
    """100 t on a hill of 150 kN slow down by 1.5 m/s² by themselves."""
    assert as_run(mean_braking_force)(20.0, 0.0, 20.0, 60.0, 150e3, 100e3) == 0.0


def test_highest_speed_is_the_last_one_from_which_the_train_can_stop(as_run):
    for speed, distance_m, b, step_s in random_stops(400, seed=9):
        room_m = distance_m + step_s * speed / 2.0
        highest = as_run(highest_speed_that_stops)(speed, room_m, b, step_s)
        left_m = room_m - step_s * (speed + highest) / 2.0
        assert left_m == pytest.approx(highest**2 / (2.0 * b), abs=1e-9 * room_m)


def test_standing_train_100_metres_before_its_stop(as_run):
    """v²/2 + 5 v = 100 at b = 1 m/s² and steps of 10 s: v = √(25 + 200) - 5 = 10 m/s."""
    assert as_run(highest_speed_that_stops)(0.0, 100.0, 1.0, 10.0) == pytest.approx(10.0)
    assert as_run(highest_speed_that_stops)(0.0, 0.0, 1.0, 10.0) == 0.0
    assert math.isfinite(as_run(highest_speed_that_stops)(30.0, 10.0, 1.0, 10.0))
