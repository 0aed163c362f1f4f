"""The plan of least regret as an integer program: with several areas, budgets and orders far ahead."""

import numpy as np

from tpss.errors import PlanError
from tpss.planning.costs import cost_by_scenario
from tpss.planning.flow import Columns, Program, program_of
from tpss.planning.highs import run_highs
from tpss.planning.linear import LinearProgram, linear_program, moved
from tpss.planning.money import Array
from tpss.planning.problem import Problem, Solution
from tpss.planning.program import GAP, over_budget


def least_regret_by_program(
    problem: Problem, known_cost: Array, gap: float = GAP, time_limit_s: float = np.inf
) -> Solution:
    """Plan whose largest regret is the least; its cost here is that regret.

    Parameters
    ----------
    problem : Problem
    known_cost : array
        What each scenario costs if it is known beforehand, shape (scenarios,).
    gap : float
        Share of the regret within which a better plan is not looked for.
    time_limit_s : float
        Time after which the best plan so far is taken. [s]

    Raises
    ------
    NoPlanError
        No plan meets the budgets.
    PlanError
        HiGHS is not installed, or there is no plan yet when the time is over.
    """
    program = program_of(problem)
    linear = _with_regret(problem, program, known_cost)
    answer = run_highs(linear, len(linear.cost) - 1, gap, time_limit_s)
    if answer.x is None:
        if answer.bound == np.inf:
            raise over_budget(problem)
        raise PlanError(f"no plan was found in {time_limit_s:g} s: allow more time")
    policy = program.policy(answer.x[:-1])
    regret = float((cost_by_scenario(problem, policy) - known_cost).max())
    return Solution(policy, regret, min(answer.bound, regret))


def _with_regret(problem: Problem, program: Program, known_cost: Array) -> LinearProgram:
    """The program with a last column, the regret, that is no less than that of any scenario."""
    linear, scenarios = program.linear, len(problem.tree.names)
    columns, rows = len(linear.cost), len(linear.low)
    parts, offset = [linear.entries], 0
    for one in program.columns:
        for w in range(scenarios):
            parts.append(moved(_entries(problem, one, w), rows + w, offset))
        offset += len(one)
    each = np.arange(scenarios)
    parts.append(np.stack([rows + each, np.full(scenarios, columns), np.full(scenarios, -1.0)]))
    cost = np.append(np.zeros(columns), 1.0)
    low = np.append(linear.low, np.full(scenarios, -np.inf))
    high = np.append(linear.high, known_cost)
    upper = np.append(linear.upper, np.inf)
    return linear_program(cost, upper, low, high, np.concatenate(parts, axis=1))


def _entries(problem: Problem, one: Columns, scenario: int) -> Array:
    """What each change of an area costs in a scenario, discounted: entries of row 0."""
    stages, area = problem.stages, problem.areas[one.area]
    found = [np.empty((3, 0))]
    for s, node in enumerate(problem.tree.node_of[scenario]):
        here = np.flatnonzero(one.group == one.decisions.group_of_node[node])
        stage = np.full(len(here), s)
        change = area.transitions.costs(stage, one.before[here], one.after[here])
        yearly = area.yearly_cost[node, one.after[here]]
        cost = stages.discount[s] * (change + stages.annuity[s] * yearly)
        found.append(np.stack([np.zeros(len(here)), here, cost]))
    return np.concatenate(found, axis=1)
