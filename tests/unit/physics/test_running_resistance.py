"""Hand-worked train used below.

A = 15 400 N, B = 279 N s/m, C = 49.2 N s²/m², v = 60 km/h = 16.667 m/s
R = 15 400 + 279 · 16.667 + 49.2 · 277.78 = 15 400 + 4 650 + 13 666.7 = 33 716.7 N

1470 t on 10 ‰: 1 470 000 · 9.81 · 0.010 = 144 207 N
"""

import pytest

from tpss.physics.running_resistance import (
    DavisCoefficients,
    by_radius,
    curve_resistance,
    gradient_force,
    running_resistance,
)

FREIGHT = DavisCoefficients.array([(15_400.0, 279.0, 49.2)])[0]


def test_freight_train_meets_33_717_newton_at_60_km_h(as_run):
    assert as_run(running_resistance)(60 / 3.6, FREIGHT) == pytest.approx(33_716.7, abs=0.1)


def test_standing_train_meets_the_constant_part_alone(as_run):
    assert as_run(running_resistance)(0.0, FREIGHT) == 15_400.0


def test_ten_per_mille_uphill_hold_1470_tonnes_back_by_144_kilonewton(as_run):
    assert as_run(gradient_force)(1_470_000.0, 0.010) == pytest.approx(144_207.0)


def test_downhill_pushes_as_uphill_holds_back(as_run):
    assert as_run(gradient_force)(1_470_000.0, -0.010) == pytest.approx(-144_207.0)


def test_level_track_adds_nothing(as_run):
    assert as_run(gradient_force)(1_470_000.0, 0.0) == 0.0


@pytest.mark.parametrize(
    ("radius_m", "permille"), [(705.0, 1.0), (300.0, 650.0 / 245.0), (280.0, 2.0), (130.0, 5.0)]
)
def test_curve_resistance_by_hand(as_run, radius_m, permille):
    assert as_run(curve_resistance)(radius_m) == pytest.approx(permille * 1e-3, rel=1e-14)


def test_a_formula_of_ones_own_by_hand(as_run):
    """800 / R at 400 m, and 690 / (R - 40) at 500 m: 2 and 1.5 per mille."""
    assert as_run(by_radius)(400.0, 800.0, 0.0) == pytest.approx(2e-3, rel=1e-14)
    assert as_run(by_radius)(500.0, 690.0, 40.0) == pytest.approx(1.5e-3, rel=1e-14)
