"""Plans that are proved by an approximator: the plan of all cases, or the claim is withdrawn.

Outcomes are made up by rules (`plan_outcomes`): each station adds 2 kV, each train an hour takes 0.6 kV,
and it uses 0.3 MW more for each kV below 15.
"""

import json
import math

import numpy as np
import pytest

import tpss
from tpss.approximator.approximator import Approximator
from tpss.planning import tables
from tpss.planning.answer import Effort, answer_of, solver_of
from tpss.planning.approximated import units_to_train
from tpss.planning.cases import CaseList
from tpss.planning.lazily import prove_lazily, simulated_and_all
from tpss.planning.learnt import APPROXIMATORS, Learnt
from tpss.planning.plan import APPROXIMATOR
from tpss.planning.solve import model_of

from plan_outcomes import outcomes
from small_plans import PLAN, changed, plan

HEADWAY = "traffic.eastbound.headway_min"
TRAINED = 60


def station(number):
    place = {"position_km": 2.0 * number + 1.0, "type": "Q48/Q49", "converters": 2}
    added = {"supply.converter_stations": {"name": f"S{number}", **place}}
    return {**PLAN["measures"]["Mid"], "add": added, "cost": 150.0 + 10.0 * number}


SEVEN = {
    "measures/Mid": None,
    "measures/AT": None,
    **{f"measures/S{number}": station(number) for number in range(7)},
    "scenarios/low": {"probability": 0.6, HEADWAY: [20.0, 12.0]},
    "scenarios/high": {"probability": 0.4, HEADWAY: [20.0, 7.5]},
}
"""Seven stations that may stand together: 128 configurations, three states of traffic."""


class Wrong(Learnt):
    """What was learnt, with energies so many times as high."""

    def __init__(self, factor):
        super().__init__()
        self.factor = factor

    def approximator(self, digest, train):
        file = super().approximator(digest, train).file
        outputs = [
            each.model_copy(
                update={
                    "low": each.low + math.log(self.factor),
                    "high": each.high + math.log(self.factor),
                }
            )
            if each.name == "energy_per_kwh"
            else each
            for each in file.outputs
        ]
        assert all(each.scale == "log" for each in outputs if each.name == "energy_per_kwh")
        return Approximator(file.model_copy(update={"outputs": tuple(outputs)}))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("plan")


@pytest.fixture(scope="module")
def table(folder):
    """Outcomes of all cases, however the plan is proved."""
    return outcomes(CaseList(plan(folder, SEVEN)))


@pytest.fixture(scope="module")
def every(folder, table):
    return answer_of(model_of(CaseList(plan(folder, SEVEN)), table))


def listed(folder, changes=None, **evaluate):
    asked = {"by": APPROXIMATOR, "training_cases": TRAINED, **evaluate}
    return CaseList(plan(folder, {**SEVEN, **(changes or {}), "evaluate": asked}))


class Handed:
    """Outcomes that are handed out when they are asked for."""

    def __init__(self, table, stop_after=None):
        self.table, self.stop_after, self.known = table, stop_after, {}

    def __call__(self, cases):
        for case in cases:
            if case.digest not in self.known and len(self.known) == self.stop_after:
                raise KeyboardInterrupt
            self.known[case.digest] = None
        return self.table.loc[list(self.known)]


def proved(case_list, table, learnt=None, handed=None):
    handed = handed or Handed(table)
    return answer_of(
        prove_lazily(case_list, handed, solver_of(Effort()), learnt=learnt or Learnt())
    )


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """Folder in which the approximator is kept, so that it is trained once for these tests."""
    return tmp_path_factory.mktemp("kept")


@pytest.fixture(scope="module")
def answer(folder, table, kept):
    return proved(listed(folder), table, Learnt(kept))


def test_the_plan_is_that_of_all_cases_from_fewer_of_them(answer, every):
    assert answer.best.cost == every.best.cost
    assert np.array_equal(answer.best.policy, every.best.policy)
    assert answer.is_closed
    simulated, cases = simulated_and_all(answer.model)
    assert cases == 384
    assert simulated < 0.5 * cases
    assert tables.decisions(answer).equals(tables.decisions(every))


def test_the_claim_is_that_of_lower_ends_and_of_an_audit(answer):
    """60 of all are drawn if the plan does not say how many: at most 3/60 are below their ends."""
    assert "if the lower ends of the approximator hold" in answer.claim
    assert "Nor is any of 60 that were drawn at random: at most 5 % of all are" in answer.claim
    assert answer.proof.audited == 60


def test_an_approximator_that_is_wrong_is_caught(folder, table, every):
    """It predicts 1.5 times the energy: its ends lie above the truth of every case that tests them."""
    answer = proved(listed(folder), table, Wrong(1.5))
    assert not answer.proof.holds
    assert not answer.is_closed
    assert answer.claim.startswith("Nothing is claimed of other plans")
    assert "tpss plan run --all" in answer.claim
    assert not answer.is_bound(answer.best.policy)


def test_one_that_is_wrong_about_a_single_case_is_caught_by_the_audit(folder, table, every):
    """A station alone takes nearly no energy, and was not among those learnt from: the audit finds it,
    and the plan that it hid.
    """
    cases = listed(folder, audit_cases=10_000)
    learnt_from = {c for _, c in units_to_train(cases.areas[0], cases.plan.file.evaluate)}
    one = next(
        c
        for c, each in enumerate(cases.areas[0].configurations)
        if each.size == 1 and c not in learnt_from
    )
    other = table.copy()
    own = [case.digest for case in cases.cases if case.configuration == one]
    other.loc[own, "status"] = "finished"
    other.loc[own, ["drawn_from_grid_mw", "service.eastbound.mean_lost_min"]] = 0.01
    other.loc[own, ["lowest_voltage_kv", "mean_useful_voltage_kv"]] = 15.0
    other.loc[own, "peak_loading"] = 0.1
    answer = proved(cases, other)
    assert not answer.proof.holds
    assert answer.best.cost == answer_of(model_of(CaseList(plan(folder, SEVEN)), other)).best.cost


def test_one_that_is_wrong_to_the_safe_side_takes_more_cases_only(folder, table, every, answer):
    careful = proved(listed(folder), table, Wrong(0.5))
    assert careful.proof.holds
    assert careful.best.cost == every.best.cost
    assert careful.proof.simulated > answer.proof.simulated


def test_the_approximator_is_trained_once_and_kept(folder, table, kept, answer, monkeypatch):
    monkeypatch.setattr("tpss.planning.approximated.train_on", None)
    (file,) = (kept / APPROXIMATORS).iterdir()
    assert json.loads(file.read_text())["format"] == "tpss-approximator"
    again = answer_of(model_of(listed(folder), answer.model.table, Learnt(kept)))
    assert again.best.cost == answer.best.cost
    assert again.claim == answer.claim


def test_an_interrupted_proof_goes_on_to_the_same_plan(folder, table, kept, answer):
    cases, handed = listed(folder), Handed(table)
    for stop in (20, 70, 100):
        handed.stop_after = stop
        with pytest.raises(KeyboardInterrupt):
            proved(cases, table, Learnt(kept), handed)
    handed.stop_after = None
    found = proved(cases, table, Learnt(kept), handed)
    assert found.best.cost == answer.best.cost
    assert found.claim == answer.claim


def test_what_was_not_trained_is_simulated_and_not_guessed(folder, table):
    """No case of the densest traffic comes through in what is learnt from: all of it is simulated."""
    other, cases = table.copy(), listed(folder)
    dense = [case for case in cases.cases if case.state == 2]
    other.loc[[case.digest for case in dense], "status"] = "collapsed"
    answer = proved(cases, other)
    assert {case.digest for case in dense} <= set(answer.model.table.index)


def test_of_few_cases_all_are_simulated(folder, table, every):
    answer = proved(listed(folder, training_cases=384), table)
    assert answer.claim == every.claim
    assert not answer.model.has_bounds


def test_what_has_changed_since_is_told(folder, table, kept, answer):
    """Another station may not stand beside others: other configurations, other cases to learn from."""
    measure = {**station(0), "excludes": ["S1"]}
    cases = listed(folder, {"measures/S0": measure})
    with pytest.raises(tpss.PlanError, match="run tpss plan run again"):
        model_of(cases, answer.model.table, Learnt(kept))


def test_fewer_cases_than_can_be_learnt_from_are_a_fault(tmp_path):
    asked = {"by": APPROXIMATOR, "training_cases": 3}
    with pytest.raises(tpss.ScenarioError, match=r"evaluate\.training_cases"):
        plan(tmp_path, changed({"evaluate": asked}, {}))
