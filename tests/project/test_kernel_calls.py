"""Kernels that only kernels call have no machine code of their own, until Python calls one."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tpss.kernel import compiles

pytestmark = pytest.mark.skipif(not compiles(), reason="compilation is switched off")

MODULE = """
from pathlib import Path
from tpss.kernel import compiled_into

def kept(function):
    return compiled_into(Path(__file__).parent / "kept", function, fused=False)

@kept
def cubed(x):
    return x * x * x if x > 0.0 else 0.0

@kept
def of_both(x, y):
    return cubed(x) + cubed(y)

@kept
def of_three(x, y, z):
    return of_both(x, y) + cubed(z)
"""

SCRIPT = """
import json
from made import cubed, of_both, of_three
from tpss.kernel_calls import CalledLibrary

def are_called():
    results = [each for kernel in (cubed, of_both, of_three) for each in kernel.overloads.values()]
    return [isinstance(each.library, CalledLibrary) for each in results]

values, called = [of_three(1.0, 2.0, 3.0)], [are_called()]
values += [cubed(2.0), of_both(1.0, 2.0)]
called.append(are_called())
values.append(of_three(1.0, 2.0, 3.0))
misses = sum(sum(each.stats.cache_misses.values()) for each in (cubed, of_both, of_three))
print(json.dumps([values, called, misses]))
"""


@pytest.fixture
def found(tmp_path: Path):
    """Gives what a script says, from a process that starts in a folder with these kernels."""
    (tmp_path / "made.py").write_text(MODULE, "utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}

    def run(script: str = SCRIPT):
        call = [sys.executable, "-c", script]
        done = subprocess.run(call, env=environment, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    return run


def test_one_gets_its_machine_code_when_python_calls_it(found):
    """1 + 8 + 27, before and after the parts are called by themselves."""
    values, called, compiled = found()
    assert values == [36.0, 8.0, 9.0, 36.0]
    assert called == [[True, True, False], [False, False, False]]
    assert compiled == 3


def test_another_process_finds_both_forms_on_disk(found):
    found("from made import of_three; print(of_three(1.0, 2.0, 3.0))")
    values, called, compiled = found()
    assert (values, compiled) == ([36.0, 8.0, 9.0, 36.0], 0)
    assert called == [[False], [False, False, False]]
    assert found("from made import cubed; print(cubed(2.0))") == 8.0


def test_a_kernel_on_disk_becomes_part_of_a_new_one(found):
    """It was kept for one that called it, and is not compiled again for another."""
    found("from made import of_both; print(of_both(1.0, 2.0))")
    script = "from made import *; print([of_three(1.0, 2.0, 3.0), {}.stats.cache_misses.total()])"
    assert found(script.format("of_both")) == [36.0, 0]
