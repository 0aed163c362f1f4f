"""Plans with budgets: an integer program, solved by HiGHS, with a bound of what any plan costs."""

import time
from dataclasses import replace

import numpy as np

from tpss.errors import NoPlanError, PlanError
from tpss.planning import dynamic
from tpss.planning.costs import expected_cost, meets_budget
from tpss.planning.flow import Program, program_of
from tpss.planning.highs import run_highs
from tpss.planning.level_transitions import table_of
from tpss.planning.linear import linear_program, moved
from tpss.planning.money import Array
from tpss.planning.problem import Problem, Solution
from tpss.planning.relaxation import Relaxation, relax, worth_keeping
from tpss.planning.tree import Indices
from tpss.planning.turns import improved_in_turns

GAP = 1e-9
"""Share of the cost up to which a plan counts as the best."""

CHOICE_S = 5.0
"""Time that the choice among plans found by prices may take. [s]"""


def solve_any(problem: Problem, gap: float = GAP, time_limit_s: float = np.inf) -> Solution:
    """Best plan: by dynamic programming without budgets, by HiGHS with them."""
    if problem.is_limited:
        return solve_program(problem, gap, time_limit_s)
    return dynamic.solve(problem)


def solve_program(problem: Problem, gap: float = GAP, time_limit_s: float = np.inf) -> Solution:
    """Best plan within budgets, or the best one found, and a bound.

    Prices on budgets give a bound and a first plan, and show which changes no better plan contains; an
    integer program of the others finds the best one.

    Parameters
    ----------
    problem : Problem
    gap : float
        Share of the cost within which a better plan is not looked for.
    time_limit_s : float
        Time after which the best plan so far is taken. [s]

    Raises
    ------
    NoPlanError
        No plan meets the requirements, or none the budgets.
    PlanError
        HiGHS is not installed, or there is no plan yet when the time is over.
    """
    dynamic.solve(replace(problem, budget=None))  # refuses what no requirement allows
    if not problem.is_limited:
        return solve_flow(problem, program_of(problem), gap, time_limit_s)
    until = time.monotonic() + time_limit_s
    areas = (replace(area, transitions=table_of(area.transitions)) for area in problem.areas)
    problem = replace(problem, areas=tuple(areas))
    relaxation = relax(problem, 0.1 * gap, time.monotonic() + 0.5 * time_limit_s)
    if relaxation.bound == np.inf:
        raise over_budget(problem)
    policy: Indices | None = relaxation.sparing
    if not meets_budget(problem, relaxation.sparing):
        policy = relaxation.best_choice(gap, min(CHOICE_S, 0.25 * time_limit_s))
    if policy is None:
        return solve_flow(problem, program_of(problem), gap, until - time.monotonic())
    enough = relaxation.bound + gap * abs(relaxation.bound)
    policy = improved_in_turns(
        problem, relaxation.found.decisions, policy, relaxation.sparing, enough
    )
    first = _solution(problem, policy, relaxation.bound)
    if first.gap <= gap:
        return first
    return _improved(problem, first, relaxation, gap, until)


def _improved(
    problem: Problem, first: Solution, relaxation: Relaxation, gap: float, until: float
) -> Solution:
    """The best plan, from a first one."""
    program = program_of(problem, worth_keeping(problem, relaxation, first.cost))
    left_s = until - time.monotonic()
    if left_s <= 0.0:
        return first
    found = solve_flow(problem, program, gap, left_s, first.policy)
    best = min(found, first, key=lambda each: each.cost)
    # What was left out costs more than the first plan: the bound holds for it too.
    return replace(best, bound=min(best.cost, max(found.bound, relaxation.bound)))


def solve_flow(
    problem: Problem,
    program: Program,
    gap: float = GAP,
    time_limit_s: float = np.inf,
    begin: Indices | None = None,
) -> Solution:
    """Solve the program of a plan; a linear one without budgets, whose corners are whole numbers.

    Raises
    ------
    NoPlanError
        No plan meets the budgets.
    PlanError
        There is no plan yet when the time is over.
    """
    start = None if begin is None else program.values(problem, begin)
    whole = len(program.linear.cost) if problem.is_limited else 0
    answer = run_highs(program.linear, whole, gap, max(time_limit_s, 0.0), start)
    if answer.x is not None:
        return _solution(problem, program.policy(answer.x), answer.bound)
    if begin is not None:
        return _solution(problem, begin, answer.bound)
    if np.isinf(answer.bound) and answer.bound > 0.0:
        raise over_budget(problem)
    raise PlanError(f"no plan was found in {time_limit_s:g} s: allow more time")


def _solution(problem: Problem, policy: Indices, bound: float) -> Solution:
    cost = expected_cost(problem, policy)
    return Solution(policy, cost, min(bound, cost))


def demand_enough(problem: Problem) -> None:
    """Refuse budgets that no plan meets even if parts of changes could be made.

    They may leave no plan though they pass: that is seen when it is looked for.

    Raises
    ------
    NoPlanError
        By how much they are exceeded, and where.
    PlanError
        HiGHS is not installed.
    """
    if problem.is_limited and (_least_excess(problem, program_of(problem)) > 0.0).any():
        raise over_budget(problem)


def over_budget(problem: Problem) -> NoPlanError:
    """Fault of budgets that no plan meets: those that are exceeded if as little as possible is."""
    program = program_of(problem)
    excess = _least_excess(problem, program)
    over = np.flatnonzero(excess > 0.0)
    nodes = program.budget_nodes[over]
    words = "; ".join(
        f"{excess[k]:.6g} more in {problem.label(int(n))}" for k, n in zip(over, nodes, strict=True)
    )
    remedy = "allow it, or let less fall due there"
    told = f"no plan meets the budget: it takes {words}; {remedy}"
    return NoPlanError("budget", told, nodes.tolist())


def _least_excess(problem: Problem, program: Program) -> Array:
    """By how much each budget is exceeded if all together are by as little as possible."""
    linear, budgets = program.linear, len(program.budget_nodes)
    assert problem.budget is not None
    limit = problem.budget[program.budget_nodes]
    unit = np.where(limit > 0.0, limit, 1.0)
    columns, rows = len(linear.cost), len(linear.low) - budgets
    each = np.arange(budgets)
    more = moved(np.stack([each, each, -1.0 / unit]), rows, columns)
    cost = np.concatenate([np.zeros(columns), np.ones(budgets)])
    upper = np.concatenate([linear.upper, np.full(budgets, np.inf)])
    entries = np.concatenate([linear.entries, more], axis=1)
    elastic = linear_program(cost, upper, linear.low, linear.high, entries)
    x = run_highs(elastic).x
    assert x is not None
    excess = x[columns:]
    excess[excess < 1e-6 * unit] = 0.0
    return excess
