"""Ratings of equipment: each fault is reported with its place and a remedy."""

import copy
from typing import Any

import pytest

from lines import line, network, scenario_of, service
from tpss import ScenarioError

WIRE = {"continuous_a": 467.0, "time_constant_min": 4.7}
MOTOR = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
OVERLOADS = [{"percent": 125.0, "minutes": 60.0}, {"percent": 150.0, "minutes": 5.0}]
HIGH = {"type": "132kV", "transformers": 0}
UNIT = {"r_ohm": 0.065, "x_ohm": 0.85}


def document(**ratings: Any) -> dict[str, Any]:
    """A line with ratings of its contact line, its trains' motors, or a transformer."""
    made = line(40.0, {"A": 0.0, "B": 40.0})
    found = network({"main": made}, [service("up", "A", "B")])
    found["supply"]["catenary"] = {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2}
    found["trains"] = copy.deepcopy(found["trains"])
    if "wire" in ratings:
        found["supply"]["catenary"]["rating"] = ratings["wire"]
    if "motor" in ratings:
        found["trains"]["freight"]["motor_rating"] = ratings["motor"]
    if "unit" in ratings:
        transformer = {**UNIT, "rating": ratings["unit"]}
        found["supply"]["high_voltage_line"] = {**HIGH, "station_transformer": transformer}
    return found


def findings(found: dict[str, Any]) -> str:
    with pytest.raises(ScenarioError) as caught:
        scenario_of(found)
    return str(caught.value)


def test_ratings_of_all_kinds_are_read():
    unit = {"rating_mva": 16.0, "cooling": "ONAF", "overloads": OVERLOADS}
    wire = {**WIRE, "reference_c": 80.0, "ambient_c": 40.0}
    scenario = scenario_of(document(wire=wire, motor=MOTOR, unit=unit))
    high_voltage = scenario.supply.high_voltage_line
    assert scenario.supply.catenary.rating.continuous_a == 467.0
    assert high_voltage.station_transformer.rating.overloads[1].minutes == 5.0
    assert scenario_of(scenario.as_document()) == scenario


FAULTS = {
    "a rating without time constant": (
        {"wire": {"continuous_a": 467.0}},
        ["supply.catenary.rating.time_constant_min"],
    ),
    "overloads that fall": (
        {"wire": {**WIRE, "overloads": OVERLOADS[::-1]}},
        ["supply.catenary.rating.overloads", "125 % for 60 min follows 150 % for 5 min"],
    ),
    "a higher overload that lasts longer": (
        {"wire": {**WIRE, "overloads": [OVERLOADS[0], {"percent": 150.0, "minutes": 90.0}]}},
        ["150 % for 90 min follows 125 % for 60 min", "higher, and shorter"],
    ),
    "an overload that is none": (
        {"wire": {**WIRE, "overloads": [{"percent": 90.0, "minutes": 5.0}]}},
        ["supply.catenary.rating.overloads.0.percent", "100"],
    ),
    "air warmer than the wire": (
        {"wire": {**WIRE, "reference_c": 80.0, "ambient_c": 80.0}},
        ["ambient_c (80 °C) is not below reference_c (80 °C)"],
    ),
    "one temperature": (
        {"wire": {**WIRE, "reference_c": 80.0}},
        ["reference_c and ambient_c belong together"],
    ),
    "a preload below zero": (
        {"wire": {**WIRE, "preload_percent": -1.0}},
        ["supply.catenary.rating.preload_percent"],
    ),
    "a transformer that is not said to cool": (
        {"unit": {"rating_mva": 25.0}},
        ["give either cooling or time_constant_min"],
    ),
    "a transformer that cools in two ways": (
        {"unit": {"rating_mva": 25.0, "cooling": "ONAF", "time_constant_min": 75.0}},
        ["give either cooling or time_constant_min", "leave one of them out"],
    ),
    "a cooling that is not known": (
        {"unit": {"rating_mva": 25.0, "cooling": "OFAF"}},
        ["station_transformer.rating.cooling", "ONAF"],
    ),
    "a temperature of no use": (
        {"unit": {"rating_mva": 25.0, "time_constant_min": 75.0, "ambient_c": 20.0}},
        ["ambient_c without cooling"],
    ),
    "air hotter than the hot spot": (
        {"unit": {"rating_mva": 25.0, "cooling": "ONAN", "ambient_c": 60.0,
                  "highest_hot_spot_c": 55.0}},
        ["ambient_c (60 °C) is not below highest_hot_spot_c (55 °C)"],
    ),
    "a transformer without rated power": (
        {"unit": {"cooling": "ONAN"}},
        ["station_transformer.rating.rating_mva"],
    ),
    "a short-time current below the continuous one": (
        {"motor": {**MOTOR, "short_time_a": 1250.0}},
        ["short_time_a (1250 A) is not above continuous_a (1250 A)"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_its_place(name):
    ratings, shown = FAULTS[name]
    said = findings(document(**ratings))
    assert all(each in said for each in shown), said


MACHINE = {
    "mass_t": 400.0, "adhesive_mass_t": 200.0, "max_speed_kmh": 120.0, "max_retardation_m_s2": 0.5,
    "resistance_a_n": 1e4, "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0,
    "efficiency": 0.8, "auxiliary_power_kw": 0.0, "power_factor": 1.0, "motor_rating": MOTOR,
    "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 4000.0},
}  # fmt: skip
"""A train whose motors' voltage is not described."""

VOLTAGE = {"base_speed_kmh": 78.0, "max_motor_voltage_v": 770.0}


def test_motors_whose_current_is_not_known_cannot_be_judged():
    found = document()
    found["trains"]["freight"] = MACHINE
    said = findings(found)
    assert (
        "motor_rating judges the motors' current, which is not known without their voltage" in said
    )
    assert "give base_speed_kmh and max_motor_voltage_v" in said
    found["trains"]["freight"] = {**MACHINE, **VOLTAGE}
    assert scenario_of(found).trains["freight"].motor_rating is not None


def test_motors_that_brake_cannot_be_judged():
    found = document()
    brakes = {"max_force_kn": 150.0, "max_power_kw": 3000.0}
    found["trains"]["freight"] = {**MACHINE, **VOLTAGE, "regeneration": brakes}
    assert "which is not recorded while they brake" in findings(found)
