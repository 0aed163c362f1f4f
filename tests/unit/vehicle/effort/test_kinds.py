"""What the motors give at most, by each of the ways to say it, against scipy and by hand."""

import math

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import tpss.scenario.machine
from tpss.vehicle.demand import certify_free_band, update_speed_terms, wheel_force
from tpss.vehicle.effort.kinds import effort_extrapolates, highest_force, update_effort
from tpss.vehicle.effort.table import MOST_VOLTAGES
from vehicles import SCRATCH, demand_at
from vehicles import kind_of as kind_with

from alternatives import central_difference

SPEEDS, VOLTAGES, CURRENTS = [0, 40, 80, 160], [11, 13.5, 15, 16.5], [500, 1250, 2000]
FORCES = [
    [
        [f0 * u / 15 * (c / 1250) ** 0.5, 0.9 * f0 * u / 15, 0.5 * f0 * (u / 15) ** 2, 0.0]
        for u in VOLTAGES
    ]
    for c, f0 in zip(CURRENTS, (120.0, 200.0, 260.0), strict=True)
]
ROW = {"speed_kmh": SPEEDS, "force_kn": FORCES[1][2]}
ROWS = {"speed_kmh": SPEEDS, "voltage_kv": VOLTAGES, "force_kn": FORCES[1]}
BLOCKS = {**ROWS, "motor_current_a": CURRENTS, "force_kn": FORCES}
LIMITS = {"max_force_kn": 200.0, "max_power_kw": 2600.0}
SAGGING = {**LIMITS, "full_voltage_kv": 14.0, "zero_voltage_kv": 10.0}
EFFORTS = {"network": "Rc4", "row": ROW, "rows": ROWS, "blocks": BLOCKS, "limits": LIMITS,
           "sagging": SAGGING}  # fmt: skip


def kind_of(effort, **more):
    """A train of the short line with another tractive effort: its record, and the curves' points."""
    return kind_with(**{"tractive_effort": effort, "power_factor": 0.9, **more})


def train_at(speed_kmh, kind, points, as_run, cap_n=1e6, resistance_n=0.0, voltage_v=15e3):
    return demand_at(
        speed_kmh, kind, points, as_run(update_speed_terms),
        force_cap_n=cap_n, resistance_n=resistance_n, voltage_v=voltage_v,
    )  # fmt: skip


def force_at(as_run, voltage_v, kind, train):
    """Largest force of all motors, and its slope."""
    return as_run(highest_force)(
        voltage_v,
        train.speed_m_s,
        kind.effort,
        train.effort,
        kind.networks.tractive_effort,
        SCRATCH,
    )


def test_a_record_has_room_for_as_many_voltages_as_a_scenario_may_give():
    assert tpss.scenario.machine.MOST_VOLTAGES == MOST_VOLTAGES


@pytest.mark.parametrize("speed_kmh", [0.0, 10.0, 40.0, 65.0, 159.0])
@pytest.mark.parametrize("voltage_kv", [11.1, 12.0, 14.1, 15.0, 16.4])
@pytest.mark.parametrize("current_a", [500.0, 800.0, 1250.0, 1999.0])
def test_a_table_is_interpolated_in_current_then_speed_then_voltage(
    as_run, speed_kmh, voltage_kv, current_a
):
    kind, points = kind_of(BLOCKS, max_motor_current_a=current_a)
    train = train_at(speed_kmh, kind, points, as_run)
    force, slope = force_at(as_run, voltage_kv * 1e3, kind, train)
    at_current = PchipInterpolator(CURRENTS, np.array(FORCES), axis=0)(current_a)
    at_speed = PchipInterpolator(SPEEDS, at_current, axis=1)(speed_kmh)
    over_voltage = PchipInterpolator(np.array(VOLTAGES) * 1e3, at_speed * 1e3)
    assert force == pytest.approx(over_voltage(voltage_kv * 1e3), rel=1e-10, abs=1e-8)
    assert slope == pytest.approx(over_voltage.derivative()(voltage_kv * 1e3), rel=1e-9, abs=1e-9)


def test_a_table_of_one_row_does_not_depend_on_the_voltage(as_run):
    """At 80 km/h half of 200 kN."""
    kind, points = kind_of(ROW)
    train = train_at(80.0, kind, points, as_run)
    for voltage_v in (8e3, 15e3, 18e3):
        assert force_at(as_run, voltage_v, kind, train) == pytest.approx((100e3, 0.0))


def test_beyond_its_voltages_and_speeds_the_outer_values_of_a_table_hold(as_run):
    """At 80 km/h: 0.5 · 200 kN · (11/15)² and (16.5/15)²; at 200 km/h as at 160: nothing."""
    kind, points = kind_of(ROWS)
    train = train_at(80.0, kind, points, as_run)
    for voltage_v, ratio in ((9e3, 11 / 15), (11e3, 11 / 15), (16.5e3, 1.1), (18e3, 1.1)):
        force, slope = force_at(as_run, voltage_v, kind, train)
        assert (force, slope) == (pytest.approx(100e3 * ratio**2), 0.0)
    beyond = train_at(200.0, kind, points, as_run)
    assert force_at(as_run, 15e3, kind, beyond) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("effort", "speed_kmh", "voltage_kv", "extrapolates"),
    [
        ("network", 100, 15, False), ("network", 251, 15, True), ("network", 100, 16.6, True),
        ("rows", 160, 16.5, False), ("rows", 161, 15, True), ("rows", 80, 10.9, True),
        ("rows", 80, 16.6, True), ("row", 80, 10.0, False), ("row", 161, 15, True),
        ("sagging", 400, 9.0, False),
    ],
)  # fmt: skip
def test_use_outside_is_noticed(as_run, effort, speed_kmh, voltage_kv, extrapolates):
    kind, points = kind_of(EFFORTS[effort])
    noticed = as_run(effort_extrapolates)(
        speed_kmh / 3.6, voltage_kv * 1e3, kind.effort, kind.networks.tractive_effort, points
    )
    assert noticed == extrapolates


def test_limits_take_the_speed_at_once_and_the_voltage_while_solving(as_run):
    """2600 kW at 72 km/h = 20 m/s: 130 kN; at 12 kV half of it, by 130 kN/4 kV = 32.5 N/V."""
    kind, points = kind_of(SAGGING)
    train = train_at(72.0, kind, points, as_run)
    assert force_at(as_run, 15e3, kind, train) == pytest.approx((130e3, 0.0))
    assert force_at(as_run, 12e3, kind, train) == pytest.approx((65e3, 32.5))
    assert train.effort.steepest_n_per_v == pytest.approx(32.5)


@pytest.mark.parametrize("effort", EFFORTS.values(), ids=EFFORTS.keys())
@pytest.mark.parametrize("speed_kmh", [0.0, 55.0, 120.0])
def test_slopes_are_those_over_voltage_and_no_steeper_than_the_bound(as_run, effort, speed_kmh):
    kind, points = kind_of(effort)
    train = train_at(speed_kmh, kind, points, as_run)
    for voltage_v in np.arange(9.13e3, 17.5e3, 0.31e3):
        _, slope = force_at(as_run, voltage_v, kind, train)
        around = central_difference(lambda v: force_at(as_run, v, kind, train)[0], voltage_v, 0.5)
        assert slope == pytest.approx(around, rel=1e-6, abs=1e-6)
        assert abs(slope) <= train.effort.steepest_n_per_v * (1 + 1e-12)


@pytest.mark.parametrize("effort", EFFORTS.values(), ids=EFFORTS.keys())
def test_inside_the_proven_band_the_force_is_what_the_driver_wants(as_run, effort):
    """The machine alone, evaluated anew with the band taken away, says the same."""
    kind, points = kind_of(effort)
    proven = 0
    for cap_n in (1e3, 30e3, 100e3, 180e3):
        train = train_at(70.0, kind, points, as_run, cap_n, 40e3, voltage_v=13.2e3)
        as_run(certify_free_band)(kind, train)
        band_v, train.free_band_v = min(train.free_band_v, 6e3), -1.0
        if band_v > 0.0:
            proven += 1
            for at_v in 13.2e3 + band_v * np.linspace(-0.999, 0.999, 7):
                assert as_run(wheel_force)(at_v, kind, train, SCRATCH) == (cap_n, 0.0)
    assert proven > 0


@pytest.mark.parametrize("effort", [ROW, LIMITS], ids=["row", "limits"])
def test_where_no_voltage_counts_the_band_has_no_end(as_run, effort):
    kind, points = kind_of(effort)
    for cap_n, band_v in ((50e3, math.inf), (190e3, -1.0)):
        train = train_at(100.0, kind, points, as_run, cap_n)
        as_run(certify_free_band)(kind, train)
        assert train.free_band_v == band_v


def test_the_effort_of_another_speed_is_taken_anew(as_run):
    kind, points = kind_of(LIMITS)
    train = train_at(0.0, kind, points, as_run)
    assert train.free_force_n == 200e3
    train.speed_m_s = 26.0
    as_run(update_effort)(26.0, kind.effort, train.effort, kind.networks.tractive_effort, points)
    assert force_at(as_run, 15e3, kind, train) == pytest.approx((100e3, 0.0))


def test_efficiency_and_power_factor_may_be_curves_over_speed(as_run):
    """Half-way between two points of a straight curve: η = 0.8, λ = 0.9; Q/P = √(1 - 0.81)/0.9."""
    kind, points = kind_of(
        LIMITS,
        efficiency={"speed_kmh": [0, 100], "value": [0.7, 0.9]},
        power_factor={"speed_kmh": [0, 100], "value": [0.8, 1.0]},
    )
    train = train_at(50.0, kind, points, as_run)
    assert train.per_efficiency == pytest.approx(1 / 0.8)
    assert train.reactive_ratio == pytest.approx(math.sqrt(0.19) / 0.9)
    fast = train_at(130.0, kind, points, as_run)
    assert (fast.per_efficiency, fast.reactive_ratio) == (1 / 0.9, 0.0)
