"""How the original driver runs: the sequence of what he does first, then the numbers."""

from itertools import pairwise

import numpy as np
import pytest

import tpss

from scenarios import phases, run, short_line

LIMIT = 60 / 3.6
MOTORING, COASTING, BRAKING = 1, 2, 3
DOWNHILL = {"line.gradients": [{"from_km": 0.0, "permille": -8.0}]}


def aggressive(changes=None):
    return run({"simulation.driver": "aggressive", **(changes or {})})


def journey(result):
    """The train's steps before its last braking, which a plan decides."""
    train = result.dataset.sel(train="eastbound 1").dropna("time", subset=["tractive_force"])
    return train.isel(time=slice(0, int(np.argmax(train.position.to_numpy() > 19_000.0))))


def test_on_level_track_full_effort_and_coasting_take_turns_until_the_train_brakes_to_stop():
    seen = phases(aggressive(), "eastbound 1")
    assert seen[:2] == ["motoring", "coasting"]
    assert seen[-2:] == ["braking", "arrived"]
    assert len(seen) > 20
    assert set(pairwise(seen[:-2])) == {("motoring", "coasting"), ("coasting", "motoring")}


def test_speed_at_the_start_of_a_step_decides_what_the_driver_does():
    """Full effort below 60 km/h, coasting from there to 65 km/h, braking beyond."""
    train = journey(aggressive(DOWNHILL))
    v, state = train.speed.to_numpy(), train.train_state.to_numpy()
    assert (state[v < LIMIT] == MOTORING).all()
    assert (state[(v >= LIMIT) & (v <= LIMIT + 5 / 3.6)] == COASTING).all()
    assert (state[v > LIMIT + 5 / 3.6] == BRAKING).all()
    assert (state == BRAKING).any()


def test_brakes_bring_a_train_back_to_its_limit_in_one_step():
    """Downhill a coasting train gathers speed, from 60 km/h to beyond 65, again and again."""
    train = journey(aggressive(DOWNHILL))
    braking = np.flatnonzero(train.train_state.to_numpy() == BRAKING)
    assert len(braking) > 3
    v = train.speed.to_numpy()
    assert v[braking[:-1] + 1] == pytest.approx(LIMIT, rel=1e-15)
    assert v.max() < 66 / 3.6


def test_power_is_zero_or_that_of_full_effort_and_nothing_between():
    """Above 50 km/h the machine's 170 kN are at least 2.3 MW; the regulated driver takes 0.56 MW."""
    motors_w = (journey(aggressive()).active_power - 151_500.0) * 0.8
    fast = motors_w[(journey(aggressive()).speed > 50 / 3.6).to_numpy()]
    assert (np.isclose(fast, 0.0, atol=1e-6) | (fast > 2.3e6)).all()
    assert int((abs(np.diff(fast)) > 2.3e6).sum()) > 20


def test_coasting_train_slows_down_with_all_its_rotating_parts():
    """H = 0.05: a = -F_res / (m (1 + H)), eq. (2.11), with the locomotive's mass in it."""
    train = journey(aggressive({"trains.freight.rotating_mass_factor": 0.05}))
    coasting = train.isel(time=train.train_state.to_numpy() == COASTING)
    expected = -coasting.running_resistance / (1.47e6 * 1.05)
    assert coasting.acceleration.to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-9)


def test_motors_are_billed_in_full_where_the_rails_pass_on_less():
    """Adhesion with the speed in km/h, as printed, holds 147 kN at 60 km/h of the machine's 169 kN."""
    choices = {"simulation.adhesion_speed_unit": "km/h", "simulation.power_sampling": "start"}
    train = journey(aggressive(choices))
    full = train.isel(time=(train.speed > 59 / 3.6).to_numpy() & (train.tractive_force > 0).values)
    assert full.tractive_force.to_numpy() == pytest.approx(147.2e3, rel=5e-3)
    motor_n = (full.active_power - 151_500.0) * 0.8 / full.speed
    assert motor_n.to_numpy() == pytest.approx(169.2e3, rel=5e-3)
    current_a = motor_n * 78 / 3.6 / 770.0 / 4.0
    assert full.motor_current.to_numpy() == pytest.approx(current_a.to_numpy(), rel=1e-9)


def test_traction_balances_unless_rails_slip():
    """The mean speed of each step is billed; without slip every joule is accounted for."""
    assert aggressive().audit["traction_balance"] < 1e-12
    slipping = aggressive({"simulation.adhesion_speed_unit": "km/h"})
    assert slipping.audit["traction_balance"] > 0.05


@pytest.mark.parametrize("step_min", [0.05, 1.0])
def test_lower_limits_and_stops_ahead_are_met_exactly_all_the_same(step_min):
    limits = [(0.0, 80.0), (8.0, 40.0), (14.0, 70.0)]
    result = aggressive({
        "simulation.time_step_min": step_min,
        "line.speed_limits": [{"from_km": km, "speed_kmh": kmh} for km, kmh in limits],
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}],
    })  # fmt: skip
    train = result.dataset.sel(train="eastbound 1")
    x, v = train.position.to_numpy() / 1e3, train.speed.to_numpy() * 3.6
    # A step that passes the limit's position, not one that ends at it, begins at or below it.
    beyond = np.flatnonzero(x > 8.0 + 1e-9)[0]
    assert v[beyond - 1] <= 40 + 1e-9
    assert v[beyond] <= 40 + 1e-9
    assert 10.0 in x
    assert x[np.isfinite(x)][-1] == 20.0
    assert train.acceleration.min() >= -0.85 - 1e-12
    assert result.audit["stop_error_m"] < 1e-6


def test_train_above_its_limit_is_not_braked_for_one_that_is_no_lower():
    """The limit of 60 km/h, written twice, is one limit: at 10 km the train coasts on above it."""
    limits = [{"from_km": km, "speed_kmh": 60.0} for km in (0.0, 10.0)]
    twice, once = aggressive({"line.speed_limits": limits}), aggressive()
    assert twice.dataset.speed.identical(once.dataset.speed)


def test_train_may_be_placed_above_the_limit_that_its_driver_does_not_keep():
    placed = [{"position_km": 3.0, "speed_kmh": 64.0}]
    limits = [{"from_km": km, "speed_kmh": 60.0} for km in (0.0, 3.1)]
    result = aggressive({"traffic.0.initial_trains": placed, "line.speed_limits": limits})
    assert phases(result, "eastbound initial 1")[0] == "coasting"


def test_train_that_would_roll_back_in_a_minute_of_coasting_stalls():
    """Uphill at 11 per mille and 20 km/h, a minute takes 0.12 · 60 = 7 m/s of its 5.6 m/s away."""
    uphill = {
        "simulation.driver": "aggressive",
        "simulation.time_step_min": 1.0,
        "line.gradients": [{"from_km": 0.0, "permille": 0.0}, {"from_km": 2.0, "permille": 11.0}],
        "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 10.0}],
    }
    result = tpss.simulate(short_line(uphill))
    assert result.status == "stalled"
    assert "would roll back" in result.summary["problem"]
    assert result.dataset.speed.min() >= 0.0
