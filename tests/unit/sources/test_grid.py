"""Hand-worked station used below: E = 16 kV, three transformers of 0.3 + 3j Ω, a grid of 0.2 + 2j Ω.

Z = 0.2 + 2j + (0.3 + 3j)/3 = 0.3 + 3j Ω
at J = 400 - 100j A:  Z J = 120 - 30j + 1200j + 300 = 420 + 1170j V
U = 16 000 - 420 - 1170j = 15 580 - 1170j V
losses: 0.3 · (400² + 100²) = 51 kW
"""

import pytest

from tpss.sources.grid import GridLaw, grid_impedance, grid_losses, grid_residual

from alternatives import pair_by_differences

CURRENT = 400.0 - 100.0j


def station(**changes):
    values = {
        "no_load_voltage_v": 16e3,
        "grid_impedance_ohm": 0.2 + 2.0j,
        "transformer_impedance_ohm": 0.3 + 3.0j,
    }
    return GridLaw.array([GridLaw.row(**{**values, **changes})])[0]


THEVENIN = station()
IDEAL = station(grid_impedance_ohm=0.0, transformer_impedance_ohm=0.0)


def test_transformers_stand_in_parallel_behind_the_grid(as_run):
    assert as_run(grid_impedance)(3.0, THEVENIN) == pytest.approx(0.3 + 3.0j)
    assert as_run(grid_impedance)(1.0, THEVENIN) == pytest.approx(0.5 + 5.0j)


def test_voltage_falls_by_the_current_over_the_impedance(as_run):
    asked = 15_580.0 - 1_170.0j
    residual, _, _ = as_run(grid_residual)(asked, CURRENT, 3.0, THEVENIN)
    assert residual == pytest.approx(0.0, abs=1e-9)
    residual, _, _ = as_run(grid_residual)(asked + 3.0 - 4.0j, CURRENT, 3.0, THEVENIN)
    assert residual == pytest.approx(3.0 - 4.0j)


def test_an_ideal_source_keeps_its_voltage_at_any_current(as_run):
    for current in (0j, CURRENT, -1e4 + 3e3j):
        residual, by_voltage, by_current = as_run(grid_residual)(16e3 + 0j, current, 1.0, IDEAL)
        assert residual == 0.0
        assert (by_voltage, by_current) == ((1.0, 0.0), (0.0, 0.0))
        assert as_run(grid_losses)(current, 1.0, IDEAL) == 0.0


def test_a_no_load_voltage_has_an_angle_too(as_run):
    residual, _, _ = as_run(grid_residual)(16e3 + 0j, 0j, 1.0, station(no_load_voltage_v=16e3j))
    assert residual == pytest.approx(16e3 - 16e3j)


@pytest.mark.parametrize("law", [THEVENIN, IDEAL], ids=["Thévenin", "ideal"])
@pytest.mark.parametrize("transformers", [1.0, 3.0])
def test_pairs_are_the_derivatives_of_the_residual(as_run, law, transformers):
    voltage = 15.1e3 - 0.8e3j

    def off(v, j):
        return as_run(grid_residual)(v, j, transformers, law)[0]

    _, by_voltage, by_current = as_run(grid_residual)(voltage, CURRENT, transformers, law)
    over_voltage = pair_by_differences(lambda v: off(v, CURRENT), voltage, 1.0)
    over_current = pair_by_differences(lambda j: off(voltage, j), CURRENT, 1.0)
    assert by_voltage == pytest.approx(over_voltage, abs=1e-9)
    assert by_current == pytest.approx(over_current, abs=1e-9)


def test_losses_are_resistance_times_the_square_of_the_current(as_run):
    assert as_run(grid_losses)(CURRENT, 3.0, THEVENIN) == pytest.approx(51e3)
    power_lost = (16e3 * CURRENT.conjugate()).real - ((15_580 - 1_170j) * CURRENT.conjugate()).real
    assert power_lost == pytest.approx(51e3)
