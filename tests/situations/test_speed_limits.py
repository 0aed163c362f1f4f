"""Profiles of several speed limits.

Rule: the train takes the largest acceleration after which every lower limit ahead can still be met, at
its position, in whole steps at the highest retardation; a step that passes a limit's position begins
and ends at or below it; a higher limit holds from the next instant.  `run` checks this rule, and the
others that hold for every train, in each of these runs.

The train of these tests weighs 100 t, so it reaches any limit within some hundred metres, and brakes
with 0.85 m/s² at most.
"""

import math

import numpy as np
import pytest

from scenarios import journey, limits, phases, run, stops

LIGHT = {"trains.freight.mass_t": 100.0}
STEPS_MIN = [0.01, 0.05, 0.3, 1.0, 2.0, 5.0]
FINE = {"simulation.time_step_min": 0.01}
"""Steps of 0.6 s: full braking lowers the speed by 0.51 m/s a step."""

BRAKING = 0.85


def kmh(speed: float) -> float:
    return speed / 3.6


def passing(way, place_m: float) -> int:
    """Number of the step that passes a place, counted from 0."""
    return int(np.flatnonzero(way.x > place_m + 1e-6)[0]) - 1


def test_a_train_accelerates_brakes_and_accelerates_from_limit_to_limit():
    """Between two of them it holds its speed by motor force."""
    result = run({**LIGHT, **FINE, **limits((0, 80), (4, 60), (8, 40), (12, 70), (15, 30))})
    assert phases(result) == [
        "motoring",  # to 80 km/h
        "braking",  # to 60
        "motoring",
        "braking",  # to 40
        "motoring",  # to 70
        "braking",  # to 30
        "motoring",
        "braking",  # to the stop
        "arrived",
    ]
    way = journey(result)
    for begin_km, limit_kmh in ((0, 80), (4, 60), (8, 40), (12, 70), (15, 30)):
        v = way.v[(way.x >= 1e3 * begin_km) & (way.x < 1e3 * begin_km + 3e3)]
        assert v.max() == pytest.approx(kmh(limit_kmh), rel=1e-9), begin_km


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_limits_are_kept_whatever_the_step(step_min):
    profile = limits((0, 80), (4, 60), (8, 40), (12, 70), (15, 30), (18, 50))
    result = run({**LIGHT, **profile, "simulation.time_step_min": step_min})
    assert result.status == "finished"


def test_braking_for_a_limit_begins_as_late_as_it_may():
    """From 80 to 60 km/h: (22.22² - 16.67²) / (2 · 0.85) = 127.1 m, and at most two steps of 13.3 m
    more, one because braking takes whole steps, one because a step ends before the limit."""
    way = journey(run({**LIGHT, **FINE, **limits((0, 80), (4, 60))}))
    begin = 4e3 - way.x[np.flatnonzero(way.a < 0.0)[0]]
    assert 127.1 <= begin <= 127.1 + 2 * 13.34


def test_the_steepest_of_several_limits_ahead_rules():
    """60 km/h at 10 km and 40 km/h 50 m later, which braking from 60 takes 90.8 m for: so the train
    passes 10 km with at most √(11.11² + 2 · 0.85 · 50) = 14.44 m/s, and little less."""
    way = journey(run({**LIGHT, **FINE, **limits((0, 100), (10.0, 60), (10.05, 40))}))
    highest = math.sqrt(kmh(40) ** 2 + 2 * BRAKING * 50.0)
    at_first = np.interp(10_000.0, way.x, way.v)
    assert highest - 2 * 0.51 < at_first <= highest
    assert way.v[passing(way, 10_050.0)] == pytest.approx(kmh(40), abs=0.51)


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_three_limits_closer_to_each_other_than_a_braking_distance(step_min):
    profile = limits((0, 100), (10.0, 60), (10.05, 40), (10.1, 20), (12.0, 100))
    run({**LIGHT, **profile, "simulation.time_step_min": step_min})


def test_a_lower_limit_shorter_than_a_step_is_not_jumped_over():
    """A minute at 60 km/h is a kilometre; for 100 m only 18 km/h are allowed."""
    profile = limits((0, 60), (10.0, 18), (10.1, 60))
    way = journey(run({**LIGHT, **profile, "simulation.time_step_min": 1.0}))
    k = passing(way, 10_000.0)
    assert max(way.v[k], way.v[k + 1]) <= kmh(18) + 1e-9
    assert way.v[k + 3 :].max() == pytest.approx(kmh(60))


def test_limits_that_rise_and_fall_within_one_step():
    """Whatever rises between them, the steps that pass 10.0 and 10.2 km keep 30 and 20 km/h."""
    profile = limits((0, 60), (10.0, 30), (10.1, 50), (10.2, 20), (10.3, 60))
    way = journey(run({**LIGHT, **profile, "simulation.time_step_min": 1.0}))
    for place_m, limit_kmh in ((10_000.0, 30), (10_200.0, 20)):
        k = passing(way, place_m)
        assert max(way.v[k], way.v[k + 1]) <= kmh(limit_kmh) + 1e-9


def test_a_higher_limit_holds_from_the_next_instant():
    """The step that passes 5 km ends at 40 km/h still; the one after it accelerates."""
    way = journey(run({**LIGHT, **limits((0, 40), (5.0, 80)), "simulation.time_step_min": 0.5}))
    k = passing(way, 5_000.0)
    assert (way.v[k], way.v[k + 1]) == (kmh(40), kmh(40))
    assert way.v[k + 2] > kmh(41)


def test_a_limit_behind_a_stop_does_not_slow_the_train_before_it():
    """10 km/h from a metre behind the stop on: up to the stop all is as without; then it is obeyed."""
    at_stop = {**LIGHT, **FINE, **stops((10.0, 1.0))}
    free, limited = (
        journey(run({**at_stop, **profile}))
        for profile in (limits((0, 80)), limits((0, 80), (10.001, 10)))
    )
    arrival = int(np.flatnonzero(free.x == 10_000.0)[0])
    assert (limited.x[: arrival + 1] == free.x[: arrival + 1]).all()
    behind = limited.x > 10_001.0
    assert limited.v[behind].max() == pytest.approx(kmh(10))


@pytest.mark.parametrize("place_km", [9.99, 9.999_999, 10.0, 10.000_001, 10.01])
@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_a_limit_close_to_a_stop(place_km, step_min):
    profile = limits((0, 80), (place_km, 10))
    step = {"simulation.time_step_min": step_min}
    result = run({**LIGHT, **profile, **stops((10.0, 3 * step_min)), **step})
    assert result.status == "finished"
    way = journey(result)
    assert (way.state[way.x == 10_000.0] == 4).sum() == 3


def test_a_limit_goes_before_a_braking_plan():
    """To stop from 80 km/h takes 290 m; 10 m before the stop only 10 km/h are allowed.  Without that
    the train would have √(2 · 0.85 · 10) = 4.1 m/s there.  It meets the limit, holds it, and stops."""
    at_stop = {**LIGHT, **FINE, **stops((10.0, 1.0))}
    result = run({**at_stop, **limits((0, 80), (9.99, 10))})
    assert phases(result)[:5] == ["motoring", "braking", "motoring", "braking", "dwelling"]
    way = journey(result)
    near = (way.x > 9_990.0 + 1e-6) & (way.x < 10_000.0)
    assert way.v[near][0] == pytest.approx(kmh(10))
    free = journey(run({**at_stop, **limits((0, 80))}))
    assert np.interp(9_990.0, free.x, free.v) == pytest.approx(math.sqrt(2 * BRAKING * 10), abs=0.3)


def test_a_limit_at_the_place_of_departure_holds_at_once():
    """The train starts at 10 km, from where 30 km/h are allowed; 80 km/h before it."""
    profile = limits((0, 80), (10.0, 30))
    way = journey(run({**LIGHT, **profile, "traffic.0.from": "Middle"}))
    assert way.x[0] == 10_000.0
    assert way.v.max() == kmh(30)


def test_the_lower_of_line_and_train_is_met_at_its_position():
    """The train may run 50 km/h; the line asks for 70, then 40, then 70."""
    profile = limits((0, 70), (8, 40), (12, 70))
    way = journey(run({**LIGHT, **FINE, **profile, "trains.freight.max_speed_kmh": 50.0}))
    assert way.v[way.x < 8e3].max() == kmh(50)
    assert way.v[(way.x >= 8e3) & (way.x < 12e3)].max() == pytest.approx(kmh(40), rel=1e-9)
    assert way.v[way.x >= 12e3].max() == kmh(50)


def test_a_limit_is_met_downhill_by_the_brakes():
    """On -12 per mille the brakes carry gravity beside the retardation."""
    profile = {**limits((0, 80), (10.0, 40)), "line.gradients.0.permille": -12.0}
    result = run({**LIGHT, **FINE, **profile})
    way = journey(result)
    hardest = int(np.nanargmax(way.braking))
    assert way.a[hardest] == pytest.approx(-BRAKING)
    inertia, weight = 100e3, 100e3 * 9.81
    resistance = float(result.dataset.running_resistance[hardest, 0])
    assert way.braking[hardest] == pytest.approx(BRAKING * inertia + 0.012 * weight - resistance)
