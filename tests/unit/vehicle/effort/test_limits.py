"""Hand-worked multiple unit used below: 200 kN, 2600 kW, pull-out limit from 108 km/h = 30 m/s.

knee: 2600/200 = 13 m/s = 46.8 km/h
at 20 m/s: 2600/20 = 130 kN;  at 30 m/s: 86.667 kN;  at 40 m/s: 2600/40 · 30/40 = 48.75 kN
"""

import math

import pytest

from tpss.vehicle.effort.limits import (
    EffortLimits,
    limited_force,
    steepest_slope,
    voltage_share,
)

from alternatives import central_difference


def limits(**values):
    return EffortLimits.array([EffortLimits.row(**values)])[0]


def unit(limit_speed_m_s=math.inf):
    return limits(highest_force_n=200e3, highest_power_w=2.6e6, limit_speed_m_s=limit_speed_m_s)


SAGGING = limits(zero_voltage_v=10e3, full_voltage_v=14e3)


@pytest.mark.parametrize(
    ("speed_m_s", "force_kn"),
    [(0.0, 200.0), (12.9, 200.0), (13.0, 200.0), (20.0, 130.0), (30.0, 86.6667), (40.0, 48.75)],
)
def test_force_is_constant_then_power_then_the_pull_out_limit(as_run, speed_m_s, force_kn):
    force = as_run(limited_force)(speed_m_s, unit(30.0))
    assert force == pytest.approx(force_kn * 1e3, rel=1e-6)


def test_without_a_pull_out_limit_power_stays_constant(as_run):
    assert as_run(limited_force)(40.0, unit()) == pytest.approx(65e3)


def test_a_pull_out_limit_below_the_knee_takes_force_where_it_falls_below_the_highest(as_run):
    """With 5 m/s: 2600 · 5/v² = 200 kN at v = √65 = 8.062 m/s; at 10 m/s 130 kN."""
    for speed_m_s, force_kn in ((5.0, 200.0), (8.06, 200.0), (10.0, 130.0)):
        force = as_run(limited_force)(speed_m_s, unit(5.0))
        assert force == pytest.approx(force_kn * 1e3)


@pytest.mark.parametrize(
    ("voltage_v", "share", "slope"),
    [
        (9e3, 0.0, 0.0),
        (10e3, 0.0, 0.0),
        (11e3, 0.25, 1 / 4e3),
        (13e3, 0.75, 1 / 4e3),
        (14e3, 1.0, 0.0),
        (16e3, 1.0, 0.0),
    ],
)
def test_force_falls_linearly_from_14_to_10_kilovolt(as_run, voltage_v, share, slope):
    assert as_run(voltage_share)(voltage_v, SAGGING) == pytest.approx((share, slope))


def test_without_voltages_there_is_no_dependence(as_run):
    for voltage_v in (1e3, 8e3, 16e3):
        assert as_run(voltage_share)(voltage_v, limits()) == (1.0, 0.0)


def test_the_slope_is_that_of_the_share(as_run):
    _, slope = as_run(voltage_share)(12.3e3, SAGGING)
    around = central_difference(lambda v: as_run(voltage_share)(v, SAGGING)[0], 12.3e3, 1.0)
    assert slope == pytest.approx(around, rel=1e-9)


def test_the_steepest_slope_is_that_of_the_fall(as_run):
    """130 kN over 4 kV."""
    assert as_run(steepest_slope)(130e3, SAGGING) == pytest.approx(32.5)
    assert as_run(steepest_slope)(130e3, limits()) == 0.0
