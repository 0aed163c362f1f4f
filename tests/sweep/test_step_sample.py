"""What a study says of its step, by a few of its cases."""

import pytest

import tpss
from accuracy.rough import ROUGH
from sweep.studies import small_cluster, study
from tpss.accuracy.changes import LARGEST
from tpss.sweep import step_sample
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.folder import read_manifest
from tpss.sweep.step_sample import SAMPLE, sample_in_words, sample_steps

ROUGH_STUDY = {
    "set": {**ROUGH, "simulation.time_step_min": 1.0},
    "vary": {"traffic.0.headway_min": [5.0, 10.0]},
}


@pytest.fixture(scope="module")
def scheduler():
    with small_cluster() as address:
        yield address


def test_the_largest_changes_are_those_of_the_cases(tmp_path):
    """Five of the six cases, each with the check that it has as a single run."""
    design = design_of(study(tmp_path))
    sample = sample_steps(design)
    assert len(sample["cases"]) == SAMPLE
    assert sample["time_steps_min"] == [0.5]
    shares: dict[str, list[float]] = {}
    for case in sample["cases"]:
        result = tpss.simulate(scenario_of(design, case), step_check=True)
        for change in result.summary["step_check"]["changes"]:
            shares.setdefault(change["figure"], []).append(change["share"])
    assert sample["largest_shares"] == {name: max(each, key=abs) for name, each in shares.items()}


def test_a_step_too_long_is_told_with_the_cases_and_what_would_do(tmp_path):
    sample = sample_steps(design_of(study(tmp_path, ROUGH_STUDY)))
    assert sample["too_long"] == [0, 1]
    assert abs(sample["largest_shares"]["trip_time_min"]) > LARGEST
    words = sample_in_words(sample)
    assert words.startswith("At half the step of 1 min, in 2 of the cases, figures move by up to: ")
    assert "; the step is too long for 2 of them, " in words


def test_what_would_do_is_what_would_do_for_all():
    sample = {
        "cases": [0, 3], "time_steps_min": [0.5], "largest_shares": {"trip_time_min": -0.025},
        "too_long": [3], "would_do_min": 0.125, "not_made": None,
    }  # fmt: skip
    told = (
        "At half the step of 0.5 min, in 2 of the cases, figures move by up to: trip times 2.5 %; the "
        "step is too long for 1 of them"
    )
    assert sample_in_words(sample) == f"{told}, 0.125 min would do"
    none = sample_in_words({**sample, "would_do_min": None})
    assert none == f"{told}, no shorter one that was tried would do for all"


def test_cases_that_cannot_be_run_are_left_out(tmp_path, monkeypatch):
    def refused(design, case):
        raise tpss.TpssError

    monkeypatch.setattr(step_sample, "scenario_of", refused)
    sample = sample_steps(design_of(study(tmp_path)))
    assert sample["cases"] == []
    assert sample_in_words(sample) == "No step check: no case of the sample could be run"


def test_cases_by_least_squares_are_not_checked(tmp_path):
    pytest.importorskip("scipy")
    settings = {"simulation.load_flow": "least-squares", "simulation.duration_min": 1.0,
                "simulation.time_step_min": 1.0}  # fmt: skip
    one = {"set": settings, "vary": {"traffic.0.headway_min": [10.0]}}
    words = sample_in_words(sample_steps(design_of(study(tmp_path, one))))
    assert words == "No step check: a run by least squares takes too long to be made twice"


def test_it_is_made_once_and_stands_in_the_study_s_file(tmp_path, scheduler, monkeypatch):
    folder, small = tmp_path / "out", study(tmp_path)
    tpss.run_study(small, folder, scheduler=scheduler)
    assert "step_check" not in read_manifest(folder)
    tpss.run_study(small, folder, scheduler=scheduler, step_check=True)
    sample = read_manifest(folder)["step_check"]
    assert sample == sample_steps(design_of(small))
    monkeypatch.setattr("tpss.sweep.campaign.sample_steps", None)
    tpss.run_study(small, folder, scheduler=scheduler, step_check=True)
    assert read_manifest(folder)["step_check"] == sample


def test_each_case_chooses_its_step_if_the_study_has_none(tmp_path, scheduler):
    """The table says which, and its rows are those of single runs."""
    small = study(tmp_path, {"set": {"simulation.time_step_min": "none"},
                             "vary": {"traffic.0.headway_min": [5.0, 10.0]}})  # fmt: skip
    tpss.run_study(small, tmp_path / "out", scheduler=scheduler)
    for row in tpss.load_table(tmp_path / "out").itertuples():
        result = tpss.simulate(scenario_of(design_of(small), row.case))
        assert row.time_step_min == result.summary["time_step_min"]
        assert row.total_energy_mwh == result.summary["total_energy_mwh"]
        assert row.scenario_hash == result.scenario.digest()
