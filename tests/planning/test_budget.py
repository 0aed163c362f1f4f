"""Budgets that areas share: HiGHS, its bound, and what is said if no plan meets them."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from tpss.errors import NoPlanError, PlanError
from tpss.planning import dynamic, program, ranking
from tpss.planning.costs import meets_budget, outlay
from tpss.planning.money import Stages
from tpss.planning.problem import Problem
from tpss.planning.ranking_within import best_plans_within
from tpss.planning.relaxation import relax, worth_keeping
from tpss.planning.switching import costs_of_first, switching
from tpss.planning.tree import make_tree
from tpss.planning.turning_within import Optima, turn_within

from made_up_plans import (
    every_policy,
    one_area,
    random_plan,
    slow_cost,
    slow_spending,
    two_stages,
)

INF = np.inf


def two_lines(budget) -> Problem:
    """Two lines, 20 years; strong supply costs 100 for each, and saves 9 and 8 a year."""
    tree = make_tree(["only"], [1.0], [[0, 0]])
    change = np.array([[[0.0, 100.0], [INF, 0.0]]] * 2)
    first = one_area([[10.0, 1.0]] * 2, change, (0, 1), name="first")
    second = one_area([[10.0, 2.0]] * 2, change, (0, 1), name="second")
    limit = np.asarray(budget, dtype=float)
    return Problem(tree, Stages((0, 10), 20, 0.0), (first, second), limit)


def test_without_a_limit_both_are_built_at_once():
    """100 + 20 and 100 + 40."""
    found = program.solve_any(two_lines([INF, INF]))
    assert found.policy.tolist() == [[1, 1], [1, 1]]
    assert found.cost == pytest.approx(260.0)


def test_a_budget_for_one_builds_the_one_that_saves_more():
    """The first at once: 120; the second later costs 100 + 100 + 20 = 220 instead of 200: never."""
    found = program.solve_any(two_lines([100.0, 100.0]))
    assert found.policy.tolist() == [[1, 1], [0, 0]]
    assert found.cost == pytest.approx(320.0)
    assert found.bound == pytest.approx(320.0)
    assert outlay(two_lines([100.0, 100.0]), found.policy).tolist() == [100.0, 0.0]


def test_a_budget_of_nothing_builds_nothing():
    found = program.solve_any(two_lines([0.0, 0.0]))
    assert found.policy.tolist() == [[0, 0], [0, 0]]


def test_a_budget_that_is_just_enough_is_enough():
    assert program.solve_any(two_lines([200.0, 0.0])).cost == pytest.approx(260.0)


def test_a_budget_that_no_plan_meets_is_named_with_what_it_lacks():
    """Weak supply is not allowed, so both have to be built at once: 200 where there are 150."""
    problem = two_lines([150.0, 0.0])
    must = [np.where([True, False], INF, area.yearly_cost) for area in problem.areas]
    with pytest.raises(
        NoPlanError, match=r"it takes 50 more in stage 1 \(0\), every scenario; allow it"
    ) as caught:
        program.solve_any(problem.with_costs(must))
    assert (caught.value.limit, caught.value.nodes) == ("budget", (0,))


def test_a_budget_that_only_halves_of_plans_meet_is_named_too():
    """One of two levels of 100 and 60 on both lines: a mixture meets 110, a plan takes 120."""
    tree = make_tree(["only"], [1.0], [[0]])
    change = np.array([[[0.0, 60.0], [INF, 0.0]]])
    cost = [[INF, 1.0]]
    areas = (one_area(cost, change, (0,), name="a"), one_area(cost, change, (0,), name="b"))
    problem = Problem(tree, Stages((0,), 10, 0.0), areas, np.array([110.0]))
    with pytest.raises(NoPlanError, match="it takes 10 more"):
        program.solve_any(problem)


def test_a_requirement_that_no_configuration_meets_is_not_laid_on_the_budget():
    problem = two_lines([100.0, 100.0])
    never = [np.full((2, 2), INF), problem.areas[1].yearly_cost]
    with pytest.raises(NoPlanError, match="area first") as caught:
        program.solve_any(problem.with_costs(never))
    assert caught.value.limit == "requirement"


@pytest.mark.parametrize("seed", range(30))
def test_prices_on_budgets_bound_what_plans_cost_and_leave_out_none_that_is_better(seed):
    problem = random_plan(seed, areas=2, budget=True)
    best = program.solve_flow(problem, program.program_of(problem))
    relaxation = relax(problem)
    assert relaxation.bound <= best.cost * (1 + 1e-9)
    keep = worth_keeping(problem, relaxation, best.cost)
    program_kept = program.program_of(problem, keep)
    assert program.solve_flow(problem, program_kept).cost == pytest.approx(best.cost, rel=1e-9)
    choice = relaxation.best_choice(1e-9, INF)
    if choice is not None:
        assert meets_budget(problem, choice)


def test_a_gap_that_is_allowed_is_reported():
    for seed in range(20):
        problem = random_plan(seed, areas=3, budget=True)
        rough, best = (program.solve_program(problem, gap) for gap in (0.05, 1e-9))
        assert rough.bound <= best.cost * (1 + 1e-9) <= rough.cost * (1 + 2e-9)
        assert rough.gap <= 0.05


def test_a_problem_without_a_budget_goes_to_dynamic_programming():
    problem = two_stages()
    assert program.solve_any(problem).cost == dynamic.solve(problem).cost


def test_dynamic_programming_refuses_a_budget():
    for call in (dynamic.solve, dynamic.first_decisions, lambda each: ranking.best_plans(each, 3)):
        with pytest.raises(PlanError, match="knows no budget"):
            call(two_lines([100.0, 100.0]))


def test_without_highs_a_budget_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "highspy", None)
    with pytest.raises(PlanError, match=r'pip install "tpss\[plan\]"'):
        program.solve_any(two_lines([100.0, 100.0]))
    assert dynamic.solve(replace(two_lines([0.0, 0.0]), budget=None)).cost == pytest.approx(260.0)


def test_highs_prints_nothing():
    """In a process of its own: it would print its name once in each."""
    call = (
        "import numpy as np; from tpss.planning.linear import linear_program;"
        "from tpss.planning.highs import run_highs; one = np.ones(1);"
        "run_highs(linear_program(one, one, one, one, np.array([[0.0], [0.0], [1.0]])))"
    )
    done = subprocess.run([sys.executable, "-c", call], capture_output=True, text=True, check=True)
    assert done.stdout == ""


@pytest.mark.parametrize("seed", range(12))
def test_the_best_plans_within_a_budget_are_those_of_all(seed):
    """The first eight of all plans by cost, by looking at each; ties in any order."""
    problem = random_plan(seed, areas=1 + seed % 2, budget=True, nodes=3 + seed % 2)
    every = sorted(
        slow_cost(problem, policy)
        for policy in every_policy(problem)
        if (slow_spending(problem, policy) <= problem.budget).all()
    )
    every = [cost for cost in every if cost < INF]
    if not every:
        pytest.skip("no plan meets this budget")
    found = best_plans_within(problem, program.solve_any(problem), 8)
    assert [each.cost for each in found] == pytest.approx(every[:8], rel=1e-8)
    assert len({each.policy.tobytes() for each in found}) == len(found)
    assert all(meets_budget(problem, each.policy) for each in found)


def test_when_all_plans_are_found_there_are_no_more():
    """Each of two lines at once, later or never, one in each stage: 9 pairs but two."""
    problem = two_lines([100.0, 100.0])
    assert len(best_plans_within(problem, program.solve_any(problem), 99)) == 7


@pytest.mark.parametrize("limit", [150.0, 190.0])
def test_a_decision_turns_with_a_price_within_a_budget(limit):
    """Of two lines one can be built, for 100. The first saves 9 a year, the second 8 times v.

    So the second leads from v = 9/8 on.
    """

    def at(v):
        problem = two_lines([limit, 0.0])
        second = replace(problem.areas[1], yearly_cost=problem.areas[1].yearly_cost * v)
        return replace(problem, areas=(problem.areas[0], second))

    found = turn_within(Optima(at), 0, 1.0, 0.0, 4.0)
    assert (found.first, found.above_to) == (1, 0)
    assert found.above == pytest.approx(9.0 / 8.0, rel=1e-9)
    assert found.below is None
    other = turn_within(Optima(at), 1, 1.0, 0.0, 4.0)
    assert (other.first, other.above_to) == (0, 1)
    assert other.above == pytest.approx(9.0 / 8.0, rel=1e-9)


def test_a_decision_turns_where_the_budget_ends():
    """The first line is built for 100 as long as there are 130: beyond a cost of 130 the second is."""

    def at(cost):
        problem = two_lines([130.0, 0.0])
        change = np.array([[[0.0, cost], [INF, 0.0]]] * 2)
        first = one_area([[100.0, 1.0]] * 2, change, (0, 1), name="first")
        return replace(problem, areas=(first, problem.areas[1]))

    found = turn_within(Optima(at), 0, 100.0, 50.0, 400.0)
    assert found.above == pytest.approx(130.0, rel=1e-8)
    assert found.above_to == 0


def test_without_a_budget_it_turns_where_dynamic_programming_says():
    for seed in range(6):
        problem = random_plan(seed, areas=2)

        def at(v, problem=problem):
            return problem.with_costs([each.yearly_cost * v for each in problem.areas])

        try:
            expected = switching(lambda v, at=at: costs_of_first(at(v)), 1.0, 0.1, 4.0)
        except PlanError:
            continue  # scenarios part at once
        found = turn_within(Optima(at), 0, 1.0, 0.1, 4.0)
        for own, other in ((found.below, expected.below), (found.above, expected.above)):
            assert (own is None) == (other is None)
            if own is not None:
                assert own == pytest.approx(other, rel=1e-7)
