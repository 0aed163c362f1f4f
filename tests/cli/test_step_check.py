"""What the command line says of the time step."""

import json
import signal

import pytest
import tomli_w

from accuracy.rough import ROUGH
from tpss import load_result
from tpss.run.run import Run

from conftest import EXAMPLES
from scenarios import short_line


@pytest.fixture
def rough_file(tmp_path):
    """A scenario in steps that are too long."""
    file = tmp_path / "rough.toml"
    scenario = short_line({**ROUGH, "simulation.time_step_min": 1.0, "name": "rough"})
    file.write_text(tomli_w.dumps(scenario.as_document()), encoding="utf-8")
    return file


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text("utf-8"))


def test_a_run_says_what_moves_at_half_its_step(tpss_command, tmp_path, short_file):
    said = tpss_command("run", short_file)
    assert "At half the step (0.025 min): trip " in said.out
    check = summary_of(tmp_path / "results" / "short-line-001")["step_check"]
    changes = {change["figure"]: change for change in check["changes"]}
    energy, voltage = changes["total_energy_mwh"], changes["lowest_voltage_kv"]
    moved_v = 1e3 * (voltage["at_half_step"] - voltage["at_step"])
    signs = str.maketrans("-", "−")
    if abs(moved_v) >= 0.5:
        assert f"lowest voltage {moved_v:+.0f} V".translate(signs) in said.out
    if abs(energy["share"]) >= 0.0005:
        assert f"energy {100 * energy['share']:+.1f} %".translate(signs) in said.out


def test_a_step_too_long_is_noted_with_what_shows_it_and_what_would_do(tpss_command, rough_file):
    said = tpss_command("run", rough_file)
    assert said.code == 0
    assert "Note: the step of 1 min is too long: at half of it (0.5 min) the " in said.out
    assert "the trip of eastbound 1 moves by " in said.out
    check = summary_of(rough_file.parent / "results" / "rough-001")["step_check"]
    if check["would_do_min"] is None:
        assert "none of the shorter ones tried would do (0.5, 0.25, 0.125 min)" in said.out
    else:
        assert f"a step of {check['would_do_min']:g} min would do" in said.out


def test_the_check_can_be_left_out(tpss_command, rough_file):
    said = tpss_command("run", rough_file, "--no-step-check")
    assert said.code == 0
    assert "half" not in said.out
    assert summary_of(rough_file.parent / "results" / "rough-001")["step_check"] is None


def test_the_report_says_it_too(tpss_command, rough_file):
    tpss_command("run", rough_file, "--report", "--quiet")
    page = (rough_file.parent / "results" / "rough-001" / "report.html").read_text("utf-8")
    assert "At half the step (0.5 min): trip " in page
    assert "the step of 1 min is too long" in page


def test_a_step_that_was_chosen_is_named_and_saved(tpss_command, tmp_path, short_file):
    said = tpss_command("run", short_file, "--set", "simulation={}")
    result = load_result(tmp_path / "results" / "short-line-001")
    step_min = result.summary["time_step_min"]
    how = "the longest one tried that keeps within 0.3 % of the run at half of it"
    assert f"Time step: {step_min:g} min, {how}" in said.out
    assert f"At half the step ({step_min / 2:g} min): " in said.out
    assert result.scenario.simulation.time_step_min == step_min


def test_check_says_that_the_step_will_be_chosen(tpss_command, short_file):
    said = tpss_command("check", short_file)
    assert "steps of 0.05 min until" in said.out
    document = short_line({"simulation.time_step_min": None}).as_document()
    short_file.write_text(tomli_w.dumps(document), encoding="utf-8")
    assert "steps of a length to be chosen until" in tpss_command("check", short_file).out


def test_a_ctrl_c_during_the_check_keeps_the_run(tpss_command, tmp_path, short_file, monkeypatch):
    """Half the step of 0.05 min is 1.5 s; only the run with it is interrupted."""
    advance_to, left = Run.advance_to, [signal.SIGINT]

    def interrupted(run, step):
        if run.model.options.step_s == 1.5 and left:
            signal.raise_signal(left.pop())
        advance_to(run, step)

    monkeypatch.setattr(Run, "advance_to", interrupted)
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        said = tpss_command("run", short_file)
    finally:
        signal.signal(signal.SIGINT, usual)
    assert said.code == 130
    assert "No step check: it was interrupted" in said.out
    assert "Interrupted after the run had ended: the result is complete." in said.out
    assert load_result(tmp_path / "results" / "short-line-001").status == "finished"


def test_a_collapse_at_both_steps_is_told_as_such(tpss_command):
    said = tpss_command("run", EXAMPLES / "overloaded.toml")
    assert said.code == 3
    assert "At half the step (0.25 min) the line cannot carry its load at 0.00 min" in said.out
    assert "Note: the step" not in said.out
