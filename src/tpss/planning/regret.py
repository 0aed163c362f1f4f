"""Regret: how much more a plan costs in a future than the best plan of that future.

The plan of least regret is exact for one area: after scenarios part, the worst of them counts, and
each branch does its best.  That is the dynamic program with the largest in the place of the mean.
"""

from collections.abc import Sequence

import numpy as np

from tpss.errors import PlanError
from tpss.planning.costs import cost_by_scenario
from tpss.planning.decisions import Decisions, decisions_of
from tpss.planning.dynamic import Values, no_plan
from tpss.planning.money import Array
from tpss.planning.problem import Problem
from tpss.planning.tree import NONE, Indices


def regrets(problem: Problem, policies: Sequence[Indices], known_cost: Array) -> Array:
    """Regret of each plan in each scenario, shape (plans, scenarios).

    Parameters
    ----------
    problem : Problem
    policies : sequence of arrays
        Configuration of each node, each of the shape (areas, nodes).
    known_cost : array
        What each scenario costs if it is known beforehand, shape (scenarios,).
    """
    return np.array([cost_by_scenario(problem, policy) - known_cost for policy in policies])


def parts_at_orders(problem: Problem) -> bool:
    """Whether what is ordered together always comes from one node: the dynamic program needs that."""
    for k in range(len(problem.areas)):
        decisions = decisions_of(problem, k)
        for g in range(decisions.groups):
            if len(np.unique(problem.tree.parent[decisions.nodes(g)])) > 1:
                return False
    return True


def least_regret(problem: Problem, known_cost: Array) -> Indices:
    """Plan whose largest regret is the least, shape (areas, nodes), of one area without a budget.

    Parameters
    ----------
    problem : Problem
    known_cost : array
        What each scenario costs if it is known beforehand, shape (scenarios,).

    Raises
    ------
    PlanError
        There are several areas, a budget, or orders more than a stage ahead: HiGHS knows these
        (`tpss.planning.regret_program`).
    NoPlanError
        There is no plan.
    """
    if len(problem.areas) > 1 or problem.is_limited or not parts_at_orders(problem):
        raise PlanError("regret of several areas, budgets or orders far ahead needs HiGHS")
    area, decisions = problem.areas[0], decisions_of(problem, 0)
    after = np.empty(decisions.cost.shape)
    before = np.empty_like(after)
    choice = np.empty(after.shape, dtype=np.int64)
    discount = problem.stages.discount
    for g in reversed(range(decisions.groups)):
        stage = int(decisions.stage[g])
        after[g] = _worst(problem, decisions, g, before, known_cost)
        least, to = area.transitions.cheapest(stage, after[g][np.newaxis] / discount[stage])
        before[g], choice[g] = least[0] * discount[stage], to[0]
    initial = area.transitions.initial
    if not np.isfinite(before[decisions.parent == NONE, initial]).all():
        raise no_plan(problem, 0)
    return Values(decisions, after, before, choice).policy(initial)[np.newaxis]


def _worst(
    problem: Problem, decisions: Decisions, group: int, before: Array, known_cost: Array
) -> Array:
    """Largest regret from a group on, without what was paid before, shape (configurations,)."""
    tree, stages, table = problem.tree, problem.stages, problem.areas[0].yearly_cost
    stage = decisions.stage[group]
    worst = np.full(table.shape[1], -np.inf)
    for node in decisions.nodes(group):
        own = stages.discount[stage] * stages.annuity[stage] * table[node]
        later = np.unique(decisions.group_of_node[tree.parent == node])
        if len(later):
            rest = before[later].max(axis=0)
        else:
            through = tree.node_of[:, stage] == node
            rest = np.full(table.shape[1], -known_cost[through].min())
        worst = np.maximum(worst, own + rest)
    return np.where(np.isfinite(decisions.cost[group]), worst, np.inf)
