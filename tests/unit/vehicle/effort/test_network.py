"""The tractive-effort network against values worked out from the printed tables, unit by unit."""

import itertools

import numpy as np
import pytest

from tpss.numerics.series import SCRATCH_SHAPE, Series, series_at
from tpss.vehicle.effort.network import (
    VOLTAGE,
    effort_outside_training,
    motor_force_series,
)
from vehicles import NETWORKS

from alternatives import central_difference

NETWORK = NETWORKS.tractive_effort

# speed [km/h], line voltage [kV], highest current [A], force [N]
TABLE = [
    (0, 15, 1250, 175057.05608980704),
    (60, 15, 1250, 169170.16003530248),
    (78, 16.5, 1250, 168634.55743625693),
    (100, 15, 1250, 127029.79612075108),
    (100, 15, 2080, 146061.69544507223),
    (0, 16.5, 2080, 290978.85165823676),
    (78, 16.5, 2080, 238200.44104352855),
    (60, 10.5, 2080, 197311.66573362658),
    (135, 13.5, 500, 31820.56640902009),
    (0, 15, 0, 2749.0769103857),
    (250, 16.5, 2080, -8.224422082275865),
    (40, 13.5, 350, 44329.59911663697),
]
CURVES = list(itertools.product([0, 40, 85, 120, 160], [10.5, 13.5, 16.5], [350, 1250, 2080]))


def effort(as_run, speed_kmh, voltage_kv, current_a):
    series = Series.blank(1)[0]
    as_run(motor_force_series)(
        speed_kmh / 3.6,
        voltage_kv * 1e3,
        float(current_a),
        NETWORK,
        np.zeros(SCRATCH_SHAPE),
        series,
    )
    return as_run(series_at)(voltage_kv * 1e3, series)


@pytest.mark.parametrize(("speed_kmh", "voltage_kv", "current_a", "force_n"), TABLE)
def test_network_reproduces_the_printed_tables(as_run, speed_kmh, voltage_kv, current_a, force_n):
    force, _ = effort(as_run, speed_kmh, voltage_kv, current_a)
    assert force == pytest.approx(force_n, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize(("speed_kmh", "voltage_kv", "current_a"), CURVES)
def test_slope_is_that_of_the_force_over_voltage(as_run, speed_kmh, voltage_kv, current_a):
    _, slope = effort(as_run, speed_kmh, voltage_kv, current_a)
    expected = central_difference(
        lambda v: effort(as_run, speed_kmh, v / 1e3, current_a)[0], voltage_kv * 1e3, 1.0
    )
    assert slope == pytest.approx(expected, rel=1e-5, abs=1e-5)


def test_no_slope_is_steeper_than_the_bound(as_run):
    bound = NETWORK.steepest[VOLTAGE]
    assert all(abs(effort(as_run, *point)[1]) <= bound for point in CURVES)


@pytest.mark.parametrize("voltage_kv", [10.5, 13.5, 16.5])
def test_curves_meet_the_ends_that_the_thesis_states(as_run, voltage_kv):
    """No current, no force; 291.87 kN at standstill with 2080 A; no force from 210 km/h on."""
    assert effort(as_run, 50, voltage_kv, 0)[0] == pytest.approx(0.0, abs=4.5e3)
    assert effort(as_run, 0, voltage_kv, 2080)[0] == pytest.approx(291.87e3, abs=2e3)
    assert effort(as_run, 210, voltage_kv, 2080)[0] == pytest.approx(0.0, abs=2e3)


@pytest.mark.parametrize(
    ("speed_kmh", "voltage_kv", "current_a", "extrapolates"),
    [
        (100, 15, 1250, False),
        (251, 15, 1250, True),
        (100, 10.4, 1250, True),
        (100, 16.6, 1250, True),
        (100, 15, 2081, True),
    ],
)
def test_extrapolation_is_noticed(as_run, speed_kmh, voltage_kv, current_a, extrapolates):
    noticed = as_run(effort_outside_training)(
        speed_kmh / 3.6, voltage_kv * 1e3, float(current_a), NETWORK
    )
    assert noticed == extrapolates
