"""Published examples of stochastic programming and of real options, as plans of few configurations."""

import numpy as np
import pytest

from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.money import Stages
from tpss.planning.problem import Problem
from tpss.planning.tree import make_tree
from tpss.planning.worth import worth_of

from made_up_plans import one_area

INF = np.inf
ACRES = 500


class Farmer:
    """Birge and Louveaux, Introduction to Stochastic Programming, section 1.1.

    500 acres of wheat, corn and sugar beets are planted at 150, 230 and 260 an acre, before the
    weather is known: yields are 2.5, 3 and 20 t an acre, or 20 % more or less, each with
    probability 1/3.  Cattle need 200 t of wheat and 240 t of corn; these are bought at 238 and 210
    a tonne and sold at 170 and 150.  Beets bring 36 for 6000 t, and 10 beyond."""

    def __init__(self):
        """Every allocation in tens of acres, and the two best ones of known weather that are not."""
        tens = [
            (wheat, corn, ACRES - wheat - corn)
            for wheat in range(0, ACRES + 1, 10)
            for corn in range(0, ACRES - wheat + 1, 10)
        ]
        known = [(550 / 3, 200 / 3, 250.0), (100.0, 25.0, 375.0)]
        self.acres = np.array([*tens, *known], dtype=float)
        nothing, count = len(self.acres), len(self.acres) + 1
        planting = np.append(self.acres @ [150.0, 230.0, 260.0], 0.0)
        harvest = np.array([self._cost(factor) for factor in (1.2, 1.0, 0.8)])
        cost = np.full((4, count), INF)  # before the harvest nothing is earned
        cost[0, :nothing] = 0.0
        cost[1:, :nothing] = harvest
        change = np.full((2, count, count), INF)
        change[0, nothing, :nothing] = planting[:-1]
        change[1, np.arange(count), np.arange(count)] = 0.0
        names = ["good", "average", "bad"]
        tree = make_tree(names, [1 / 3] * 3, [["unknown", name] for name in names])
        area = one_area(cost, change, (0, 1), initial=nothing)
        self.problem = Problem(tree, Stages((0, 1), 2, 0.0), (area,))
        self.mean = [np.vstack([cost[0], cost[2]])]

    def _cost(self, factor):
        """What is bought less what is sold after the harvest, of each allocation."""
        wheat, corn, beets = (self.acres * [2.5, 3.0, 20.0] * factor).T
        total = np.zeros(len(self.acres))
        for crop, need, bought, sold in ((wheat, 200, 238, 170), (corn, 240, 210, 150)):
            total += np.where(crop < need, (need - crop) * bought, -(crop - need) * sold)
        return total - 36.0 * np.minimum(beets, 6000.0) - 10.0 * np.maximum(beets - 6000.0, 0.0)


def test_the_farmer():
    """SP 108,390 at (170, 80, 250); WS 115,405.56; EVPI 7,015.56; EEV 107,240 and VSS 1,150."""
    farmer = Farmer()
    assert len(farmer.acres) == 1328
    worth = worth_of(farmer.problem, farmer.mean)
    assert -worth.best.cost == pytest.approx(108_390.0)
    assert farmer.acres[worth.best.policy[0, 0]].tolist() == [170.0, 80.0, 250.0]
    assert -worth.expected_known_cost == pytest.approx(115_405.56, abs=0.005)
    assert worth.of_information == pytest.approx(7_015.56, abs=0.005)
    assert farmer.acres[worth.mean.policy[0, 0]].tolist() == [120.0, 80.0, 300.0]
    assert -worth.mean.cost == pytest.approx(107_240.0)
    assert worth.of_the_tree == pytest.approx(1_150.0)
    assert worth.of_flexibility == pytest.approx(0.0)  # nothing is left to be decided later


def test_the_widget_factory():
    """Dixit and Pindyck, Investment under Uncertainty, chapter 2.

    A factory costs 1600 and makes a widget a year for ever, the first one at once.  A widget brings
    200 now, and from next year on 300 or 100, each with probability 0.5; the rate is 10 %.  Now:
    -1600 + 200·11 = 600.  In a year, if the price rises: 0.5·(-1600/1.1 + 300·11/1.1) = 772.7.  So
    the option to wait is worth 172.7.

    Here a year is paid at its end, so a widget at its start counts 1.1 times; a thousand years
    stand for ever."""
    tree = make_tree(["up", "down"], [0.5, 0.5], [[200, 300], [200, 100]])
    cost = -1.1 * np.array([[0.0, 200.0], [0.0, 300.0], [0.0, 100.0]])
    change = np.array([[[0.0, 1600.0], [INF, 0.0]]] * 2)
    problem = Problem(tree, Stages((0, 1), 1001, 0.1), (one_area(cost, change, (0, 1)),))
    wait, now = first_decisions(problem)
    assert -now.cost == pytest.approx(600.0)
    assert -wait.cost == pytest.approx(772.7, abs=0.05)
    assert now.surplus == pytest.approx(172.7, abs=0.05)
    assert solve(problem).policy.tolist() == [[0, 1, 0]]
