"""The check of a step: the same run with half of it, and the step that would do."""

from dataclasses import replace

import numpy as np
import pytest

import tpss
from accuracy.rough import ROUGH
from tpss.accuracy.check import MOST_HALVINGS, agree, check_step
from tpss.accuracy.trial import Trial
from tpss.api import prepare
from tpss.many import key_figures
from tpss.run import limits
from tpss.run.run import INTERRUPTED, Run
from tpss.step.recording import recording_bytes

from conftest import EXAMPLES
from scenarios import short_line

FIGURES = {
    "trip_time_min": lambda figures: figures.trip_time_min,
    "total_energy_mwh": lambda figures: figures.total_energy_mwh,
    "lowest_voltage_kv": lambda figures: figures.lowest_voltage.voltage_kv,
}


def at(step_min, changes=None):
    """The short line at a step."""
    return short_line({**(changes or {}), "simulation.time_step_min": step_min})


def trial_of(scenario):
    prepared = prepare(scenario)
    return Trial(scenario, prepared.start.model, prepared.clock, prepared.frame)


def checked(scenario):
    """The check of a run."""
    return tpss.simulate(scenario, step_check=True).summary["step_check"]


def test_it_compares_with_a_run_at_half_the_step():
    check = checked(at(0.2))
    here, finer = (key_figures(at(step_min)) for step_min in (0.2, 0.1))
    assert check["half_step_min"] == 0.1
    assert (check["status"], check["duration_min"]) == (finer.status, finer.duration_min)
    changes = {change["figure"]: change for change in check["changes"]}
    for name, figure in FIGURES.items():
        assert changes[name]["at_step"] == figure(here)
        assert changes[name]["at_half_step"] == figure(finer)


@pytest.mark.parametrize("running", [False, True], ids=["from an empty line", "already running"])
def test_the_run_itself_is_the_same_to_the_last_bit(running):
    scenario = at(0.2, {"traffic.0.already_running": running, "traffic.0.headway_min": 7.0})
    alone, with_check = (tpss.simulate(scenario, step_check=each) for each in (False, True))
    assert alone.dataset.drop_attrs().identical(with_check.dataset.drop_attrs())
    own = ("step_check", "simulation_s", "provenance")
    same = [
        {key: value for key, value in result.summary.items() if key not in own}
        for result in (alone, with_check)
    ]
    assert same[0] == same[1]


def test_a_library_call_makes_no_second_run_unasked():
    assert tpss.simulate(at(0.5)).summary["step_check"] is None


def test_the_step_that_would_do_is_the_longest_half_that_agrees_with_its_own_half():
    """Stops of 0.3 min that take whole steps of 1 min; each run here is a plain one."""
    check = checked(at(1.0, ROUGH))
    assert check["within"] is False
    trial = trial_of(at(1.0, ROUGH))
    assert 1 <= len(check["tried_min"]) <= MOST_HALVINGS
    for step_min in check["tried_min"]:
        pair = [key_figures(at(each, ROUGH)) for each in (step_min, step_min / 2)]
        assert agree(*pair, trial) == (step_min == check["would_do_min"])


def test_a_run_that_ends_otherwise_at_half_the_step_is_a_step_too_long():
    """As if the train stalled with steps of 0.2 min, and with no others."""
    figures = key_figures(at(0.2))
    stalled = replace(figures, status="stalled", duration_min=3.0)
    check = check_step(stalled, 0.2, trial_of(at(0.2)))
    assert (check.status, check.within, check.changes) == ("finished", False, ())
    assert check.would_do_min is not None


def test_a_collapse_that_half_the_step_confirms_is_no_matter_of_the_step():
    """The line is overloaded from the first instant on, whatever the step."""
    scenario = tpss.load_scenario(EXAMPLES / "overloaded.toml")
    check = checked(scenario)
    assert (check["status"], check["within"], check["tried_min"]) == ("collapsed", True, [])


def test_a_run_by_least_squares_is_not_made_twice():
    pytest.importorskip("scipy")
    options = {"simulation.load_flow": "least-squares", "simulation.duration_min": 1.0}
    check = checked(at(1.0, options))
    assert check["not_made"] == "a run by least squares takes too long to be made twice"
    assert check["changes"] == []


def test_a_failed_audit_is_not_compared():
    figures = key_figures(at(0.2))
    failed = replace(figures, audit=replace(figures.audit, failures=("a balance",)))
    assert check_step(failed, 0.2, trial_of(at(0.2))).not_made == "the audit of the run failed"
    check = check_step(figures, 0.2, trial_of(at(0.2)), half=failed)
    assert check.not_made == "the audit of the run at half the step failed"


def test_an_interruption_of_the_check_keeps_the_run():
    """Half the step is 0.1 min, 6 s; its run is interrupted, the run itself is whole."""
    prepared, interrupted = prepare(at(0.2)), []
    advance_to = Run.advance_to

    def interrupted_at_half(run, step):
        advance_to(run, step)
        if run.model.options.step_s == 6.0:
            interrupted.append(2)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Run, "advance_to", interrupted_at_half)
        result = prepared.run(None, interrupted, step_check=True)
    assert result.status == "finished"
    assert result.summary["step_check"]["not_made"] == "it was interrupted"
    whole = tpss.simulate(at(0.2)).dataset
    assert np.array_equal(result.dataset.position, whole.position, equal_nan=True)


def test_the_progress_of_the_check_is_that_of_a_check():
    """Reports of the run come first, those of the run at half the step follow."""
    reports = []
    tpss.simulate(at(0.2), reports.append, step_check=True)
    in_check = [state.in_check for state in reports]
    assert in_check == sorted(in_check)
    assert {False, True} == set(in_check)


def test_an_interrupted_run_is_not_checked():
    figures = replace(key_figures(at(0.2)), status=INTERRUPTED)
    assert check_step(figures, 0.2, trial_of(at(0.2))).not_made == "it was interrupted"


def test_half_the_step_that_needs_too_much_memory_is_left_out(monkeypatch):
    """There is room for one and a half times the recording of the run."""
    prepared = prepare(at(0.2))
    start = prepared.start
    needed = recording_bytes(start.model, start.capacity, len(start.trains))
    monkeypatch.setattr(limits, "MOST_MEMORY_BYTES", 1.5 * needed)
    check = prepared.run(step_check=True).summary["step_check"]
    assert check["not_made"] == "the run at half the step needs too much memory"


def test_a_search_that_takes_long_is_not_made(monkeypatch):
    monkeypatch.setattr("tpss.accuracy.check.MOST_TRAIN_STEPS", 10)
    check = checked(at(1.0, ROUGH))
    assert (check["within"], check["tried_min"], check["would_do_min"]) == (False, [], None)
