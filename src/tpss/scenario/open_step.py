"""Scenarios that leave their time step open."""

from tpss.scenario.scenario import Scenario

LADDER_MIN = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
"""Steps from which one is chosen, the longest one first."""


def with_step(scenario: Scenario, step_min: float = LADDER_MIN[-1]) -> Scenario:
    """A scenario with a step if it gives none, by default with the shortest one.

    That is enough to find faults: what a train can do in long steps it can do in short ones.
    """
    if scenario.simulation.time_step_min is not None:
        return scenario
    return scenario.with_({"simulation.time_step_min": step_min})
