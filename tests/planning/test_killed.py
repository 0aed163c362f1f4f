"""A plan that is killed, however often, comes to the same answer, and simulates no case twice."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import pytest

from tpss.planning.case_folder import CaseFolder

from small_plans import write_plan

SLOW = {"evaluate": {"time_step_min": 0.01}, "require/also_with": ["one out"]}
"""Cases of some tenths of a second, so that there is time to kill what runs them."""

KILLS = 4

BY = {
    "simulation": ("answer", "claim", "expected_cost", "decisions"),
    "bounds": ("expected_cost", "decisions"),
}
"""Ways to prove a plan, and what does not depend on where it was killed: by bounds, which alternatives
were simulated may."""


def command(file, folder):
    whole = [sys.executable, "-m", "tpss", "plan", "run", str(file), "--out", str(folder)]
    return [*whole, "--workers", "1", "--quiet"]


def answer(folder, by):
    document = json.loads((folder / "plan.json").read_text())
    return {key: document[key] for key in BY[by]}


@pytest.mark.skipif(os.name != "posix", reason="kills processes")
@pytest.mark.parametrize("by", BY)
def test_killed_plans_lose_nothing(by, tmp_path):
    draw = random.Random(1)
    file = write_plan(tmp_path, {**SLOW, "evaluate": {**SLOW["evaluate"], "by": by}})
    subprocess.run(command(file, tmp_path / "whole"), check=True)
    for _ in range(KILLS):
        process = subprocess.Popen(command(file, tmp_path / "out"))
        time.sleep(draw.uniform(1.5, 4.0))
        process.send_signal(signal.SIGKILL)
        process.wait()
    subprocess.run(command(file, tmp_path / "out"), check=True)
    assert answer(tmp_path / "out", by) == answer(tmp_path / "whole", by)
    killed, whole = CaseFolder(tmp_path / "out").table(), CaseFolder(tmp_path / "whole").table()
    assert killed.index.is_unique
    own = [name for name in whole.columns if not name.startswith("timing.")]
    both = whole.index.intersection(killed.index)
    assert by == "bounds" or len(both) == len(whole)
    assert killed.loc[both, own].equals(whole.loc[both, own])
