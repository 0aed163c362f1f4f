"""Hand-worked train used below: 1470 t at 60 km/h, R = 33 717 N, steps of 60 s.

to 70 km/h in one step: a = 10/3.6/60 = 0.0462963 m/s²
F = 0.0462963 · 1 470 000 + 33 717 = 68 055.6 + 33 717 = 101 772.6 N
"""

import pytest

from tpss.driving.regulated import ideal_force, wanted_acceleration


def test_ten_kilometres_an_hour_more_in_a_minute(as_run):
    assert as_run(wanted_acceleration)(60 / 3.6, 70 / 3.6, 60.0) == pytest.approx(
        0.0462963, abs=1e-7
    )


def test_it_takes_102_kilonewton(as_run):
    assert as_run(ideal_force)(0.0462963, 33_717.0, 1.47e6) == pytest.approx(101_772.6, abs=0.1)


def test_holding_the_speed_takes_the_resistance(as_run):
    a = as_run(wanted_acceleration)(60 / 3.6, 60 / 3.6, 60.0)
    assert as_run(ideal_force)(a, 33_717.0, 1.47e6) == 33_717.0


def test_slowing_faster_than_the_resistance_does_takes_the_brakes(as_run):
    """To 50 km/h in a minute: -68 055.6 + 33 717 N is negative."""
    a = as_run(wanted_acceleration)(60 / 3.6, 50 / 3.6, 60.0)
    assert as_run(ideal_force)(a, 33_717.0, 1.47e6) == pytest.approx(-34_338.6, abs=0.1)
