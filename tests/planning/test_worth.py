"""Switching values, and what a plan costs by component, stage and scenario."""

from dataclasses import replace

import numpy as np
import pytest

from tpss.errors import NoPlanError, PlanError
from tpss.planning.costs import cost_by_scenario, expected_cost
from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.money import Stages
from tpss.planning.problem import Area, Problem
from tpss.planning.regret import least_regret, parts_at_orders
from tpss.planning.regret_program import least_regret_by_program
from tpss.planning.switching import costs_of_first, switching
from tpss.planning.tree import make_tree
from tpss.planning.worth import compare, costs_by_part, known_plans, worth_of

from made_up_plans import one_area, random_plan, two_stages

INF = np.inf


def price_of_strong(price):
    """First decisions of the plan of two stages if strong supply costs so much."""
    change = np.array([[[0.0, price], [INF, 0.0]]] * 2)
    problem = two_stages()
    area = one_area(problem.areas[0].yearly_cost, change, (0, 1))
    return costs_of_first(replace(problem, areas=(area,)))


def test_at_which_price_the_first_decision_changes():
    """At once costs K + 24.  Waiting costs 20 + 12 + 0.4·(K + 20) = 0.4 K + 40 as long as it builds
    later.

    They are equal at K = 80/3: below it is built at once.  Above no other first decision ever leads.
    """
    found = switching(price_of_strong, now=100.0, low=0.0, high=1000.0)
    assert found.first == 0
    assert found.below == pytest.approx(80.0 / 3.0, rel=1e-12)
    assert found.below_to == 1
    assert (found.above, found.above_to) == (None, None)


def test_at_which_probability_the_first_decision_changes():
    """With much traffic of probability p: at once 100 + 10 + 10·(1 - p) + 20·p = 120 + 10 p; wait
    20 + 20·(1 - p) + 120·p = 40 + 100 p: equal at p = 8/9."""

    def of_probability(p):
        tree = make_tree(["low", "high"], [1 - p, p], [["a", "little"], ["a", "much"]])
        return costs_of_first(replace(two_stages(), tree=tree))

    found = switching(of_probability, now=0.4, low=0.01, high=0.99)
    assert found.above == pytest.approx(8.0 / 9.0, rel=1e-12)
    assert found.below is None


def test_todays_value_lies_in_the_range():
    with pytest.raises(PlanError, match="does not lie between"):
        switching(price_of_strong, now=100.0, low=200.0, high=1000.0)


def test_where_scenarios_part_at_once_there_is_no_single_first_decision():
    tree = make_tree(["a", "b"], [0.5, 0.5], [[1], [2]])
    area = one_area(np.ones((2, 2)), np.zeros((1, 2, 2)), (0,))
    problem = Problem(tree, Stages((0,), 10, 0.0), (area,))
    assert len(first_decisions(problem)) == 4
    with pytest.raises(PlanError, match="no single first decision"):
        costs_of_first(problem)


def test_costs_by_component_stage_and_scenario():
    """Two stages of 10 years; the yearly cost is energy and late minutes in halves; building in the
    second stage if traffic is much.  Plain: energy 10 and 10, then 10 (little) or 10 (much);
    changes 0, then 0 or 100."""
    problem = two_stages()
    policy = solve(problem).policy
    yearly = problem.areas[0].yearly_cost[np.arange(3), policy[0]]
    plain, present = costs_by_part(problem, policy, [np.stack([yearly, yearly], axis=1) / 2.0])
    assert plain.shape == (3, 2, 2)
    assert plain[:, :, 0].tolist() == [[10.0, 10.0], [10.0, 10.0], [0.0, 0.0]]
    assert plain[:, :, 1].tolist() == [[10.0, 10.0], [10.0, 10.0], [0.0, 100.0]]
    assert present.tolist() == plain.tolist()  # no interest


@pytest.mark.parametrize("seed", range(10))
def test_discounted_parts_add_up_to_what_a_scenario_costs(seed):
    problem = random_plan(seed, areas=2)
    policy = solve(problem).policy
    nodes = np.arange(problem.tree.nodes)
    parts = [
        area.yearly_cost[nodes, row][:, np.newaxis] * [[0.25, 0.75]]
        for area, row in zip(problem.areas, policy, strict=True)
    ]
    _, present = costs_by_part(problem, policy, parts)
    assert present.sum(axis=(0, 1)) == pytest.approx(cost_by_scenario(problem, policy))


def test_where_nothing_is_invested_there_is_no_ratio():
    problem = two_stages()
    stay = np.zeros((1, 3), dtype=np.int64)
    assert np.isnan(compare(problem, stay, stay).ratio)


@pytest.mark.parametrize("seed", range(6))
def test_regret_of_several_areas_is_no_more_than_that_of_the_best_plan(seed):
    problem = random_plan(seed, areas=2, nodes=4)
    known = np.array([plan.cost for plan in known_plans(problem)])
    found = least_regret_by_program(problem, known)
    of_best = (cost_by_scenario(problem, solve(problem).policy) - known).max()
    assert -1e-9 <= found.cost <= of_best + 1e-9
    with pytest.raises(PlanError, match="needs HiGHS"):
        least_regret(problem, known)


def test_regret_of_orders_two_stages_ahead_takes_the_integer_program():
    """What is ordered in the first stage for the third comes to nodes of different parents."""
    tree = make_tree(["a", "b"], [0.5, 0.5], [[0, 0, 0], [0, 1, 1]])
    cost = np.array([[1.0, 1.0], [1.0, 1.0], [1.0, 1.0], [2.0, 8.0], [20.0, 3.0]])
    change = np.array([[[0.0, 10.0], [INF, 0.0]]] * 3)
    area = one_area(cost, change, (-1, -1, 0))
    problem = Problem(tree, Stages((0, 5, 10), 15, 0.0), (area,))
    assert not parts_at_orders(problem)
    known = np.array([plan.cost for plan in known_plans(problem)])
    # Not built: 5·(20 - 3) - 10 = 75 too much in b; built: 5·(8 - 2) + 10 = 40 too much in a.
    assert least_regret_by_program(problem, known).cost == pytest.approx(40.0)


def test_where_nothing_is_allowed_the_place_is_named():
    problem = two_stages()
    cost = problem.areas[0].yearly_cost.copy()
    cost[2] = INF
    with pytest.raises(
        NoPlanError, match=r"area line: .* is allowed in stage 2 \(2040\), high"
    ) as caught:
        solve(problem.with_costs([cost]))
    assert (caught.value.limit, caught.value.nodes) == ("requirement", (2,))


def test_where_an_order_cannot_serve_both_branches_that_is_said():
    """One order for both: little traffic allows weak supply only, much traffic strong supply only."""
    problem = two_stages(lead=1)
    cost = np.array([[2.0, 1.0], [2.0, INF], [INF, 2.0]])
    with pytest.raises(
        NoPlanError, match=r"is allowed in stage 2 \(2040\), low; stage 2 \(2040\), high"
    ):
        solve(problem.with_costs([cost]))


def test_a_fixed_plan_may_not_exist():
    """Strong supply only in the branch of much traffic, weak only in the other."""
    problem = two_stages()
    cost = np.array([[2.0, 1.0], [2.0, INF], [INF, 2.0]])
    problem = problem.with_costs([cost])
    assert solve(problem).policy.tolist() == [[0, 0, 1]]
    worth = worth_of(problem, [cost[[0, 2]]])
    assert (worth.fixed, worth.of_flexibility) == (None, None)
    assert worth.expected_known_cost <= worth.best.cost


def test_what_a_mean_future_decides_today_may_leave_no_plan():
    """It builds strong supply at once, which a future of little traffic does not allow."""
    problem = two_stages()
    problem = problem.with_costs([np.array([[2.0, 1.0], [2.0, INF], [20.0, 2.0]])])
    worth = worth_of(problem, [np.array([[20.0, 2.0], [20.0, 2.0]])])
    assert (worth.mean, worth.of_the_tree) == (None, None)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"yearly_cost": np.full((3, 2), np.nan)}, "area line: a yearly cost is missing"),
        ({"yearly_cost": np.ones((3, 3))}, "shape"),
        ({"ordered_at": (0, 2)}, "cannot be ordered"),
        ({"ordered_at": (0, -1)}, "cannot be ordered"),
        ({"ordered_at": (0, 1, 2)}, "different stages"),
    ],
)
def test_faults_of_an_area_are_named(changes, words):
    area = two_stages().areas[0]
    with pytest.raises(PlanError, match=words):
        replace(area, **changes)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"stages": Stages((0,), 10, 0.0)}, "stages of values"),
        ({"areas": ()}, "an area at least"),
        ({"areas": two_stages().areas * 2}, "each its own name"),
        ({"budget": np.ones(2)}, "a number for each node"),
        ({"budget": np.full(3, np.nan)}, "a number for each node"),
        ({"budget": np.full(3, -1.0)}, "not negative"),
    ],
)
def test_faults_of_a_problem_are_named(changes, words):
    with pytest.raises(PlanError, match=words):
        replace(two_stages(), **changes)


def test_a_plan_that_is_not_allowed_costs_without_end():
    assert expected_cost(two_stages(), np.array([[1, 0, 1]])) == INF


def test_an_area_of_which_nothing_can_be_decided():
    """It has what is there today, and no first decision."""
    problem = two_stages()
    area = Area("line", problem.areas[0].yearly_cost, problem.areas[0].transitions, (-1, -1))
    assert solve(replace(problem, areas=(area,))).cost == pytest.approx(112.0)
    assert first_decisions(replace(problem, areas=(area,))) == []
