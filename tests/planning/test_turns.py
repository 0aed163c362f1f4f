"""Plans within budgets that get better as areas take turns."""

import numpy as np
import pytest

from tpss.planning.costs import expected_cost, meets_budget
from tpss.planning.decisions import decisions_of
from tpss.planning.money import Stages
from tpss.planning.problem import Problem
from tpss.planning.program import solve_program
from tpss.planning.relaxation import relax
from tpss.planning.tree import make_tree
from tpss.planning.turns import improved_in_turns

from made_up_plans import one_area, random_plan

INF = np.inf


def improved(problem, policy):
    decisions = [decisions_of(problem, k) for k in range(len(problem.areas))]
    sparing = np.zeros_like(policy)
    return improved_in_turns(problem, decisions, policy, sparing, -INF)


def test_an_area_that_saves_more_takes_the_place_of_one_that_saves_less():
    """100 for one of two: at first the one that saves 8 a year has it, at last the one that saves 9."""
    tree = make_tree(["only"], [1.0], [[0]])
    change = np.array([[[0.0, 100.0], [INF, 0.0]]])
    first = one_area([[20.0, 11.0]], change, (0,), name="first")
    second = one_area([[20.0, 12.0]], change, (0,), name="second")
    problem = Problem(tree, Stages((0,), 20, 0.0), (first, second), np.array([100.0]))
    found = improved(problem, np.array([[0], [1]]))
    assert found.tolist() == [[1], [0]]


@pytest.mark.parametrize("seed", range(20))
def test_the_plan_gets_no_worse_keeps_within_the_budget_and_is_not_far_from_the_best(seed):
    """Local search proves nothing: it may stay above the optimum, never below."""
    problem = random_plan(seed, areas=3, budget=True)
    relaxation = relax(problem)
    start = relaxation.sparing
    assert meets_budget(problem, start)
    found = improved(problem, start)
    assert meets_budget(problem, found)
    best = solve_program(problem).cost
    assert best * (1 - 1e-9) <= expected_cost(problem, found) <= expected_cost(problem, start)
    assert expected_cost(problem, found) <= 1.02 * best
