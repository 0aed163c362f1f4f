"""The load flow against what can be worked out by hand."""

import cmath
import math

import numpy as np
import pytest

from tpss.powerflow.solve import solve

from networks import BT, ROTARY, STIFF, highest_root, simple_line

COLD = False


@pytest.mark.parametrize("load", [2e6 + 0j, 3e6 + 2e6j, 1e6 - 1.5e6j, 0.2e6 + 4e6j])
def test_one_train_and_one_stiff_source_meet_the_closed_form(load):
    case = simple_line(60e3, [40e3], [load], STIFF)
    share, _ = solve(COLD, case.network, case.flow, case.loads)
    assert share == 1.0
    expected = highest_root(16_500.0, BT * 40e3, load)
    assert abs(case.train_voltage[0]) == pytest.approx(expected, rel=1e-11)


def test_the_most_power_at_unity_power_factor_is_e_squared_over_twice_r_plus_z():
    """P_max = E² / (2 (R + |Z|)) = 16 500² / (2 (8.4 + 11.6)) = 6.8066 MW at 40 km of BT catenary."""
    z = BT * 40e3
    most = 16_500.0**2 / (2 * (z.real + abs(z)))
    below = simple_line(60e3, [40e3], [0.9999 * most], STIFF)
    assert solve(COLD, below.network, below.flow, below.loads)[0] == 1.0
    above = simple_line(60e3, [40e3], [1.25 * most], STIFF)
    share, _ = solve(COLD, above.network, above.flow, above.loads)
    assert share == pytest.approx(0.8, abs=2e-4)


def test_a_warm_start_beside_the_low_voltage_root_ends_at_the_high_one():
    """The same load has a second root: the closed form with a minus before the root."""
    load, z = 3e6 + 1e6j, BT * 40e3
    case = simple_line(60e3, [40e3], [load], STIFF)
    solve(COLD, case.network, case.flow, case.loads)
    high = abs(case.train_voltage[0])
    low = abs(z * load) / high  # the product of both roots is |Z| |S|
    voltage = low * cmath.exp(1j * -0.9)
    case.flow.sections.current_a = (load / voltage).conjugate()
    case.flow.nodes[0].voltage_v = voltage + z * case.flow.sections[0].current_a
    share, _ = solve(True, case.network, case.flow, case.loads)
    assert share == 1.0
    assert abs(case.train_voltage[0]) == pytest.approx(high, rel=1e-10)


def test_two_equal_stations_share_a_train_half_way_equally():
    case = simple_line(100e3, [50e3], [4e6 + 3e6j], ROTARY, ROTARY)
    solve(COLD, case.network, case.flow, case.loads)
    west, east = case.fed
    assert west == pytest.approx(east, rel=1e-10)
    angles = np.angle(case.flow.nodes.voltage_v)
    assert angles[0] == pytest.approx(angles[1], abs=1e-12)


def test_what_stations_feed_is_what_trains_draw_and_the_line_loses():
    case = simple_line(100e3, [20e3, 70e3], [3e6 + 2e6j, 2e6 + 1e6j], ROTARY, ROTARY)
    solve(COLD, case.network, case.flow, case.loads)
    volts = [case.flow.nodes[0].voltage_v, *case.train_voltage, case.flow.nodes[1].voltage_v]
    lost = sum(
        abs((a - b) / (BT * m)) ** 2 * BT.real * m
        for a, b, m in zip(volts, volts[1:], (20e3, 50e3, 30e3), strict=False)
    )
    assert case.fed.real.sum() == pytest.approx(5e6 + lost, rel=1e-10)


def test_the_station_with_fewer_converters_takes_less():
    case = simple_line(100e3, [50e3], [6e6 + 3e6j], ROTARY, ROTARY)
    case.flow.sources.running = [2.0, 4.0]
    solve(COLD, case.network, case.flow, case.loads)
    west, east = case.fed
    assert west.real < east.real
    assert abs(west) / 2 > abs(east) / 4  # and is loaded higher for it


def test_at_catenary_loses_less_than_bt_catenary():
    """|z| of AT is a sixth of that of BT; at nearly the same current so are the losses."""
    at = complex(0.0335, 0.031) * 1e-3
    losses = []
    for z in (BT, at):
        case = simple_line(80e3, [40e3], [4e6 + 1e6j], ROTARY, ROTARY, impedance=z)
        solve(COLD, case.network, case.flow, case.loads)
        losses.append(case.fed.real.sum() - 4e6)
    assert losses[1] < losses[0] / 5


def test_an_open_line_s_capacitance_raises_its_end():
    """U_end = U / (1 - ω c l z l / 2 + ...): a π-section of z l and j b l, half of it at the end."""
    b = 2 * math.pi * 16.7 * 13.5e-12
    case = simple_line(160e3, [], [], STIFF, susceptance=b)
    solve(COLD, case.network, case.flow, case.loads)
    expected = 16_500.0 / (1 + BT * 160e3 * 0.5j * b * 160e3)
    assert case.flow.nodes[1].voltage_v == pytest.approx(expected, rel=1e-12)


def test_trains_at_the_same_place_count_as_a_metre_apart():
    """Their voltages differ by the drop over one metre of line, |z| I."""
    case = simple_line(60e3, [30e3, 30e3], [1e6, 1e6], STIFF)
    solve(COLD, case.network, case.flow, case.loads)
    first, second = case.train_voltage
    assert first - second == pytest.approx(BT * (1e6 / second).conjugate(), rel=1e-6)
