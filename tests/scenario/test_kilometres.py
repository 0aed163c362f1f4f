"""Positions and the ends of a line: what lies outside it, and what all positions have in common."""

import copy
from typing import Any

import pytest

import tpss

from properties.kilometres import moved
from scenarios import SHORT_LINE

FAR: dict[str, Any] = moved(SHORT_LINE, 438.0)
"""20 km from km 438 on."""


def faults_of(changes: dict[str, Any], document: dict[str, Any] = FAR) -> list[tuple[str, ...]]:
    """Key, value, problem and remedy of every finding."""
    scenario = tpss.Scenario.from_document(copy.deepcopy(document), "far")
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario.with_(changes)
    return [(f.key, f.value, f.problem, f.remedy) for f in caught.value.findings]


OUTSIDE = "outside the line, which runs from 438 to 458 km"
HIGH_VOLTAGE = "supply.high_voltage_line"
ZONE = {"name": "z", "from_km": 437.0, "to_km": 460.0}


@pytest.mark.parametrize(
    ("changes", "keys"),
    [
        ({"line.stations.1.position_km": 10.0}, ["line.stations.1.position_km"]),
        ({"line.stations.1.position_km": 458.5}, ["line.stations.1.position_km"]),
        ({"supply.converter_stations.0.position_km": 437.9},
         ["supply.converter_stations.0.position_km"]),
        ({HIGH_VOLTAGE: {"type": "132kV", "transformers_km": [5.0, 450.0, 470.0]}},
         [f"{HIGH_VOLTAGE}.transformers_km.0", f"{HIGH_VOLTAGE}.transformers_km.2"]),
        ({"standards.zones": [ZONE]}, ["standards.zones.0.from_km", "standards.zones.0.to_km"]),
        ({"line.speed_limits.0.from_km": 0.0}, ["line.speed_limits.0.from_km"]),
    ],
)  # fmt: skip
def test_what_stands_outside_the_line_is_a_fault_that_names_its_ends(changes, keys):
    faults = faults_of(changes)
    assert [key for key, *_ in faults] == keys
    assert {problem for _, _, problem, _ in faults} == {OUTSIDE}
    assert {remedy for *_, remedy in faults} == {"place it between 438 and 458 km"}


def test_a_train_stands_on_its_route():
    train = {"position_km": -1.0, "speed_kmh": 0.0}
    ((key, value, problem, _),) = faults_of({"traffic.0.initial_trains": [train]})
    assert (key, value) == ("traffic.0.initial_trains.0.position_km", "-1")
    assert problem == "not between West (438 km) and East (458 km)"


def test_positions_beyond_1000_km_are_told_to_the_metre():
    ((_, value, problem, _),) = faults_of(
        {"line.stations.1.position_km": 1458.1234}, moved(SHORT_LINE, 1438.1)
    )
    assert value == "1458.123"
    assert problem == "outside the line, which runs from 1438.1 to 1458.1 km"


def test_a_limit_applies_where_the_line_begins():
    ((key, value, _, remedy),) = faults_of({"line.speed_limits.0.from_km": 440.0})
    assert (key, value) == ("line.speed_limits.0.from_km", "440")
    assert remedy == "make the first limit begin at 438"


def test_gradients_in_other_kilometres_than_the_line_are_a_fault():
    """One gradient alone holds everywhere, and a longer profile may continue beyond the line."""
    rows = [{"from_km": 0.0, "permille": 1.0}, {"from_km": 10.0, "permille": 2.0}]
    ((key, value, problem, _),) = faults_of({"line.gradients": rows})
    assert (key, value) == ("line.gradients.0.from_km", "0")
    assert problem.startswith("none of the gradients, from 0 to 10 km, begins on the line")
    scenario = tpss.Scenario.from_document(FAR, "far")
    assert scenario.with_({"line.gradients": rows[:1]}).line.gradients[0].from_km == 0.0
    rows.append({"from_km": 445.0, "permille": 3.0})
    line = scenario.with_({"line.gradients": rows}).line
    assert line.gradients_between(438.0, 458.0) == [(438.0, 445.0, 2.0), (445.0, 458.0, 3.0)]


@pytest.mark.parametrize("begin_km", [438.0, -2.5])
def test_positions_that_fit_another_beginning_are_one_finding(begin_km):
    """Such as the positions of a register, or of a line that was lengthened beyond its zero."""
    document = moved(SHORT_LINE, begin_km)
    ((key, value, problem, remedy),) = faults_of({"line.begins_at_km": None}, document)
    assert (key, value) == ("line.begins_at_km", "")
    assert problem == (
        "it is missing: without it the line runs from 0 to 20 km, but its positions lie between "
        f"{begin_km:g} and {begin_km + 20.0:g} km"
    )
    assert remedy == f"add begins_at_km = {begin_km:g}"


FALLING = {
    "line.begins_at_km": None,
    "line.length_km": 112.4,
    "line.gradients": [
        {"from_km": 112.4, "permille": 3.0}, {"from_km": 105.0, "permille": -3.0}
    ],
    "line.speed_limits": [
        {"from_km": 112.4, "speed_kmh": 100.0}, {"from_km": 108.0, "speed_kmh": 80.0}
    ],
    "line.stations": [
        {"name": "West", "position_km": 112.4}, {"name": "East", "position_km": 102.4}
    ],
    "supply.converter_stations.0.position_km": 0.0,
    "supply.converter_stations.1.position_km": 100.0,
}  # fmt: skip


def test_falling_kilometres_are_one_finding():
    """To put the profiles in ascending order would leave the gradients with the wrong sign."""
    ((key, value, problem, remedy),) = faults_of(FALLING)
    assert (key, value) == ("line.gradients.1.from_km", "105")
    assert problem == "kilometres fall in the direction of travel: 105 follows 112.4"
    assert "minus sign before every position" in remedy
    assert "line.begins_at_km = -112.4" in remedy


def test_other_faults_are_told_beside_falling_kilometres():
    faults = faults_of(FALLING | {"traffic.0.train": "express", "traffic.0.headway_min": -1.0})
    assert [key for key, *_ in faults] == [
        "traffic.0.headway_min", "line.gradients.1.from_km", "traffic.0.train"
    ]  # fmt: skip


def test_limits_of_the_other_direction_begin_with_the_line_and_within_it():
    late = [{"from_km": 440.0, "speed_kmh": 60.0}]
    before = [{"from_km": 437.0, "speed_kmh": 60.0}]
    ((key, _, problem, _),) = faults_of({"line.speed_limits_down": late})
    assert (key, problem) == (
        "line.speed_limits_down.0.from_km", "no speed limit applies at the beginning of the line",
    )  # fmt: skip
    ((key, _, problem, _),) = faults_of({"line.speed_limits_down": before})
    assert key == "line.speed_limits_down.0.from_km"
    assert problem.startswith("outside the line")
