"""Cases: each is simulated once ever, whatever becomes of the plan."""

import pytest

import tpss
from sweep.studies import small_cluster
from tpss.errors import StudyError
from tpss.planning import local, simulate
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import CaseList, distinct
from tpss.planning.load import load_plan
from tpss.planning.outcome import outcome_of
from tpss.planning.simulate import simulate_cases

from conftest import EXAMPLES
from small_plans import plan


def run(loaded, folder, **options):
    """Table of all cases of a plan, and its cases."""
    listed, cases = CaseList(loaded), CaseFolder(folder)
    with cases.opened():
        return listed, simulate_cases(listed, cases, listed.cases, workers=1, **options)


@pytest.fixture
def counted(monkeypatch):
    """Digests of the cases that are simulated."""
    seen, original = [], local.row_of

    def row_of(case, scenario, evaluation):
        seen.append(case.digest)
        return original(case, scenario, evaluation)

    monkeypatch.setattr(local, "row_of", row_of)
    return seen


def test_cases_are_configurations_with_states_and_outages(tmp_path):
    """Four configurations, two states, intact and with one outage: 16."""
    listed = CaseList(plan(tmp_path, {"require/also_with": ["one out"]}))
    assert len(listed) == 16
    assert len(listed.cases) == len({case.digest for case in listed.cases}) == 16


def test_a_row_is_the_outcome_of_its_scenario(tmp_path):
    listed, table = run(plan(tmp_path), tmp_path / "out")
    case = listed.cases[5]
    row = table.loc[case.digest]
    scenario = listed.scenario(case)
    outcome = outcome_of(scenario, listed.plan.file.evaluate)
    assert row.scenario_hash == scenario.digest()
    assert row.drawn_from_grid_mw == outcome["drawn_from_grid_mw"]
    assert row["service.eastbound.mean_lost_min"] == outcome["service.eastbound.mean_lost_min"]


def test_what_is_done_is_not_run_again(tmp_path, counted):
    listed, first = run(plan(tmp_path), tmp_path / "out")
    assert sorted(counted) == sorted(case.digest for case in listed.cases)
    _, again = run(plan(tmp_path), tmp_path / "out")
    assert len(counted) == 8
    assert again.equals(first)


def test_one_more_measure_or_state_needs_its_own_cases_only(tmp_path, counted):
    """Four configurations by two states; then eight by two; prices and dates change nothing."""
    run(plan(tmp_path), tmp_path / "out")
    west = {
        "set": {"supply.converter_stations.West.converters": 3},
        "cost": 1.0,
        "lifetime_years": 9,
    }
    run(plan(tmp_path, {"measures/West": west}), tmp_path / "out")
    assert len(counted) == 16
    cheaper = {"economics/energy_per_kwh": 1e-6, "measures/AT/cost": 1.0, "name": "other"}
    run(plan(tmp_path, cheaper), tmp_path / "out")
    assert len(counted) == len(set(counted)) == 16


def test_measures_that_come_to_the_same_are_simulated_once(tmp_path):
    """A level of two converters is what stands there today."""
    same = {
        "set": {"supply.converter_stations.West.converters": "{level}"},
        "levels": [2, 3],
        "cost": [0.0, 1.0],
        "lifetime_years": 40,
    }
    listed = CaseList(plan(tmp_path, {"measures": {"West": same}}))
    assert len(listed.cases) == 6
    assert len(distinct(listed.cases)) == 4


def test_what_is_lost_is_simulated_again(tmp_path, counted, monkeypatch):
    monkeypatch.setattr(simulate, "FILE_S", 0.0)
    run(plan(tmp_path), tmp_path / "out")
    parts = sorted((tmp_path / "out" / "cases").glob("*.parquet"))
    assert len(parts) == 8
    parts[3].unlink()
    run(plan(tmp_path), tmp_path / "out")
    assert len(counted) == 9


def test_an_interrupted_run_keeps_what_is_done(tmp_path, counted):
    def stop(state):
        if state.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(plan(tmp_path), tmp_path / "out", report=stop)
    done = len(CaseFolder(tmp_path / "out").table())
    assert done >= 3
    run(plan(tmp_path), tmp_path / "out")
    assert len(CaseFolder(tmp_path / "out").table()) == 8


def test_cases_of_another_version_are_not_mixed_in(tmp_path, monkeypatch):
    run(plan(tmp_path), tmp_path / "out")
    from tpss.planning import case_folder

    other = {"tpss_version": "9.9", "kernel_hash": "other"}
    monkeypatch.setattr(case_folder, "versions", lambda: other)
    with pytest.raises(StudyError, match="another version"):
        run(plan(tmp_path), tmp_path / "out")


def test_a_folder_of_something_else_is_refused(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    with pytest.raises(StudyError, match="nor the folder of a plan"):
        run(plan(tmp_path), tmp_path / "out")


def test_a_case_that_is_no_scenario_is_a_row_that_says_why(tmp_path, monkeypatch):
    loaded = plan(tmp_path)
    original = CaseList.scenario

    def scenario(self, case):
        made = original(self, case)
        return made.with_({"line.length_km": -1.0}) if case.configuration == 1 else made

    monkeypatch.setattr(CaseList, "scenario", scenario)
    listed, table = run(loaded, tmp_path / "out")
    states = [table.loc[case.digest].status for case in listed.cases]
    assert states == ["finished"] * 2 + ["invalid"] * 2 + ["finished"] * 4
    assert "length_km" in table[table.status == "invalid"].problem.iloc[0]


def test_a_document_of_a_case_needs_no_files(tmp_path):
    """It is what is sent to another computer."""
    loaded = load_plan(EXAMPLES / "plan_320km.toml")
    listed = CaseList(loaded)
    document = listed.document(listed.cases[0])
    assert "gradients_file" not in document["line"]
    assert tpss.Scenario.from_document(document, "elsewhere") == listed.scenario(listed.cases[0])


def test_workers_of_a_scheduler_come_to_the_same_rows(tmp_path):
    loaded = plan(tmp_path)
    _, here = run(loaded, tmp_path / "here")
    with small_cluster() as address:
        _, there = run(loaded, tmp_path / "there", scheduler=address)
    own = [name for name in here.columns if not name.startswith("timing.")]
    assert there.loc[here.index, own].equals(here[own])


def test_rows_are_the_same_on_processes_of_their_own(tmp_path, monkeypatch):
    """Eight cases, the first two in this process; no case is in the folder twice."""
    monkeypatch.setattr("tpss.sweep.campaign.WORTHWHILE_S", 0.0)
    listed = CaseList(plan(tmp_path))
    tables = []
    for workers in (1, 2):
        cases = CaseFolder(tmp_path / f"by-{workers}")
        with cases.opened():
            tables.append(simulate_cases(listed, cases, listed.cases, workers=workers))
    own = [name for name in tables[0].columns if not name.startswith("timing.")]
    assert tables[0].index.is_unique
    assert tables[1].loc[tables[0].index, own].equals(tables[0][own])
