"""The clock with the load flow that a scenario asks for."""

from importlib.util import find_spec

from tpss.errors import Finding, ScenarioError
from tpss.scenario.scenario import Scenario
from tpss.simulation.advance import advance
from tpss.simulation.run import Clock


def clock_of(scenario: Scenario) -> Clock:
    """What runs the steps of a scenario.

    Raises
    ------
    ScenarioError
        Least squares are asked for, and scipy is not installed.
    """
    if scenario.simulation.load_flow == "equations":
        return advance
    if find_spec("scipy") is None:
        key, value = "simulation.load_flow", "'least-squares'"
        problem = "the least squares of the original program need scipy, which is not installed"
        remedy = "pip install 'tpss[least-squares]', or load_flow = \"equations\""
        raise ScenarioError([Finding(str(scenario.source), key, value, problem, remedy)])
    from tpss.original.least_squares import advance_by_least_squares

    return advance_by_least_squares
