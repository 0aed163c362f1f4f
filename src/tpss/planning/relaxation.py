r"""Prices on budgets: a bound of what plans with budgets cost, and good plans on the way there.

With a price :math:`\lambda_n \ge 0` of what is spent in a node, areas are on their own again, and

.. math:: L(\lambda) = \sum_{areas} \min_{plan} [cost + \lambda \cdot outlay] - \lambda \cdot budget

is no more than any plan within the budgets costs.  Each price adds the plans found to a list, the best
mixture of the plans in the list gives the next prices (column generation, Dantzig and Wolfe), until the
mixture costs no more than the bound.  The best choice of a plan of the list for each area is a good
plan, and what costs more than it even with the prices can be left out of the exact search.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tpss.planning.costs import transition_costs
from tpss.planning.decisions import decisions_of
from tpss.planning.dynamic import Values, values_of
from tpss.planning.highs import run_highs
from tpss.planning.linear import LinearProgram, linear_program
from tpss.planning.money import Array
from tpss.planning.problem import Area, Problem
from tpss.planning.tree import NONE, Indices

Flags = npt.NDArray[np.bool_]

CLOSED = 1e-10
"""Share of the cost up to which the mixture costs no more than the bound."""

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
        once = transition_costs(self.problem, k, configuration, area.transitions.cost)
        yearly = area.yearly_cost[np.arange(tree.nodes), configuration]
        cost = float(self.problem.weight @ (stages.annuity[tree.stage] * yearly + once))
        spent = transition_costs(self.problem, k, configuration, area.transitions.outlay)
        self.plans[k].append(AreaPlan(configuration, cost, spent[self.nodes]))
        return True

    def mixture(self, excess: bool) -> LinearProgram:
        """Best mixture of plans within the budgets; or, if asked for, with the least excess."""
        flat = [(k, plan) for k, plans in enumerate(self.plans) for plan in plans]
        assert self.problem.budget is not None
        limit = self.problem.budget[self.nodes]
        unit = np.where(limit > 0.0, limit, 1.0)
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


def relax(problem: Problem) -> Relaxation:
    """Bound and plans by prices on budgets.

    Parameters
    ----------
    problem : Problem
        With a budget, and a plan without it.
    """
    assert problem.budget is not None
    nodes = np.flatnonzero(np.isfinite(problem.budget))
    found = PlanList(problem, nodes)
    free = replace(problem, areas=tuple(_without_costs(area) for area in problem.areas))
    _price(free, found, np.zeros(problem.tree.nodes))
    if _generate(free, found, excess=True)[0] > CLOSED:
        return Relaxation(np.inf, np.zeros(problem.tree.nodes), found)
    _price(problem, found, np.zeros(problem.tree.nodes))
    bound, price = _generate(problem, found, excess=False)
    return Relaxation(bound, price, found)


def _generate(problem: Problem, found: PlanList, excess: bool) -> tuple[float, Array]:
    """Highest bound, and its prices; of the excess of budgets in their own units, or of the cost."""
    assert problem.budget is not None
    limit = problem.budget[found.nodes]
    unit = np.where(limit > 0.0, limit, 1.0)
    best, at = -np.inf, np.zeros(problem.tree.nodes)
    for _ in range(ROUNDS):
        answer = run_highs(found.mixture(excess))
        price = np.zeros(problem.tree.nodes)
        price[found.nodes] = np.maximum(0.0, -answer.price[len(problem.areas) :]) / unit
        least, is_new = _price(problem, found, price)
        if (bound := least - float(price[found.nodes] @ limit)) > best:
            best, at = bound, price
        if not is_new or answer.bound - best <= CLOSED * abs(answer.bound):
            break
    return best, at


def _price(problem: Problem, found: PlanList, price: Array) -> tuple[float, bool]:
    """Least cost of all areas with prices on what they spend; whether a plan of it is new."""
    least, is_new = 0.0, False
    for k, area in enumerate(problem.areas):
        values = _priced_values(problem, k, price)
        least += values.least(area.transitions.initial)
        is_new |= found.add(k, values.policy(area.transitions.initial))
    return least, is_new


def _priced_values(problem: Problem, k: int, price: Array) -> Values:
    decisions = decisions_of(problem, k)
    return values_of(problem.areas[k], decisions, decisions.total(price))


def _without_costs(area: Area) -> Area:
    """The same area if nothing cost anything: what it spends is all that counts."""
    transitions = area.transitions
    change = np.where(np.isfinite(transitions.cost), 0.0, np.inf)
    yearly = np.where(np.isfinite(area.yearly_cost), 0.0, np.inf)
    return replace(area, yearly_cost=yearly, transitions=replace(transitions, cost=change))


def worth_keeping(problem: Problem, relaxation: Relaxation, cost: float) -> list[Flags]:
    """Changes that a plan of less than some cost may contain, by area of shape (groups, from, to)."""
    spare = (cost - relaxation.bound) + CLOSED * abs(cost)
    keep = []
    for k, area in enumerate(problem.areas):
        values = _priced_values(problem, k, relaxation.price)
        through = _through(area, values, values.decisions.total(relaxation.price))
        keep.append(through <= values.least(area.transitions.initial) + spare)
    return keep


def _through(area: Area, values: Values, price: Array) -> Array:
    """Least cost of an area's plans that contain a change, shape (groups, from, to)."""
    decisions, initial = values.decisions, area.transitions.initial
    spent = np.where(np.isfinite(area.transitions.cost), area.transitions.outlay, 0.0)
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
        change = decisions.weight[g] * area.transitions.cost[stage] + price[g] * spent[stage]
        through[g] = others[:, np.newaxis] + change + values.after[g]
    return through


def _difference(total: Array, part: Array) -> Array:
    """Total less a part of it, infinite where the total is."""
    finite = np.isfinite(total)
    return np.where(finite, total - np.where(finite, part, 0.0), np.inf)
