"""Measures, their levels and renewals, as transitions between configurations."""

import numpy as np
import pytest

from tpss.errors import PlanError
from tpss.planning.measures import Measure, Renewal, allowed, make_transitions
from tpss.planning.money import Stages, charged_share
from tpss.planning.transitions import Transitions

INF = np.inf
STAGES = Stages((2030, 2035, 2045), 2085, 0.035)


def test_what_is_built_stays():
    """Configurations nothing, B, D, B and D; B costs 270 and D 200, both charged whole."""
    levels = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
    found = make_transitions(
        STAGES, levels, [Measure("B", (0.0, 270.0)), Measure("D", (0.0, 200.0))]
    )
    expected = [
        [0.0, 270.0, 200.0, 470.0],
        [INF, 0.0, INF, 200.0],
        [INF, INF, 0.0, 270.0],
        [INF, INF, INF, 0.0],
    ]
    assert found.cost[1].tolist() == expected
    assert found.outlay[1][np.isfinite(found.cost[1])].tolist() == [
        0, 270, 200, 470, 0, 200, 0, 270, 0,
    ]  # fmt: skip


def test_a_budget_counts_the_price_and_the_plan_the_years_within_its_horizon():
    """270 for 40 years, in service in 2035: 50 years are left, so 270·A(50)/A(40) is charged."""
    found = make_transitions(STAGES, np.array([[0], [1]]), [Measure("B", (0.0, 270.0), 40.0)])
    assert found.cost[1, 0, 1] == pytest.approx(270.0 * charged_share(0.035, 40, 50))
    assert found.outlay[1, 0, 1] == 270.0


def test_a_higher_level_costs_the_difference():
    """Two, three or four converters: 0, 45 and 90."""
    levels = np.array([[0], [1], [2]])
    found = make_transitions(STAGES, levels, [Measure("converters", (0.0, 45.0, 90.0))])
    assert found.cost[0].tolist() == [[0.0, 45.0, 90.0], [INF, 0.0, 45.0], [INF, INF, 0.0]]


def test_what_takes_anothers_place_is_paid_in_full():
    """AT, and a 132 kV line that takes its place: nothing is paid back, and there is no way back."""
    levels = np.array([[0, 0], [1, 0], [0, 1]])
    measures = [Measure("AT", (0.0, 100.0)), Measure("HV", (0.0, 300.0), replaces=(0,))]
    found = make_transitions(STAGES, levels, measures)
    assert found.cost[0].tolist() == [[0.0, 100.0, 300.0], [INF, 0.0, 300.0], [INF, INF, 0.0]]


def test_a_measure_has_its_time():
    """From the second stage on, to the second stage; what was built then stays."""
    measure = Measure("B", (0.0, 10.0), first_stage=1, last_stage=1)
    found = make_transitions(STAGES, np.array([[0], [1]]), [measure])
    assert found.cost[:, 0, 1].tolist() == [INF, 10.0, INF]
    assert found.cost[:, 1, 1].tolist() == [0.0, 0.0, 0.0]


def test_a_renewal_falls_due_where_nothing_spares_it():
    """900 in 2040, five years into the second stage, unless there is AT: discounted to 2035."""
    renewal = Renewal("catenary", 900.0, 2040, unless=(0,))
    found = make_transitions(
        STAGES, np.array([[0], [1]]), [Measure("AT", (0.0, 1000.0))], [renewal]
    )
    assert found.cost[1] == pytest.approx(
        np.array([[900.0 * 1.035**-5, 1000.0], [INF, 0.0]]), rel=1e-12
    )
    assert found.cost[0, 0, 0] == found.cost[2, 0, 0] == 0.0
    assert found.outlay[1, 0, 0] == 0.0


def test_a_renewal_counts_towards_a_budget_if_it_is_said():
    renewal = Renewal("catenary", 900.0, 2035, in_budget=True)
    found = make_transitions(STAGES, np.array([[0]]), [Measure("AT", (0.0, 1.0))], [renewal])
    assert found.outlay[:, 0, 0].tolist() == [0.0, 900.0, 0.0]


def test_exclusions_and_needs():
    """Of AT and HV one, and D only with B."""
    levels = np.array([[0, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1], [0, 0, 2, 1]])
    found = allowed(levels, excludes=[(0, 1)], needs=[(3, 2)])
    assert found.tolist() == [True, False, True, False, True]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Measure("B", (5.0, 10.0)), "measure B: prices of its levels start with 0"),
        (lambda: Measure("B", (0.0, np.nan)), "measure B: a price is missing"),
        (lambda: Renewal("rail", np.nan, 2040), "renewal rail: its cost is missing"),
        (
            lambda: make_transitions(STAGES, np.array([[2]]), [Measure("B", (0.0, 1.0))]),
            "a level that its measure does not have",
        ),
        (
            lambda: make_transitions(STAGES, np.array([[0, 0]]), [Measure("B", (0.0, 1.0))]),
            "1 measures, and levels",
        ),
        (
            lambda: make_transitions(
                STAGES, np.array([[0]]), [Measure("B", (0.0, 1.0))], [Renewal("x", 1.0, 2085)]
            ),
            "renewal x: 2085 is no year of the plan",
        ),
        (lambda: Transitions(np.zeros((1, 2, 2)), np.zeros((1, 2, 3))), "have the shape"),
        (lambda: Transitions(np.full((1, 1, 1), np.nan), np.zeros((1, 1, 1))), "is missing"),
        (lambda: Transitions(np.zeros((1, 1, 1)), np.full((1, 1, 1), np.nan)), "spends is missing"),
        (lambda: Transitions(np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), 1), "no configuration 1"),
    ],
)
def test_what_makes_no_sense_is_refused(call, words):
    with pytest.raises(PlanError, match=words):
        call()
