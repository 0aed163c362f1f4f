"""The command ``tpss sweep``: what it prints, its exit codes, and what it says of bad input."""

import importlib.util

import pytest

import tpss
from accuracy.rough import ROUGH
from sweep.studies import small_cluster, write_study


@pytest.fixture(scope="module")
def scheduler():
    with small_cluster() as address:
        yield address


@pytest.fixture
def finished(tpss_command, tmp_path, scheduler):
    """Folder of the small study, run by the command."""
    write_study(tmp_path, {"set": {"simulation.time_step_min": 0.5}})
    said = tpss_command("sweep", "study.toml", "--out", "out", "--scheduler", scheduler)
    return said, tmp_path / "out"


def test_a_study_is_run_and_summarised(finished, tpss_command):
    said, folder = finished
    assert said.code == 0
    assert "6 of 6 cases: 6 finished" in said.out
    assert "lowest voltage [kV]" in said.out
    assert "6 cases in" in said.err
    assert len(tpss.load_table(folder)) == 6
    again = tpss_command("sweep", "--summary", folder)
    assert again.code == 0
    assert "6 of 6 cases: 6 finished" in again.out
    resumed = tpss_command("sweep", "study.toml", "--out", "out")
    assert "6 cases were finished before" in resumed.err


def test_figures_that_no_case_has_are_left_out(tpss_command, tmp_path, scheduler):
    """In ten minutes no train arrives."""
    write_study(tmp_path)
    said = tpss_command("sweep", "study.toml", "--out", "out", "--scheduler", scheduler)
    assert said.code == 0
    assert "losses [MWh]" in said.out
    assert "trip time" not in said.out


def test_a_dry_run_tells_cases_and_time_and_writes_nothing(tpss_command, tmp_path):
    write_study(tmp_path, {"design": "sobol", "cases": 12_000, "vary": {
        "traffic.0.headway_min": {"low": 5.0, "high": 30.0}}})  # fmt: skip
    before = sorted(tmp_path.iterdir())
    said = tpss_command("sweep", "study.toml", "--out", "out", "--dry-run", "--workers", 3)
    assert said.code == 0
    assert said.out.startswith("small: 12,000 cases, ")
    assert "with 3 worker(s). Nothing was written." in said.out
    assert sorted(tmp_path.iterdir()) == before


def test_faults_of_a_study_are_exit_code_2(tpss_command, tmp_path):
    write_study(tmp_path, {"vary": {"supply.catenary": ["BT", "ATT"]}})
    said = tpss_command("sweep", "study.toml", "--out", "out", "--dry-run")
    assert said.code == 2
    assert "study.toml: vary.supply.catenary = 'ATT'" in said.err
    assert "did you mean AT?" in said.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["study.toml"], "give --out with a folder for the table"),
        ([], "give either a study, or --summary with its folder"),
        (["study.toml", "--summary", "out"], "give either a study, or --summary"),
        (["--summary", "nowhere"], "nowhere is not the folder of a study"),
        (["other.toml", "--out", "out"], "there is no such file"),
        (["study.toml", "--out", "study.toml"], "study.toml is not a folder; give another --out"),
    ],
)
def test_bad_arguments_are_exit_code_2(tpss_command, tmp_path, arguments, words):
    write_study(tmp_path)
    said = tpss_command("sweep", *arguments)
    assert said.code == 2
    assert words in said.err


@pytest.mark.parametrize(
    ("package", "options"), [("pyarrow", []), ("distributed", ["--scheduler", "tcp://127.0.0.1:9"])]
)
def test_a_missing_package_is_told_with_what_to_install(
    tpss_command, tmp_path, monkeypatch, package, options
):
    """Dask is needed with a scheduler only."""
    write_study(tmp_path)
    find = importlib.util.find_spec
    monkeypatch.setattr(
        "tpss.extras.find_spec", lambda name: None if name == package else find(name)
    )
    said = tpss_command("sweep", "study.toml", "--out", "out", *options)
    assert said.code == 2
    assert f'need {package}, not installed: pip install "tpss[study]"' in said.err


def test_cases_that_could_not_be_run_are_told_in_the_end(finished, tpss_command):
    """As if the second case had turned out to be no scenario, and the audit of another had failed."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    _, folder = finished
    for file in sorted(folder.glob("cases/*.parquet"))[:1]:
        table = pq.read_table(file)
        rows = table.to_pylist()
        rows[0] |= {"status": "invalid", "problem": "1 fault in the input: too fast"}
        file.unlink()  # a name without a checksum fits any content
        file = file.with_name("cases-0-1.parquet")
        pq.write_table(pa.Table.from_pylist(rows, schema=table.schema), file)
    said = tpss_command("sweep", "--summary", folder)
    assert said.code == 2
    assert "1 case(s) could not be run: 1 fault in the input: too fast" in said.err
    rows[0] |= {"status": "finished", "problem": None, "audit_passed": False}
    pq.write_table(pa.Table.from_pylist(rows, schema=table.schema), file)
    said = tpss_command("sweep", "--summary", folder)
    assert said.code == 4
    assert "The audit of 1 case(s) failed" in said.err


@pytest.mark.parametrize("left_out", [False, True])
def test_the_command_prints_it_unless_it_is_left_out(tpss_command, tmp_path, scheduler, left_out):
    settings = {**ROUGH, "simulation.time_step_min": 1.0}
    vary = {"traffic.0.headway_min": [5.0, 10.0]}
    write_study(tmp_path, {"set": settings, "vary": vary})
    options = ["--no-step-check"] if left_out else []
    said = tpss_command("sweep", "study.toml", "--out", "out", "--scheduler", scheduler, *options)
    again = tpss_command("sweep", "--summary", "out")
    for printed in (said, again):
        assert printed.code == 0
        assert ("At half the step of 1 min" in printed.out) != left_out
