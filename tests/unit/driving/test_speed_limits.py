"""Lower speed limits ahead, against stepping through the train's motion.

Hand-worked train used below: b = 1 m/s², h = 10 s, so one step of full braking takes 10 m/s.

    from 30 to 15 m/s: two steps, 30 → 20 → 10 m/s: 250 m + 150 m = 400 m
    at 30 m/s, 500 m before a limit of 15 m/s, 25 m/s is the highest speed after the next step:
    30 → 25 → 15 m/s takes 275 m + 200 m = 475 m, but from more than 25 m/s two steps are needed,
    and 30 → 25.1 → 15.1 → 5.1 m/s takes 275.5 m + 201 m + 101 m = 577.5 m

and where steps hold their speed first, from 30 to 15 m/s in 15 s, so in 20 s:

    5 s at 30 m/s, then 15 s with the brakes: 150 m + 15 s · 22.5 m/s = 487.5 m
    at 30 m/s, 687.5 m before the limit, 25 m/s: 5 s at 30 m/s and 5 s · 27.5 m/s, then 25 → 15 m/s in
    10 s: 150 m + 137.5 m + 200 m = 487.5 m; from 26 m/s on in two steps, 30 → 26 m/s in 292 m, then 9 s
    at 26 m/s and 11 s · 20.5 m/s = 459.5 m: 751.5 m
"""

from itertools import pairwise

import numpy as np
import pytest

from tpss.driving.speed_limits import (
    HOLD_FIRST,
    OUT_OF_REACH,
    UNIFORM,
    can_meet_limit,
    highest_speed_before_limit,
    latest_slowing_distance,
    respect_limits_ahead,
    slowing_distance,
)
from tpss.numerics.staircase import index_at

from alternatives import full_braking, positions, way_of_full_braking

STEPS_S = [0.6, 1.0, 6.0, 30.0, 60.0, 300.0]


@pytest.mark.parametrize(
    ("speed", "limit", "distance_m"),
    [
        (30.0, 15.0, 400.0),
        (30.0, 20.0, 250.0),
        (15.0, 15.0, 0.0),
        (10.0, 15.0, 0.0),
        (25.0, 1.0, 325.0),  # to a stand: the third step ends at 0, above the limit before
    ],
)
def test_slowing_takes_whole_steps(as_run, speed, limit, distance_m):
    assert as_run(slowing_distance)(speed, limit, 1.0, 10.0) == pytest.approx(distance_m)


def test_slowing_distance_is_the_way_of_full_braking(as_run):
    random = np.random.default_rng(8)
    for case in range(2000):
        step_s, b = float(random.choice(STEPS_S)), random.uniform(0.1, 1.5)
        limit = random.uniform(0.0, 40.0)
        whole = b * step_s * float(random.integers(0, 6))
        speed = limit + (whole if case % 3 == 0 else random.uniform(-5.0, 40.0))
        speed = max(0.0, speed)
        expected_m = way_of_full_braking(speed, limit, b, step_s)
        given_m = as_run(slowing_distance)(speed, limit, b, step_s)
        assert given_m == pytest.approx(expected_m, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("next_speed", "distance_m", "possible"),
    [
        (25.0, 475.0, True),  # 275 m, then 25 → 15 m/s in 200 m
        (25.0, 474.0, False),
        (15.0, 225.0, True),  # 30 → 15 m/s in 225 m
        (15.0, 224.0, False),  # begins above the limit and passes its position
    ],
)
def test_step_and_slowing_after_it_fit_before_the_limit(as_run, next_speed, distance_m, possible):
    assert (
        as_run(can_meet_limit)(30.0, next_speed, distance_m, 15.0, 1.0, 10.0, UNIFORM) == possible
    )


@pytest.mark.parametrize("manner", [UNIFORM, HOLD_FIRST])
def test_limit_means_nothing_to_a_train_below_it(as_run, manner):
    assert as_run(can_meet_limit)(10.0, 15.0, 0.0, 15.0, 1.0, 10.0, manner)
    assert not as_run(can_meet_limit)(10.0, 15.1, 100.0, 15.0, 1.0, 10.0, manner)


def test_highest_speed_before_a_limit_by_hand(as_run):
    highest = as_run(highest_speed_before_limit)(30.0, 40.0, 500.0, 15.0, 1.0, 10.0, UNIFORM)
    assert highest == pytest.approx(25.0, abs=1e-9)


@pytest.mark.parametrize("manner", [UNIFORM, HOLD_FIRST])
@pytest.mark.parametrize("excess", [0.0, 1e-15, 2e-13])
def test_train_above_a_limit_by_rounding_alone_holds_it(as_run, excess, manner):
    """At 20 m/s, 50 m before a limit of 20 m/s: no reason to brake, the less to a stand."""
    speed = 20.0 * (1.0 + excess)
    kept = as_run(highest_speed_before_limit)(speed, speed, 50.0, 20.0, 0.85, 6.0, manner)
    assert kept == pytest.approx(20.0, rel=1e-9)


def random_approaches(count):
    """Speed, wanted speed, distance, limit, retardation, step, from where the limit can be met."""
    random = np.random.default_rng(9)
    for _ in range(count):
        step_s, b = float(random.choice(STEPS_S)), random.uniform(0.1, 1.5)
        limit, speed = random.uniform(0.5, 40.0), random.uniform(0.0, 50.0)
        needed_m = way_of_full_braking(speed, limit, b, step_s)
        distance_m = (
            needed_m + random.choice([0.0, 1.0]) * random.uniform(0.0, 3.0) * speed * step_s
        )
        yield speed, speed + random.uniform(0.0, 10.0), distance_m, limit, b, step_s


def test_after_the_highest_speed_the_limit_is_within_reach_and_above_it_no_more(as_run):
    for speed, wanted, distance_m, limit, b, step_s in random_approaches(600):

        def short_m(after, v=speed, limit=limit, d=distance_m, b=b, h=step_s):
            if max(v, after) <= limit + 1e-9:
                return 0.0
            return h * (v + after) / 2.0 + way_of_full_braking(after, limit, b, h) - d

        highest = as_run(highest_speed_before_limit)(
            speed, wanted, distance_m, limit, b, step_s, UNIFORM
        )
        assert short_m(highest) < 1e-6
        assert highest >= min(wanted, max(0.0, speed - b * step_s)) - 1e-9 * b * step_s
        assert highest == wanted or short_m(highest + 1e-6) > 0.0


def way_that_holds_first(speed, after, b, step_s):
    """Way of a step that brakes at its end, phase by phase; of one that does not, uniformly."""
    slowing_s = max(0.0, speed - after) / b
    if slowing_s == 0.0:
        return step_s * (speed + after) / 2.0
    return speed * (step_s - slowing_s) + (speed + after) / 2.0 * slowing_s


@pytest.mark.parametrize(
    ("speed", "limit", "distance_m"),
    [
        (30.0, 15.0, 487.5),
        (30.0, 20.0, 250.0),  # with the brakes all along, as in a uniform step
        (25.0, 24.0, 249.5),  # 9 s at 25 m/s, 1 s · 24.5 m/s
        (15.0, 15.0, 0.0),
        (10.0, 15.0, 0.0),
    ],
)
def test_slowing_that_holds_first_ends_at_the_limit(as_run, speed, limit, distance_m):
    given = as_run(latest_slowing_distance)(speed, limit, 1.0, 10.0)
    assert given == pytest.approx(distance_m)


@pytest.mark.parametrize(
    ("distance_m", "highest"),
    [
        (487.5, 25.0),
        (487.4, 24.980_1),  # 300 - (30 - v')²/2 + 10 v' - (v' - 15)²/2 = 487.4
        (751.5, 26.0),
        (900.0, 30.0),
    ],
)
def test_highest_speed_where_the_speed_is_held_first(as_run, distance_m, highest):
    given = as_run(highest_speed_before_limit)(30.0, 30.0, distance_m, 15.0, 1.0, 10.0, HOLD_FIRST)
    assert given == pytest.approx(highest, abs=1e-4)


def test_a_limit_too_near_for_steps_that_hold_first_is_out_of_reach(as_run):
    """30 → 20 m/s takes 250 m, then 5 s at 20 m/s and 5 s · 17.5 m/s: 187.5 m more."""
    reach = as_run(highest_speed_before_limit)
    assert reach(30.0, 30.0, 437.4, 15.0, 1.0, 10.0, HOLD_FIRST) == OUT_OF_REACH
    assert reach(30.0, 30.0, 437.6, 15.0, 1.0, 10.0, HOLD_FIRST) >= 20.0
    assert reach(30.0, 30.0, 437.4, 15.0, 1.0, 10.0, UNIFORM) >= 20.0


def random_lines(count):
    """Positions and limits of a line, retardation and step of a train."""
    random = np.random.default_rng(10)
    for _ in range(count):
        limits = random.integers(2, 8)
        step_s = float(random.choice(STEPS_S))
        from_m = np.sort(random.uniform(0.0, 400.0 * step_s + 4000.0, limits))
        from_m[0] = 0.0
        yield from_m, random.uniform(3.0, 50.0, limits), random.uniform(0.1, 1.5), step_s


def drive(heed, from_m, limit, b, step_s, manner):
    """Speeds and positions of a train that accelerates at 0.3 m/s² where the limits let it."""
    speeds, places = [0.0], [0.0]
    while places[-1] < from_m[-1] + 2000.0:
        here = limit[index_at(places[-1], from_m)]
        wanted = min(here, speeds[-1] + 0.3 * step_s)
        speeds.append(heed(places[-1], speeds[-1], wanted, from_m, limit, b, step_s, manner))
        way_m = positions(speeds[-2:], step_s)[-1]
        if manner == HOLD_FIRST:
            assert speeds[-1] >= min(speeds[-2], limit.min())
            way_m = way_that_holds_first(*speeds[-2:], b, step_s)
        places.append(places[-1] + way_m)
    return speeds, places


@pytest.mark.parametrize("manner", [UNIFORM, HOLD_FIRST])
def test_train_that_heeds_its_limits_never_passes_one_too_fast_nor_brakes_too_hard(as_run, manner):
    for from_m, limit, b, step_s in random_lines(100):
        speeds, places = drive(as_run(respect_limits_ahead), from_m, limit, b, step_s, manner)
        assert (-np.diff(speeds)).max() <= b * step_s * (1.0 + 1e-8)
        for steps_speeds, (begin_m, end_m) in zip(pairwise(speeds), pairwise(places), strict=True):
            passed = limit[(from_m > begin_m + 1e-6) & (from_m < end_m - 1e-6)]
            assert max(steps_speeds) <= passed.min(initial=np.inf) + 1e-9


def test_line_without_a_lower_limit_leaves_the_wish_alone(as_run):
    rising = np.array([0.0, 1000.0]), np.array([20.0, 30.0])
    assert as_run(respect_limits_ahead)(900.0, 20.0, 20.0, *rising, 1.0, 10.0, UNIFORM) == 20.0


def test_the_more_demanding_of_two_limits_rules(as_run):
    """15 m/s in 500 m alone would allow 25 m/s; 1 m/s in 520 m allows less."""
    from_m, limit = np.array([0.0, 500.0, 520.0]), np.array([50.0, 15.0, 1.0])
    given = as_run(respect_limits_ahead)(0.0, 30.0, 40.0, from_m, limit, 1.0, 10.0, UNIFORM)
    alone = as_run(highest_speed_before_limit)(30.0, 40.0, 520.0, 1.0, 1.0, 10.0, UNIFORM)
    assert given == pytest.approx(alone, abs=1e-9)
    assert given < 25.0


def test_full_braking_ends_at_or_below_the_limit():
    """The twin itself: 30 → 20 → 10 m/s."""
    assert full_braking(30.0, 15.0, 1.0, 10.0) == [30.0, 20.0, 10.0]
