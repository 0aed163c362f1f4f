"""``tpss plan`` of a plan that is proved by bounds: 5 of the 8 cases of the small plan are simulated."""

import json
import shutil

import pandas as pd
import pytest

from small_plans import write_plan

BY_BOUNDS = {"require/lowest_voltage_kv": 14.0, "evaluate": {"by": "bounds"}}

ALL = "tpss plan run --all"


def run(tpss_command, folder, *more):
    out = folder / "out"
    return tpss_command("plan", "run", folder / "plan.toml", "--out", out, "--workers", "1", *more)


@pytest.fixture
def solved(tpss_command, tmp_path):
    write_plan(tmp_path, BY_BOUNDS)
    said = run(tpss_command, tmp_path)
    assert said.code == 0
    return said


def document(folder):
    return json.loads((folder / "out" / "plan.json").read_text())


def cases(folder):
    return sum(len(pd.read_parquet(file)) for file in (folder / "out" / "cases").glob("*.parquet"))


def test_run_says_round_by_round_how_far_the_proof_is_and_what_it_claims(solved, tmp_path):
    assert "5 cases simulated: no plan costs less than" in solved.err
    assert "5 of 8 cases were simulated, and none of them does" in solved.out
    assert ALL in solved.out
    assert cases(tmp_path) == 5
    proof = document(tmp_path)["proof"]
    assert proof == {
        "grade": "bounded", "holds": True, "simulated_cases": 5, "cases": 8, "violations": 0,
        "audited": 0,
    }  # fmt: skip
    table = pd.read_csv(tmp_path / "out" / "tables" / "configurations.csv")
    assert (table.why_not == "not simulated").sum() == 3


def test_the_same_command_simulates_nothing_and_all_adds_what_was_left_out(
    solved, tpss_command, tmp_path
):
    before = document(tmp_path)
    assert run(tpss_command, tmp_path).code == 0
    assert cases(tmp_path) == 5
    assert document(tmp_path) == before
    said = run(tpss_command, tmp_path, "--all")
    assert said.code == 0
    assert cases(tmp_path) == 8
    assert "all 8 cases were simulated" in said.out
    after = document(tmp_path)
    assert after["expected_cost"] == before["expected_cost"]
    assert after["decisions"] == before["decisions"]
    assert "proof" not in after


def test_price_says_what_may_be_claimed_at_other_prices(solved, tpss_command, tmp_path):
    said = tpss_command("plan", "price", tmp_path / "out", "--set", "measures.AT.cost=60.0")
    assert said.code == 0
    assert "if no case costs less than its bound" in said.out
    assert "at least" in said.out


def test_price_refuses_what_takes_cases_that_were_not_simulated(solved, tpss_command, tmp_path):
    said = tpss_command("plan", "price", tmp_path / "out", "--set", "measures.AT.cost=0.01")
    assert said.code == 2
    assert said.out == ""
    assert ALL in said.err
    said = tpss_command("plan", "price", tmp_path / "out", "--sweep", "measures.AT.cost=1:90")
    assert said.code == 2
    assert ALL in said.err


def test_why_says_what_is_a_bound(solved, tpss_command, tmp_path):
    said = tpss_command("plan", "why", tmp_path / "out", "AT in 2030")
    assert said.code == 0
    assert "The best plan with AT in 2030: at least" in said.out
    assert ALL in said.out
    assert "investment" not in said.out


def test_the_report_says_what_was_not_simulated(solved, tpss_command, tmp_path):
    assert tpss_command("plan", "report", tmp_path / "out").code == 0
    page = (tmp_path / "out" / "report.html").read_text("utf-8")
    assert document(tmp_path)["claim"] in page
    assert ALL in page
    carried = page.split('aria-labelledby="carried-0-title"')[1].split("</svg>")[0]
    assert ">not simulated</text>" in carried


def test_a_claim_that_is_withdrawn_leaves_the_plan_open(solved, tpss_command, tmp_path):
    """A margin of 0 % and a strongest supply whose rows take twice the energy: its bound is too high."""
    (part, *others) = sorted((tmp_path / "out" / "cases").glob("*.parquet"))
    frames = [pd.read_parquet(file) for file in (part, *others)]
    whole = pd.concat(frames)
    strongest = whole.scenario.str.endswith("Mid-AT")
    assert strongest.sum() == 2
    whole.loc[strongest, "drawn_from_grid_mw"] *= 2.0
    shutil.rmtree(tmp_path / "out" / "tables")
    for file in (part, *others):
        file.unlink()
    whole.to_parquet(part.with_name("all.parquet"))
    said = run(tpss_command, tmp_path)
    assert said.code == 5
    assert "Nothing is claimed of other plans" in said.out
    assert document(tmp_path)["proof"]["holds"] is False
    assert tpss_command("plan", "report", tmp_path / "out").code == 0
