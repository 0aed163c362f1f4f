"""``tpss plan``: check, run, price and why."""

import json

import pandas as pd

from small_plans import write_plan

TIGHT = {"require/lowest_voltage_kv": 14.0}


def run(tpss_command, folder, changes=None):
    file = write_plan(folder, {**TIGHT, **(changes or {})})
    return tpss_command("plan", "run", file, "--out", folder / "out", "--workers", "1")


def test_check_says_what_a_plan_consists_of(tpss_command, tmp_path):
    said = tpss_command("plan", "check", write_plan(tmp_path, TIGHT))
    assert said.code == 0
    assert "2 measures, 4 configurations, 2 states of traffic" in said.out
    assert "From 2040 one knows whether it is low, or high." in said.out
    assert "Prices without a source: economics.energy_per_kwh, economics.lost_minute.freight" in (
        said.out
    )
    assert "8 cases" in said.out


def test_check_names_faults(tpss_command, tmp_path):
    file = write_plan(tmp_path, {"scenarios/low/probability": 0.5, "measures/AT/price_year": 2020})
    said = tpss_command("plan", "check", file)
    assert said.code == 2
    assert "the probabilities add up to 0.9" in said.err
    assert "measures.AT.price_year = 2020" in said.err


def test_check_builds_every_configuration(tpss_command, tmp_path):
    taken = {"name": "Mid", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
    changes = {"measures/Mid/add": {"supply.converter_stations": taken}}
    said = tpss_command("plan", "check", write_plan(tmp_path, changes))
    assert said.code == 2
    assert "measures.Mid" in said.err


def test_more_cases_than_allowed_are_refused(tpss_command, tmp_path):
    said = tpss_command("plan", "check", write_plan(tmp_path, {"evaluate": {"most_cases": 7}}))
    assert said.code == 2
    assert "8 cases are more than that" in said.err


def test_run_answers_in_a_sentence_and_in_tables(tpss_command, tmp_path):
    said = run(tpss_command, tmp_path)
    assert said.code == 0
    assert "all 8 cases were simulated" in said.out
    assert "Not counted:" in said.out
    document = json.loads((tmp_path / "out" / "plan.json").read_text())
    (sentence,) = document["answer"]
    assert said.out.startswith(f"{sentence} {document['claim']}")
    assert sentence.startswith("Build ")
    assert "in 2030: " in sentence
    assert "MSEK expected" in sentence
    assert document["gap"] <= 1e-9
    tables = {file.stem for file in (tmp_path / "out" / "tables").glob("*.csv")}
    assert tables == {
        "decisions", "first_decisions", "first_costs", "best_plans", "costs", "regret", "values",
        "configurations", "switching_values", "finer_step",
    }  # fmt: skip
    decisions = pd.read_csv(tmp_path / "out" / "tables" / "decisions.csv")
    assert decisions.in_service.tolist() == [2030, 2040, 2040]


def test_the_same_command_comes_to_the_same_plan_without_a_simulation(tpss_command, tmp_path):
    run(tpss_command, tmp_path)
    before = (tmp_path / "out" / "plan.json").read_bytes()
    parts = {file.name: file.read_bytes() for file in (tmp_path / "out" / "cases").iterdir()}
    assert run(tpss_command, tmp_path).code == 0
    assert (tmp_path / "out" / "plan.json").read_bytes() == before
    assert parts == {f.name: f.read_bytes() for f in (tmp_path / "out" / "cases").iterdir()}


def test_price_prices_anew(tpss_command, tmp_path):
    """All costs and values doubled double the expected cost."""
    run(tpss_command, tmp_path)
    cost = json.loads((tmp_path / "out" / "plan.json").read_text())["expected_cost"]
    doubled = [
        f"--set={text}"
        for text in (
            "economics.energy_per_kwh=1.3e-6", "economics.lost_minute.freight=134e-6",
            "economics.train_not_run.freight=0.12", "measures.Mid.cost=40.0", "measures.AT.cost=80.0",
        )
    ]  # fmt: skip
    said = tpss_command("plan", "price", tmp_path / "out", *doubled)
    assert said.code == 0
    assert f": {2.0 * cost:,.1f} MSEK expected" in said.out


def test_price_says_where_the_decision_turns(tpss_command, tmp_path):
    run(tpss_command, tmp_path)
    said = tpss_command("plan", "price", tmp_path / "out", "--sweep", "measures.Mid.cost=0:5000")
    assert said.code == 0
    assert "Where the first decision turns" in said.out
    said = tpss_command("plan", "price", tmp_path / "out", "--sweep", "measures.Mit.cost=0:1")
    assert said.code == 2
    assert "did you mean measures.Mid.cost?" in said.err
    said = tpss_command("plan", "price", tmp_path / "out", "--sweep", "measures.Mid.cost=9:1")
    assert said.code == 2


def test_a_change_that_needs_simulation_is_refused_by_price(tpss_command, tmp_path):
    run(tpss_command, tmp_path)
    change = "--set=scenarios.high.traffic.eastbound.headway_min=[20.0, 4.0]"
    said = tpss_command("plan", "price", tmp_path / "out", change)
    assert said.code == 2


def test_why_says_what_another_plan_costs(tpss_command, tmp_path):
    run(tpss_command, tmp_path)
    said = tpss_command("plan", "why", tmp_path / "out", "AT in 2030")
    assert said.code == 0
    assert "The best plan with AT in 2030:" in said.out
    assert "investment" in said.out
    said = tpss_command("plan", "why", tmp_path / "out", "ATT in 2030")
    assert said.code == 2
    assert "did you mean AT?" in said.err
    said = tpss_command("plan", "why", tmp_path / "out", "AT, please")
    assert said.code == 2


def test_why_says_that_there_is_no_such_plan(tpss_command, tmp_path):
    run(tpss_command, tmp_path, {"measures/AT/earliest": 2040})
    said = tpss_command("plan", "why", tmp_path / "out", "AT in 2030")
    assert said.code == 3
    assert "There is no plan with AT in 2030" in said.out


def test_a_budget_that_no_plan_meets_is_bad_input(tpss_command, tmp_path):
    due = {"year": 2030, "cost": 50.0, "lifetime_years": 40, "in_budget": True}
    changes = {"renewals": {"line": due}, "budget": {"per_stage": [10.0, 10.0]}}
    said = run(tpss_command, tmp_path, changes)
    assert said.code == 2
    assert "no plan meets the budget: it takes" in said.err
    assert "more in stage 1 (2030), every scenario" in said.err
    assert not (tmp_path / "out").exists()  # nothing was simulated
    said = tpss_command("plan", "check", tmp_path / "plan.toml")
    assert said.code == 2
    assert "no plan meets the budget" in said.err


def test_a_folder_without_a_plan_is_refused(tpss_command, tmp_path):
    said = tpss_command("plan", "price", tmp_path)
    assert said.code == 2
    assert "name one that tpss plan run has written" in said.err


def test_report_is_written_once_and_replaced_by_force(tpss_command, tmp_path):
    run(tpss_command, tmp_path)
    said = tpss_command("plan", "report", tmp_path / "out")
    assert said.code == 0
    assert said.out.strip() == f"Wrote {tmp_path / 'out' / 'report.html'}"
    again = tpss_command("plan", "report", tmp_path / "out")
    assert again.code == 2
    assert "--force" in again.err
    elsewhere = tpss_command("plan", "report", tmp_path / "out", "--out", tmp_path / "b.html")
    assert elsewhere.code == 0
    assert (tmp_path / "b.html").exists()
    assert tpss_command("plan", "report", tmp_path).code == 2
