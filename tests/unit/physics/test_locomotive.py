"""Hand-worked train used below: 1470 t on level track at 60 km/h, R = 33 717 N.

At the machine's limit F_max = 169 170 N the rotors, 10 750 kg, take their share:

    c/M = 10 750/1 470 000 = 0.00731293
    F = (169 170 + 0.00731293 · 33 717)/1.00731293 = 168 186.6 N
    a = (168 186.6 - 33 717)/1 470 000 = 0.0914759 m/s²;  F + 10 750 a = 169 170 N again

    P_motor = 100 000 N · 20 m/s · 1.02 = 2.04 MW;  P_D = 2.04 MW/0.8 + 151.5 kW = 2.7015 MW
"""

import pytest

from tpss.physics.locomotive import acceleration, active_power, machine_force, motor_power

RESISTANCE_N = 33_717.0


def test_rotors_take_their_share_of_the_machine_limit(as_run):
    force = as_run(machine_force)(169_170.0, RESISTANCE_N, 10_750.0, 1.47e6)
    a = as_run(acceleration)(force, RESISTANCE_N, 1.47e6)
    assert force == pytest.approx(168_186.6, abs=0.1)
    assert a == pytest.approx(0.0914759, abs=1e-7)
    assert force + 10_750.0 * a == pytest.approx(169_170.0)


def test_slip_turns_the_rotors_faster_than_the_train_runs(as_run):
    assert as_run(motor_power)(100e3, 20.0, 1.02) == pytest.approx(2.04e6)


def test_efficiency_and_auxiliaries_come_on_top_of_the_motors(as_run):
    assert as_run(active_power)(2.04e6, 1.0 / 0.8, 151.5e3) == pytest.approx(2.7015e6)
