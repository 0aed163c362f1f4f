"""Dynamic programming on the tree: the exact optimum of areas that share no budget.

Backwards from the last stage: what a configuration costs from a group on is its own operation and, for
each group after it, the least of a change and what comes after that.
"""

import math
from dataclasses import dataclass

import numpy as np

from tpss.errors import NoPlanError, PlanError
from tpss.planning.costs import expected_cost
from tpss.planning.decisions import Decisions, decisions_of
from tpss.planning.level_transitions import table_of
from tpss.planning.money import Array
from tpss.planning.problem import Area, Problem, Solution
from tpss.planning.tree import NONE, Indices


@dataclass(frozen=True)
class Values:
    """What the rest of a plan costs at least, from each group of decisions of an area."""

    decisions: Decisions
    after: Array
    """Expected cost from a group on, its configuration given, shape (groups, configurations)."""
    before: Array
    """The same with the change into the group, the configuration before it given."""
    choice: Indices
    """The best configuration of a group, the one before it given."""

    def least(self, initial: int) -> float:
        """Least expected cost of the area."""
        return math.fsum(self.before[self.decisions.parent == NONE, initial])

    def policy(self, initial: int, given: dict[int, int] | None = None) -> Indices:
        """Best configuration of each node, shape (nodes,), those of some groups given."""
        groups = np.empty(self.decisions.groups, dtype=np.int64)
        for g, parent in enumerate(self.decisions.parent):
            before = initial if parent == NONE else groups[parent]
            groups[g] = (given or {}).get(g, self.choice[g, before])
        return groups[self.decisions.group_of_node]


def values_of(
    area: Area,
    decisions: Decisions,
    multiplier: Array | None = None,
    limit: Array | None = None,
) -> Values:
    """Costs of the best rests of a plan.

    Parameters
    ----------
    area : Area
    decisions : Decisions
        Those of the area.
    multiplier : array, optional
        Price of what is spent in each group, on top of its cost and as worth today, shape (groups,).
    limit : array, optional
        What may be spent in each group, shape (groups,).
    """
    after = decisions.cost.copy()
    before = np.empty_like(after)
    choice = np.empty(after.shape, dtype=np.int64)
    for s in reversed(range(len(decisions.of_stage))):
        groups = decisions.of_stage[s]
        weight = decisions.weight[groups]
        each = after[groups] / weight[:, np.newaxis]
        if multiplier is None and limit is None:
            least, choice[groups] = area.transitions.cheapest(s, each)
        else:
            extra = None if multiplier is None else multiplier[groups] / weight
            most = None if limit is None else limit[groups]
            table = table_of(area.transitions)
            least, choice[groups] = table.cheapest(s, each, extra, most)
        before[groups] = least * weight[:, np.newaxis]
        if s:
            np.add.at(after, decisions.parent[groups], before[groups])
    return Values(decisions, after, before, choice)


def solve(problem: Problem) -> Solution:
    """Best plan of areas that share no budget.

    Raises
    ------
    PlanError
        There is a budget: dynamic programming knows none.
    NoPlanError
        No configuration is allowed in some node.
    """
    _refuse_budget(problem)
    rows, costs = [], []
    for k, area in enumerate(problem.areas):
        values = values_of(area, decisions_of(problem, k))
        costs.append(values.least(area.transitions.initial))
        if not math.isfinite(costs[-1]):
            raise no_plan(problem, k)
        rows.append(values.policy(area.transitions.initial))
    policy = np.array(rows)
    return Solution(policy, expected_cost(problem, policy), math.fsum(costs))


@dataclass(frozen=True)
class FirstDecision:
    """A first decision of an area, and the best plan that contains it."""

    area: int
    nodes: Indices
    """Nodes in which it is in service."""
    configuration: int
    cost: float
    """Expected cost of that plan, in all areas."""
    surplus: float
    """How much more that is than the best plan costs."""
    policy: Indices
    """Shape (areas, nodes)."""

    def is_tie(self, tolerance: float) -> bool:
        """Whether it is as good as the best one, up to a share of the cost."""
        return self.surplus <= tolerance * abs(self.cost)


def first_decisions(problem: Problem) -> list[FirstDecision]:
    """Every first decision with the best plan that contains it, area by area, the best one first.

    The first decision is what the first stage has in service that is not given; where it is ordered one
    stage ahead that is the second.  Those that no plan contains are left out.

    Raises
    ------
    PlanError
        There is a budget.
    NoPlanError
        There is no plan at all.
    """
    best = solve(problem)
    found: list[FirstDecision] = []
    for k, area in enumerate(problem.areas):
        values = values_of(area, decisions_of(problem, k))
        if area.first_free is None:
            continue
        for g in values.decisions.of_stage[area.first_free]:
            found += _with_each(best, k, area, values, int(g))
    return found


def _with_each(
    best: Solution, k: int, area: Area, values: Values, group: int
) -> list[FirstDecision]:
    """Plans with each configuration of a group before which nothing is decided."""
    initial, decisions = area.transitions.initial, values.decisions
    change = area.transitions.costs_from(int(decisions.stage[group]), initial)
    cost = decisions.weight[group] * change + values.after[group]
    surplus = cost - values.before[group, initial]
    found = []
    for c in np.argsort(surplus, kind="stable"):
        if math.isfinite(surplus[c]):
            policy = best.policy.copy()
            policy[k] = values.policy(initial, {group: int(c)})
            more = max(0.0, float(surplus[c]))
            nodes = decisions.nodes(group)
            found.append(FirstDecision(k, nodes, int(c), best.cost + more, more, policy))
    return found


def no_plan(problem: Problem, k: int) -> NoPlanError:
    """Why an area has no plan: the nodes at which none of its configurations can be in service."""
    area, decisions = problem.areas[k], decisions_of(problem, k)
    reached = np.zeros((decisions.groups, area.configurations), dtype=np.bool_)
    for g, parent in enumerate(decisions.parent):
        start = np.arange(area.configurations) == area.transitions.initial
        before = start if parent == NONE else reached[parent]
        follows = area.transitions.reached(int(decisions.stage[g]), before)
        reached[g] = follows & np.isfinite(decisions.cost[g])
    stuck = [g for g in range(decisions.groups) if not reached[g].any()]
    first = [g for g in stuck if decisions.parent[g] == NONE or reached[decisions.parent[g]].any()]
    nodes = [int(n) for g in first for n in decisions.nodes(g)]
    where = "; ".join(problem.label(n) for n in nodes[:3])
    where = where or "some branch: each choice that serves one node leaves another without any"
    return NoPlanError(
        "requirement",
        f"area {area.name}: no configuration that can be in service is allowed in {where}",
        nodes,
    )


def _refuse_budget(problem: Problem) -> None:
    if problem.is_limited:
        raise PlanError("dynamic programming knows no budget; HiGHS does (`tpss.planning.program`)")
