r"""Prices on budgets: a bound of what plans with budgets cost, and good plans on the way there.

With a price :math:`\lambda_n \ge 0` of what is spent in a node, areas are on their own again, and

.. math:: L(\lambda) = \sum_{areas} \min_{plan} [cost + \lambda \cdot outlay] - \lambda \cdot budget

is no more than any plan within the budgets costs.  Each price adds the plans found to a list, the best
mixture of the plans in the list gives the next prices (column generation, Dantzig and Wolfe), until the
mixture costs no more than the bound.  The best choice of a plan of the list for each area is a good
plan, and what costs more than it even with the prices can be left out of the exact search.
"""

import time
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tpss.planning.costs import change_costs, change_outlays
from tpss.planning.decisions import Decisions, decisions_of
from tpss.planning.dynamic import Values, values_of
from tpss.planning.highs import Answer, run_highs
from tpss.planning.level_transitions import table_of
from tpss.planning.linear import LinearProgram, linear_program
from tpss.planning.money import Array
from tpss.planning.problem import Area, Problem
from tpss.planning.tree import NONE, Indices

Flags = npt.NDArray[np.bool_]

CLOSED = 1e-10
"""Share of the cost up to which the mixture costs no more than the bound."""

EXCEEDED = 1e-7
"""Share of a budget by which the best mixture may be over it."""

ROUNDS = 300
"""After so many prices the best bound so far is taken; it is one at any time."""


@dataclass(frozen=True)
class AreaPlan:
    """A plan of one area."""

    configuration: Indices
    """Shape (nodes,)."""
    cost: float
    outlay: Array
    """What it spends in each node with a budget."""


@dataclass
class PlanList:
    """Plans of each area that were found, each once."""

    problem: Problem
    nodes: Indices
    """Those with a budget."""
    decisions: list[Decisions]
    """Of each area."""
    plans: list[list[AreaPlan]] = field(init=False)
    known: set[tuple[int, bytes]] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.plans = [[] for _ in self.problem.areas]

    def add(self, k: int, configuration: Indices) -> bool:
        """Add a plan of an area; whether it is new."""
        if (key := (k, configuration.tobytes())) in self.known:
            return False
        self.known.add(key)
        area, tree, stages = self.problem.areas[k], self.problem.tree, self.problem.stages
        once = change_costs(self.problem, k, configuration)
        yearly = area.yearly_cost[np.arange(tree.nodes), configuration]
        cost = float(self.problem.weight @ (stages.annuity[tree.stage] * yearly + once))
        spent = change_outlays(self.problem, k, configuration)
        self.plans[k].append(AreaPlan(configuration, cost, spent[self.nodes]))
        return True

    def limits(self) -> tuple[Array, Array]:
        """Budget of each node that has one, and the unit in which it is 1, or 0."""
        assert self.problem.budget is not None
        limit: Array = self.problem.budget[self.nodes]
        return limit, np.where(limit > 0.0, limit, 1.0)

    def mixture(self, excess: bool) -> LinearProgram:
        """Best mixture of plans within the budgets; or, if asked for, with the least excess."""
        flat = [(k, plan) for k, plans in enumerate(self.plans) for plan in plans]
        limit, unit = self.limits()
        areas, budgets = len(self.plans), len(self.nodes)
        spent = np.array([plan.outlay / unit for _, plan in flat]).T
        rows, columns = np.nonzero(spent)
        own = np.array([(k, j, 1.0) for j, (k, _) in enumerate(flat)]).T
        entries = [own, np.stack([areas + rows, columns, spent[rows, columns]])]
        cost = np.array([0.0 if excess else plan.cost for _, plan in flat])
        if excess:
            more = np.arange(budgets)
            entries.append(np.stack([areas + more, len(flat) + more, np.full(budgets, -1.0)]))
            cost = np.concatenate([cost, np.ones(budgets)])
        low = np.concatenate([np.ones(areas), np.full(budgets, -np.inf)])
        high = np.concatenate([np.ones(areas), limit / unit])
        return linear_program(cost, np.full(len(cost), np.inf), low, high, np.hstack(entries))


@dataclass(frozen=True)
class Relaxation:
    """What prices on budgets show."""

    bound: float
    """No plan within the budgets costs less; infinite if there is none."""
    price: Array
    """Price of what is spent in each node, shape (nodes,), that gives the bound."""
    found: PlanList
    sparing: Indices
    """The plan that spends least, shape (areas, nodes), budgets in their own units."""

    def best_choice(self, gap: float, time_limit_s: float) -> Indices | None:
        """Best choice of a plan of each area, shape (areas, nodes), if one was found."""
        program = self.found.mixture(excess=False)
        x = run_highs(program, len(program.cost), gap, time_limit_s).x
        if x is None:
            return None
        rows, start = [], 0
        for plans in self.found.plans:
            taken = int(np.argmax(x[start : start + len(plans)]))
            rows.append(plans[taken].configuration)
            start += len(plans)
        return np.array(rows)


def relax(problem: Problem, gap: float = CLOSED, until_s: float = np.inf) -> Relaxation:
    """Bound and plans by prices on budgets.

    Parameters
    ----------
    problem : Problem
        With a budget, and a plan without it.
    gap : float
        Share of the cost up to which the mixture counts as no more than the bound.
    until_s : float
        Time of `time.monotonic` after which the best bound so far is taken. [s]
    """
    assert problem.budget is not None
    nodes = np.flatnonzero(np.isfinite(problem.budget))
    decisions = [decisions_of(problem, k) for k in range(len(problem.areas))]
    found = PlanList(problem, nodes, decisions)
    nothing = np.zeros(problem.tree.nodes)
    is_possible = _fill(problem, found)
    sparing = np.array([plans[0].configuration for plans in found.plans])
    if not is_possible:
        return Relaxation(np.inf, nothing, found, sparing)
    limit, unit = found.limits()
    best, at, price = -np.inf, nothing, nothing
    for _ in range(ROUNDS):
        least, is_new = _price(problem, decisions, found, price)
        if (bound := least - float(price[nodes] @ limit)) > best:
            best, at = bound, price
        answer = run_highs(found.mixture(excess=False))
        closed = answer.bound - best <= max(gap, CLOSED) * abs(answer.bound)
        if answer.x is None or not is_new or closed or time.monotonic() > until_s:
            break
        price = _prices(problem, found, answer, unit)
    return Relaxation(best, at, found, sparing)


def _fill(problem: Problem, found: PlanList) -> bool:
    """Add plans until some mixture of them is within the budgets; whether there is one."""
    free = replace(problem, areas=tuple(_without_costs(area) for area in problem.areas))
    decisions = [decisions_of(free, k) for k in range(len(free.areas))]
    limit, unit = found.limits()
    price = np.zeros(problem.tree.nodes)
    price[found.nodes] = 1.0 / unit
    while True:
        least, is_new = _price(free, decisions, found, price)
        if least - float(price[found.nodes] @ limit) > EXCEEDED:
            return False
        answer = run_highs(found.mixture(excess=True))
        if answer.bound <= EXCEEDED or not is_new:
            return answer.bound <= EXCEEDED
        price = _prices(problem, found, answer, unit)


def _prices(problem: Problem, found: PlanList, answer: Answer, unit: Array) -> Array:
    """Price of what is spent in each node at which a mixture of plans is the best, shape (nodes,)."""
    price = np.zeros(problem.tree.nodes)
    price[found.nodes] = np.maximum(0.0, -answer.price[len(problem.areas) :]) / unit
    return price


def _price(
    problem: Problem, decisions: list[Decisions], found: PlanList, price: Array
) -> tuple[float, bool]:
    """Least cost of all areas with prices on what they spend; whether a plan of it is new."""
    least, is_new = 0.0, False
    for k, area in enumerate(problem.areas):
        values = values_of(area, decisions[k], decisions[k].total(price))
        least += values.least(area.transitions.initial)
        is_new |= found.add(k, values.policy(area.transitions.initial))
    return least, is_new


def _without_costs(area: Area) -> Area:
    """The same area if nothing cost anything: what it spends is all that counts."""
    transitions = table_of(area.transitions)
    change = np.where(np.isfinite(transitions.cost), 0.0, np.inf)
    yearly = np.where(np.isfinite(area.yearly_cost), 0.0, np.inf)
    return replace(area, yearly_cost=yearly, transitions=replace(transitions, cost=change))


def worth_keeping(problem: Problem, relaxation: Relaxation, cost: float) -> list[Flags]:
    """Changes that a plan of less than some cost may contain, by area of shape (groups, from, to)."""
    spare = (cost - relaxation.bound) + CLOSED * abs(cost)
    keep = []
    for k, area in enumerate(problem.areas):
        decisions = relaxation.found.decisions[k]
        price = decisions.total(relaxation.price)
        values = values_of(area, decisions, price)
        through = _through(area, values, price)
        keep.append(through <= values.least(area.transitions.initial) + spare)
    return keep


def _through(area: Area, values: Values, price: Array) -> Array:
    """Least cost of an area's plans that contain a change, shape (groups, from, to)."""
    decisions, initial = values.decisions, area.transitions.initial
    table = table_of(area.transitions)
    total = values.least(initial)
    through = np.empty((decisions.groups, area.configurations, area.configurations))
    without: list[Array] = []
    """Least cost of all but a group and what follows, the configuration before it given."""
    for g, parent in enumerate(decisions.parent):
        if parent == NONE:
            others = np.full(area.configurations, np.inf)
            others[initial] = total - values.before[g, initial]
        else:
            others = _difference(through[parent].min(axis=0), values.before[g])
        without.append(others)
        stage = decisions.stage[g]
        change = decisions.weight[g] * table.cost[stage] + price[g] * table.spent[stage]
        through[g] = others[:, np.newaxis] + change + values.after[g]
    return through


def _difference(total: Array, part: Array) -> Array:
    """Total less a part of it, infinite where the total is."""
    finite = np.isfinite(total)
    return np.where(finite, total - np.where(finite, part, 0.0), np.inf)
