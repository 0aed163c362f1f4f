"""Where the first decision of a plan with budgets turns: a few searches of the best plan around today's.

Between a value at which a first decision leads and one at which another does, the next look is where the
plans found at both cost the same: there a third one is best, or the decision turns.  Costs of a plan are
linear in prices, costs and probabilities, so few looks are enough.  Where a plan breaks a budget on the
way, the next look is half-way.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tpss.errors import NoPlanError, PlanError
from tpss.planning.costs import expected_cost, meets_budget
from tpss.planning.decisions import decisions_of
from tpss.planning.flow import program_of
from tpss.planning.problem import Problem, Solution
from tpss.planning.program import solve_any, solve_flow
from tpss.planning.switching import Switching

LOOKS = 8
"""Looks between today's value and the end of a range: a lead that is shorter than one may be missed."""

STEPS = 40
"""After so many the value is as exact as plans are, also where each look is half-way."""

SAME = 1e-9
"""Share of its cost by which a plan may be dearer than the best, and counts as the best."""

SMALL = 3_000
"""Changes up to which HiGHS is quicker without prices on budgets before."""


@dataclass(frozen=True)
class Optima:
    """Best plans at values of a number of the plan, each found once."""

    problem_at: Callable[[float], Problem]
    known: dict[float, Solution | None] = field(default_factory=dict)

    def at(self, value: float) -> Solution | None:
        """The best plan at a value; None if there is none."""
        if value not in self.known:
            try:
                self.known[value] = _solved(self.problem_at(value))
            except NoPlanError:
                self.known[value] = None
        return self.known[value]

    def cost(self, found: Solution, value: float) -> float:
        """What a plan costs at a value; infinite if it breaks a budget there."""
        problem = self.problem_at(value)
        return (
            expected_cost(problem, found.policy) if meets_budget(problem, found.policy) else np.inf
        )


def _solved(problem: Problem) -> Solution:
    size = sum(area.configurations**2 for area in problem.areas) * problem.tree.nodes
    return solve_flow(problem, program_of(problem)) if size <= SMALL else solve_any(problem)


def first_nodes(problem: Problem, area: int) -> int:
    """A node of the first decision of an area.

    Raises
    ------
    PlanError
        Scenarios part at once, or nothing is decided.
    """
    own = problem.areas[area]
    stage, decisions = own.first_free, decisions_of(problem, area)
    groups = [] if stage is None else decisions.of_stage[stage].tolist()
    if len(groups) != 1:
        raise PlanError("scenarios part at once, or nothing is decided: no single first decision")
    return int(decisions.nodes(groups[0])[0])


def turn_within(optima: Optima, area: int, now: float, low: float, high: float) -> Switching:
    """Values around today's at which the best first decision of an area changes, within budgets.

    Parameters
    ----------
    optima : Optima
    area : int
    now : float
        Today's value.
    low, high : float
        Range that is looked through; today's value lies in it.

    Raises
    ------
    NoPlanError
        There is no plan today.
    PlanError
        Today's value lies outside the range, or there is no single first decision.
    """
    if not low <= now <= high:
        raise PlanError(f"today's value {now:g} does not lie between {low:g} and {high:g}")
    node = first_nodes(optima.problem_at(now), area)
    today = optima.at(now)
    if today is None:
        raise NoPlanError("budget", "no plan meets the budget today", [])
    first = int(today.policy[area, node])
    ends = [_leaves(optima, (area, node), first, now, end) for end in (low, high)]
    return Switching(now, first, *ends[0], *ends[1])


def _leaves(
    optima: Optima, place: tuple[int, int], first: int, now: float, end: float
) -> tuple[float | None, int | None]:
    """Nearest value towards the end of a range at which a decision loses the lead, and to which.

    It is not looked beyond a value at which no plan meets the budgets.
    """
    inside = now
    for look in np.linspace(now, end, LOOKS + 1)[1:].tolist() if end != now else ():
        found = optima.at(look)
        if found is None:
            return None, None
        if found.policy[place] != first:
            return _between(optima, place, first, inside, look)
        inside = look
    return None, None


def _between(
    optima: Optima, place: tuple[int, int], first: int, inside: float, outside: float
) -> tuple[float, int]:
    """Where it turns between a value at which a decision leads, and one at which another does."""
    for _ in range(STEPS):
        there, beyond = optima.at(inside), optima.at(outside)
        assert there is not None
        assert beyond is not None
        value, both = _next(optima, there, beyond, inside, outside)
        if value in (inside, outside) or abs(outside - inside) <= SAME * abs(outside):
            break
        found = optima.at(value)
        assert found is not None
        if np.isfinite(both) and found.cost >= both - SAME * abs(both):
            return value, int(beyond.policy[place])
        if found.policy[place] == first:
            inside = value
        else:
            outside = value
    last = optima.at(outside)
    assert last is not None
    return outside, int(last.policy[place])


def _next(
    optima: Optima, there: Solution, beyond: Solution, inside: float, outside: float
) -> tuple[float, float]:
    """Next value to look at, and what both plans cost there, infinite if they do not cost the same."""
    middle = 0.5 * (inside + outside)
    less = optima.cost(beyond, inside) - there.cost
    more = optima.cost(there, outside) - beyond.cost
    # A plan that spends just what there is may be within a budget here, and not for HiGHS.
    if not (0.0 <= less < np.inf and 0.0 <= more < np.inf) or less + more == 0.0:
        return middle, np.inf
    value = inside + (outside - inside) * less / (less + more)
    costs = optima.cost(there, value), optima.cost(beyond, value)
    is_same = abs(costs[0] - costs[1]) <= SAME * abs(costs[0])
    return value, min(costs) if is_same else np.inf
