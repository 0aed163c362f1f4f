"""Ctrl-C: what was simulated is saved, and the exit code is 130; a second one does not wait."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tpss import load_result
from tpss.files import whole
from tpss.run.lone import EmptyLine
from tpss.run.run import Run

from conftest import EXAMPLES

HEADWAY = EXAMPLES / "at_headway_3.toml"

TELLS_OF_ITS_FIRST_STEPS = """
from tpss.run import run
advance_to = run.Run.advance_to
def telling(self, step):
    advance_to(self, step)
    if step:
        print("under way", flush=True)
run.Run.advance_to = telling
from tpss.__main__ import main
main()
"""


def press_ctrl_c(towards: int, monkeypatch: pytest.MonkeyPatch, times: int = 1) -> None:
    """Press Ctrl-C when the clock sets out for a step; to step 0 it goes to compile the kernels."""
    advance_to, left = Run.advance_to, [signal.SIGINT] * times

    def interrupted(run, step):
        while step >= towards and left:
            signal.raise_signal(left.pop())
        advance_to(run, step)

    monkeypatch.setattr(Run, "advance_to", interrupted)


def press_ctrl_c_while_saving(monkeypatch: pytest.MonkeyPatch, times: int) -> None:
    """Press Ctrl-C when the first file of a result has been written."""
    write, left = whole.write_new, [signal.SIGINT] * times

    def interrupted(path, content):
        write(path, content)
        while left:
            signal.raise_signal(left.pop())

    monkeypatch.setattr(whole, "write_new", interrupted)


@pytest.fixture(autouse=True)
def ctrl_c_interrupts():
    """A process that a shell has started in the background ignores Ctrl-C, and so do its children."""
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, usual)


def started(folder: Path, *command: object, **environment: str) -> "subprocess.Popen[str]":
    """A Python process in a folder, which can be read from and interrupted."""
    return subprocess.Popen(
        [sys.executable, *map(str, command)],
        env={**os.environ, **environment}, cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def test_an_interrupted_run_is_saved(tpss_command, tmp_path, short_file, monkeypatch):
    press_ctrl_c(1, monkeypatch)
    said = tpss_command("run", short_file)
    assert said.code == 130
    result = load_result(tmp_path / "results" / "short-line-001")
    assert result.status == "interrupted"
    assert result.audit["passed"]
    minutes = float(result.dataset.time[-1]) / 60.0
    assert 0.0 < minutes < 20.0
    assert f"Interrupted. Stopped at {minutes:.2f} min" in said.out
    assert "Run it again to the end." in said.out


def test_a_process_that_is_interrupted_saves_its_run(tmp_path, short_file):
    """The signal comes from outside, in one of 100 000 steps."""
    long = ("simulation.duration_min=100", "simulation.time_step_min=0.001")
    options = [word for value in long for word in ("--set", value)]
    with started(tmp_path, "-c", TELLS_OF_ITS_FIRST_STEPS, "run", short_file, *options) as process:
        assert process.stdout.readline() == "under way\n"
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "Interrupted: the result so far will be saved; another Ctrl-C discards it." in err
    assert "Saved in results/short-line-001" in out
    result = load_result(tmp_path / "results" / "short-line-001")
    assert result.status == "interrupted"
    assert 0 < result.dataset.sizes["time"] < 100_000


def test_a_second_ctrl_c_does_not_wait(tpss_command, tmp_path, short_file, monkeypatch):
    press_ctrl_c(1, monkeypatch, times=2)
    said = tpss_command("run", short_file)
    assert said.code == 130
    assert said.err.endswith("Interrupted; nothing was saved.")
    assert list(tmp_path.iterdir()) == [short_file]


def test_an_interruption_before_there_are_trains_saves_nothing(tpss_command, tmp_path, monkeypatch):
    """While it is found out where those stand that run already."""
    advance = EmptyLine.advance

    def interrupted(line, lone, step):
        signal.raise_signal(signal.SIGINT)
        advance(line, lone, step)

    monkeypatch.setattr(EmptyLine, "advance", interrupted)
    said = tpss_command("run", HEADWAY)
    assert (said.code, said.out) == (130, "")
    assert said.err.endswith("Interrupted; nothing was saved.")
    assert list(tmp_path.iterdir()) == []


def test_a_compilation_can_be_interrupted(tmp_path):
    with started(tmp_path, "-m", "tpss", "run", HEADWAY, NUMBA_CACHE_DIR="kernels") as process:
        assert process.stderr.readline().startswith("Compiling the numerical kernels")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "Interrupted; nothing was saved.\n")
    assert [path.name for path in tmp_path.iterdir()] == ["kernels"]


def test_an_interrupted_saving_is_completed(tpss_command, tmp_path, short_file, monkeypatch):
    press_ctrl_c_while_saving(monkeypatch, times=1)
    said = tpss_command("run", short_file)
    assert said.code == 130
    assert "Interrupted after the run had ended: the result is complete." in said.out
    assert load_result(tmp_path / "results" / "short-line-001").status == "finished"


def test_a_second_ctrl_c_gives_the_saving_up(tpss_command, tmp_path, short_file, monkeypatch):
    press_ctrl_c_while_saving(monkeypatch, times=2)
    said = tpss_command("run", short_file)
    assert (said.code, said.out) == (130, "")
    assert said.err.endswith("Interrupted; nothing was saved.")
    assert list((tmp_path / "results").iterdir()) == []


def test_an_interruption_of_the_printing_says_where_the_result_lies(
    tpss_command, short_file, monkeypatch
):
    def interrupted(*_):
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("tpss.cli.tables.print_result", interrupted)
    said = tpss_command("run", short_file)
    assert said.code == 130
    assert said.err.endswith("Interrupted. The result is in results/short-line-001")


def test_a_failed_run_keeps_its_exit_code_when_its_saving_is_interrupted(tpss_command, monkeypatch):
    press_ctrl_c_while_saving(monkeypatch, times=1)
    assert tpss_command("run", EXAMPLES / "overloaded.toml", "--quiet").code == 3


def test_where_ctrl_c_is_ignored_a_run_ignores_it_too(tpss_command, short_file, monkeypatch):
    """So a shell script starts what it leaves in the background."""
    press_ctrl_c(1, monkeypatch)
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert tpss_command("run", short_file, "--quiet").code == 0
    finally:
        signal.signal(signal.SIGINT, usual)
