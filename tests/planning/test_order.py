"""What holds whatever the figures: more freedom never costs more, a higher price never less."""

from dataclasses import replace

import numpy as np
import pytest

from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.money import Stages
from tpss.planning.problem import Area, Problem
from tpss.planning.program import solve_any, solve_program
from tpss.planning.transitions import Transitions
from tpss.planning.tree import Tree, make_tree
from tpss.planning.worth import worth_of

from made_up_plans import enumerated, one_area, random_plan

seeds = pytest.mark.parametrize("seed", range(30))
EXACT = 1e-9


def costs(problem):
    return [area.yearly_cost for area in problem.areas]


def with_transitions(problem, change):
    """The same with other transitions of each area."""
    areas = (replace(area, transitions=change(area.transitions)) for area in problem.areas)
    return replace(problem, areas=tuple(areas))


@seeds
def test_one_more_configuration_never_costs_more(seed):
    problem = random_plan(seed)
    fewer = [table.copy() for table in costs(problem)]
    fewer[0][:, -1] = np.inf
    assert solve(problem).cost <= solve(problem.with_costs(fewer)).cost * (1 + EXACT)


@seeds
def test_a_larger_budget_never_costs_more(seed):
    problem = random_plan(seed, budget=True)
    larger = replace(problem, budget=1.3 * problem.budget)
    free = replace(problem, budget=None)
    tight, loose, none = (solve_any(each).cost for each in (problem, larger, free))
    assert none <= loose * (1 + EXACT)
    assert loose <= tight * (1 + EXACT)


@seeds
def test_a_higher_price_never_costs_less(seed):
    rng = np.random.default_rng(seed)
    problem = random_plan(seed)
    dearer = problem.with_costs([table * rng.uniform(1.0, 1.5) for table in costs(problem)])
    assert solve(dearer).cost >= solve(problem).cost * (1 - EXACT)


@seeds
def test_all_prices_times_three_cost_three_times_as_much_for_the_same_plan(seed):
    problem = random_plan(seed)
    dearer = problem.with_costs([3.0 * table for table in costs(problem)])
    dearer = with_transitions(dearer, lambda each: replace(each, cost=3.0 * each.cost))
    once, thrice = solve(problem), solve(dearer)
    assert thrice.cost == pytest.approx(3.0 * once.cost, rel=EXACT)
    assert thrice.policy.tolist() == once.policy.tolist()


@seeds
def test_to_know_is_worth_something_and_to_decide_for_ever_costs_something(seed):
    worth = worth_of(random_plan(seed))
    assert worth.expected_known_cost <= worth.best.cost * (1 + EXACT)
    assert worth.best.cost <= worth.fixed.cost * (1 + EXACT)


@seeds
def test_to_plan_for_the_mean_costs_something(seed):
    """Mean costs stand for a mean future here."""
    problem = random_plan(seed, forbid=0.0)
    tree = problem.tree
    mean = [
        np.array(
            [tree.probability[tree.stage == s] @ t[tree.stage == s] for s in range(tree.stages)]
        )
        for t in costs(problem)
    ]
    assert worth_of(problem, mean).of_the_tree >= -EXACT * worth_of(problem).best.cost


@seeds
def test_with_one_scenario_nothing_is_uncertain(seed):
    problem = random_plan(seed).of_scenario(0)
    worth = worth_of(problem, costs(problem))
    for nothing in (worth.of_information, worth.of_flexibility, worth.of_the_tree):
        assert nothing == pytest.approx(0.0, abs=EXACT * worth.best.cost)


@seeds
def test_a_scenario_as_two_equal_halves_changes_nothing(seed):
    problem = random_plan(seed)
    tree = problem.tree
    halves = np.append(tree.scenario_probability, tree.scenario_probability[-1] / 2.0)
    halves[-2] /= 2.0
    doubled = Tree((*tree.names, "twin"), halves, np.vstack([tree.node_of, tree.node_of[-1]]))
    split = replace(problem, tree=doubled)
    assert solve(split).cost == pytest.approx(solve(problem).cost, rel=EXACT)
    assert worth_of(split).of_information == pytest.approx(
        worth_of(problem).of_information, rel=1e-7, abs=1e-7
    )


@seeds
def test_other_names_and_numbers_change_nothing(seed):
    """Configurations in another order."""
    problem = random_plan(seed)
    area = problem.areas[0]
    order = np.random.default_rng(seed).permutation(area.configurations)
    change = area.transitions
    turned = Area(
        "other",
        area.yearly_cost[:, order],
        Transitions(
            change.cost[:, order][:, :, order],
            change.outlay[:, order][:, :, order],
            int(np.flatnonzero(order == change.initial)[0]),
        ),
        area.ordered_at,
    )
    found = solve(replace(problem, areas=(turned,)))
    assert found.cost == pytest.approx(solve(problem).cost, rel=EXACT)


@seeds
def test_areas_without_a_budget_are_on_their_own(seed):
    problem = random_plan(seed, areas=3)
    alone = [solve(replace(problem, areas=(area,))).cost for area in problem.areas]
    assert solve(problem).cost == pytest.approx(sum(alone), rel=EXACT)


@pytest.mark.parametrize("seed", range(10))
def test_a_stage_in_two_without_new_options_changes_no_cost(seed):
    """The second half allows no change, and has the nodes and costs of the first."""
    rng = np.random.default_rng(seed)
    cost = rng.uniform(1.0, 20.0, (3, 3))
    change = rng.uniform(20.0, 100.0, (2, 3, 3)) * (1 - np.eye(3))
    stay = np.where(np.eye(3, dtype=bool), 0.0, np.inf)[np.newaxis]
    values = [["a", "low"], ["a", "high"]]
    whole = Problem(
        make_tree(["low", "high"], [0.3, 0.7], values),
        Stages((2030, 2040), 2060, 0.04),
        (one_area(cost, change, (0, 1)),),
    )
    halves = Problem(
        make_tree(["low", "high"], [0.3, 0.7], [[*row, "later"] for row in values]),
        Stages((2030, 2040, 2047), 2060, 0.04),
        (one_area(np.vstack([cost, cost[1:]]), np.vstack([change, stay]), (0, 1, 2)),),
    )
    assert solve(halves).cost == pytest.approx(solve(whole).cost, rel=1e-12)


def test_ties_are_shown_as_ties():
    """Two configurations that cost the same are both as good as the best; a third is not."""
    tree = make_tree(["only"], [1.0], [[0]])
    area = one_area([[5.0, 3.0, 3.0]], np.zeros((1, 3, 3)), (0,))
    found = first_decisions(Problem(tree, Stages((0,), 10, 0.0), (area,)))
    assert [each.configuration for each in found] == [1, 2, 0]
    assert [each.is_tie(1e-9) for each in found] == [True, True, False]


def test_random_plans_are_not_all_alike():
    """Some build, some do not; some budgets bind."""
    problems = [random_plan(seed, budget=True) for seed in range(60)]
    policies = [solve_program(problem).policy for problem in problems]
    building = sum((policy != 0).any() for policy in policies)
    bound = sum(
        enumerated(problem)[0] > solve(replace(problem, budget=None)).cost * (1 + EXACT)
        for problem in problems[:20]
    )
    assert 20 <= building < 60
    assert bound >= 4
