"""Changes as sums over measures are the same changes as in a table of all pairs."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from tpss.errors import NoPlanError, PlanError
from tpss.planning.costs import cost_by_scenario, expected_cost, outlay
from tpss.planning.counting import number_of_plans
from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.level_transitions import LevelTransitions, table_of
from tpss.planning.measures import Measure, Renewal, allowed, make_transitions
from tpss.planning.money import Stages
from tpss.planning.problem import Area, Problem
from tpss.planning.program import solve_any
from tpss.planning.ranking import best_plans

from made_up_plans import random_plan

seeds = pytest.mark.parametrize("seed", range(12))


def measures_of(rng):
    """Four measures: C takes the place of A, and they exclude each other; D needs B."""
    measures = [
        Measure("A", (0.0, rng.uniform(20, 90)), 40.0),
        Measure("B", (0.0, 30.0, 45.0, 80.0), 30.0, first_stage=int(rng.integers(0, 2))),
        Measure("C", (0.0, rng.uniform(50, 150)), replaces=(0,)),
        Measure("D", (0.0, 25.0), 15.0, last_stage=1),
    ]
    levels = np.array(list(itertools.product((0, 1), (0, 1, 2, 3), (0, 1), (0, 1))))
    levels = levels[allowed(levels, excludes=[(0, 2)], needs=[(3, 1)])]
    return measures, levels[rng.permutation(len(levels))]


def both(seed):
    """A random plan of such measures, with changes by measures and as a table."""
    rng = np.random.default_rng(seed)
    problem = random_plan(seed)
    measures, levels = measures_of(rng)
    stages = problem.stages
    renewals = [Renewal("catenary", 70.0, stages.start_year[-1] + 1, unless=(2,), in_budget=True)]
    initial = int(np.flatnonzero((levels == 0).all(axis=1))[0])
    cost = rng.uniform(1.0, 20.0, (problem.tree.nodes, len(levels)))
    found = []
    for most in (0, 1000):
        changes = make_transitions(stages, levels, measures, renewals, initial, most)
        ordered = problem.areas[0].ordered_at
        found.append(replace(problem, areas=(Area("line", cost, changes, ordered),)))
    assert isinstance(found[0].areas[0].transitions, LevelTransitions)
    return found


@seeds
def test_the_table_is_the_same(seed):
    by_measures, table = (each.areas[0].transitions for each in both(seed))
    whole = by_measures.table()
    assert whole.cost == pytest.approx(table.cost)
    possible = np.isfinite(table.cost)
    assert whole.outlay[possible] == pytest.approx(table.outlay[possible])
    assert table_of(table) is table


@seeds
def test_the_cheapest_change_is_the_same(seed):
    by_measures, table = (each.areas[0].transitions for each in both(seed))
    after = np.random.default_rng(seed).uniform(0.0, 100.0, (5, table.configurations))
    after[after > 80.0] = np.inf
    for stage in range(table.stages):
        (cost, to), (least, _) = (each.cheapest(stage, after) for each in (by_measures, table))
        assert cost == pytest.approx(least)
        before = np.broadcast_to(np.arange(table.configurations), to.shape)
        reached = table.cost[stage, before, to] + np.take_along_axis(after, to, axis=1)
        assert reached == pytest.approx(least)


@seeds
def test_plans_are_the_same(seed):
    by_measures, table = both(seed)
    one, other = solve(by_measures), solve(table)
    assert one.cost == pytest.approx(other.cost, rel=1e-12)
    assert expected_cost(table, one.policy) == pytest.approx(other.cost, rel=1e-12)
    assert outlay(by_measures, one.policy) == pytest.approx(outlay(table, one.policy))
    assert cost_by_scenario(by_measures, one.policy) == pytest.approx(
        cost_by_scenario(table, one.policy)
    )
    assert number_of_plans(by_measures) == number_of_plans(table)
    costs = [[each.cost for each in best_plans(p, 12)] for p in (by_measures, table)]
    assert costs[0] == pytest.approx(costs[1], rel=1e-12)
    firsts = [
        {each.configuration: each.cost for each in first_decisions(p)} for p in (by_measures, table)
    ]
    assert firsts[0] == pytest.approx(firsts[1], rel=1e-12)


def test_a_budget_takes_a_table_of_them():
    by_measures, table = both(3)
    limit = np.full(table.tree.nodes, 80.0)
    costs = [solve_any(replace(each, budget=limit)).cost for each in (by_measures, table)]
    assert costs[0] == pytest.approx(costs[1], rel=1e-9)


def test_where_nothing_is_allowed_the_place_is_named():
    by_measures, table = both(4)
    cost = by_measures.areas[0].yearly_cost.copy()
    cost[-1] = np.inf
    said = []
    for each in (by_measures, table):
        with pytest.raises(NoPlanError) as caught:
            solve(each.with_costs([cost]))
        said.append(str(caught.value))
    assert said[0] == said[1]


def many(measures):
    """So many measures, each built or not; as a plan of a stage."""
    levels = np.array(list(itertools.product((0, 1), repeat=measures)))
    prices = [Measure(f"M{k}", (0.0, 2.0**k)) for k in range(measures)]
    return make_transitions(Stages((0,), 10, 0.0), levels, prices), levels


def test_of_many_measures_those_are_built_that_pay():
    """Fourteen of which the k-th costs 2^k and saves 100: the first seven pay, 64 at most."""
    changes, levels = many(14)
    problem = random_plan(0).of_scenario(0)
    tree = problem.tree
    one = replace(tree, node_of=np.zeros((1, 1), dtype=np.int64))
    cost = 10_000.0 - 100.0 * levels.sum(axis=1) / 10.0
    found = solve(Problem(one, Stages((0,), 10, 0.0), (Area("line", cost[None], changes, (0,)),)))
    assert levels[found.policy[0, 0]].tolist() == [1] * 7 + [0] * 7
    assert (
        number_of_plans(
            Problem(one, Stages((0,), 10, 0.0), (Area("line", cost[None], changes, (0,)),))
        )
        == 2**14
    )


def test_too_many_configurations_for_a_budget_are_refused():
    with pytest.raises(
        PlanError, match=r"1,024 configurations .* too many for plans with a budget"
    ):
        table_of(many(10)[0])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (lambda good: {"extra_cost": good.extra_cost[:, 1:]}, "shapes that do not fit"),
        (lambda good: {"place": np.zeros_like(good.place)}, "the same levels"),
        (lambda good: {"initial": -1}, "no configuration -1"),
        (
            lambda good: {"axes": good.axes * 30, "place": np.tile(good.place, 30)},
            "let fewer measures be built",
        ),
    ],
)
def test_what_makes_no_sense_is_refused(changes, words):
    good = both(0)[0].areas[0].transitions
    with pytest.raises(PlanError, match=words):
        replace(good, **changes(good))
