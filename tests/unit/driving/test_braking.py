"""Braking plans against hand calculation, against their motion, and against a linear program.

Hand-worked train used below: b = 1 m/s², h = 10 s, so one step of full braking takes 10 m/s.

    at 20 m/s the shortest stop takes two steps: 150 m + 50 m = 200 m
    at 25 m/s it takes three, the last one half: 200 m + 100 m + 25 m = 325 m
    at 20 m/s, 400 m before its stop: hold for one step (200 m), then brake twice
    at 20 m/s, 300 m before its stop: the moments are Σ u = 2 and Σ u (s - 1/2) = 3, so the block
    0.5, 1, 0.5 of steps 1 to 3 (0.25 + 1.5 + 1.25 = 3): 20, 15, 5, 0 m/s; 175 m + 100 m + 25 m
"""

import math

import numpy as np
import pytest

from tpss.driving.braking import (
    braking_plan,
    highest_speed_that_stops,
    plan_fraction,
    plan_length,
    shortest_stop,
)

from alternatives import least_remaining_distances, positions, way_of_full_braking

STEPS_S = [0.6, 1.0, 3.0, 6.0, 30.0, 60.0, 120.0, 300.0]


def speeds_of(plan, speed, retardation, step_s):
    """Speeds that a plan asks for; the train is made to stand after its last step."""
    hold, first, full, last = plan
    speeds = [speed]
    for step in range(plan_length(hold, full, last)):
        fraction = plan_fraction(step, hold, first, full, last)
        speeds.append(speeds[-1] - fraction * retardation * step_s)
    return speeds


def random_stops(count, seed, furthest=4.0, steps_s=STEPS_S):
    """Speed, distance, retardation, step; some speeds in whole steps, some shortest stops."""
    random = np.random.default_rng(seed)
    for case in range(count):
        step_s, b = float(random.choice(steps_s)), random.uniform(0.1, 1.5)
        speed = random.uniform(0.01, 60.0)
        if case % 4 == 1:
            speed = b * step_s * float(random.integers(1, 8))
        shortest_m = shortest_stop(speed, b, step_s)
        room_m = shortest_m * random.uniform(1.0, furthest) + speed * step_s * random.random()
        yield speed, shortest_m if case % 4 == 2 else room_m, b, step_s


@pytest.mark.parametrize(("speed", "distance_m"), [(20.0, 200.0), (25.0, 325.0), (0.0, 0.0)])
def test_shortest_stop_brakes_fully_and_eases_in_the_last_step(as_run, speed, distance_m):
    assert as_run(shortest_stop)(speed, 1.0, 10.0) == pytest.approx(distance_m)


def test_shortest_stop_is_the_way_of_full_braking(as_run):
    for speed, _, b, step_s in random_stops(500, seed=3):
        expected_m = way_of_full_braking(speed, 0.0, b, step_s)
        assert as_run(shortest_stop)(speed, b, step_s) == pytest.approx(expected_m, rel=1e-9)


@pytest.mark.parametrize(
    ("speed", "distance_m", "speeds"),
    [
        (20.0, 200.0, [20, 10, 0]),
        (20.0, 400.0, [20, 20, 10, 0]),
        (20.0, 300.0, [20, 15, 5, 0]),
        (25.0, 325.0, [25, 15, 5, 0]),
        (5.0, 25.0, [5, 0]),
        (5.0, 50.0, [5, 2.5, 0]),
    ],
)
def test_train_holds_its_speed_then_brakes_in_one_block(as_run, speed, distance_m, speeds):
    plan = as_run(braking_plan)(speed, distance_m, 1.0, 10.0)
    planned = speeds_of(plan, speed, 1.0, 10.0)
    moving = [v for i, v in enumerate(planned) if i == 0 or v > 1e-9 or planned[i - 1] > 1e-9]
    assert moving == pytest.approx(speeds, abs=1e-9)


def test_plan_is_read_step_by_step(as_run):
    """Two steps held, a quarter, two full ones, a half, and it is over."""
    plan = (2, 0.25, 2, 0.5)
    fractions = [as_run(plan_fraction)(step, *plan) for step in range(6)]
    assert fractions == [0.0, 0.0, 0.25, 1.0, 1.0, 0.5]
    assert as_run(plan_length)(2, 2, 0.5) == 6
    assert as_run(plan_length)(2, 2, 0.0) == 5


@pytest.mark.parametrize("furthest", [1.001, 4.0, 100.0])
def test_train_stands_within_a_millimetre_of_its_stop_and_never_brakes_too_hard(as_run, furthest):
    for speed, distance_m, b, step_s in random_stops(1500, seed=4, furthest=furthest):
        speeds = speeds_of(as_run(braking_plan)(speed, distance_m, b, step_s), speed, b, step_s)
        error_m = positions([*speeds[:-1], 0.0], step_s)[-1] - distance_m
        retardation = -np.diff([*speeds[:-1], 0.0]) / step_s
        assert abs(error_m) < 1e-3
        assert min(speeds) > -1e-9 * b * step_s
        assert retardation.min() > -1e-9 * b
        assert retardation.max() <= b * (1.0 + 1e-9)


@pytest.mark.parametrize("error", [-1e-12, 0.0, 1e-12])
def test_whole_number_of_steps_that_rounding_has_moved_is_whole_again(as_run, error):
    """30 m/s, 450 m before its stop, takes three full steps, not four and not a fraction."""
    plan = as_run(braking_plan)(30.0 * (1.0 + error), 450.0, 1.0, 10.0)
    assert plan == pytest.approx((0, 1.0, 2, 0.0))


def test_shortage_by_rounding_counts_as_none(as_run):
    exact = as_run(braking_plan)(25.0, 325.0, 1.0, 10.0)
    assert as_run(braking_plan)(25.0, 325.0 - 1e-9, 1.0, 10.0) == pytest.approx(exact)


def test_plan_is_the_optimum_of_the_linear_program(as_run):
    """With three steps more than the plan takes; the shortest stops are for the next test."""
    for speed, distance_m, b, step_s in random_stops(300, seed=5, steps_s=STEPS_S[3:]):
        if distance_m < shortest_stop(speed, b, step_s) * (1.0 + 1e-6):
            continue
        plan = as_run(braking_plan)(speed, distance_m, b, step_s)
        places = np.array(positions(speeds_of(plan, speed, b, step_s), step_s))
        optimum = least_remaining_distances(speed, distance_m, b, step_s, places.size + 2)
        assert (distance_m - places).sum() == pytest.approx(optimum, rel=1e-6)


def test_linear_program_has_no_solution_below_the_shortest_stop_and_one_above():
    for speed, _, b, step_s in random_stops(60, seed=6, steps_s=STEPS_S[3:]):
        shortest_m = shortest_stop(speed, b, step_s)
        steps = math.ceil(speed / (b * step_s)) + 3
        for factor, solvable in ((0.5, False), (0.999, False), (1.001, True), (1.01, True)):
            optimum = least_remaining_distances(speed, factor * shortest_m, b, step_s, steps)
            assert (optimum is not None) == solvable


def test_highest_speed_is_the_last_one_from_which_the_train_can_stop(as_run):
    for speed, distance_m, b, step_s in random_stops(1000, seed=7):
        highest = as_run(highest_speed_that_stops)(speed, distance_m, b, step_s)

        def short_m(next_speed, speed=speed, distance_m=distance_m, b=b, step_s=step_s):
            way_m = step_s * (speed + next_speed) / 2.0
            return way_m + way_of_full_braking(next_speed, 0.0, b, step_s) - distance_m

        assert short_m(highest) < 1e-9 * max(1.0, distance_m)
        assert short_m(highest * (1.0 + 1e-6) + 1e-6) > 0.0


def test_train_at_a_stand_with_no_room_stays(as_run):
    assert as_run(highest_speed_that_stops)(0.0, 0.0, 1.0, 10.0) == 0.0


def test_standing_train_200_metres_before_its_stop_may_reach_15_metres_a_second(as_run):
    """0 → 15 → 5 → 0 m/s in steps of 10 s: 75 m + 100 m + 25 m = 200 m."""
    assert as_run(highest_speed_that_stops)(0.0, 200.0, 1.0, 10.0) == pytest.approx(15.0)
