"""Hand-worked motors used below: E_max = 770 V, v_base = 78 km/h, rotors 4 K_J = 10 750 kg.

U_di at 39 km/h                770 · 39/78              = 385 V
... former, at 10.5 kV         385 · 10.5/14            = 288.75 V
4 I_D, 169 kN at 60 km/h       169 000 · 21.6667/770    = 4755.4 A   (below base: v_base counts)
4 I_D, 127 kN at 100 km/h      127 000 · 27.7778/770    = 4581.5 A
F_motor, 100 kN at 0.05 m/s²   100 000 + 10 750 · 0.05  = 100 537.5 N
"""

import pytest

from tpss.physics.motor import (
    MotorModel,
    armature_current,
    line_voltage_factor,
    motor_current,
    motor_force,
    motor_voltage,
)

V_BASE = 78 / 3.6


def test_motors_turn_their_own_rotors_too(as_run):
    assert as_run(motor_force)(100_000.0, 0.05, 10_750.0) == pytest.approx(100_537.5)


def test_decelerating_rotors_relieve_the_motors_but_never_turn_them_into_brakes(as_run):
    assert as_run(motor_force)(100_000.0, -0.05, 10_750.0) == pytest.approx(99_462.5)
    assert as_run(motor_force)(100.0, -0.05, 10_750.0) == 0.0


@pytest.mark.parametrize(
    ("speed_kmh", "line_v", "model", "motor_v"),
    [
        (0.0, 15e3, MotorModel.NEW, 0.0),
        (39.0, 15e3, MotorModel.NEW, 385.0),
        (39.0, 10.5e3, MotorModel.NEW, 385.0),
        (78.0, 15e3, MotorModel.NEW, 770.0),
        (135.0, 15e3, MotorModel.NEW, 770.0),
        (39.0, 15e3, MotorModel.FORMER, 385.0),
        (39.0, 10.5e3, MotorModel.FORMER, 288.75),
        (135.0, 7e3, MotorModel.FORMER, 385.0),
    ],
)
def test_motor_voltage_follows_speed_and_formerly_the_line(
    as_run, speed_kmh, line_v, model, motor_v
):
    voltage = as_run(motor_voltage)(speed_kmh / 3.6, line_v, V_BASE, 770.0, model)
    assert voltage == pytest.approx(motor_v)


@pytest.mark.parametrize(
    ("line_v", "model", "factor"),
    [
        (10.5e3, MotorModel.FORMER, 0.75),
        (14e3, MotorModel.FORMER, 1.0),
        (15e3, MotorModel.FORMER, 1.0),
        (10.5e3, MotorModel.NEW, 1.0),
    ],
)
def test_only_the_former_model_heeds_the_line_and_only_below_14_kilovolt(
    as_run, line_v, model, factor
):
    assert as_run(line_voltage_factor)(line_v, model) == factor


@pytest.mark.parametrize(
    ("force_n", "speed_kmh", "current_a"), [(169e3, 60.0, 4755.41), (127e3, 100.0, 4581.53)]
)
def test_current_is_power_over_motor_voltage(as_run, force_n, speed_kmh, current_a):
    speed = speed_kmh / 3.6
    below = speed < V_BASE
    current = as_run(armature_current)(force_n, 1.0, speed, V_BASE, 770.0, below)
    motor_v = as_run(motor_voltage)(speed, 15e3, V_BASE, 770.0, MotorModel.NEW)
    assert current == pytest.approx(current_a, abs=0.01)
    assert current == pytest.approx(force_n * speed / motor_v)


def test_a_standing_train_draws_the_current_of_its_force(as_run):
    """175 kN · 21.6667 m/s / 770 V = 4924.2 A, with no division of zero power by zero voltage."""
    current = as_run(armature_current)(175e3, 1.0, 0.0, V_BASE, 770.0, True)
    assert current == pytest.approx(4924.24, abs=0.01)


def test_slip_adds_to_the_current(as_run):
    current = as_run(armature_current)(127e3, 1.02, 100 / 3.6, V_BASE, 770.0, False)
    assert current == pytest.approx(1.02 * 4581.53, abs=0.01)


def test_four_motors_share_the_current_which_the_former_model_ascribes_to_one(as_run):
    assert as_run(motor_current)(5000.0, MotorModel.NEW) == 1250.0
    assert as_run(motor_current)(5000.0, MotorModel.FORMER) == 5000.0
