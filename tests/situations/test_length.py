"""Length: limits rise when the tail has passed, and all of a train lies on the gradient."""

import numpy as np
import pytest

import tpss

from scenarios import gradients, journey, limits, run, short_line

FREIGHT = {
    "tractive_effort": {"max_force_kn": 300.0, "max_power_kw": 6400.0},
    "mass_t": 1400.0,
    "adhesive_mass_t": 1400.0,
    "resistance_a_n": 16_800.0,
    "resistance_b_n_s_per_m": 0.0,
    "resistance_c_n_s2_per_m2": 42.0,
    "max_speed_kmh": 120.0,
    "max_retardation_m_s2": 0.35,
    "auxiliary_power_kw": 0.0,
    "power_factor": 1.0,
    "efficiency": 1.0,
}
RESTRICTIONS = limits(
    (0, 100), (4.0, 40), (4.3, 100), (9.0, 60), (9.2, 100), (14.0, 40), (14.1, 100)
)
HUMP = {**limits((0, 30)), **gradients((0, 0.0), (5.0, 30.0), (5.4, 0.0))}


def freight(length_m, **changes):
    return {"trains.freight": {**FREIGHT, "length_m": length_m}, **changes}


@pytest.mark.parametrize(("length_m", "trip_s"), [(0.0, 956.4), (700.0, 1048.8)])
def test_three_short_restrictions_hold_until_the_tail_has_passed(length_m, trip_s):
    """Trip times of an integration over the way; a step here is 0.6 s."""
    result = run(freight(length_m, **RESTRICTIONS, **{"simulation.time_step_min": 0.01}))
    assert 60.0 * result.trips.trip_min[0] == pytest.approx(trip_s, abs=2.0)


@pytest.mark.parametrize("braking", ["whole-steps", "within-step"])
def test_a_train_accelerates_once_its_tail_has_left_the_restriction(braking):
    way = journey(run(freight(700.0, **RESTRICTIONS, **{"simulation.braking": braking})))
    held = (way.x > 4000.0) & (way.x < 5000.0)
    assert way.v[held].max() <= 40.0 / 3.6 + 1e-9
    assert way.v[(way.x > 5000.0) & (way.x < 5300.0)].max() > 45.0 / 3.6


def test_a_long_train_goes_over_a_hump_that_stalls_a_point():
    """30 per mille take 412 kN of 300 kN; 400 m of them under 700 m are 17 per mille, 235 kN."""
    assert tpss.simulate(short_line(freight(0.0, **HUMP))).status == "stalled"
    result = run(freight(700.0, **HUMP))
    way, steepest_n = journey(result), float(result.dataset.gradient_force.max())
    assert steepest_n == pytest.approx(1.4e6 * 9.81 * 0.030 * 400.0 / 700.0, rel=1e-3)
    assert way.v[(way.x > 5000.0) & (way.x < 6100.0)].min() > 25.0 / 3.6


def test_trains_of_several_lengths_see_the_line_by_their_own():
    """A point behind a long train goes as behind a point; its machine does not heed the voltage."""
    both = {
        "trains.point": FREIGHT,
        "traffic": [
            {"name": name, "train": train, "from": "West", "to": "East", "departures_min": [start]}
            for name, train, start in (("long", "freight", 0.0), ("short", "point", 5.0))
        ],
    }
    profile = RESTRICTIONS | gradients((0, 0.0), (6.0, 8.0), (7.0, -3.0))
    results = [run(freight(length_m, **profile, **both)) for length_m in (0.0, 700.0)]
    behind, long = (
        [journey(result, train).x[:220] for result in results] for train in ("short 1", "long 1")
    )
    assert behind[0][-1] > 12_000.0
    assert np.array_equal(*behind)
    assert (long[1][200:] < long[0][200:]).all()
