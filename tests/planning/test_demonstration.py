"""The example of a plan: half a reinforcement is worth nothing, and a lead time changes what to do."""

import json
import tomllib

import pytest

from tpss.planning import tables
from tpss.planning.answer import answer_of
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import CaseList
from tpss.planning.load import load_plan
from tpss.planning.simulate import simulate_cases
from tpss.planning.solve import model_of
from tpss.planning.turning import nearest, turns_of

from conftest import EXAMPLES


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    """The plan with the outcomes of its cases."""
    plan = load_plan(EXAMPLES / "plan_320km.toml")
    listed, folder = CaseList(plan), CaseFolder(tmp_path_factory.mktemp("cases") / "out")
    with folder.opened():
        return plan, simulate_cases(listed, folder, listed.cases)


def answered(simulated, changes=None):
    plan, table = simulated
    return answer_of(model_of(CaseList(plan.with_(changes or {})), table))


def carried(answer):
    """Headways that each configuration carries, the longest first."""
    table = tables.configurations(answer.model)
    headway = table.traffic.str.extract(r"= ([\d.]+)$")[0].astype(float)
    found = table.assign(headway_min=headway)[table.carried].groupby("configuration").headway_min
    return {name: sorted(each, reverse=True) for name, each in found}


def test_one_more_station_carries_no_more_than_today_and_both_carry_all(simulated):
    """Of the five headways today's supply carries the longest one only, as with B or D alone."""
    headways = carried(answered(simulated))
    assert headways["as today"] == headways["B"] == headways["D"] == [60.0]
    assert headways["B+D"] == headways["AT"] == headways["HV"] == [60.0, 48.0, 40.0, 30.0, 20.0]


def test_both_stations_are_ordered_at_once(simulated):
    """What is ordered in 2030 is in service in 2035, when it is too late to order it."""
    answer = answered(simulated)
    firsts = tables.first_decisions(answer)
    assert firsts.configuration.tolist()[:3] == ["B+D", "AT", "as today"]
    assert firsts.ordered.unique().tolist() == [2030]
    assert 0.0 < firsts.surplus[1] < 0.02 * firsts.cost[0]
    assert answer.worth.of_information > 0.0


def test_without_lead_time_one_waits(simulated):
    """Today's traffic is carried, and what comes is known before it must be built for."""
    at_once = dict.fromkeys(("measures.B", "measures.AT", "measures.HV"), 0)
    answer = answered(simulated, {f"{name}.lead_time_years": v for name, v in at_once.items()})
    assert tables.first_decisions(answer).configuration[0] == "as today"
    assert answer.worth.of_information == pytest.approx(0.0, abs=1e-6)
    assert answer.worth.of_flexibility > 0.0
    assert answer.best.cost < answered(simulated).best.cost


def test_the_choice_turns_at_a_price_of_the_catenary(simulated):
    """At that price both first decisions cost the same: solved anew, not scaled."""
    answer = answered(simulated)
    turn = nearest(turns_of(answer.model, 0))
    assert turn.key == "measures.AT.cost"
    at = answered(simulated, {"measures.AT.cost": turn.found.below})
    assert at.firsts[1].surplus == pytest.approx(0.0, abs=1e-6)


def test_half_the_step_moves_a_year_s_energy_by_little(simulated):
    """A case at 1 min and at 0.5 min: within 0.5 %."""
    from tpss.planning.outcome import outcome_of

    plan, _ = simulated
    listed = CaseList(plan)
    case = next(c for c in listed.cases if c.configuration == 0 and c.state == 0)
    scenario = listed.scenario(case)
    coarse, fine = (
        outcome_of(scenario.with_({"simulation.time_step_min": step}), plan.file.evaluate)
        for step in (1.0, 0.5)
    )
    assert fine["drawn_from_grid_mw"] == pytest.approx(coarse["drawn_from_grid_mw"], rel=5e-3)


def test_a_budget_turns_what_two_lines_do(tmp_path):
    """Free, the freight line waits for its renewal; 600 a stage is too little then, so stations come."""
    plan = load_plan(EXAMPLES / "plan_two_lines.toml")
    listed, folder = CaseList(plan), CaseFolder(tmp_path / "out")
    with folder.opened():
        table = simulate_cases(listed, folder, listed.cases)
    tied, free = (
        answer_of(model_of(CaseList(plan.with_(changes)), table))
        for changes in ({}, {"budget": None})
    )
    assert tied.best.cost > free.best.cost
    assert tied.is_closed
    firsts = {
        name: tables.first_decisions(answer).drop_duplicates("area").configuration.tolist()
        for name, answer in (("free", free), ("tied", tied))
    }
    assert firsts == {"free": ["as today", "AT"], "tied": ["stations", "as today"]}
    spent = tables.decisions(tied).groupby(["in_service", "if"]).spent.sum()
    assert (spent <= 600.0).all()


def test_a_network_s_timetable_grows(tmp_path):
    """Today's branch does not even carry today's timetable; either measure carries the denser one."""
    plan = load_plan(EXAMPLES / "plan_network.toml")
    listed, folder = CaseList(plan), CaseFolder(tmp_path / "out")
    with folder.opened():
        answer = answer_of(model_of(listed, simulate_cases(listed, folder, listed.cases)))
    table = tables.configurations(answer.model)
    weak = table[~table.carried]
    assert weak.configuration.tolist() == ["as today", "as today"]
    assert weak.why_not.str.startswith("lowest voltage 11").all()
    served = answer.model.served[0].quantities
    assert served.may_serve.tolist() == [[True, False, True], [True, True, True]]
    assert tables.first_decisions(answer).configuration.tolist()[:2] == ["AT", "Gruvan"]


def test_the_plan_with_losses_differs_in_what_converters_lose_and_nothing_else():
    """Its line and its new stations have the twin of the converters' type; names and comments differ."""
    for name in ("plan_320km", "line_320km"):
        plain, losing = (
            tomllib.loads((EXAMPLES / f"{name}{end}.toml").read_text("utf-8"))
            for end in ("", "_losses")
        )
        text = json.dumps(plain).replace('"Q48/Q49"', '"Q48/Q49 with losses (estimate)"')
        text = text.replace("line_320km.toml", "line_320km_losses.toml")
        assert {**json.loads(text), "name": losing["name"]} == losing
    load_plan(EXAMPLES / "plan_320km_losses.toml")
