"""Hand-worked locomotive used below: transformer 15 kV / 487 V.

4 I_D = 4755.4 A, β = 0.5:  Q = 487 · 4755.4 · √2/π · 0.5 = 521 256 var
λ = 0.8:                    Q/P = √(1 - 0.64)/0.8 = 0.75; auxiliaries 151.5 kW: 113.6 kvar
X_f = -0.45 Ω at 16 kV:     U_locoRc = 487 · 16/15 = 519.47 V; Q_f = -599 657 var, about -600 kvar
"""

import numpy as np
import pytest

from tpss.numerics.neural_network import NEURONS
from tpss.numerics.series import SCRATCH_SHAPE, Series, series_at
from tpss.physics.reactive_power import (
    bridge_outside_training,
    bridge_reactive_power,
    bridge_sine_series,
    filter_reactive_power,
    power_factor,
    reactive_ratio,
    sine_over_motor_voltage,
)
from vehicles import NETWORKS

from alternatives import central_difference, exact_bridge_sine

SCRATCH = np.zeros(NEURONS)

# U_di [V], U_locoRc [V], the network's β, eq. (3.1)
SINES = [
    (0.0, 487.0, -0.0004513417884875159, 0.0),
    (100.0, 487.0, 0.8405035907596063, 0.8391812441107616),
    (385.0, 487.0, 0.6598401172815885, 0.654374805292786),
    (600.0, 535.7, 0.8476618103884269, 0.8590336004620066),
    (770.0, 487.0, 0.8593680056394922, 0.8587822689544776),
    (770.0, 300.0, 0.001281054165799415, 0.0),
    (400.0, 642.84, 0.9300968008008443, 0.9240518698809986),
    (50.0, 214.28, 0.8529888265641893, 0.8763637583126945),
]

# speed [km/h], λ
FACTORS = [
    (0, 0.22680202803620264),
    (10, 0.5278344086395317),
    (20, 0.6830354443974971),
    (30, 0.8594122181371094),
    (40, 0.9192373532730911),
    (41, 0.8422008864707116),
    (42, 0.6550877354554228),
    (45, 0.6433123463246685),
    (60, 0.7211580013039967),
    (75, 0.8276831708665939),
    (78, 0.8155188908060167),
    (100, 0.8093580042400198),
    (135, 0.8085724659062311),
    (160, 0.808494134898069),
]


def bridge(as_run, motor_v, locomotive_v):
    """β and its slopes over both voltages."""
    network, scratch, series = NETWORKS.bridge_sine, np.zeros(SCRATCH_SHAPE), Series.blank(1)[0]
    as_run(bridge_sine_series)(motor_v, locomotive_v, network, scratch, series)
    sine, by_locomotive = as_run(series_at)(locomotive_v, series)
    return sine, as_run(sine_over_motor_voltage)(network, scratch), by_locomotive


@pytest.mark.parametrize(("motor_v", "locomotive_v", "sine", "exact"), SINES)
def test_bridge_network_reproduces_the_printed_tables(as_run, motor_v, locomotive_v, sine, exact):
    given, _, _ = bridge(as_run, motor_v, locomotive_v)
    assert given == pytest.approx(sine, rel=1e-9, abs=1e-12)
    assert exact_bridge_sine(motor_v, locomotive_v) == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize(("motor_v", "locomotive_v"), [row[:2] for row in SINES])
def test_slopes_are_those_of_the_bridge_network(as_run, motor_v, locomotive_v):
    def sine(of_motor, of_locomotive):
        return bridge(as_run, of_motor, of_locomotive)[0]

    _, by_motor, by_locomotive = bridge(as_run, motor_v, locomotive_v)
    motor_slope = central_difference(lambda u: sine(u, locomotive_v), motor_v, 1e-3)
    locomotive_slope = central_difference(lambda u: sine(motor_v, u), locomotive_v, 1e-3)
    assert by_motor == pytest.approx(motor_slope, rel=1e-6, abs=1e-9)
    assert by_locomotive == pytest.approx(locomotive_slope, rel=1e-6, abs=1e-9)


def test_bridge_network_is_within_two_hundredths_of_the_exact_sine():
    """Root of the mean square over the whole training range, every 2 V: below 0.02."""
    motor_v, locomotive_v = np.meshgrid(np.arange(0.0, 771.0, 2.0), np.arange(214.28, 642.84, 2.0))
    exact = exact_bridge_sine(motor_v, locomotive_v)
    pairs = zip(motor_v.flat, locomotive_v.flat, strict=True)
    given = np.array([bridge(lambda kernel: kernel, *pair)[0] for pair in pairs])
    assert np.sqrt(np.mean((given - exact.ravel()) ** 2)) < 0.02


@pytest.mark.parametrize(
    ("motor_v", "locomotive_v", "extrapolates"),
    [(100.0, 487.0, False), (771.0, 487.0, True), (400.0, 214.0, True), (400.0, 643.0, True)],
)
def test_extrapolation_is_noticed(as_run, motor_v, locomotive_v, extrapolates):
    noticed = as_run(bridge_outside_training)(motor_v, locomotive_v, NETWORKS.bridge_sine)
    assert noticed == extrapolates


@pytest.mark.parametrize(("speed_kmh", "factor"), FACTORS)
def test_power_factor_reproduces_the_printed_tables(as_run, speed_kmh, factor):
    given = as_run(power_factor)(speed_kmh / 3.6, NETWORKS.power_factor, SCRATCH)
    assert given == pytest.approx(factor, rel=1e-9)


def test_bridges_draw_521_kilovar(as_run):
    reactive = as_run(bridge_reactive_power)(487.0, 4755.4, 0.5)
    assert reactive == pytest.approx(521_256, abs=1.0)


@pytest.mark.parametrize(("factor", "ratio"), [(0.8, 0.75), (0.6, 4 / 3), (1.0, 0.0)])
def test_power_factor_fixes_reactive_over_active_power(as_run, factor, ratio):
    assert as_run(reactive_ratio)(factor) == pytest.approx(ratio)


def test_auxiliaries_draw_113_6_kilovar(as_run):
    assert 151.5 * as_run(reactive_ratio)(0.8) == pytest.approx(113.6, abs=0.05)


def test_filter_feeds_600_kilovar_at_16_kilovolt(as_run):
    """(16 kV · 487/15000)² / 0.45 Ω, and twice that over 16 kV for each volt."""
    reactive, slope = as_run(filter_reactive_power)(16e3, (487 / 15e3) ** 2 / -0.45)
    assert reactive == pytest.approx(-599_657, abs=1.0)
    assert slope == pytest.approx(2 * reactive / 16e3)


def test_an_infinite_reactance_is_no_filter(as_run):
    assert as_run(filter_reactive_power)(15e3, (487 / 15e3) ** 2 / np.inf) == (0.0, 0.0)
