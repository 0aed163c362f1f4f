"""The answer to a plan: the best one of all, what else one could do, and where it turns."""

import itertools

import numpy as np
import pytest

import tpss
from tpss.planning import tables
from tpss.planning.answer import answer_of
from tpss.planning.costs import expected_cost
from tpss.planning.sentence import sentences
from tpss.planning.switching import costs_of_first
from tpss.planning.turning import all_turns, first_costs, nearest, turns_of

from small_plans import PLAN, modelled, write_plan


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("plan")


TIGHT = {"require/lowest_voltage_kv": 14.0}
"""A requirement that today's supply does not meet with a train every 5 min."""


def test_no_plan_of_all_is_better(folder):
    """Four configurations, three nodes: 64 plans, each with its cost."""
    answer = answer_of(modelled(folder, TIGHT))
    problem = answer.model.problem
    costs = [
        expected_cost(problem, np.array([plan])) for plan in itertools.product(range(4), repeat=3)
    ]
    assert answer.best.cost == pytest.approx(min(costs), rel=1e-12)
    assert answer.is_closed
    assert answer.claim.endswith("all 8 cases were simulated.")


def test_a_plan_costs_what_its_parts_cost(folder):
    """Components, stages and scenarios, discounted and weighted, add up to the expected cost."""
    answer = answer_of(modelled(folder, TIGHT))
    costs = tables.costs(answer)
    probability = costs.scenario.map({"low": 0.6, "high": 0.4})
    assert (costs.discounted * probability).sum() == pytest.approx(answer.best.cost, rel=1e-12)
    assert set(costs.component) >= {"energy_per_kwh", "train_not_run.freight", "investment"}


def test_decisions_say_what_is_built_and_when_it_is_ordered(folder):
    lead = {"measures/Mid/lead_time_years": 8, "measures/AT/lead_time_years": 5}
    answer = answer_of(modelled(folder, {**TIGHT, **lead, "measures/Mid/cost": 1.0}))
    table = tables.decisions(answer)
    assert table.in_service.tolist() == [2030, 2040, 2040]
    assert table.ordered.fillna(0).tolist() == [0, 2030, 2030]
    assert table["if"].tolist() == ["low or high", "low", "high"]
    assert table.configuration.tolist()[0] == "as today"
    assert table.builds.tolist()[1] == table.builds.tolist()[2] != ""


def test_every_first_decision_has_its_surplus(folder):
    answer = answer_of(modelled(folder, TIGHT))
    firsts = tables.first_decisions(answer)
    assert sorted(firsts.configuration) == ["AT", "Mid", "Mid+AT", "as today"]
    assert firsts.surplus.tolist() == sorted(firsts.surplus)
    assert firsts.cost[0] == pytest.approx(answer.best.cost)


def test_regret_is_none_for_the_best_plan_of_a_future(folder):
    answer = answer_of(modelled(folder, {**TIGHT, "scenarios/high": None, "scenarios/low": {
        "probability": 1.0, "traffic.eastbound.headway_min": [20.0, 5.0]}}))  # fmt: skip
    table = tables.regret(answer)
    assert table.loc[table.plan == "the plan", "largest"].item() == pytest.approx(0.0, abs=1e-9)
    assert answer.worth.of_information == pytest.approx(0.0, abs=1e-9)


def test_a_budget_keeps_what_it_does_not_allow_out(folder):
    """A budget of 25 in each stage: Mid for 20 may be built, AT for 40 never."""
    free = answer_of(modelled(folder, TIGHT))
    tied = answer_of(modelled(folder, {**TIGHT, "budget": {"per_stage": [25.0, 25.0]}}))
    assert tied.best.cost >= free.best.cost
    assert not {"AT", "Mid+AT"} & set(tables.decisions(tied).configuration)
    assert (tables.decisions(tied).spent <= 25.0).all()


def test_a_future_in_two_equal_halves_changes_nothing(folder):
    high = {"probability": 0.2, "traffic.eastbound.headway_min": [20.0, 5.0]}
    whole = answer_of(modelled(folder, TIGHT))
    halves = answer_of(modelled(folder, {**TIGHT, "scenarios/high": high, "scenarios/other": high}))
    assert halves.best.cost == pytest.approx(whole.best.cost, rel=1e-12)


def test_the_first_decision_turns_where_both_cost_the_same(folder):
    """At the cost of a measure at which the decision turns, both are as good."""
    model = modelled(folder, {**TIGHT, "measures/Mid/cost": 20.0})
    turns = {turn.key: turn.found for turn in turns_of(model, 0)}
    found = turns["measures.Mid.cost"]
    at = found.above if found.above is not None else found.below
    if at is None:
        pytest.fail("it does not turn")
    answer = answer_of(modelled(folder, {**TIGHT, "measures/Mid/cost": at}))
    assert answer.firsts[1].surplus == pytest.approx(0.0, abs=1e-6)
    assert nearest(list(turns_of(model, 0))) is not None


def test_configurations_say_what_they_carry(folder):
    table = tables.configurations(modelled(folder, TIGHT))
    assert len(table) == 8
    assert (table.why_not == "").tolist() == table.carried.tolist()


def test_the_best_plans_come_in_the_order_of_their_costs(folder):
    """The first is the best one; all plans of three nodes in which what is built stays."""
    answer = answer_of(modelled(folder, TIGHT))
    table = tables.best_plans(answer)
    costs = table.drop_duplicates("rank").cost.tolist()
    assert costs == sorted(costs)
    assert costs[0] == pytest.approx(answer.best.cost)
    first = table[table["rank"] == 1]
    assert first.configuration.tolist() == tables.decisions(answer).configuration.tolist()


def test_no_plan_has_less_regret_than_the_one_of_least_regret(folder):
    table = tables.regret(answer_of(modelled(folder, TIGHT))).set_index("plan").largest
    assert table["least regret"] <= table.min() + 1e-9


def test_futures_that_part_at_once_have_a_first_decision_each(folder):
    """Both are told in a sentence; where they turn is not asked, as there is no single one."""
    parted = {"scenarios/high/traffic.eastbound.headway_min": [5.0, 5.0]}
    answer = answer_of(modelled(folder, {**TIGHT, **parted}))
    low, high = sentences(answer, all_turns(answer))
    assert "in 2030 if low: " in low
    assert "in 2030 if high: " in high
    assert all_turns(answer) == []


def test_a_plan_is_run_from_python(tmp_path):
    """The same answer as by its parts, and the files of the command line."""
    answered = tpss.run_plan(
        tpss.load_plan(write_plan(tmp_path, TIGHT)), tmp_path / "out", workers=1
    )
    by_parts = answer_of(modelled(tmp_path, TIGHT))
    assert answered.answer.best.cost == by_parts.best.cost
    assert (tmp_path / "out" / "plan.json").exists()


def test_costs_of_first_decisions_are_those_of_the_plans_that_contain_them(folder):
    lead = {"measures/Mid/lead_time_years": 8, "measures/AT/lead_time_years": 5}
    for changes in (TIGHT, {**TIGHT, **lead}):
        problem = modelled(folder, changes).problem
        assert first_costs(problem, 0) == pytest.approx(costs_of_first(problem), rel=1e-12)


def test_each_area_has_its_own_lead_time(tmp_path):
    """What is ordered at once and what is ordered a stage ahead stand in one plan."""
    two = {
        "scenario": None,
        "areas": {name: {"scenario": "line.toml"} for name in ("north", "south")},
        "measures": {
            "north.AT": PLAN["measures"]["AT"],
            "south.AT": {**PLAN["measures"]["AT"], "lead_time_years": 10},
        },
        "scenarios": {
            "low": {"probability": 0.5, "north.traffic.eastbound.headway_min": [20.0, 20.0]},
            "high": {"probability": 0.5, "north.traffic.eastbound.headway_min": [20.0, 5.0]},
        },
    }
    answer = answer_of(modelled(tmp_path, {**TIGHT, **two}))
    table = tables.decisions(answer)
    ordered = {name: own.ordered.fillna(0).tolist() for name, own in table.groupby("area")}
    assert ordered == {"north": [2030, 2040, 2040], "south": [0, 2030, 2030]}
    assert answer.is_closed
