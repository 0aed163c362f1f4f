"""What runs the steps of a scenario, by the load flow that it asks for."""

from collections.abc import Callable

from tpss.errors import Finding, ScenarioError
from tpss.extras import absent, remedy
from tpss.run.run import Clock
from tpss.step.advance import advance


def _by_least_squares() -> Clock:
    from tpss.original.least_squares import advance_by_least_squares

    return advance_by_least_squares


CLOCKS: dict[str, Callable[[], Clock]] = {
    "equations": lambda: advance,
    "least-squares": _by_least_squares,
}
"""Clocks by the values of `simulation.load_flow`; what they need is imported where it is asked for."""


def clock_of(load_flow: str, file: str) -> Clock:
    """What runs the steps of a scenario.

    Parameters
    ----------
    load_flow : str
        The scenario's choice.
    file : str
        The scenario's file, for an error.

    Raises
    ------
    ScenarioError
        Least squares are asked for, and scipy is not installed.
    """
    if load_flow == "least-squares" and absent("least squares"):
        key, value = "simulation.load_flow", f"'{load_flow}'"
        problem = "the least squares of the original program need scipy, which is not installed"
        to_do = f'{remedy("least squares")}, or load_flow = "equations"'
        raise ScenarioError([Finding(file, key, value, problem, to_do)])
    return CLOCKS[load_flow]()
