"""Better plans within budgets, an area at a time: each in its turn does its best with what is left.

What the other areas leave of a budget limits single changes of one area, which dynamic programming can
obey.  The plan gets better with each turn until none helps.  Then a few areas give back what they spend,
and all take their turns in another order, as long as that finds better plans (iterated local search).
"""

import math

import numpy as np

from tpss.planning.costs import change_outlays, expected_cost, meets_budget, outlay
from tpss.planning.decisions import Decisions
from tpss.planning.dynamic import values_of
from tpss.planning.problem import Problem
from tpss.planning.tree import Indices

GIVING_BACK = 3
"""Areas that give back what they spend, at a time."""

PATIENCE = 60
"""So many times without a better plan end the search."""

ROUNDING = 1e-9
"""Share of a budget, or of a cost, that counts as nothing."""


def improved_in_turns(
    problem: Problem, decisions: list[Decisions], policy: Indices, sparing: Indices, enough: float
) -> Indices:
    """A plan that is as good, or better, and keeps within the budgets.

    Parameters
    ----------
    problem : Problem
        With a budget.
    decisions : list of Decisions
        Of each area.
    policy : array
        A plan within the budgets, shape (areas, nodes).
    sparing : array
        The plan that spends least, of the same shape.
    enough : float
        A plan that costs no more need not be improved.
    """
    draw = np.random.default_rng(0)
    best = _descended(problem, decisions, policy, draw.permutation(len(policy)))
    least, tries = expected_cost(problem, best), 0
    while least > enough and tries < PATIENCE:
        changed = best.copy()
        giving = draw.choice(len(policy), min(GIVING_BACK, len(policy)), replace=False)
        changed[giving] = sparing[giving]
        found = _descended(problem, decisions, changed, draw.permutation(len(policy)))
        cost, tries = expected_cost(problem, found), tries + 1
        if cost < least - ROUNDING * abs(least) and meets_budget(problem, found):
            best, least, tries = found, cost, 0
    return best


def _descended(
    problem: Problem, decisions: list[Decisions], policy: Indices, order: Indices
) -> Indices:
    """A plan that no area alone can make better, by turns in an order."""
    policy = policy.copy()
    cost, before = expected_cost(problem, policy), math.inf
    while cost < before - ROUNDING * abs(cost):
        for k in order:
            policy[k] = _best_of_rest(problem, decisions[k], int(k), policy)
        before, cost = cost, expected_cost(problem, policy)
    return policy


def _best_of_rest(problem: Problem, decisions: Decisions, k: int, policy: Indices) -> Indices:
    """Best plan of an area with what the others leave of the budgets."""
    assert problem.budget is not None
    area = problem.areas[k]
    own = change_outlays(problem, k, policy[k])
    left = problem.budget - outlay(problem, policy) + own
    left += ROUNDING * np.maximum(1.0, np.abs(own))
    values = values_of(area, decisions, limit=decisions.smallest(left))
    if not math.isfinite(values.least(area.transitions.initial)):
        same: Indices = policy[k]
        return same
    best: Indices = values.policy(area.transitions.initial)
    return best
