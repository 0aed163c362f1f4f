"""Random plans: looking at each plan, dynamic programming and HiGHS find the same optimum."""

import numpy as np
import pytest

from tpss.planning import program
from tpss.planning.costs import expected_cost, meets_budget, outlay
from tpss.planning.counting import number_of_plans
from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.flow import program_of
from tpss.planning.ranking import best_plans
from tpss.planning.regret import least_regret, parts_at_orders, regrets
from tpss.planning.regret_program import least_regret_by_program
from tpss.planning.worth import known_plans

from made_up_plans import enumerated, every_policy, random_plan, slow_cost, slow_spending

EXACT = 1e-9
"""Two exact methods differ by the rounding of sums only."""


@pytest.mark.parametrize("seed", range(0, 100))
def test_without_a_budget_all_three_agree(seed):
    problem = random_plan(seed)
    least, _ = enumerated(problem)
    assert solve(problem).cost == pytest.approx(least, rel=EXACT)
    flow = program.solve_program(problem)
    assert flow.cost == pytest.approx(least, rel=EXACT)
    assert flow.bound == pytest.approx(least, rel=EXACT)


@pytest.mark.parametrize("seed", range(100, 200))
def test_with_a_budget_highs_finds_what_enumeration_finds(seed):
    problem = random_plan(seed, budget=True)
    least, _ = enumerated(problem)
    found = program.solve_program(problem)
    assert found.cost == pytest.approx(least, rel=EXACT)
    assert found.bound == pytest.approx(least, rel=2 * EXACT)  # the gap that it may leave
    assert meets_budget(problem, found.policy)
    plain = program.solve_flow(problem, program_of(problem))
    assert plain.cost == pytest.approx(least, rel=EXACT)


@pytest.mark.parametrize("seed", range(200, 230))
def test_areas_that_share_a_budget(seed):
    problem = random_plan(seed, areas=2, nodes=3, budget=True)
    least, _ = enumerated(problem)
    found = program.solve_program(problem)
    assert found.cost == pytest.approx(least, rel=EXACT)
    assert found.gap <= EXACT


@pytest.mark.parametrize("seed", range(0, 24))
def test_the_best_plans_are_the_first_of_all_in_their_order(seed):
    problem = random_plan(seed)
    costs = sorted(slow_cost(problem, policy) for policy in every_policy(problem))
    costs = [cost for cost in costs if np.isfinite(cost)]
    assert number_of_plans(problem) == len(costs)
    found = best_plans(problem, 25)
    assert [plan.cost for plan in found] == pytest.approx(costs[:25], rel=EXACT)
    assert len({plan.policy.tobytes() for plan in found}) == len(found)


@pytest.mark.parametrize("seed", range(0, 24))
def test_each_first_decision_has_the_best_plan_that_contains_it(seed):
    problem = random_plan(seed)
    plans = list(every_policy(problem))
    for first in first_decisions(problem):
        with_it = [p for p in plans if (p[first.area, first.nodes] == first.configuration).all()]
        least = min(slow_cost(problem, policy) for policy in with_it)
        assert first.cost == pytest.approx(least, rel=EXACT)
        assert expected_cost(problem, first.policy) == pytest.approx(least, rel=EXACT)
        assert (first.policy[first.area, first.nodes] == first.configuration).all()


@pytest.mark.parametrize("seed", range(0, 24))
def test_the_least_regret_is_the_least_of_all_plans(seed):
    problem = random_plan(seed)
    known = np.array([plan.cost for plan in known_plans(problem)])
    plans = [p for p in every_policy(problem) if np.isfinite(slow_cost(problem, p))]
    least = regrets(problem, plans, known).max(axis=1).min()
    found = least_regret_by_program(problem, known)
    assert found.cost == pytest.approx(least, rel=EXACT, abs=1e-6)
    assert parts_at_orders(problem)
    policy = least_regret(problem, known)
    assert regrets(problem, [policy], known).max() == pytest.approx(least, rel=EXACT, abs=1e-6)


@pytest.mark.parametrize("seed", range(0, 20))
def test_what_a_plan_costs_does_not_depend_on_how_it_was_found(seed):
    problem = random_plan(seed, budget=True)
    policy = solve(random_plan(seed)).policy
    assert expected_cost(problem, policy) == pytest.approx(slow_cost(problem, policy), rel=EXACT)
    assert outlay(problem, policy) == pytest.approx(slow_spending(problem, policy))
