"""The six-pulse bridge over its three modes, against its formulae and a bridge in the time domain."""

import math

import numpy as np
import pytest

from tpss.kernel import plain
from tpss.physics.rectifier_bridge import bridge_voltage, current_at_power, mode_ends
from tpss.scenario.supply.rectifier_station import MOST_POINTS, RectifierTransformer

LINE_V, X_OHM = 1220.0, 0.1077

TABLE = [
    # current, voltage by formula, voltage of a bridge in the time domain
    (0.0, 1647.578859, None),
    (462.4539595, 1600.017354, 1600.006898),
    (924.907919, 1552.455849, 1552.445393),
    (1849.815838, 1457.332839, 1457.322383),
    (3237.177716, 1314.648324, 1314.637869),
    (4004.968752, 1235.684146, 1235.67369),
    (4624.539595, 1165.014183, 1164.722438),
    (5549.447514, 1028.912667, 1027.479486),
    (6474.355433, 840.103675, 839.1548103),
    (6936.809392, 713.4225731, 713.4047796),
    (7399.263352, 570.7380585, 570.7205231),
    (8324.171271, 285.3690293, 285.3518694),
    (9064.097606, 57.07380585, 57.05816775),
]


@pytest.mark.parametrize(("current_a", "formula_v", "simulated_v"), TABLE)
def test_voltage_over_the_current(current_a, formula_v, simulated_v):
    """1220 V behind 0.1077 ohm; the simulation of 720 steps a period errs most in the second mode."""
    found = bridge_voltage(current_a, LINE_V, X_OHM)
    assert found == pytest.approx(formula_v, abs=1e-5)
    if simulated_v is not None:
        assert found == pytest.approx(simulated_v, abs=1.5)


def test_the_modes_meet_at_their_ends_and_the_last_one_is_the_short_circuit():
    first_a, second_a, third_a = mode_ends(LINE_V, X_OHM)
    assert first_a == pytest.approx(math.sqrt(2.0) * LINE_V / (4.0 * X_OHM))
    for each_a in (first_a, second_a):
        below, above = (bridge_voltage(each_a * f, LINE_V, X_OHM) for f in (1 - 1e-9, 1 + 1e-9))
        assert below == pytest.approx(above, abs=1e-4)
    assert bridge_voltage(third_a, LINE_V, X_OHM) == pytest.approx(0.0, abs=1e-9)


def transformer(bridges="one", load_loss_kw=0.0):
    """1220 V, X = e U² / S for one bridge: 0.1077 ohm with e = 9.5 %."""
    rated_kva = 0.095 * LINE_V**2 / X_OHM / 1e3
    return RectifierTransformer.model_validate(
        {"rated_kva": rated_kva, "secondary_v": LINE_V, "short_circuit_percent": 9.5,
         "bridges": bridges, "load_loss_kw": load_loss_kw}
    )  # fmt: skip


def interpolated(points, current_a):
    amperes, kv = zip(*points, strict=True)
    return float(np.interp(current_a, amperes, kv)) * 1e3


@pytest.mark.parametrize(("current_a", "formula_v", "_"), TABLE)
def test_the_points_of_a_transformer_follow_it_up_to_the_short_circuit(current_a, formula_v, _):
    """Exactly along straight parts; in the bent one within 0.6 % of the voltage without load."""
    points = transformer().points()
    assert len(points) <= MOST_POINTS
    bent = 4005.0 < current_a < 6936.0
    assert interpolated(points, current_a) == pytest.approx(formula_v, abs=10.0 if bent else 1e-3)


def test_bridges_in_series_add_their_voltages_and_bridges_in_parallel_their_currents():
    """Each of two has half the transformer: twice the reactance, so half the currents of one."""
    one, series, parallel = (transformer(each).points() for each in ("one", "series", "parallel"))
    for (one_a, one_kv), (series_a, series_kv), (parallel_a, parallel_kv) in zip(
        one, series, parallel, strict=True
    ):
        assert (series_a, series_kv) == pytest.approx((one_a / 2.0, 2.0 * one_kv))
        assert (parallel_a, parallel_kv) == pytest.approx((one_a, one_kv))


def test_copper_takes_its_part_all_along():
    """13 kW at the rated current of 1313 kVA / 1.6476 kV = 796.9 A: 0.02047 ohm."""
    bare, with_copper = transformer(), transformer(load_loss_kw=13.0)
    ohm = 13e3 / with_copper.rated_a**2
    for (current_a, kv), (same_a, lower_kv) in list(
        zip(bare.points(), with_copper.points(), strict=True)
    )[:-1]:
        assert same_a == current_a
        assert kv - lower_kv == pytest.approx(ohm * current_a / 1e3)
    assert with_copper.points()[-1][0] < bare.points()[-1][0]
    assert with_copper.resistance_ohm == pytest.approx(3.0 * X_OHM / math.pi + ohm)


def test_current_at_a_power_is_that_of_the_characteristic():
    amperes, volts = (
        np.array([0.0, 30.0, 1818.0, 5454.0]),
        np.array([3600.0, 3510.0, 3300.0, 2850.0]),
    )
    current_a = np.array([0.0, 12.0, 30.0, 900.0, 1818.0, 4000.0, 5454.0])
    power_w = current_a * np.interp(current_a, amperes, volts)
    np.testing.assert_allclose(
        plain(current_at_power)(power_w, amperes, volts), current_a, rtol=1e-12
    )


def test_beyond_the_highest_power_it_is_the_current_of_that():
    """1000 V behind 0.1 ohm: U²/4R = 2.5 MW at 5000 A; 3 MW have the same, and -1 MW none."""
    amperes, volts = np.array([0.0, 9000.0]), np.array([1000.0, 100.0])
    found = current_at_power(np.array([2.5e6, 3e6, -1e6]), amperes, volts)
    np.testing.assert_allclose(found, [5000.0, 5000.0, 0.0], rtol=1e-12)
