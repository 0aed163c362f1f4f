"""Hand-worked train used below: 400 A, auxiliaries of 165 kVA, Un = 15 kV, a = 0.95, Umin2 = 11 kV.

    knee:  0.95 · 15 = 14.25 kV;  auxiliaries at 11 kV: 165/11 = 15 A
    slope: (400 - 15)/(14 250 - 11 000) = 0.118462 A/V
    at 12 kV: 15 + 0.118462 · 1000 = 133.46 A;  at 13 kV: 251.92 A

With efficiency 0.8, λ = 1, auxiliaries of 165 kW at λ = 1 and the speed 20 m/s, at 13 kV:

    P = 13 000 · 251.92 = 3 275 000 W;  P_motor = 0.8 (3 275 000 - 165 000) = 2 488 000 W
    F = 2 488 000/20 = 124 400 N
"""

import math

import numpy as np
import pytest

from tpss.vehicle.demand import (
    certify_free_band,
    electrical_demand,
    update_cap_terms,
    wheel_force,
)
from tpss.vehicle.line_current import highest_line_current, within_line_current
from vehicles import SCRATCH, demand_at
from vehicles import kind_of as kind_with

from alternatives import central_difference

LIMIT = {"max_current_a": 400.0}
PURE = {
    "tractive_effort": {"max_force_kn": 300.0, "max_power_kw": 10_000.0},
    "power_factor": 1.0,
    "auxiliary_power_kw": 165.0,
    "auxiliary_power_factor": 1.0,
    "motor_inertia_kg": 0.0,
}
EFFORTS = {
    "network": {"max_motor_current_a": 2080.0},
    "table": {"tractive_effort": {"speed_kmh": [0, 60, 200], "voltage_kv": [11, 16.5],
                                  "force_kn": [[300, 250, 100], [320, 280, 120]]},
              "power_factor": 0.9},
    "limits": {"tractive_effort": {"max_force_kn": 300.0, "max_power_kw": 8000.0},
               "power_factor": {"speed_kmh": [0, 100], "value": [0.7, 0.95]}},
    "bridge": {"max_motor_current_a": 2080.0, "reactive_power": "double-bridge",
               "filter_reactance_ohm": -0.45},
    "former": {"max_motor_current_a": 2080.0, "reactive_power": "double-bridge",
               "motor_voltage": "former"},
}  # fmt: skip


def kind_of(**changes):
    """A train of the short line with a current limitation: its record, and the curves' points."""
    return kind_with(**{"current_limitation": LIMIT, **changes})


def train_at(speed_kmh, kind, points, cap_n=1e6, resistance_n=0.0, mean_over_s=0.0, grip_n=1e6):
    train = demand_at(
        speed_kmh, kind, points, force_cap_n=cap_n, resistance_n=resistance_n, adhesion_n=grip_n,
        mean_speed_weight_s=mean_over_s / 2.0,
    )  # fmt: skip
    certify_free_band(kind, train)
    update_cap_terms(kind, train)
    return train


@pytest.mark.parametrize(
    ("voltage_v", "current_a", "slope_a_per_v"),
    [
        (10_000, 15.0, 0.0),
        (11_000, 15.0, 0.0),
        (12_000, 133.4615, 0.118462),
        (13_000, 251.9231, 0.118462),
        (14_249, 399.8815, 0.118462),
        (14_250, 400.0, 0.0),
        (16_500, 400.0, 0.0),
    ],
)
def test_current_falls_from_the_knee_to_that_of_the_auxiliaries(
    as_run, voltage_v, current_a, slope_a_per_v
):
    kind, _ = kind_of(**PURE)
    found = as_run(highest_line_current)(voltage_v, kind.line_current)
    assert found == pytest.approx((current_a, slope_a_per_v), rel=1e-5)


@pytest.mark.parametrize(
    ("voltage_v", "current_a", "slope_a_per_v"),
    [
        (10_000, 16.5, -0.00165),
        (12_000, 132.5962, 0.118053),
        (13_000, 251.0355, 0.118796),
        (14_250, 400.0, 0.0),
        (16_500, 400.0, 0.0),
    ],
)
def test_current_may_fall_to_what_the_auxiliaries_power_takes(
    as_run, voltage_v, current_a, slope_a_per_v
):
    """At 12 kV f = 1/3.25: 400 f + (1 - f) 165/12 = 132.5962 A, slope (400 - 13.75) / 3250 - (1 - f)
    13.75 / 12000 = 0.118053 A/V; below 11 kV 165 kVA / U.
    """
    kind, _ = kind_of(**{**PURE, "current_limitation": {**LIMIT, "auxiliaries": "power"}})
    found = as_run(highest_line_current)(voltage_v, kind.line_current)
    assert found == pytest.approx((current_a, slope_a_per_v), rel=1e-5)


def test_force_is_what_the_current_leaves_for_the_motors(as_run):
    kind, points = kind_of(**PURE)
    train = train_at(72.0, kind, points)
    force, _ = as_run(wheel_force)(13e3, kind, train, SCRATCH)
    assert force == pytest.approx(124_400.0, rel=1e-9)


def test_at_the_lowest_voltage_and_below_there_is_no_traction(as_run):
    kind, points = kind_of(**PURE)
    for speed_kmh in (0.0, 72.0):
        train = train_at(speed_kmh, kind, points)
        for voltage_v in (9e3, 11e3):
            assert as_run(wheel_force)(voltage_v, kind, train, SCRATCH) == (0.0, 0.0)
            assert as_run(electrical_demand)(voltage_v, kind, train, SCRATCH)[0] == 165e3


def test_where_the_current_allows_more_machine_and_driver_have_their_way(as_run):
    """At 72 km/h and 13 kV the current leaves 124.4 kN."""
    kind, points = kind_of(**PURE)
    free, points_too = kind_of(**{**PURE, "current_limitation": None})
    calm = train_at(72.0, kind, points, cap_n=120e3)
    assert as_run(wheel_force)(13e3, kind, calm, SCRATCH) == (120e3, 0.0)
    for speed_kmh, voltage_v in ((20.0, 15e3), (10.0, 12e3)):
        limited = train_at(speed_kmh, kind, points)
        unlimited = train_at(speed_kmh, free, points_too)
        assert as_run(wheel_force)(voltage_v, kind, limited, SCRATCH) == as_run(wheel_force)(
            voltage_v, free, unlimited, SCRATCH
        )


def test_a_standing_train_that_draws_no_power_for_its_force_is_not_limited_by_current(as_run):
    kind, points = kind_of(**PURE)
    assert as_run(wheel_force)(11.001e3, kind, train_at(0.0, kind, points), SCRATCH)[0] == 300e3


def test_a_machine_without_force_stays_without(as_run):
    kind, points = kind_of(**PURE)
    found = as_run(within_line_current)(
        13e3, -2e3, 0.1, kind, train_at(72.0, kind, points), SCRATCH
    )
    assert found == (-2e3, 0.1)


@pytest.mark.parametrize("effort", EFFORTS.values(), ids=EFFORTS.keys())
@pytest.mark.parametrize("speed_kmh", [3.0, 50.0, 95.0])
@pytest.mark.parametrize("mean_over_s", [0.0, 60.0], ids=["start", "mean"])
@pytest.mark.parametrize("grip_n", [50e3, 1e6], ids=["slip", "grip"])
def test_motors_and_auxiliaries_draw_the_allowed_current_or_the_machine_limits(
    as_run, effort, speed_kmh, mean_over_s, grip_n
):
    """The filter's share taken out: |P + jQ| = U I to rounding, or the force without a limit."""
    kind, points = kind_of(**effort)
    free, free_points = kind_of(**{**effort, "current_limitation": None})
    kind.filter_susceptance_s = 0.0
    limited = 0
    for voltage_v in np.arange(11.05e3, 16e3, 0.45e3):
        train = train_at(speed_kmh, kind, points, 1e9, 30e3, mean_over_s, grip_n)
        p, q, _, _ = as_run(electrical_demand)(voltage_v, kind, train, SCRATCH)
        allowed_a, _ = as_run(highest_line_current)(voltage_v, kind.line_current)
        unlimited = train_at(speed_kmh, free, free_points, 1e9, 30e3, mean_over_s, grip_n)
        force, _ = as_run(wheel_force)(voltage_v, free, unlimited, SCRATCH)
        if as_run(wheel_force)(voltage_v, kind, train, SCRATCH)[0] < force:
            assert math.hypot(p, q) / voltage_v == pytest.approx(allowed_a, rel=1e-11)
            limited += 1
        else:
            assert math.hypot(p, q) / voltage_v <= allowed_a
    assert limited > 0


@pytest.mark.parametrize("voltage_v", [11.3e3, 12.4e3, 13.7e3, 14.6e3])
def test_slopes_beside_the_auxiliaries_power_are_those_over_voltage(as_run, voltage_v):
    kind, points = kind_of(**{**PURE, "current_limitation": {**LIMIT, "auxiliaries": "power"}})
    train = train_at(72.0, kind, points, 1e9, 30e3)

    def drawn(at_v):
        return as_run(electrical_demand)(at_v, kind, train, SCRATCH)

    slope = central_difference(lambda v: drawn(v)[0], voltage_v, 0.5)
    assert drawn(voltage_v)[2] == pytest.approx(slope, rel=1e-5, abs=1e-4)


@pytest.mark.parametrize("effort", EFFORTS.values(), ids=EFFORTS.keys())
@pytest.mark.parametrize("speed_kmh", [5.0, 50.0, 95.0])
@pytest.mark.parametrize("mean_over_s", [0.0, 60.0], ids=["start", "mean"])
@pytest.mark.parametrize("grip_n", [50e3, 1e6], ids=["slip", "grip"])
@pytest.mark.parametrize("voltage_v", [11.3e3, 12.4e3, 13.7e3, 14.6e3])
def test_slopes_of_the_demand_are_those_over_voltage(
    as_run, effort, speed_kmh, mean_over_s, grip_n, voltage_v
):
    kind, points = kind_of(**effort)
    train = train_at(speed_kmh, kind, points, 1e9, 30e3, mean_over_s, grip_n)

    def drawn(at_v):
        return as_run(electrical_demand)(at_v, kind, train, SCRATCH)

    _, _, active_slope, reactive_slope = drawn(voltage_v)
    active = central_difference(lambda v: drawn(v)[0], voltage_v, 0.5)
    reactive = central_difference(lambda v: drawn(v)[1], voltage_v, 0.5)
    assert active_slope == pytest.approx(active, rel=1e-5, abs=1e-4)
    assert reactive_slope == pytest.approx(reactive, rel=1e-5, abs=1e-4)
