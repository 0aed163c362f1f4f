"""Runs in which drivers spare hot motors: 60 km with a climb of 30 km at 10 ‰, a train of 1200 t.

At full effort its motors, warm from 70 % of their continuous current, pass the temperature that they
bear on the climb.
"""

from typing import Any

import numpy as np
import pytest

import tpss

MOTOR = {
    "continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0, "preload_percent": 70.0,
}  # fmt: skip


def climb(motion: str = "continuous", step_min: float = 0.5, **changes: Any) -> tpss.Scenario:
    station = {"type": "Q48/Q49", "converters": 4}
    ends = {"West": 0.0, "East": 60.0}
    scenario = tpss.Scenario.from_document(
        {
            "format": 1,
            "name": "climb",
            "simulation": {"time_step_min": step_min, "motion": motion},
            "line": {
                "length_km": 60.0,
                "gradients": [
                    {"from_km": 0.0, "permille": 0.0},
                    {"from_km": 10.0, "permille": 10.0},
                    {"from_km": 40.0, "permille": 0.0},
                ],
                "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
                "stations": [{"name": name, "position_km": km} for name, km in ends.items()],
            },
            "supply": {
                "catenary": "AT",
                "converter_stations": [
                    {"name": name, "position_km": km, **station} for name, km in ends.items()
                ],
            },
            "trains": {
                "freight": {
                    "model": "Rc4-freight-1470t", "mass_t": 1200.0, "max_motor_current_a": 2080.0,
                    "motor_rating": dict(MOTOR),
                }
            },
            "traffic": [
                {"name": "east", "train": "freight", "from": "West", "to": "East", "headway_min": 30.0}
            ],
        }
    )  # fmt: skip
    return scenario.with_(changes) if changes else scenario


SPARED = {"trains.freight.motor_rating.spared": True}


def hottest_percent(result: tpss.Result) -> float:
    return float(result.thermal.query("kind == 'motors'").highest_state_percent.max())


@pytest.mark.parametrize("motion", ["stepped", "continuous"])
@pytest.mark.parametrize("step_min", [1.0, 0.1])
def test_spared_motors_get_just_as_hot_as_they_may(motion, step_min):
    """Full effort brings them to about 104 % of it; spared, they reach 100 % and stay there."""
    at_full_effort = tpss.simulate(climb(motion, step_min))
    spared = tpss.simulate(climb(motion, step_min, **SPARED))
    assert hottest_percent(at_full_effort) > 103.0
    assert (at_full_effort.thermal.verdict == "over").any()
    assert hottest_percent(spared) == pytest.approx(100.0, abs=1e-6)
    assert (spared.thermal.verdict == "within").all()
    assert spared.summary["trip_time_min"] > at_full_effort.summary["trip_time_min"] + 0.1
    assert spared.summary["limited"]["motors_spared"] > 0
    assert spared.audit["passed"]


def test_the_step_hardly_matters():
    """Steps of a minute and of two seconds: within 0.1 % of the trip."""
    trips = [tpss.simulate(climb(step_min=step_min, **SPARED)).summary["trip_time_min"]
             for step_min in (1.0, 1.0 / 30.0)]  # fmt: skip
    assert trips[0] == pytest.approx(trips[1], rel=1e-3)


def test_a_driver_of_cool_motors_drives_as_any_other():
    level = {"line.gradients.1.permille": 0.0}
    other, sparing = (tpss.simulate(climb(**level, **more)) for more in ({}, SPARED))
    assert sparing.summary["limited"]["motors_spared"] == 0
    assert sparing.dataset.identical(other.dataset.assign_attrs(sparing.dataset.attrs))


def test_the_original_program_s_load_flow_spares_them_too():
    pytest.importorskip("scipy")
    least = {"simulation.load_flow": "least-squares", "simulation.duration_min": 30.0}
    exact = tpss.simulate(climb("stepped", 1.0, **SPARED, **{"simulation.duration_min": 30.0}))
    found = tpss.simulate(climb("stepped", 1.0, **SPARED, **least))
    currents = (result.dataset.motor_current.to_numpy() for result in (exact, found))
    np.testing.assert_allclose(*currents, rtol=1e-5, atol=1e-3)
    assert found.summary["limited"] == exact.summary["limited"]


def test_a_climb_that_takes_more_than_they_bear_stalls_and_the_reason_is_told():
    result = tpss.simulate(climb(**SPARED, **{"line.gradients.1.permille": 19.0}))
    assert result.summary["status"] == "stalled"
    assert "To spare hot motors its driver asks for no more than" in result.summary["problem"]
    assert "leave out motor_rating.spared" in result.summary["advice"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"preload_percent": None}, "has to know how warm they are at first"),
        ({"preload_percent": 120.0}, "leaves motors hotter than they bear"),
    ],
)
def test_without_a_start_that_can_be_spared_it_is_a_fault(changes, said):
    document = climb().as_document()
    rating = {**MOTOR, "spared": True, **changes}
    document["trains"]["freight"]["motor_rating"] = {
        k: v for k, v in rating.items() if v is not None
    }
    with pytest.raises(tpss.ScenarioError, match=said):
        tpss.Scenario.from_document(document)


def test_the_former_model_of_the_motors_voltage_is_refused():
    with pytest.raises(tpss.ScenarioError, match="lets depend on the line voltage"):
        climb(**SPARED, **{"trains.freight.motor_voltage": "former"})
