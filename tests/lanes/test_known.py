"""What lanes cover is told in one place, and what they do not cover runs alone."""

from typing import Any

import pytest

import tpss
from tpss.api import build
from tpss.lanes.known import RULES, covers, not_covered
from tpss.lanes.structure import structure_of

from scenarios import short_line

CONTINUOUS = {"simulation.motion": "continuous", "simulation.braking": None}
TABLE = {"speed_kmh": [0.0, 60.0, 120.0], "force_kn": [200.0, 200.0, 100.0]}
RATED = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}

OUTSIDE: dict[str, dict[str, Any]] = {
    "trains move in steps": CONTINUOUS,
    "trains brake in whole steps": {"simulation.braking": "within-step"},
    "runs are long enough to be worth it": {"simulation.time_step_min": 1.0},
    "all trains have one type and one route, along one line": {
        "traffic.+": {
            "name": "westbound", "train": "freight", "from": "East", "to": "West",
            "headway_min": 60.0,
        }
    },
    "all key figures follow from the figures of steps": {"trains.freight.motor_rating": RATED},
    "no law of somebody's own, no driver who spares motors": {
        "trains.freight.motor_rating": {**RATED, "preload_percent": 70.0, "spared": True}
    },
    "every station has converters of one law, and feeds at all times": {
        "outages": [{"name": "out", "stations": ["West"], "from_min": 3.0, "to_min": 6.0}],
        "simulation.outage": "out",
    },
}  # fmt: skip
"""Changes of the short line by which a rule does not hold."""


def test_a_line_of_the_thesis_is_covered():
    assert not_covered(build(short_line())) == []
    assert covers(build(short_line()))


@pytest.mark.parametrize("words", OUTSIDE)
def test_a_case_for_which_a_rule_does_not_hold_is_not_covered(words):
    case = build(short_line(OUTSIDE[words]))
    assert words in not_covered(case)
    assert not covers(case)


def test_rules_decide_each_condition_once():
    conditions = [condition for rule in RULES for condition in rule.decides]
    assert len(conditions) == len(set(conditions))


@pytest.mark.parametrize(
    ("changes", "alike"),
    [
        ({"trains.freight.mass_t": 900.0}, True),
        ({"traffic.0.headway_min": 7.0}, True),
        ({"line.gradients": [{"from_km": k, "permille": 1.0} for k in (0.0, 3.0, 9.0)]}, True),
        ({"simulation.time_step_min": 0.1}, False),
        ({"simulation.braking": "within-step"}, False),
        ({"supply.converter_stations.0.converters": 3}, False),
        ({"trains.freight.reactive_power": "double-bridge"}, False),
    ],
    ids=["mass", "headway", "gradients", "step", "braking", "converters", "reactive power"],
)
def test_cases_are_alike_whose_kernels_branch_alike(changes, alike):
    first, other = (structure_of(build(short_line(each))) for each in ({}, changes))
    assert (first == other) is alike


def test_the_figures_say_which_way_they_were_computed():
    """By themselves cases run alone until the kernels of lanes are worth it."""
    (figures,) = tpss.simulate_many([short_line()])
    assert figures.way == "alone"
