"""A driver who spares the motors allows just the current after which they are as warm as they may be."""

import math

import pytest

from tpss.physics.motor import MOTORS_OF_LOCOMOTIVE, armature_current
from tpss.vehicle.billing import billed_power, force_of_current, motors_current
from tpss.vehicle.spared_motors import SparedMotors, allowed_current, state_after_step
from vehicles import demand_at, kind_of

TIME_CONSTANT_S = -360.0 / math.log1p(-1.0 / (2080.0 / 1250.0) ** 2)


def motors(initial_state: float = 0.0):
    return SparedMotors.array(
        [SparedMotors.row(
            continuous_a=1250.0,
            short_time_load=2080.0 / 1250.0,
            time_constant_s=TIME_CONSTANT_S,
            initial_state=initial_state,
        )]
    )[0]  # fmt: skip


def test_a_cold_motor_may_take_its_short_time_current_for_just_its_short_time(as_run):
    """In one step of six minutes 2080 A bring θ from 0 to 1; in a longer one less is allowed."""
    assert as_run(allowed_current)(0.0, 360.0, motors()) == pytest.approx(
        MOTORS_OF_LOCOMOTIVE * 2080.0
    )
    longer = as_run(allowed_current)(0.0, 361.0, motors())
    assert 0.99 * 2080.0 < longer / MOTORS_OF_LOCOMOTIVE < 2080.0
    after = as_run(state_after_step)(0.0, MOTORS_OF_LOCOMOTIVE * 2080.0, 360.0, motors())
    assert after == pytest.approx(1.0, rel=1e-12)


def test_a_motor_at_its_rated_temperature_may_take_its_continuous_current(as_run):
    assert as_run(allowed_current)(1.0, 7.0, motors()) == pytest.approx(
        MOTORS_OF_LOCOMOTIVE * 1250.0
    )
    assert as_run(state_after_step)(1.0, MOTORS_OF_LOCOMOTIVE * 1250.0, 7.0, motors()) == 1.0


@pytest.mark.parametrize("state", [0.0, 0.3, 0.9, 0.999, 1.0])
@pytest.mark.parametrize("step_s", [0.1, 6.0, 60.0, 600.0])
def test_after_what_is_allowed_no_motor_is_too_hot(as_run, state, step_s):
    """θ' = 1, or less where the short-time current is what limits."""
    allowed_a = as_run(allowed_current)(state, step_s, motors())
    after = as_run(state_after_step)(state, allowed_a, step_s, motors())
    if allowed_a < MOTORS_OF_LOCOMOTIVE * 2080.0 * (1.0 - 1e-12):
        assert after == pytest.approx(1.0, rel=1e-12)
    else:
        assert allowed_a == pytest.approx(MOTORS_OF_LOCOMOTIVE * 2080.0)
        assert after <= 1.0 + 1e-12


@pytest.mark.parametrize("weight_s", [0.0, 3.0, 30.0], ids=["start", "mean", "long"])
@pytest.mark.parametrize("resistance_n", [-400e3, 0.0, 80e3])
@pytest.mark.parametrize("speed_kmh", [0.0, 50.0, 80.0, 120.0])
def test_the_force_of_a_current_is_billed_with_that_current(
    as_run, speed_kmh, resistance_n, weight_s
):
    kind, points = kind_of(max_motor_current_a=2080.0)
    train = demand_at(
        speed_kmh, kind, points,
        resistance_n=resistance_n, mean_speed_weight_s=weight_s, adhesion_n=1e9,
    )  # fmt: skip
    force_n = as_run(force_of_current)(5000.0, train.speed_m_s, resistance_n, weight_s, kind)
    ratio = kind.rotor_mass_kg / kind.inertia_kg
    motor_n = force_n * (1.0 + ratio) - ratio * resistance_n
    if force_n == 0.0:  # the rotors alone, which the gradient accelerates, take more
        assert motor_n >= 0.0
        return
    _, _, billed_m_s, _ = as_run(billed_power)(motor_n, 1.0, kind, train)
    found_a = as_run(motors_current)(motor_n, billed_m_s, 1.0, kind, train)
    assert found_a == pytest.approx(5000.0, rel=1e-12)


def test_without_a_current_there_is_no_force(as_run):
    kind, _ = kind_of(max_motor_current_a=2080.0)
    assert as_run(force_of_current)(0.0, 10.0, 1e4, 30.0, kind) == 0.0
    by_hand = as_run(armature_current)(1e5, kind.slip_factor, 10.0, kind.base_speed_m_s,
                                       kind.highest_motor_voltage_v, True)  # fmt: skip
    motor_n = as_run(force_of_current)(by_hand, 10.0, 0.0, 0.0, kind)
    assert motor_n * (1.0 + kind.rotor_mass_kg / kind.inertia_kg) == pytest.approx(1e5)
