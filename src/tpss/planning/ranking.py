"""The best plans in the order of their costs: the best one, the second best, and so on.

A plan from a group of decisions on is a sum: one rest for each group after it.  A rest is a choice among
configurations.  Both are sorted streams that are extended only as far as somebody asks, so the first
few of 10^20 plans cost no more than a few looks at each group.
"""

import heapq
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np

from tpss.errors import PlanError
from tpss.planning.costs import expected_cost
from tpss.planning.decisions import decisions_of
from tpss.planning.dynamic import Values, solve, values_of
from tpss.planning.problem import Area, Problem, Solution
from tpss.planning.tree import NONE, Indices


class Item(NamedTuple):
    """One way to go on."""

    cost: float
    configuration: int
    """Configuration that is chosen; -1 of a sum, which chooses none."""
    ranks: tuple[int, ...]
    """Rank, counted from 0, of what follows: of the rest, or of each part of a sum."""


@dataclass
class Stream:
    """Items of an iterator, kept, so that several can read them."""

    source: Iterator[Item]
    found: list[Item] = field(default_factory=list)

    def at(self, rank: int) -> Item | None:
        """The item of a rank, if there are so many."""
        while len(self.found) <= rank:
            if (item := next(self.source, None)) is None:
                return None
            self.found.append(item)
        return self.found[rank]


def sums(own_cost: float, parts: Sequence[Stream]) -> Iterator[Item]:
    """Sums of an item of each part, by rising cost."""

    def item(ranks: tuple[int, ...]) -> Item | None:
        each = [part.at(rank) for part, rank in zip(parts, ranks, strict=True)]
        costs = [one.cost for one in each if one is not None]
        return Item(math.fsum([own_cost, *costs]), NONE, ranks) if len(costs) == len(each) else None

    first = (0,) * len(parts)
    known, open_items = {first}, [one for one in [item(first)] if one]
    while open_items:
        yield (best := heapq.heappop(open_items))
        for k in range(len(parts)):
            ranks = (*best.ranks[:k], best.ranks[k] + 1, *best.ranks[k + 1 :])
            if ranks not in known and (one := item(ranks)):
                known.add(ranks)
                heapq.heappush(open_items, one)


class AreaRanking:
    """Plans of one area by rising cost."""

    def __init__(self, area: Area, values: Values) -> None:
        self.area, self.values = area, values
        self.after = cache(self._after)
        self.before = cache(self._before)

    def roots(self) -> list[Stream]:
        """Plans from each group of the first stage on."""
        initial = self.area.transitions.initial
        return [self.before(int(g), initial) for g in self.values.decisions.of_stage[0]]

    def policy(self, ranks: Sequence[int]) -> Indices:
        """Configuration of each node, shape (nodes,), of plans from the first stage's groups on."""
        decisions, initial = self.values.decisions, self.area.transitions.initial
        groups = np.empty(decisions.groups, dtype=np.int64)
        waiting = [
            (int(g), initial, rank) for g, rank in zip(decisions.of_stage[0], ranks, strict=True)
        ]
        while waiting:
            group, before, rank = waiting.pop()
            choice = self.before(group, before).found[rank]
            groups[group] = choice.configuration
            rest = self.after(group, choice.configuration).found[choice.ranks[0]]
            children = decisions.children[group]
            waiting += [
                (int(g), choice.configuration, r) for g, r in zip(children, rest.ranks, strict=True)
            ]
        return groups[decisions.group_of_node]

    def _after(self, group: int, configuration: int) -> Stream:
        decisions = self.values.decisions
        parts = [self.before(int(g), configuration) for g in decisions.children[group]]
        return Stream(sums(float(decisions.cost[group, configuration]), parts))

    def _before(self, group: int, configuration: int) -> Stream:
        return Stream(self._choices(group, configuration))

    def _choices(self, group: int, before: int) -> Iterator[Item]:
        """Configurations of a group with what follows, by rising cost."""
        decisions = self.values.decisions
        stage = int(decisions.stage[group])
        change = decisions.weight[group] * self.area.transitions.costs_from(stage, before)
        least = change + self.values.after[group]
        possible = np.flatnonzero(np.isfinite(least))
        waiting = [Item(float(least[c]), int(c), (0,)) for c in possible]
        heapq.heapify(waiting)
        while waiting:
            best = heapq.heappop(waiting)
            c, rest = best.configuration, self.after(int(group), best.configuration)
            if (now := rest.at(best.ranks[0])) is None:
                continue
            yield best._replace(cost=float(change[c]) + now.cost)
            if (more := rest.at(best.ranks[0] + 1)) is not None:
                item = Item(float(change[c]) + more.cost, c, (best.ranks[0] + 1,))
                heapq.heappush(waiting, item)


def best_plans(problem: Problem, count: int) -> list[Solution]:
    """The best plans, the best one first; fewer if there are no more.

    Equal costs are ties, whatever their order.

    Parameters
    ----------
    problem : Problem
        Without a budget.
    count : int
        How many plans.

    Raises
    ------
    PlanError
        There is a budget, or no plan is asked for.
    NoPlanError
        There is no plan.
    """
    if count < 1:
        raise PlanError(f"the number of best plans is 1 or more, not {count}")
    bound = solve(problem).bound
    rankings = [
        AreaRanking(area, values_of(area, decisions_of(problem, k)))
        for k, area in enumerate(problem.areas)
    ]
    roots = [ranking.roots() for ranking in rankings]
    plans = Stream(sums(0.0, [root for of_area in roots for root in of_area]))
    found = []
    for rank in range(count):
        if (item := plans.at(rank)) is None:
            break
        ranks, rows = iter(item.ranks), []
        for ranking, of_area in zip(rankings, roots, strict=True):
            rows.append(ranking.policy([next(ranks) for _ in of_area]))
        policy = np.array(rows)
        found.append(Solution(policy, expected_cost(problem, policy), bound))
    return found
