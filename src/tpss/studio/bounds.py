"""What one edit may ask for: as many trains and steps as a page can wait for."""

from tpss.errors import Finding, ScenarioError
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic

MOST_TRAINS = 3_000
"""Trains of a run, about."""

MOST_STEPS = 500_000
"""Steps of a run that has a duration."""

SLOW_KMH = 30.0
"""Speed at which the longest line is taken to be run over, where a run has no duration. [km/h]"""


def demand_bounded(scenario: Scenario) -> None:
    """Refuse a scenario of more trains or steps than can be simulated while one edits.

    Raises
    ------
    ScenarioError
    """
    simulation = scenario.simulation
    longest_km = sum(line.length_km for line in scenario.lines_by_name.values())
    span_min = simulation.duration_min or 60.0 * longest_km / SLOW_KMH
    trains = [_trains_of(service, span_min) for service in scenario.traffic]
    if sum(trains) > MOST_TRAINS:
        worst = max(range(len(trains)), key=trains.__getitem__)
        raise _too_much(
            scenario, f"traffic.{worst}", f"about {sum(trains):,.0f} trains", MOST_TRAINS
        )
    steps = span_min / (simulation.time_step_min or span_min)
    if simulation.duration_min is not None and steps > MOST_STEPS:
        raise _too_much(scenario, "simulation.time_step_min", f"{steps:,.0f} steps", MOST_STEPS)


def _trains_of(service: Traffic, span_min: float) -> float:
    """Trains of a service within a time, about."""
    if service.headway_min is None:
        return len(service.departures_min or (0.0,))
    return 1.0 + span_min / service.headway_min


def _too_much(scenario: Scenario, key: str, value: str, most: int) -> ScenarioError:
    problem = f"more than the {most:,} that are simulated while editing"
    remedy = "ask for fewer, or save the file, and run it with tpss run"
    return ScenarioError([Finding(scenario.given_source, key, value, problem, remedy)])
