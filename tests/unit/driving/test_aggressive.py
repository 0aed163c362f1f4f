"""The original driver's rule at a limit of 60 km/h; speeds after the step at hand are 70, 58 and 40."""

import pytest

from tpss.driving.aggressive import aggressive_force, aggressive_speed

LIMIT = 60 / 3.6
FASTEST, COASTING, SLOWEST = 70 / 3.6, 58 / 3.6, 40 / 3.6


@pytest.mark.parametrize(
    ("speed_kmh", "aim"),
    [
        (0.0, FASTEST),
        (59.999, FASTEST),
        (60.0, COASTING),  # full effort is for a speed "inferior to the speed limit"
        (64.999, COASTING),
    ],
)
def test_full_effort_below_the_limit_and_coasting_up_to_5_km_h_above_it(as_run, speed_kmh, aim):
    assert as_run(aggressive_speed)(speed_kmh / 3.6, LIMIT, FASTEST, COASTING, SLOWEST) == aim


def test_braking_beyond_reaches_the_limit_at_the_next_step(as_run):
    gathering = 67 / 3.6
    assert as_run(aggressive_speed)(65.001 / 3.6, LIMIT, FASTEST, gathering, SLOWEST) == LIMIT


def test_brakes_stay_off_where_resistance_alone_slows_the_train_to_its_limit(as_run):
    assert as_run(aggressive_speed)(66 / 3.6, LIMIT, FASTEST, COASTING, SLOWEST) == COASTING


def test_brakes_give_no_more_than_the_highest_retardation(as_run):
    slowest = gathering = 65.9 / 3.6
    given = as_run(aggressive_speed)(66 / 3.6, LIMIT, FASTEST, gathering + 0.1, slowest)
    assert given == slowest


@pytest.mark.parametrize(("target", "force_n"), [(FASTEST, 9e9), (COASTING, 0.0), (50 / 3.6, -7.0)])
def test_force_is_all_or_nothing_unless_something_else_sets_the_target(as_run, target, force_n):
    assert as_run(aggressive_force)(target, FASTEST, COASTING, -7.0, 9e9) == force_n
