"""Quantities times prices: yearly costs, and the traffic that is run."""

import numpy as np
import pytest

from tpss.errors import PlanError
from tpss.planning.prices import Quantities

INF, NAN = np.inf, np.nan
ENERGY, MISSED = 0, 1


def line(state_of_node=(0, 1), **changes):
    """Traffic of 10 and 20 trains; weak supply (0) carries 10, strong (1) both.

    Energy in GWh a year: 10 trains 5 and 4.5, 20 trains 9 with strong supply; up to ten trains are
    missed."""
    parts = {
        "components": ("energy", "train not run"),
        "operation": np.array([[[5.0, 0.0], [4.5, 0.0]], [[NAN, NAN], [9.0, 0.0]]]),
        "carried": np.array([[True, True], [False, True]]),
        "unserved": np.array([[[0.0, 0.0], [NAN, NAN]], [[0.0, 10.0], [0.0, 0.0]]]),
        "may_serve": np.array([[True, False], [True, True]]),
        "state_of_node": np.array(state_of_node),
    }
    return Quantities(**parts | changes)


def test_what_cannot_be_carried_is_not_run_and_costs():
    """At 2 a GWh and 1 a train: asked for 20, weak runs 10: 5·2 + 10·1 = 20; strong runs 20: 18."""
    found = line().priced(np.array([2.0, 1.0]))
    assert found.yearly_cost.tolist() == [[10.0, 9.0], [20.0, 18.0]]
    assert found.served(np.array([0, 0])).tolist() == [0, 0]
    assert found.served(np.array([1, 1])).tolist() == [0, 1]


def test_if_trains_are_worth_little_fewer_are_run():
    """At 0.1 a train strong supply runs 10 of 20 too: 4.5·2 + 10·0.1 = 10."""
    found = line().priced(np.array([2.0, 0.1]))
    assert found.yearly_cost[1].tolist() == [11.0, 10.0]
    assert found.served(np.array([1, 1])).tolist() == [0, 0]


def test_costs_by_component_add_up():
    found = line().priced(np.array([2.0, 1.0]))
    assert found.by_component(np.array([0, 0])).tolist() == [[10.0, 0.0], [10.0, 10.0]]
    for policy in ([0, 0], [0, 1], [1, 1]):
        total = found.by_component(np.array(policy)).sum(axis=1)
        assert total == pytest.approx(found.yearly_cost[np.arange(2), policy])


def test_prices_may_differ_between_nodes():
    """The same traffic at two prices of energy."""
    found = line(state_of_node=(0, 0, 1)).priced(np.array([[2.0, 1.0], [4.0, 1.0], [4.0, 1.0]]))
    assert found.yearly_cost.tolist() == [[10.0, 9.0], [20.0, 18.0], [30.0, 28.0]]


def test_where_nothing_can_be_carried_a_configuration_is_not_allowed():
    found = line(carried=np.array([[False, True], [False, True]])).priced(np.array([2.0, 1.0]))
    assert found.yearly_cost[:, 0].tolist() == [INF, INF]


def test_random_quantities_at_random_prices():
    """Against the definition, node by node."""
    rng = np.random.default_rng(0)
    traffic, configurations, nodes = 6, 4, 9
    quantities = Quantities(
        ("a", "b", "c"),
        rng.uniform(0, 1, (traffic, configurations, 3)),
        rng.random((traffic, configurations)) < 0.7,
        rng.uniform(0, 1, (traffic, traffic, 3)),
        rng.random((traffic, traffic)) < 0.7,
        rng.integers(0, traffic, nodes),
    )
    for price in (rng.uniform(0, 1, 3), rng.uniform(0, 1, (nodes, 3))):
        found = quantities.priced(price)
        for n, d in enumerate(quantities.state_of_node):
            for c in range(configurations):
                each = price if price.ndim == 1 else price[n]
                costs = [
                    each @ (quantities.operation[g, c] + quantities.unserved[d, g])
                    for g in range(traffic)
                    if quantities.carried[g, c] and quantities.may_serve[d, g]
                ]
                assert found.yearly_cost[n, c] == pytest.approx(min(costs, default=INF))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"operation": np.full((2, 2, 2), NAN)}, "quantity of operation is missing"),
        ({"unserved": np.full((2, 2, 2), NAN)}, "not served is missing"),
        ({"components": ("energy",)}, "shapes that do not fit"),
        ({"state_of_node": np.array([0, 2])}, "shapes that do not fit"),
    ],
)
def test_missing_quantities_are_refused(changes, words):
    with pytest.raises(PlanError, match=words):
        line(**changes)


def test_a_missing_price_is_a_fault_and_never_nothing():
    with pytest.raises(PlanError, match="no price of train not run"):
        line().priced(np.array([2.0, NAN]))
