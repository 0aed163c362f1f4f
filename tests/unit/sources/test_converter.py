"""Hand-worked station used below: two Q48/Q49 feed 10 MW and 4 Mvar, so 5 MW and 2 Mvar each.

    X_q^g = 0.53 · 16.5²/10   = 14.42925 Ω,   X_q^m = 0.49 · 16.5²/10.7 = 12.46752 Ω
    U_m   = 16.5 kV, so U_m²  = 272.25 kV²
    U_g   = 16.5 - 4/(2 · 20) = 16.4 kV                                                        (2.1)
    motor:      arctan(12.46752 · 5/272.25)/3             = arctan(0.228972)/3 = 0.0750306     (2.3)
    generator:  arctan(14.42925 · 5/(268.96 + 28.8585))   = arctan(0.242249)   = 0.2376705
    θ     = -0.0750306 - 0.2376705                        = -0.3127011 rad = -17.92°           (2.4)

Behind a grid of X_50 = 1 Ω to which Q_50 = 6 Mvar are delivered:

    grid:       arctan(1 · 10/(272.25 + 6))/3             = arctan(0.035939)/3 = 0.0119745     (2.2)
    motor:      arctan(62.3376/(272.25 + 12.46752 · 3))/3 = arctan(0.201315)/3 = 0.0662198
    θ     = -0.0119745 - 0.0662198 - 0.2376705            = -0.3158647 rad
"""

import cmath

import pytest

from tpss.sources.converter import (
    ConverterLaw,
    converter_is_plausible,
    converter_residual,
    converter_voltage,
    grid_angle,
    terminal_voltage,
)

from alternatives import central_difference, pair_by_differences


def station(grid_ohm=0.0, grid_var=0.0, grid_angle_rad=0.0):
    law = (16_500.0, 50e-6, 14.42925, 12.467523, 16_500.0, grid_ohm, grid_var, grid_angle_rad)
    return ConverterLaw.array([law])[0]


STRONG, WEAK = station(), station(grid_ohm=1.0, grid_var=6e6)


def test_terminal_voltage_droops_by_50_volt_a_megavar(as_run):
    assert as_run(converter_voltage)(4e6, 2.0, STRONG) == pytest.approx((16_400.0, -25e-6))


def test_angle_lags_by_17_92_degrees(as_run):
    voltage, direction, *_ = as_run(terminal_voltage)(10e6, 4e6, 2.0, STRONG)
    assert voltage == pytest.approx(16_400.0)
    assert cmath.phase(direction) == pytest.approx(-0.3127011, abs=1e-7)


def test_weak_grid_adds_its_own_angle_of_the_whole_power(as_run):
    _, direction, *_ = as_run(terminal_voltage)(10e6, 4e6, 2.0, WEAK)
    behind, _ = as_run(grid_angle)(10e6, 2.0, WEAK)
    assert cmath.phase(direction) == pytest.approx(-0.3158647, abs=1e-7)
    assert behind == pytest.approx(-0.0119745 - 0.0662198, abs=1e-7)


def test_idle_station_stands_at_16_5_kilovolt_and_angle_zero(as_run):
    voltage, direction, *_ = as_run(terminal_voltage)(0.0, 0.0, 1.0, STRONG)
    assert (voltage, direction) == (16_500.0, 1.0)


def test_angle_of_the_grid_shifts_the_station(as_run):
    _, direction, *_ = as_run(terminal_voltage)(0.0, 0.0, 1.0, station(grid_angle_rad=0.1))
    assert cmath.phase(direction) == pytest.approx(0.1, rel=1e-15)


@pytest.mark.parametrize("converters", [1.0, 3.0, 6.0])
def test_converters_on_a_strong_grid_share_the_power_equally(as_run, converters):
    alone = as_run(terminal_voltage)(5e6, 2e6, 1.0, STRONG)
    together = as_run(terminal_voltage)(5e6 * converters, 2e6 * converters, converters, STRONG)
    assert together[:2] == pytest.approx(alone[:2], rel=1e-12)


def test_a_station_that_receives_power_leads(as_run):
    _, direction, *_ = as_run(terminal_voltage)(-10e6, 0.0, 2.0, STRONG)
    assert direction.imag > 0.0


@pytest.mark.parametrize("law", [STRONG, WEAK], ids=["strong", "weak"])
@pytest.mark.parametrize("converters", [1.0, 4.0])
@pytest.mark.parametrize(
    ("power", "reactive"), [(0.0, 0.0), (10e6, 4e6), (-3e6, 8e6), (30e6, -5e6)]
)
def test_slopes_are_those_of_voltage_and_angle(as_run, law, converters, power, reactive):
    def angle(p, q):
        return cmath.phase(as_run(terminal_voltage)(p, q, converters, law)[1])

    _, _, voltage_slope, by_power, by_reactive = as_run(terminal_voltage)(
        power, reactive, converters, law
    )
    assert voltage_slope == -50e-6 / converters
    expected_by_power = central_difference(lambda p: angle(p, reactive), power, 1e4)
    expected_by_reactive = central_difference(lambda q: angle(power, q), reactive, 1e4)
    assert by_power == pytest.approx(expected_by_power, rel=1e-5)
    assert by_reactive == pytest.approx(expected_by_reactive, rel=1e-5, abs=1e-14)


@pytest.mark.parametrize("law", [STRONG, WEAK], ids=["strong", "weak"])
def test_slope_behind_the_machines_is_that_of_their_angle(as_run, law):
    _, slope = as_run(grid_angle)(10e6, 2.0, law)
    expected = central_difference(lambda p: as_run(grid_angle)(p, 2.0, law)[0], 10e6, 1e4)
    assert slope == pytest.approx(expected, rel=1e-5)


POINTS = [(16.3e3 - 2.1e3j, 520.0 - 310.0j), (15.9e3 + 0.4e3j, -200.0 + 90.0j)]


@pytest.mark.parametrize("law", [STRONG, WEAK], ids=["strong", "weak"])
@pytest.mark.parametrize(("voltage", "current"), POINTS)
def test_residual_is_what_voltage_and_angle_of_the_powers_leave(as_run, law, voltage, current):
    power = voltage * current.conjugate()
    size, direction, *_ = as_run(terminal_voltage)(power.real, power.imag, 2.0, law)
    off, _, _ = as_run(converter_residual)(voltage, current, 2.0, law, False)
    assert off == pytest.approx(voltage - size * direction, abs=1e-9)


@pytest.mark.parametrize("law", [STRONG, WEAK], ids=["strong", "weak"])
@pytest.mark.parametrize("converters", [1.0, 4.0])
@pytest.mark.parametrize(("voltage", "current"), POINTS)
def test_pairs_are_the_derivatives_of_the_residual(as_run, law, converters, voltage, current):
    def off(v, j):
        return as_run(converter_residual)(v, j, converters, law, False)[0]

    _, by_voltage, by_current = as_run(converter_residual)(voltage, current, converters, law, True)
    assert by_voltage == pytest.approx(
        pair_by_differences(lambda v: off(v, current), voltage, 1.0), rel=1e-6, abs=1e-9
    )
    assert by_current == pytest.approx(
        pair_by_differences(lambda j: off(voltage, j), current, 0.1), rel=1e-6, abs=1e-7
    )


def test_a_droop_beyond_zero_is_not_plausible(as_run):
    """16.5 kV over 50 V/Mvar: 330 Mvar from one converter leave nothing."""
    for current_a, plausible in ((-32_900j, True), (-33_100j, False)):
        assert as_run(converter_is_plausible)(1e4 + 0j, current_a, 1.0, STRONG) == plausible
