"""The best plans within budgets, the best one first: HiGHS, with each plan that was found cut off."""

import time
from dataclasses import replace

import numpy as np

from tpss.planning.costs import expected_cost
from tpss.planning.flow import Program, program_of
from tpss.planning.highs import run_highs
from tpss.planning.linear import LinearProgram, linear_program, moved
from tpss.planning.money import Array
from tpss.planning.problem import Problem, Solution
from tpss.planning.program import GAP

MOST_COLUMNS = 20_000
"""Possible changes up to which further plans are looked for: beyond, each takes too long."""


def best_plans_within(
    problem: Problem, best: Solution, count: int, gap: float = GAP, time_limit_s: float = np.inf
) -> list[Solution]:
    """The best plans within budgets, the best one first; fewer if there are no more, or no more time.

    Parameters
    ----------
    problem : Problem
        With a budget.
    best : Solution
        The best plan, up to the gap.
    count : int
        How many plans.
    gap : float
        Share of the cost within which a better plan is not looked for, each time.
    time_limit_s : float
        Time after which those found so far are taken. [s]
    """
    program = program_of(problem)
    if len(program.linear.cost) > MOST_COLUMNS:
        return [best]
    found, until = [best], time.monotonic() + time_limit_s
    while len(found) < count:
        program = _without(program, program.values(problem, found[-1].policy))
        left_s = max(0.0, until - time.monotonic())
        answer = run_highs(program.linear, len(program.linear.cost), gap, left_s)
        if answer.x is None:
            break
        policy = program.policy(answer.x)
        found.append(Solution(policy, expected_cost(problem, policy), answer.bound))
    return sorted(found, key=lambda each: each.cost)


def _without(program: Program, x: Array) -> Program:
    """The program without one of its solutions: not all of its changes come together again."""
    linear: LinearProgram = program.linear
    used = np.flatnonzero(x > 0.5)
    row = np.stack([np.zeros(len(used)), used.astype(np.float64), np.ones(len(used))])
    entries = np.concatenate([linear.entries, moved(row, len(linear.low), 0)], axis=1)
    low, high = np.append(linear.low, -np.inf), np.append(linear.high, len(used) - 1.0)
    return replace(program, linear=linear_program(linear.cost, linear.upper, low, high, entries))
