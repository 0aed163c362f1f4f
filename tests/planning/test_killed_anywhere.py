"""A plan whose process is killed 20 times (SIGKILL), anywhere in its work, comes to the same plan.

Outcomes are made up (`plan_outcomes`), so that a run takes no time but that of its files.  A child is
killed before or after a case, before, within or after the writing of a file, or of its taking its place.
"""

import json
import os
import random
import signal
import sys
import warnings
from pathlib import Path

import pytest

from tpss.files import whole
from tpss.planning import local, simulate
from tpss.planning.case_folder import DIGEST, CaseFolder
from tpss.planning.cases import CaseList
from tpss.planning.load import load_plan
from tpss.planning.run import run_plan

from plan_outcomes import outcomes
from small_plans import write_plan

KILLS = 20

ONE_MORE = {
    "measures/East": {
        "add": {
            "supply.converter_stations": {
                "name": "East", "position_km": 17.0, "type": "Q48/Q49", "converters": 2,
            }
        },
        "cost": 150.0,
        "lifetime_years": 40,
    }
}  # fmt: skip
"""Beside the two measures of the small plan: 8 configurations, two states of traffic."""

SAME = {
    "simulation": ("answer", "claim", "expected_cost", "decisions", "values"),
    "bounds": ("expected_cost", "decisions"),
}
"""Ways to prove a plan, and what does not depend on where it was killed: by bounds, which alternatives
were simulated may."""


class Moments:
    """Counts the moments of a run at which it may be killed, and kills it at one of them."""

    def __init__(self, fatal=None):
        self.count, self.fatal = 0, fatal

    def pass_one(self):
        self.count += 1
        if self.count == self.fatal:
            os.kill(os.getpid(), signal.SIGKILL)


@pytest.fixture
def moments(monkeypatch, tmp_path):
    """Moments of the runs of this process, and of those that it forks."""
    found = Moments()
    replace = Path.replace

    def write(file, content):
        found.pass_one()
        file.write(bytes(content)[: len(content) // 2])
        file.flush()
        found.pass_one()
        file.write(bytes(content)[len(content) // 2 :])
        file.flush()
        found.pass_one()

    def put(self, target):
        replace(self, target)
        found.pass_one()

    monkeypatch.setattr(whole, "_write_through", write)
    monkeypatch.setattr(Path, "replace", put)
    monkeypatch.setattr(simulate, "FILE_S", 0.0)
    return found


def killed_at(moment, moments, work):
    """Fork, and let the child be killed at a moment; whether it was, and did not come to an end."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # forks with other threads: they rest
        child = os.fork()
    if child == 0:
        moments.count, moments.fatal = 0, moment
        try:
            work()
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL


@pytest.mark.skipif(sys.platform != "linux", reason="forks a process with threads")
@pytest.mark.parametrize("by", SAME)
def test_killed_at_20_random_moments_it_is_the_same_plan(by, tmp_path, moments, monkeypatch):
    file = write_plan(tmp_path, {**ONE_MORE, "evaluate": {"by": by}})
    listed = CaseList(load_plan(file))
    rows = {row[DIGEST]: row for row in outcomes(listed).reset_index().to_dict("records")}
    simulated = []

    def row_of(case, *_):
        simulated.append(case.digest)
        moments.pass_one()
        return rows[case.digest]

    monkeypatch.setattr(local, "row_of", row_of)
    plan = load_plan(file)

    def run(folder):
        return run_plan(plan, tmp_path / folder, workers=1)

    run("whole")
    draw, every, kills = random.Random(by), moments.count, 0
    for _ in range(KILLS):
        # A tenth of a run at most, so that all of it is passed through, its last files too.
        kills += killed_at(draw.randint(1, every // 10), moments, lambda: run("killed"))
    assert kills == KILLS
    kept = set(CaseFolder(tmp_path / "killed").table().index)
    assert len(kept) > 0
    simulated.clear()
    run("killed")
    assert not kept & set(simulated), "a case was simulated twice"
    table = CaseFolder(tmp_path / "killed").table()
    assert table.index.is_unique
    documents = [json.loads((tmp_path / k / "plan.json").read_text()) for k in ("whole", "killed")]
    for key in SAME[by]:
        assert documents[0][key] == documents[1][key]
