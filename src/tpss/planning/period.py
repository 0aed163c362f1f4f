"""The period after which a timetable repeats: means are taken over whole ones."""

import math
from fractions import Fraction

from tpss.errors import Finding, ScenarioError
from tpss.planning.plan import Evaluation
from tpss.scenario.scenario import Scenario

LONGEST_MIN = 1440.0
"""Longest period that headways of several services may have together. [min]"""


def period_of(scenario: Scenario, evaluation: Evaluation) -> float:
    """Time after which all services repeat: the least common multiple of their headways. [min]

    Where departures are listed it is the period that the plan gives.

    Raises
    ------
    ScenarioError
        Departures are listed and no period is given, or headways repeat together too seldom.
    """
    if evaluation.period_min is not None:
        return evaluation.period_min
    headways = [entry.headway_min for entry in scenario.traffic]
    if any(headway is None for headway in headways):
        problem = "departures are listed, and after which time they repeat is not said"
        raise ScenarioError([_finding(scenario, problem, "add it, such as 1440 of a day")])
    period = _common_multiple([Fraction(str(headway)) for headway in headways])
    if period > LONGEST_MIN:
        shown = ", ".join(f"{headway:g}" for headway in headways)
        problem = f"headways of {shown} min repeat together only after {float(period):g} min"
        remedy = "take headways with a shorter common multiple, or give a period to take means over"
        raise ScenarioError([_finding(scenario, problem, remedy)])
    return float(period)


def _common_multiple(numbers: list[Fraction]) -> Fraction:
    """Least common multiple of fractions: that of numerators over a common denominator."""
    denominator = math.lcm(*(number.denominator for number in numbers))
    return Fraction(math.lcm(*(int(number * denominator) for number in numbers)), denominator)


def _finding(scenario: Scenario, problem: str, remedy: str) -> Finding:
    return Finding(scenario.given_source, "evaluate.period_min", "", problem, remedy)
