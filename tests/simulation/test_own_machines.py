"""Whole runs of trains with machines of one's own: closed forms, audits, and a twin of the Rc4.

Hand-worked train used below: 100 t on level track without resistance, all of it on driven axles,
200 kN and then 2000 kW.

    constant force:  a = 2 m/s² up to the knee v₁ = P/F = 10 m/s, at t₁ = 5 s, x₁ = 25 m
    constant power:  v² = v₁² + 2 P (t - t₁)/m,   x = x₁ + m (v³ - v₁³)/(3 P)
    after 60 s:      v = √(100 + 40 · 55) = 47.958 m/s,   x = 25 + (47.958³ - 1000)/60 = 1846.8 m
"""

import math

import numpy as np
import pytest

from tpss.model import build_model
from tpss.numerics.series import SCRATCH_SHAPE, Series
from tpss.vehicle.effort.network import motor_force_series
from vehicles import NETWORKS

from conftest import plain
from scenarios import run, short_line

OWN_TRAIN = {
    "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 2000.0},
    "mass_t": 100.0,
    "adhesive_mass_t": 100.0,
    "resistance_a_n": 0.0,
    "resistance_b_n_s_per_m": 0.0,
    "resistance_c_n_s2_per_m2": 0.0,
    "max_speed_kmh": 400.0,
    "max_retardation_m_s2": 1.0,
    "efficiency": 0.9,
    "power_factor": 1.0,
    "auxiliary_power_kw": 0.0,
}
FAST_LINE = {"line.speed_limits": [{"from_km": 0.0, "speed_kmh": 300.0}]}

SPEED_M_S = math.sqrt(2300.0)
WAY_M = 25.0 + (SPEED_M_S**3 - 1000.0) / 60.0

TABLE = {
    "speed_kmh": [0, 40, 80, 120, 300],
    "voltage_kv": [11, 14, 16.5],
    "force_kn": [[150, 140, 70, 30, 5], [190, 180, 100, 60, 20], [200, 190, 120, 75, 25]],
}


def own(**changes):
    """Changes that put a train of one's own on the short line."""
    return {**FAST_LINE, "trains.freight": {**OWN_TRAIN, **changes}}


def after_a_minute(step_min):
    result = run({**own(), "simulation.time_step_min": step_min, "simulation.duration_min": 1.0})
    last = result.dataset.sel(train="eastbound 1").isel(time=-1)
    return float(last.speed), float(last.position)


def test_unit_with_all_axles_driven_accelerates_its_rotating_parts_too():
    """203 t, rotating parts 10 % of it, 1 in 250 uphill, 45 N/t, 146.0 kN, to 42 km/h.

    (145 995 - 9 135 - 203 000 · 9.81 · 0.004) N / (203 t · 1.1) = 0.577 m/s², so 20.2 s.
    """
    unit = own(
        mass_t=203.0,
        adhesive_mass_t=203.0,
        resistance_a_n=9135.0,
        rotating_mass_share=0.1,
        tractive_effort={"max_force_kn": 145.995, "max_power_kw": 100_000.0},
        efficiency=1.0,
    )
    unit |= {"line.gradients.0.permille": 4.0, "simulation.time_step_min": 0.001,
             "simulation.duration_min": 0.5, "supply.catenary": "AT"}  # fmt: skip
    train = run(unit).dataset.sel(train="eastbound 1")
    after_s = float(np.interp(42.0 / 3.6, train.speed, train.time))
    assert after_s == pytest.approx(20.2, abs=0.05)
    assert float(train.acceleration[1]) == pytest.approx(128_894.28 / 223_300.0, rel=1e-6)


def test_share_of_rotating_parts_stands_in_place_of_the_model_s():
    """Of the library's locomotive, whose motors have their own inertia."""
    (kind,) = build_model(short_line({"trains.freight.rotating_mass_share": 0.06}))[0].types
    assert kind.inertia_kg == kind.coasting_inertia_kg == pytest.approx(1.06 * 1.47e6)
    assert kind.rotor_mass_kg == 0.0


def test_constant_force_then_constant_power_meets_its_closed_form():
    """First order in the step: each tenth of it leaves a tenth of the error."""
    errors = [
        np.abs(np.array(after_a_minute(step)) / (SPEED_M_S, WAY_M) - 1.0) for step in (0.02, 0.002)
    ]
    assert errors[0].max() < 0.02
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.15)
    assert errors[1].max() < 2e-3


def test_energy_of_the_closed_form_is_kinetic_energy_over_the_efficiency():
    result = run({**own(), "simulation.time_step_min": 0.01, "simulation.duration_min": 1.0})
    speed = float(result.dataset.speed[-1, 0])
    expected_mwh = 100e3 / 2.0 * speed**2 / 0.9 / 3.6e9
    assert result.trips.energy_mwh[0] == pytest.approx(expected_mwh, rel=1e-9)


def test_a_highest_acceleration_is_kept_exactly_until_the_power_is_less():
    """0.5 m/s² asks for 50 kN, which 2000 kW give up to 40 m/s = 144 km/h, after 80 s."""
    result = run({**own(max_acceleration_m_s2=0.5), "simulation.duration_min": 3.0})
    train = result.dataset.sel(train="eastbound 1")
    a, v = train.acceleration.to_numpy()[:-1], train.speed.to_numpy()[:-1]
    assert a[v < 40.0] == pytest.approx(0.5, rel=1e-12)
    assert (a[v > 40.1] < 0.5).all()
    assert v[a < 0.4999].min() == pytest.approx(40.0, abs=1.5)  # a step of 3 s at 0.5 m/s²


def test_motor_current_is_not_a_number_where_the_motors_voltage_is_not_known():
    result = run({**own(), "simulation.duration_min": 2.0})
    assert result.dataset.motor_current.isnull().all()
    known = run({**own(base_speed_kmh=80.0, max_motor_voltage_v=770.0),
                 "simulation.duration_min": 2.0})  # fmt: skip
    assert known.dataset.motor_current[:-1].notnull().all()


@pytest.mark.parametrize(
    "changes",
    [
        {"tractive_effort": TABLE},
        {"tractive_effort": {**TABLE, "force_kn": [
            [0.3 * np.array(row) for row in TABLE["force_kn"]], TABLE["force_kn"]],
            "motor_current_a": [200, 1000]}, "max_motor_current_a": 700.0},
        {"tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 6000.0, "limit_speed_kmh": 120.0,
                             "full_voltage_kv": 16.4, "zero_voltage_kv": 12.0}},
        {"efficiency": {"speed_kmh": [0, 30, 200], "value": [0.6, 0.9, 0.85]}},
        {"power_factor": {"speed_kmh": [0, 60, 200], "value": [0.7, 0.95, 1.0]}},
        {"tractive_effort": TABLE, "reactive_power": "double-bridge", "base_speed_kmh": 80.0,
         "max_motor_voltage_v": 770.0},
        {"slip": 0.02, "motor_inertia_kg": 9000.0, "rotating_mass_factor": 0.1,
         "adhesive_mass_t": 50.0},
    ],
    ids=["table", "current", "limits", "efficiency", "power factor", "bridge", "inertia"],
)  # fmt: skip
def test_a_run_on_a_weak_line_passes_its_audit(changes):
    """One station with one converter; three trains at once; their force follows the voltage."""
    changes = {**own(**changes), "traffic.0.headway_min": 1.0, "simulation.duration_min": 8.0,
               "supply.converter_stations": [
                   {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}],
               "line.gradients": [{"from_km": 0.0, "permille": 5.0}]}  # fmt: skip
    changes = as_plain_lists(changes)
    result = run(changes)
    assert result.summary["lowest_voltage"]["voltage_kv"] < 16.3
    assert result.dataset.speed.max() > 20.0


def as_plain_lists(value):
    """The same with arrays as lists."""
    if isinstance(value, dict):
        return {key: as_plain_lists(item) for key, item in value.items()}
    if isinstance(value, list | np.ndarray):
        return [as_plain_lists(item) for item in value]
    return float(value) if isinstance(value, np.floating) else value


def test_use_beyond_a_table_or_a_curve_is_counted():
    table = {"speed_kmh": [0, 50], "force_kn": [200, 100]}
    curve = {"speed_kmh": [10, 50], "value": [0.8, 0.9]}
    changes = own(tractive_effort=table, efficiency=curve, power_factor=curve)
    result = run({**changes, "simulation.duration_min": 3.0})
    train = result.dataset.sel(train="eastbound 1")
    motoring = train.tractive_force.to_numpy()[:-1] > 0.0
    v_kmh = train.speed.to_numpy()[:-1][motoring] * 3.6
    limited = result.summary["limited"]
    assert limited["effort_extrapolated"] == (v_kmh > 50.0).sum() > 0
    outside = ((v_kmh < 10.0) | (v_kmh > 50.0)).sum()
    assert limited["efficiency_extrapolated"] == limited["power_factor_extrapolated"] == outside


def sampled_network():
    """The Rc4's network around 1250 A as a dense table; below zero counts as 0."""
    network, series = NETWORKS.tractive_effort, Series.blank(1)[0]
    speeds, voltages = np.arange(0.0, 161.0, 2.5), np.arange(10.5, 16.6, 0.5)
    currents = np.arange(1050.0, 1301.0, 50.0)
    force_kn = np.zeros((currents.size, voltages.size, speeds.size))
    for c, current in enumerate(currents):
        for k, speed in enumerate(speeds):
            for u, voltage in enumerate(voltages):
                plain(motor_force_series)(
                    speed / 3.6, voltage * 1e3, current, network, np.zeros(SCRATCH_SHAPE), series
                )
                force_kn[c, u, k] = max(0.0, series.coefficient[0]) / 1e3
    return {"speed_kmh": speeds.tolist(), "voltage_kv": voltages.tolist(),
            "motor_current_a": currents.tolist(), "force_kn": force_kn.tolist()}  # fmt: skip


@pytest.mark.parametrize("current_a", [1250.0, 1130.0])
def test_a_dense_table_of_the_rc4_runs_like_its_network(current_a):
    """Piecewise cubics of 2.5 km/h, 0.5 kV and 50 A: the same time, energies within 1e-4."""
    changes = {"line.speed_limits": [{"from_km": 0.0, "speed_kmh": 110.0}],
               "line.gradients": [{"from_km": 0.0, "permille": 3.0}],
               "traffic.0.headway_min": 6.0,
               "trains.freight.max_motor_current_a": current_a}  # fmt: skip
    effort = {"trains.freight.tractive_effort": sampled_network(),
              "trains.freight.reactive_power": "double-bridge"}  # fmt: skip
    network = run({**changes, "trains.freight.reactive_power": "double-bridge"})
    table = run({**changes, **effort})
    assert table.summary["trip_time_min"] == network.summary["trip_time_min"]
    assert table.summary["total_energy_mwh"] == pytest.approx(
        network.summary["total_energy_mwh"], rel=1e-4
    )
    force = (r.dataset.tractive_force.to_numpy() for r in (table, network))
    assert np.nanmax(np.abs(np.subtract(*force))) < 300.0
