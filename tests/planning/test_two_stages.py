"""The plan of two stages that can be worked out by hand.

Two stages of 10 years at no interest; ``weak`` supply exists, ``strong`` costs 100.  A year of little
traffic costs 2 with weak and 1 with strong supply, one of much traffic 20 and 2.  Stage 1 has little
traffic, stage 2 little with probability 0.6 and much with 0.4.
"""

import numpy as np
import pytest

from tpss.planning.counting import number_of_plans
from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.ranking import best_plans
from tpss.planning.regret import least_regret, regrets
from tpss.planning.worth import compare, worth_of

from made_up_plans import two_stages

WEAK, STRONG = 0, 1
NOW, LITTLE, MUCH = 0, 1, 2
"""Nodes of the tree."""


def test_the_best_plan_waits_and_builds_if_traffic_grows():
    """10·2 + 0.6·10·2 + 0.4·(100 + 10·2) = 20 + 12 + 48 = 80."""
    found = solve(two_stages())
    assert found.cost == pytest.approx(80.0, abs=1e-12)
    assert found.bound == pytest.approx(80.0, abs=1e-12)
    assert found.policy.tolist() == [[WEAK, WEAK, STRONG]]


def test_the_best_plan_that_builds_at_once():
    """100 + 10·1 + 0.6·10·1 + 0.4·10·2 = 124, which is 44 more."""
    wait, build = first_decisions(two_stages())
    assert (wait.configuration, wait.surplus) == (WEAK, 0.0)
    assert (build.configuration, build.cost, build.surplus) == (STRONG, 124.0, 44.0)
    assert build.policy.tolist() == [[STRONG, STRONG, STRONG]]


def test_all_five_plans_in_their_order():
    """Never: 20 + 0.6·20 + 0.4·200 = 112; at once 124; always later 20 + 100 + 6 + 8 = 134; the wrong
    way round 20 + 0.6·(100 + 10) + 0.4·200 = 166."""
    assert number_of_plans(two_stages()) == 5
    found = best_plans(two_stages(), 10)
    assert [plan.cost for plan in found] == pytest.approx([80.0, 112.0, 124.0, 134.0, 166.0])
    assert found[-1].policy.tolist() == [[WEAK, STRONG, WEAK]]


def test_with_an_order_a_stage_ahead_nothing_is_built():
    """What is ordered at once serves both branches: 134; never is 112."""
    found = solve(two_stages(lead=1))
    assert found.cost == pytest.approx(112.0)
    assert number_of_plans(two_stages(lead=1)) == 2


def test_what_the_plan_is_worth():
    """Known beforehand: little 40, much: build later 20 + 100 + 20 = 140, at once 100 + 10 + 20 = 130.

    Expected 0.6·40 + 0.4·130 = 76: knowing is worth 4.  Never, the best fixed plan, costs 112:
    waiting is worth 32.
    """
    worth = worth_of(two_stages())
    assert worth.known_cost == pytest.approx([40.0, 130.0])
    assert worth.expected_known_cost == pytest.approx(76.0)
    assert worth.of_information == pytest.approx(4.0)
    assert worth.fixed.cost == pytest.approx(112.0)
    assert worth.of_flexibility == pytest.approx(32.0)
    assert worth.of_the_tree is None


def test_planning_for_the_mean_future():
    """Mean costs of stage 2: weak 0.6·2 + 0.4·20 = 9.2, strong 1.4: never 112 is best, so today is weak.

    With weak today the best that remains is the best plan: nothing is lost.
    """
    worth = worth_of(two_stages(), [np.array([[2.0, 1.0], [9.2, 1.4]])])
    assert worth.mean.cost == pytest.approx(80.0)
    assert worth.of_the_tree == pytest.approx(0.0)


def test_planning_for_a_mean_future_that_is_wrong():
    """If the mean future were much traffic, strong is built at once: 124, so planning for it costs
    44."""
    worth = worth_of(two_stages(), [np.array([[20.0, 2.0], [20.0, 2.0]])])
    assert worth.mean.cost == pytest.approx(124.0)
    assert worth.of_the_tree == pytest.approx(44.0)


def test_regret():
    """Wait and see: 40 - 40 and 140 - 130; never: 0 and 220 - 130; at once: 120 - 40 and 0."""
    problem = two_stages()
    known = np.array([40.0, 130.0])
    wait = [[WEAK, WEAK, STRONG]]
    policies = [wait, [[WEAK] * 3], [[STRONG] * 3]]
    table = regrets(problem, [np.array(each) for each in policies], known)
    assert table == pytest.approx(np.array([[0.0, 10.0], [0.0, 90.0], [80.0, 0.0]]))
    assert least_regret(problem, known).tolist() == wait


def test_the_best_plan_beside_leaving_everything_as_it_is():
    """112 - 80 = 32 saved by 0.4·100 = 40 expected to be invested: 0.8 for each unit."""
    problem = two_stages()
    beside = compare(problem, solve(problem).policy, np.zeros((1, 3), dtype=np.int64))
    assert (beside.saved, beside.invested, beside.ratio) == pytest.approx((32.0, 40.0, 0.8))


def test_a_node_in_words():
    """Its stage, counted from 1, the year in which it begins, and what may still come."""
    problem = two_stages()
    assert problem.label(0) == "stage 1 (2030), every scenario"
    assert problem.label(2) == "stage 2 (2040), high"
