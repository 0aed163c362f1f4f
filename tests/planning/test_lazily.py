"""Plans that are proved by bounds: the same plan as with all cases, from fewer of them.

Outcomes are made up by rules (`plan_outcomes`), handed out a case at a time to see which are asked for.
"""

import copy

import numpy as np
import pytest

import tpss
from tpss.planning import tables
from tpss.planning.answer import Effort, answer_of, solver_of
from tpss.planning.cases import CaseList
from tpss.planning.first_costs import first_costs
from tpss.planning.lazily import prove_lazily, simulated_and_all
from tpss.planning.plan import BOUNDS, SIMULATION
from tpss.planning.solve import model_of
from tpss.planning.strongest import bound_of, strongest
from tpss.planning.turning import all_turns
from tpss.planning.uncounted import unknown

from plan_outcomes import outcomes
from small_plans import PLAN, plan

HEADWAY = "traffic.eastbound.headway_min"


def station(number):
    place = {"position_km": 4.0 * number + 2.0, "type": "Q48/Q49", "converters": 2}
    added = {"supply.converter_stations": {"name": f"S{number}", **place}}
    return {**copy.deepcopy(PLAN["measures"]["Mid"]), "add": added, "cost": 150.0 + 10.0 * number}


FOUR = {
    "measures/Mid": None,
    "measures/AT": None,
    **{f"measures/S{number}": station(number) for number in range(4)},
    "scenarios/high": {"probability": 0.4, HEADWAY: [20.0, 7.5]},
}
"""Four stations that may stand together: 16 configurations, two states of traffic."""

VARIED = {
    "as it is": {},
    "trains are worth little": {"economics/train_not_run": {"freight": 0.001}},
    "energy is dear": {"economics/energy_per_kwh": 4e-6},
    "ordered ahead": {
        f"measures/S{n}": {**station(n), "cost": 400.0, "lead_time_years": 10} for n in range(4)
    },
    "an outage is stood": {"require/also_with": ["one out"]},
    "a budget": {"budget": {"per_stage": [160.0, 320.0]}},
    "prices rise": {
        "scenarios/high": {
            "probability": 0.4, HEADWAY: [20.0, 7.5], "economics.energy_per_kwh": [0.65e-6, 3e-6],
        }
    },
}  # fmt: skip


def two_lines():
    """The four stations on each of two lines, of which one has less traffic, with a budget for both."""
    measures = {
        f"measures/{area}.S{n}": {**station(n), "cost": cost + 10.0 * n}
        for n in range(4)
        for area, cost in (("north", 150.0), ("south", 190.0))
    }
    futures = {
        f"scenarios/{name}": {
            "probability": share,
            f"north.{HEADWAY}": [20.0, north],
            f"south.{HEADWAY}": [20.0, south],
        }
        for name, share, north, south in (("low", 0.6, 20.0, 10.0), ("high", 0.4, 7.5, 10.0))
    }
    lines = {name: {"scenario": "line.toml"} for name in ("north", "south")}
    without = dict.fromkeys(("scenario", *(key for key in FOUR if key.startswith("measures"))))
    return {
        **without,
        **measures,
        **futures,
        "areas": lines,
        "budget": {"per_stage": [400.0, 500.0]},
    }


def levels():
    """Two stations of one to three converters each, beside the two others."""
    found = {}
    for n in range(2):
        measure = station(n)
        measure["add"]["supply.converter_stations"]["converters"] = "{level}"
        costs = [150.0, 190.0, 210.0 + n]
        found[f"measures/S{n}"] = {**measure, "levels": [1, 2, 3], "cost": costs}
    return found


class Handed:
    """Outcomes that are handed out when they are asked for."""

    def __init__(self, listed, table=None, stop_after=None):
        self.whole = outcomes(listed) if table is None else table
        self.known: dict[str, None] = {}
        self.stop_after = stop_after

    def __call__(self, cases):
        for case in cases:
            if len(self.known) == self.stop_after:
                raise KeyboardInterrupt
            self.known[case.digest] = None
        return self.whole.loc[list(self.known)]


def bounded(folder, changes, table=None, **evaluate):
    """Answer by bounds, and what was handed out for it."""
    listed = CaseList(plan(folder, {**changes, "evaluate": {"by": BOUNDS, **evaluate}}))
    handed = Handed(listed, table)
    return answer_of(prove_lazily(listed, handed, solver_of(Effort()))), handed


def whole(folder, changes, table=None):
    """Answer from all cases."""
    listed = CaseList(plan(folder, changes))
    return answer_of(model_of(listed, outcomes(listed) if table is None else table))


@pytest.mark.parametrize("name", [*VARIED, "two lines", "levels"])
def test_the_plan_is_that_of_all_cases_from_fewer_of_them(name, tmp_path):
    built = {"two lines": two_lines, "levels": levels}
    changes = {**FOUR, **(VARIED[name] if name in VARIED else built[name]())}
    every, answer = whole(tmp_path, changes), bounded(tmp_path, changes)[0]
    assert answer.best.cost == every.best.cost
    assert np.array_equal(answer.best.policy, every.best.policy)
    assert answer.is_closed
    simulated, cases = simulated_and_all(answer.model)
    assert simulated < cases == len(every.model.table)
    assert f"{simulated} of {cases} cases were simulated, and none of them does" in answer.claim
    assert tables.decisions(answer).equals(tables.decisions(every))
    assert tables.costs(answer).equals(tables.costs(every))


def test_the_more_may_be_built_the_less_of_it_is_simulated(tmp_path):
    """Eight stations: 256 configurations, of which less than a fifth is simulated."""
    eight = {f"measures/S{n}": station(n) for n in range(8)}
    for n, measure in enumerate(eight.values()):
        measure["add"]["supply.converter_stations"]["position_km"] = 2.0 * n + 1.0
    every, answer = whole(tmp_path, {**FOUR, **eight}), bounded(tmp_path, {**FOUR, **eight})[0]
    assert answer.best.cost == every.best.cost
    simulated, cases = simulated_and_all(answer.model)
    assert cases == 512
    assert simulated < 0.2 * cases


def test_costs_that_are_at_least_so_much_are_no_less_in_truth(tmp_path):
    """First decisions, the worth of knowing and of deciding later, against those of all cases."""
    every, answer = whole(tmp_path, FOUR), bounded(tmp_path, FOUR)[0]
    truth = tables.first_decisions(every).set_index("configuration").cost
    firsts = tables.first_decisions(answer).set_index("configuration")
    known = firsts.known == "simulated"
    assert known.any()
    assert not known.all()
    assert firsts.cost[known].to_dict() == truth[firsts.index[known]].to_dict()
    assert (firsts.cost <= truth[firsts.index] * (1.0 + 1e-12)).all()
    assert answer.worth.of_information >= every.worth.of_information - 1e-9
    assert answer.worth.of_flexibility <= every.worth.of_flexibility + 1e-9


def test_nothing_that_was_not_simulated_is_shown_as_if_it_were(tmp_path):
    answer = bounded(tmp_path, FOUR)[0]
    model = answer.model
    table = tables.configurations(model)
    lacking = table.why_not == "not simulated"
    count, cases = simulated_and_all(model)
    assert lacking.sum() == cases - count
    assert table[lacking].carried.isna().all()
    assert table.loc[lacking, list(tables.SHOWN)].isna().all(axis=None)
    firsts = tables.first_decisions(answer).set_index("configuration")
    assert set(first_costs(answer).configuration) <= set(firsts.index[firsts.known == "simulated"])
    assert tables.best_plans(answer).cost.is_monotonic_increasing
    assert all_turns(answer) == []
    assert "tpss plan run --all" in "".join(unknown(model))


def test_the_best_plans_are_told_as_far_as_their_order_is_known(tmp_path):
    every = tables.best_plans(whole(tmp_path, FOUR), count=500)
    told = tables.best_plans(bounded(tmp_path, FOUR)[0], count=500)
    assert 0 < len(told) < len(every)
    assert told.equals(every.head(len(told)))


def test_bounds_that_do_not_hold_withdraw_the_claim(tmp_path):
    """The strongest supply takes twice the energy by a fault: other cases take less than its bound."""
    listed = CaseList(plan(tmp_path, FOUR))
    table = outcomes(listed)
    (best,) = strongest(listed.areas[0])
    own = [case.digest for case in listed.cases if case.configuration == best]
    table.loc[own, "drawn_from_grid_mw"] *= 2.0
    answer = bounded(tmp_path, FOUR, table)[0]
    assert not answer.proof.holds
    assert not answer.is_closed
    assert answer.claim.startswith("Nothing is claimed of other plans")
    assert "tpss plan run --all" in answer.claim
    assert not answer.is_bound(answer.best.policy)


def test_a_better_plan_that_a_wrong_bound_hid_is_followed(tmp_path):
    """A single case far below its bound that the audit comes upon becomes part of the plan."""
    listed = CaseList(plan(tmp_path, FOUR))
    table = outcomes(listed)
    one = next(c for c, each in enumerate(listed.areas[0].configurations) if each.size == 1)
    own = [case.digest for case in listed.cases if case.configuration == one]
    table.loc[own, "drawn_from_grid_mw"] = 0.01
    table.loc[own, ["lowest_voltage_kv", "mean_useful_voltage_kv"]] = 15.0
    answer = bounded(tmp_path, FOUR, table, audit_cases=1000)[0]
    assert not answer.proof.holds
    assert answer.best.cost == whole(tmp_path, FOUR, table).best.cost


def test_an_interrupted_proof_goes_on_and_simulates_no_case_twice(tmp_path):
    straight, _ = bounded(tmp_path, FOUR)
    listed = CaseList(plan(tmp_path, {**FOUR, "evaluate": {"by": BOUNDS}}))
    handed = Handed(listed)
    for stop in (1, 3, 6, 9):
        handed.stop_after = stop
        with pytest.raises(KeyboardInterrupt):
            prove_lazily(listed, handed, solver_of(Effort()))
    handed.stop_after = None
    answer = answer_of(prove_lazily(listed, handed, solver_of(Effort())))
    assert answer.best.cost == straight.best.cost
    assert np.array_equal(answer.best.policy, straight.best.policy)
    assert answer.proof.holds


@pytest.mark.parametrize("factor", [0.0, 0.3, 0.9, 1.1, 1.5, 3.0])
def test_priced_anew_it_is_the_plan_of_all_cases_or_is_not_told(factor, tmp_path):
    model = bounded(tmp_path, FOUR)[0].model
    prices = {"economics.energy_per_kwh": 0.65e-6 * factor, "measures.S0.cost": 150.0 * factor}
    listed = CaseList(model.plan.with_(prices))
    as_whole = CaseList(model.plan.with_({**prices, "evaluate.by": SIMULATION}))
    truth = answer_of(model_of(as_whole, outcomes(as_whole)))
    try:
        answer = answer_of(model_of(listed, model.table))
    except tpss.TpssError as error:
        assert "tpss plan run --all" in str(error)  # noqa: PT017
        assert factor > 1.0
    else:
        assert answer.best.cost == truth.best.cost


def test_an_audit_tests_cases_drawn_at_random(tmp_path):
    """Of 32 pairs of configuration and traffic 10 are drawn: at most 3/10 of all are faults."""
    plain, audited = (bounded(tmp_path, FOUR, audit_cases=n)[0] for n in (0, 10))
    assert audited.proof.audited == 10
    assert audited.proof.simulated > plain.proof.simulated
    assert "any of 10 that were drawn at random: at most 30 % of all do" in audited.claim
    assert audited.best.cost == plain.best.cost
    drawn = [
        set(bounded(tmp_path, FOUR, audit_cases=4, audit_seed=seed)[0].model.table.index)
        for seed in (1, 1, 3)
    ]
    assert drawn[0] == drawn[1] != drawn[2]


def test_an_audit_of_all_cases_is_a_proof_by_all_cases(tmp_path):
    answer = bounded(tmp_path, FOUR, audit_cases=1000)[0]
    assert answer.claim == whole(tmp_path, FOUR).claim
    assert not answer.model.has_bounds
    assert list(unknown(answer.model)) == []


def test_traffic_that_no_strongest_supply_carries_through_is_simulated_as_a_whole(tmp_path):
    """30 trains an hour lower the voltage to 14 + 4*2 - 18 = 4 kV: even the strongest collapses."""
    changes = {**FOUR, "scenarios/high": {"probability": 0.4, HEADWAY: [20.0, 2.0]}}
    every, (answer, handed) = whole(tmp_path, changes), bounded(tmp_path, changes)
    assert answer.best.cost == every.best.cost
    dense = [case for case in answer.model.case_list.cases if case.state == 1]
    assert {case.digest for case in dense} <= set(handed.known)


def test_no_more_cases_are_simulated_than_the_plan_allows(tmp_path):
    with pytest.raises(tpss.ScenarioError, match=r"evaluate\.most_cases = 7\n.*the proof takes 8"):
        bounded(tmp_path, FOUR, most_cases=7)


def test_cases_are_the_same_however_a_plan_is_proved(tmp_path):
    ways = [
        {},
        {
            "evaluate": {
                "by": BOUNDS,
                "bound_margin_percent": 3.0,
                "audit_cases": 4,
                "audit_seed": 2,
            }
        },
    ]
    lists = [CaseList(plan(tmp_path, each)).cases for each in ways]
    assert lists[0] == lists[1]


def test_the_strongest_are_those_to_which_nothing_can_be_added(tmp_path):
    area = CaseList(plan(tmp_path)).areas[0]
    assert [area.configurations[c].name for c in strongest(area)] == ["Mid+AT"]
    changes = {"measures/AT": {**PLAN["measures"]["AT"], "excludes": ["Mid"]}}
    area = CaseList(plan(tmp_path, changes)).areas[0]
    assert [area.configurations[c].name for c in strongest(area)] == ["AT", "Mid"]


def test_a_bound_has_the_best_of_every_strongest_supply():
    """Energy 100 less 5 %, 12 given back and 5 % more, of minutes the fewest, whoever has them."""
    operation = np.array([[100.0, 10.0, 3.0], [110.0, 12.0, 2.0]])
    assert bound_of(operation, 0.05, 0, 1).tolist() == pytest.approx([95.0, 12.6, 2.0], rel=1e-15)
    assert bound_of(operation[:, ::2], 0.0, 0, None).tolist() == [100.0, 2.0]


@pytest.mark.parametrize(
    ("evaluate", "key"),
    [
        ({"by": "guess"}, "evaluate.by"),
        ({"bound_margin_percent": -1.0}, "evaluate.bound_margin_percent"),
        ({"audit_cases": -1}, "evaluate.audit_cases"),
    ],
)
def test_what_is_no_way_to_prove_a_plan_is_a_fault(evaluate, key, tmp_path):
    with pytest.raises(tpss.ScenarioError, match=key.replace(".", r"\.")):
        plan(tmp_path, {"evaluate": evaluate})
