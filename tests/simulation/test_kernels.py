"""The parts in which the kernels are compiled are what the clock and the audit call."""

import json
import subprocess
import sys

import pytest

from tpss.model import build_model
from tpss.run.kernels import (
    adopt,
    are_ready,
    compile_calls,
    figures_calls,
    load_flow_calls,
    make_ready,
    step_calls,
)

from scenarios import short_line


@pytest.mark.parametrize("part", [load_flow_calls, step_calls, figures_calls])
def test_a_part_asks_for_nothing_that_the_clock_has_not_compiled(part):
    """With other types of arguments a kernel would be compiled twice, once for nothing."""
    model, _ = build_model(short_line())
    make_ready(model)
    assert are_ready()
    calls = part(model)
    before = [sum(kernel.stats.cache_misses.values()) for kernel, _ in calls]
    compile_calls(calls, by_kernels=part is not figures_calls)
    assert [sum(kernel.stats.cache_misses.values()) for kernel, _ in calls] == before


@pytest.fixture
def caches(tmp_path):
    """A cache with the kernel f, and another one with f, of another kind, and g."""
    for place, name, content in (
        ("own/a", "f-1.py311", "own"), ("other/a", "f-1.py311", "other"), ("other/b", "g-2.py311", "g"),
    ):  # fmt: skip
        folder = tmp_path / place
        folder.mkdir(parents=True, exist_ok=True)
        for file in (f"{name}.nbi", f"{name}.1.nbc", f"{name}.2.nbc"):
            (folder / file).write_text(content)
    return tmp_path / "own", tmp_path / "other"


def test_what_a_cache_lacks_is_adopted_whole(caches):
    own, other = caches
    adopt(other, own)
    adopted = {path.name: path.read_text() for path in (own / "b").iterdir()}
    assert adopted == {"g-2.py311.nbi": "g", "g-2.py311.1.nbc": "g", "g-2.py311.2.nbc": "g"}


def test_what_a_cache_has_stays_as_it_is(caches):
    own, other = caches
    adopt(other, own)
    assert {path.read_text() for path in (own / "a").iterdir()} == {"own"}
    assert len(list((other / "a").iterdir())) == 3


TWO_THREADS = """
import json, sys, threading, tpss
scenario = tpss.Scenario.from_document(json.load(sys.stdin), "short-line")
together, done = threading.Barrier(2), []
def simulate():
    together.wait()
    done.append(tpss.simulate(scenario).status)
threads = [threading.Thread(target=simulate) for _ in range(2)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(done)
"""


def test_two_threads_may_begin_at_the_same_time():
    """In a process of their own, whose first runs these are."""
    make_ready(build_model(short_line())[0])
    document = json.dumps(short_line({"simulation.duration_min": 1.0}).as_document())
    call = [sys.executable, "-c", TWO_THREADS]
    done = subprocess.run(call, input=document, capture_output=True, text=True, check=True)
    assert done.stdout == "['finished', 'finished']\n", done.stderr
