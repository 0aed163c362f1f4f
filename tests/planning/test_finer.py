"""The best first decisions at a finer time step, and whether the step decides between them."""

import numpy as np
import pytest

from tpss.planning.answer import Effort, answer_of, solver_of
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import CaseList
from tpss.planning.costs import expected_cost
from tpss.planning.finer import compare_finer, finer_sentences, finer_table
from tpss.planning.lazily import prove_lazily
from tpss.planning.plan import BOUNDS
from tpss.planning.simulate import simulate_cases
from tpss.planning.solve import model_of

from plan_outcomes import outcomes
from small_plans import PLAN, plan

FINER = {"require/lowest_voltage_kv": 10.0, "evaluate": {"finer_step_min": 0.25}}


def made_up(folder, changes, tamper=lambda table, listed: table):
    """Answer from made-up outcomes, and its decisions at the finer step, which are tampered with."""
    listed = CaseList(plan(folder, changes))
    answer = answer_of(model_of(listed, outcomes(listed)))
    asked = []

    def simulate(fine, cases):
        asked.extend(cases)
        known = list(dict.fromkeys(case.digest for case in asked))
        return tamper(outcomes(fine), fine).loc[known]

    return answer, compare_finer(answer, simulate), asked


def test_costs_are_those_of_the_same_plan_at_that_step(tmp_path):
    """All cases of the small plan at both steps: only what three plans use is simulated again."""
    listed, folder = CaseList(plan(tmp_path, FINER)), CaseFolder(tmp_path / "out")
    with folder.opened():

        def simulate(of, cases):
            return simulate_cases(of, folder, cases, workers=1)

        answer = answer_of(model_of(listed, simulate(listed, listed.cases)))
        (compared,) = compare_finer(answer, simulate)
        again = len(folder.table()) - len(listed)
        whole = CaseList(listed.plan.with_({"evaluate.time_step_min": 0.25}))
        fine = model_of(whole, simulate(whole, whole.cases))
    assert 0 < again < len(listed)
    assert len(compared) == 3
    for each, cost in compared:
        assert cost == pytest.approx(expected_cost(fine.problem, each.policy), rel=1e-12)
        assert cost != each.cost


def test_a_plan_that_asks_for_none_is_left_as_it_is(tmp_path):
    answer, compared, asked = made_up(tmp_path, {})
    assert (compared, asked, finer_sentences(answer, compared)) == ([], [], [])
    assert finer_table(answer, compared).empty


def test_the_same_outcomes_are_the_same_costs(tmp_path):
    answer, (compared,), _ = made_up(tmp_path, FINER)
    for each, cost in compared:
        assert cost == pytest.approx(each.cost, rel=1e-12)
    (sentence,) = finer_sentences(answer, [compared])
    assert sentence.startswith("At a step of 0.25 min the best is the same: ")
    table = finer_table(answer, [compared])
    assert table.finer_surplus.to_numpy() == pytest.approx(table.surplus.to_numpy(), abs=1e-9)


def test_a_step_that_decides_is_told(tmp_path):
    """At the finer step the best configuration takes ten times the energy."""

    def tamper(table, fine):
        own = [c.digest for c in fine.cases if c.configuration == best]
        table.loc[own, "drawn_from_grid_mw"] *= 10.0
        return table

    listed = CaseList(plan(tmp_path, FINER))
    best = answer_of(model_of(listed, outcomes(listed))).firsts[0].configuration
    answer, compared, _ = made_up(tmp_path, FINER, tamper)
    (sentence,) = finer_sentences(answer, compared)
    assert "is better: " in sentence
    assert "let evaluate.time_step_min be finer" in sentence
    assert finer_table(answer, compared).finer_surplus.iloc[0] > 0.0


def test_what_is_not_carried_at_the_finer_step_runs_less(tmp_path):
    """The supply that carries all collapses there: fewer trains run, whose traffic is simulated too."""

    def tamper(table, fine):
        dense = [c.digest for c in fine.cases if c.state == 1]
        table.loc[dense, "status"] = "collapsed"
        return table

    _, (compared,), asked = made_up(tmp_path, FINER, tamper)
    assert compared[0][1] > compared[0][0].cost
    assert {case.state for case in asked} == {0, 1}


def test_decisions_whose_costs_are_bounds_are_left_out(tmp_path):
    place = {"name": "East", "position_km": 17.0, "type": "Q48/Q49", "converters": 2}
    east = {**PLAN["measures"]["Mid"], "add": {"supply.converter_stations": place}, "cost": 400.0}
    evaluate = {**FINER["evaluate"], "by": BOUNDS}
    changes = {**FINER, "evaluate": evaluate, "measures/East": east}
    listed, known = CaseList(plan(tmp_path, changes)), {}

    def simulate(cases):
        known.update((case.digest, None) for case in cases)
        return outcomes(listed).loc[list(known)]

    answer = answer_of(prove_lazily(listed, simulate, solver_of(Effort())))
    (compared,) = compare_finer(answer, lambda fine, cases: outcomes(fine))
    assert any(answer.is_bound(each.policy) for each in answer.firsts)
    assert 0 < len(compared) < len(answer.firsts)
    assert not any(answer.is_bound(each.policy) for each, _ in compared)
    assert np.isfinite([cost for _, cost in compared]).all()
