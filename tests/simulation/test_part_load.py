"""Trains whose efficiency follows their load, up and down a constant grade.

The line and the train are those of the tests of regeneration: at 20 m/s on 10 per mille of 400 t,
39.24 kN, against 10 kN.  Upwards the motors give 49.24 kN or 984.8 kW, 24.6 % of their 4000 kW;
downwards the electric brakes hold 29.24 kN or 584.8 kW, 19.5 % of their 3000 kW and 14.6 % of the
motors' 4000 kW.
"""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from grades import A_N, EFFICIENCY, SPEED_M_S, WEIGHT_N, document, values
from lines import run

from conftest import EXAMPLES
from scenarios import short_line
from slow_audit import assert_agree, audit_of

GRADE_N = WEIGHT_N * 0.01
MIDDLE = slice(150, 200)
UP_AND_DOWN = {"load_percent": [12.0, 16.0, 20.0, 30.0, 100.0], "value": [0.7, 0.7, 0.8, 0.8, 1.0]}
"""Flat around the loads of both ways."""
UNEVEN = {"load_percent": [2.0, 10.0, 40.0, 100.0], "value": [0.5, 0.75, 0.9, 0.85]}


def over_load(permille: float, curve: dict[str, Any], **brakes: Any) -> dict[str, Any]:
    found = document(permille=permille, **brakes)
    found["trains"]["freight"]["efficiency_over_load"] = curve
    return found


def test_motors_take_as_much_more_as_the_load_makes_them_worse() -> None:
    """984.8 kW / (0.8 · 0.8) = 1538.7 kW."""
    drawn = values(run(over_load(10.0, UP_AND_DOWN)), "active_power")[MIDDLE]
    expected = (GRADE_N + A_N) * SPEED_M_S / (EFFICIENCY * 0.8)
    np.testing.assert_allclose(drawn, expected, rtol=1e-9)


def test_motor_power_is_that_at_the_wheel() -> None:
    """There is no slip: what is recorded does not depend on the efficiency."""
    recorded = values(run(over_load(10.0, UP_AND_DOWN)), "motor_power")[MIDDLE]
    np.testing.assert_allclose(recorded, (GRADE_N + A_N) * SPEED_M_S, rtol=1e-9)


@pytest.mark.parametrize(
    ("own", "factor"),
    [({}, 0.7), ({"efficiency_over_load": {"load_percent": [15.0, 25.0, 100.0],
                                           "value": [0.9, 0.9, 1.0]}}, 0.9)],
    ids=["of traction", "of their own"],
)  # fmt: skip
def test_brakes_give_back_less_at_a_low_load(own: dict[str, Any], factor: float) -> None:
    """584.8 kW · 0.8 · 0.7 = 327.5 kW, or by a curve over their own 3000 kW 421.1 kW."""
    wide = {"full_until_kv": 18.5, "zero_from_kv": 19.0}
    gives = -values(run(over_load(-10.0, UP_AND_DOWN, **own, **wide)), "active_power")[MIDDLE]
    expected = (GRADE_N - A_N) * SPEED_M_S * EFFICIENCY * factor
    np.testing.assert_allclose(gives, expected, rtol=1e-9)


@pytest.mark.parametrize("permille", [-10.0, 10.0])
def test_a_flat_curve_is_a_factor(permille: float) -> None:
    """The same as an efficiency of 0.8 · 0.9, but for roundings that the way carries on."""
    flat = over_load(
        permille, {"load_percent": [10.0, 100.0], "value": [0.9, 0.9]}, max_force_kn=1e3
    )
    plain = document(permille=permille, max_force_kn=1e3)
    plain["trains"]["freight"]["efficiency"] = EFFICIENCY * 0.9
    one, two = run(flat), run(plain)
    for name in ("active_power", "regenerated_power", "motor_power", "speed"):
        np.testing.assert_allclose(values(one, name), values(two, name), rtol=1e-9, atol=1e-3)


WITH_CURVE = {
    "trains.freight.efficiency_over_load": {**UNEVEN, "rated_power_kw": 3600.0},
    "traffic.0.headway_min": 6.0,
    "line.gradients": [{"from_km": 0.0, "permille": 3.0}, {"from_km": 9.0, "permille": -6.0}],
}
STEPPED = {
    "whole steps": {},
    "within steps": {"simulation.braking": "within-step"},
    "start": {"simulation.power_sampling": "start"},
    "aggressive": {"simulation.driver": "aggressive"},
    "continuous": {"simulation": {"time_step_min": 0.2}},
    "braking": {"simulation": {"time_step_min": 0.2},
                "trains.freight.regeneration": {"max_force_kn": 150.0, "max_power_kw": 3000.0}},
    "limited": {"trains.freight.current_limitation": {"max_current_a": 150.0}},
    "bridges": {"trains.freight.reactive_power": "double-bridge"},
}  # fmt: skip


@pytest.mark.parametrize("changes", STEPPED.values(), ids=STEPPED)
def test_audit_and_its_slow_twin_pass_trains_that_follow_their_load(
    changes: dict[str, Any],
) -> None:
    scenario = short_line(copy.deepcopy({**changes, **WITH_CURVE}))
    result = tpss.simulate(scenario)
    assert result.status == "finished"
    assert result.audit["passed"], result.audit["failures"]
    expected, limits = audit_of(scenario)
    found = type(expected)(**{name: result.audit[name] for name in vars(expected)})
    assert_agree(found, expected, limits)


def test_loads_beyond_the_curve_are_counted() -> None:
    """Of 500 kW the curve knows all; the motors give twice that."""
    beyond = {**UP_AND_DOWN, "rated_power_kw": 500.0}
    for curve, counts in ((beyond, True), (UP_AND_DOWN, False)):
        limited = run(over_load(10.0, curve)).summary["limited"]
        assert (limited["efficiency_extrapolated"] > 0) == counts


def test_trams_on_their_own_stores_follow_their_load_too() -> None:
    """What a store gives beyond the auxiliaries moves the tram, less what its drive wastes then."""
    scenario = tpss.load_scenario(EXAMPLES / "tram_750v.toml").with_(
        {"trains.tram.efficiency_over_load": UNEVEN, "simulation.duration_min": 20.0}
    )
    result = tpss.simulate(scenario)
    assert result.audit["passed"], result.audit["failures"]
    expected, limits = audit_of(scenario)
    found = type(expected)(**{name: result.audit[name] for name in vars(expected)})
    assert_agree(found, expected, limits)
