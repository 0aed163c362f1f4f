"""How many plans there are."""

import numpy as np

from tpss.planning.decisions import decisions_of
from tpss.planning.money import Array
from tpss.planning.problem import Problem
from tpss.planning.tree import NONE


def number_of_plans(problem: Problem) -> int:
    """How many plans there are, of any cost, whatever the budget.

    Exact up to 2^53, and to 15 digits beyond: numbers of hundreds of digits are usual.
    """
    count = 1
    for k, area in enumerate(problem.areas):
        decisions = decisions_of(problem, k)
        after = np.isfinite(decisions.cost).astype(np.float64)
        power = np.zeros(decisions.groups, dtype=np.int64)
        for g in reversed(range(decisions.groups)):
            after[g], more = _scaled(after[g])
            power[g] += more
            before = area.transitions.ways(int(decisions.stage[g]), after[g])
            if (parent := decisions.parent[g]) == NONE:
                count *= _whole(float(before[area.transitions.initial]), int(power[g]))
            else:
                after[parent], more = _scaled(after[parent] * before)
                power[parent] += power[g] + more
    return count


def _scaled(figures: Array) -> tuple[Array, int]:
    """Figures divided by a power of 2 so that they are 1 at most, and that power; exact."""
    largest = float(figures.max())
    power = int(np.frexp(largest)[1]) if largest > 0.0 else 0
    return np.ldexp(figures, -power), power


def _whole(figure: float, power: int) -> int:
    """A figure times a power of 2, which is a whole number."""
    top, bottom = figure.as_integer_ratio()
    return (top << power) // bottom if power >= 0 else top // (bottom << -power)
