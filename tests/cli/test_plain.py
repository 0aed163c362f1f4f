"""`tpss run --plain` runs the equations as plain Python: nothing is compiled, results are the same."""

import os
import subprocess
import sys

import pytest

from tpss import load_result

CALL = [sys.executable, "-m", "tpss", "run", "short_line.toml", "--no-step-check", "--quiet"]


@pytest.fixture
def runs(short_file, tmp_path):
    """The short line, compiled and as plain Python, and the folder of kernels of the latter."""
    shorter = ["--set", "simulation.until=", "--set", "simulation.duration_min=3"]
    for name in ("compiled", "plain"):
        own = {"NUMBA_CACHE_DIR": str(tmp_path / "kernels")} if name == "plain" else {}
        options = ["--out", name, *shorter, *(["--plain"] if name == "plain" else [])]
        environment = {**os.environ, **own}
        subprocess.run([*CALL, *options], cwd=tmp_path, env=environment, check=True, timeout=300)
    return [load_result(tmp_path / name) for name in ("compiled", "plain")]


def test_the_results_are_the_same_and_nothing_is_compiled(runs, tmp_path):
    """To rounding: compiled, a product and the sum that it enters are rounded once, not twice."""
    compiled, plain = runs
    assert plain.status == compiled.status == "finished"
    assert plain.audit["passed"]
    assert plain.dataset.sizes == compiled.dataset.sizes
    for name in ("position", "speed", "pantograph_voltage", "active_power"):
        expected = compiled.dataset[name].to_numpy()
        size = abs(expected[expected == expected]).max()
        assert plain.dataset[name].to_numpy() == pytest.approx(
            expected, rel=1e-9, abs=1e-9 * size, nan_ok=True
        ), name
    assert list((tmp_path / "kernels").rglob("*.nbc")) == []


def test_a_program_that_has_imported_numba_is_left_as_it_was(tpss_command, short_file, tmp_path):
    """The command then runs in a process of its own."""
    said = tpss_command(
        "run", short_file, "--plain", "--out", "result", "--set", "simulation.until=",
        "--set", "simulation.duration_min=0.5", "--no-step-check",
    )  # fmt: skip
    assert said.code == 0
    assert load_result(tmp_path / "result").status == "finished"
    assert "NUMBA_DISABLE_JIT" not in os.environ


def test_bad_input_keeps_its_exit_code(tpss_command):
    assert tpss_command("run", "nowhere.toml", "--plain").code == 2
