"""What it costs to plan for the mean future only: its first decision held, and the best after it.

Outcomes are made up by rules (`plan_outcomes`).
"""

import json

import numpy as np
import pytest

from tpss.planning import tables
from tpss.planning.answer import answer_of
from tpss.planning.cases import CaseList
from tpss.planning.costs import expected_cost
from tpss.planning.mean_future import mean_future_of
from tpss.planning.solve import model_of

from made_up_plans import every_policy
from plan_outcomes import outcomes
from small_plans import plan
from solved_plans import solved

HEADWAY = "traffic.eastbound.headway_min"
THREE = {
    "require/lowest_voltage_kv": 13.0,
    "measures/Mid/cost": 300.0,
    "measures/Mid/lead_time_years": 10,
    "measures/AT/lead_time_years": 10,
    "scenarios/low": {"probability": 0.5, HEADWAY: [20.0, 20.0]},
    "scenarios/mid": {"probability": 0.2, HEADWAY: [20.0, 12.0]},
    "scenarios/high": {"probability": 0.3, HEADWAY: [20.0, 6.0]},
}
"""Trains an hour at the end: 3 with 0.5, 5 with 0.2, 10 with 0.3: 5.5 in the mean, 5 is nearest."""


def answered(folder, changes):
    listed = CaseList(plan(folder, changes))
    return answer_of(model_of(listed, outcomes(listed)))


def test_mean_traffic_is_that_of_the_plan_with_the_nearest_number_of_trains(tmp_path):
    """5.5 trains an hour in the mean: a train every 12 min is nearest. A mean of headways is 14.2."""
    answer = answered(tmp_path, THREE)
    table = tables.mean_future(answer)
    assert table.stage.tolist() == [2030, 2040]
    assert table.traffic.tolist() == [f"{HEADWAY} = 20.0", f"{HEADWAY} = 12.0"]
    mid = next(
        n
        for n in range(answer.model.tree.nodes)
        if answer.model.tree.scenarios_through(n) == ("mid",)
    )
    assert np.array_equal(answer.mean.yearly_cost[0][1], answer.model.priced[0].yearly_cost[mid])


def test_the_first_decision_of_the_mean_is_held_and_the_rest_is_the_best(tmp_path):
    """Against all plans: of those whose order of 2030 is the mean future's, the cheapest."""
    answer = answered(tmp_path, THREE)
    problem, mean = answer.model.problem, answer.mean.yearly_cost[0]
    area, stages = problem.areas[0], problem.stages
    change = [area.transitions.costs_from(1, 0)[c] for c in range(area.configurations)]
    total = stages.discount[1] * (np.array(change) + stages.annuity[1] * mean[1])
    first = int(total.argmin())
    costs = [
        expected_cost(problem, policy)
        for policy in every_policy(problem)
        if (policy[0, problem.tree.stage == 1] == first).all()
    ]
    values = tables.values(answer).set_index("value").cost
    assert values["mean"] == pytest.approx(min(costs), rel=1e-12)
    assert values["tree"] == pytest.approx(min(costs) - answer.best.cost, abs=1e-9)
    assert values["tree"] > 1.0


def test_prices_of_the_mean_future_are_their_means(tmp_path):
    """0.65 and, with 0.4, 3 times as much: 1.17 in the mean."""
    dear = {
        "scenarios/high": {
            "probability": 0.4, HEADWAY: [20.0, 20.0],
            "economics.energy_per_kwh": [0.65e-6, 1.95e-6],
        }
    }  # fmt: skip
    answer = answered(tmp_path, dear)
    now, later = (answer.mean.yearly_cost[0][s] for s in (0, 1))
    energy = answer.model.served[0].quantities.operation[0, :, 0]
    assert later - now == pytest.approx(energy * 0.52e-6, rel=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {"scenarios": None},
        {"scenarios/high": {"probability": 0.4, "line.length_km": [20.0, 21.0]}},
    ],
)
def test_where_there_is_no_mean_none_is_made_up(changes, tmp_path):
    """One future; or futures that differ in more than trains."""
    answer = answered(tmp_path, changes)
    assert mean_future_of(answer.model) is None
    assert not tables.values(answer).value.isin(["mean", "tree"]).any()


def test_the_document_tells_values_and_the_mean_future(tmp_path):
    document = json.loads((solved(tmp_path, THREE) / "plan.json").read_text())
    assert document["values"]["plan"] == document["expected_cost"]
    assert document["values"]["tree"] == pytest.approx(
        document["values"]["mean"] - document["values"]["plan"]
    )
    assert document["mean_future"][1] == {
        "area": "small", "stage": 2040, "traffic": f"{HEADWAY} = 12.0",
    }  # fmt: skip
