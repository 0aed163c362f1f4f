"""A run that gives way to a newer one, and does not take too long."""

from threading import Timer

from tpss.api import Prepared, build
from tpss.errors import Finding, ScenarioError
from tpss.results.result import Result
from tpss.run.run import INTERRUPTED
from tpss.scenario.scenario import Scenario
from tpss.studio.bounds import demand_bounded
from tpss.studio.newest import DroppedError

LONGEST_S = 30.0
"""Time that a run may take while one edits; the command line runs longer ones."""


def built(scenario: Scenario) -> Prepared:
    """A scenario that is ready to run.

    Raises
    ------
    ScenarioError
        It asks for more than can be simulated while one edits.
    """
    demand_bounded(scenario)
    return build(scenario)


def run_for(prepared: Prepared, interrupted: list[int], *, step_check: bool = False) -> Result:
    """Run that ends early for a newer one, or when it has taken too long.

    Raises
    ------
    DroppedError
        It ended for a newer one.
    ScenarioError
        It took too long.
    """
    late: list[int] = []

    def end() -> None:
        late.append(1)
        interrupted.append(0)

    if interrupted:
        raise DroppedError("a newer run was asked for")
    timer = Timer(LONGEST_S, end)
    timer.daemon = True
    timer.start()
    try:
        result = prepared.run(interrupted=interrupted, step_check=step_check)
    finally:
        timer.cancel()
    if result.status == INTERRUPTED and late:
        source, value = prepared.scenario.given_source, f"more than {LONGEST_S:g} s"
        problem = "the run takes too long to be made while editing"
        remedy = "take a longer step or a shorter time, or save, and run it with tpss run"
        raise ScenarioError([Finding(source, "simulation", value, problem, remedy)])
    if interrupted and not late:
        raise DroppedError("a newer run was asked for")
    return result
