"""Switching values: at which price, rate or probability the best first decision changes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tpss.errors import PlanError
from tpss.planning.dynamic import first_decisions
from tpss.planning.money import Array
from tpss.planning.problem import Problem

LOOKS = 64
"""Looks between today's value and the end of a range: a lead that is shorter than one may be missed."""

HALVINGS = 60
"""After so many the value is as exact as numbers are."""


@dataclass(frozen=True)
class Switching:
    """Where another first decision takes the lead, if one does in the range."""

    now: float
    first: int
    """Best first decision now."""
    below: float | None
    """Highest value below today's at which another one is as good."""
    below_to: int | None
    """The one that takes the lead there."""
    above: float | None
    """Lowest value above today's at which another one is as good."""
    above_to: int | None


def costs_of_first(problem: Problem, area: int = 0) -> Array:
    """Least cost of a plan with each first decision of an area, shape (configurations,).

    Infinite for one that no plan contains.

    Raises
    ------
    PlanError
        The area has several first decisions, as scenarios part at once.
    """
    cost = np.full(problem.areas[area].configurations, np.inf)
    nodes: tuple[int, ...] | None = None
    for each in first_decisions(problem):
        if each.area == area:
            if nodes not in (None, tuple(each.nodes)):
                raise PlanError("scenarios part at once: there is no single first decision")
            nodes = tuple(each.nodes)
            cost[each.configuration] = each.cost
    return cost


def switching(cost_of: Callable[[float], Array], now: float, low: float, high: float) -> Switching:
    """Values around today's at which the best first decision changes.

    Every look is a new plan: what is varied may be a price, a rate, a probability, a cost of a measure.

    Parameters
    ----------
    cost_of : callable
        Least cost with each first decision at a value, shape (decisions,), as `costs_of_first` gives it.
    now : float
        Today's value.
    low, high : float
        Range that is looked through; today's value lies in it.

    Raises
    ------
    PlanError
        Today's value lies outside the range.
    """
    if not low <= now <= high:
        raise PlanError(f"today's value {now:g} does not lie between {low:g} and {high:g}")
    first = int(np.argmin(cost_of(now)))
    below = _leaves(cost_of, first, now, low)
    above = _leaves(cost_of, first, now, high)
    return Switching(now, first, *below, *above)


def _leaves(
    cost_of: Callable[[float], Array], first: int, now: float, end: float
) -> tuple[float | None, int | None]:
    """Nearest value towards the end of a range at which a decision loses the lead, and to which."""
    inside = now
    for look in np.linspace(now, end, LOOKS + 1)[1:] if end != now else ():
        if not _leads(cost_of(look), first):
            return _halved(cost_of, first, inside, float(look))
        inside = float(look)
    return None, None


def _halved(
    cost_of: Callable[[float], Array], first: int, inside: float, outside: float
) -> tuple[float, int]:
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if _leads(cost_of(middle), first):
            inside = middle
        else:
            outside = middle
    return outside, int(np.argmin(cost_of(outside)))


def _leads(cost: Array, first: int) -> bool:
    """Whether no other decision is better."""
    return bool(cost[first] <= cost.min())
