"""Processes that begin at the same time compile a kernel once for each kind of arguments."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import json, sys
from one_compile import compile_once
compile_once()
from tpss.physics.adhesion import adhesion_limit
print(flush=True)
sys.stdin.readline()
value = adhesion_limit(1.0, json.loads(sys.argv[1]), 0)
print(json.dumps([value, sum(adhesion_limit.stats.cache_misses.values())]))
"""
SPEEDS = ["10.0", "10.0", "10", "10"]
"""A speed as a number with and without decimals: two kinds of arguments. [m/s]"""


@pytest.mark.skipif(os.name != "posix", reason="waits by locks of POSIX")
def test_each_is_compiled_by_one_of_all(tmp_path: Path) -> None:
    """Of four processes that all call it, two compile; a fifth one of each kind loads what they kept."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    environment["PYTHONPATH"] = os.pathsep.join(map(str, sys.path))

    def start(speed: str) -> "subprocess.Popen[str]":
        call = [sys.executable, "-c", SCRIPT, speed]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        return subprocess.Popen(call, env=environment, cwd=tmp_path, text=True, **pipes)

    def found_by(processes: list["subprocess.Popen[str]"]) -> tuple[set[float], int]:
        for process in processes:
            assert process.stdout is not None
            process.stdout.readline()  # it has imported what it needs
        for process in processes:
            assert process.stdin is not None
            process.stdin.write("\n")
            process.stdin.flush()
        told = [process.communicate()[0] for process in processes]
        values, misses = zip(*map(json.loads, told), strict=True)
        return set(values), sum(misses)

    values, compiled = found_by([start(speed) for speed in SPEEDS])
    assert len(values) == 1
    assert compiled == 2
    assert found_by([start(speed) for speed in SPEEDS[1:3]]) == (values, 0)
