"""Simulate the cases of a plan that its folder does not hold yet."""

import datetime as dt
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from tpss.errors import TpssError
from tpss.many import Scratch, in_threads
from tpss.planning.case_folder import DIGEST, CaseFolder
from tpss.planning.cases import Case, CaseList, distinct
from tpss.planning.outcome import outcome_of
from tpss.planning.plan import Evaluation
from tpss.scenario.scenario import Scenario
from tpss.sweep.columns import FAILED, INVALID

FILE_S = 1.0
"""Time after which finished cases are written. [s]"""


@dataclass(frozen=True)
class Advance:
    """Progress of the cases of a plan."""

    cases: int
    done: int
    """Finished cases."""
    before: int
    """Cases that were finished at the start."""
    elapsed_s: float


def simulate_cases(
    case_list: CaseList,
    folder: CaseFolder,
    cases: Sequence[Case],
    *,
    threads: int | None = None,
    report: Callable[[Advance], None] | None = None,
) -> pd.DataFrame:
    """Rows of cases, by their digests, of which those are simulated that a folder does not hold.

    Parameters
    ----------
    case_list : CaseList
    folder : CaseFolder
        Opened.
    cases : sequence of Case
    threads : int, optional
        Number of threads; by default one for each core.
    report : callable, optional
        Called after every case.

    Raises
    ------
    StudyError
        The folder cannot be written.
    """
    wanted = distinct(cases)
    known = set(folder.table().index)
    todo = [case for case in wanted if case.digest not in known]
    started, before = time.perf_counter(), len(wanted) - len(todo)
    evaluation = case_list.plan.file.evaluate

    def work(case: Case) -> dict[str, Any]:
        return row_of(case, lambda: case_list.scenario(case), evaluation)

    rows = in_threads(work, todo, threads)
    for done in _written(rows, folder):
        if report is not None:
            elapsed_s = time.perf_counter() - started
            report(Advance(len(wanted), before + done, before, elapsed_s))
    return folder.table()


def _written(rows: Iterable[dict[str, Any]], folder: CaseFolder) -> Iterator[int]:
    """Numbers of rows, as they are done; they are written now and then, and when it ends early too."""
    waiting: list[dict[str, Any]] = []
    written_at = time.perf_counter()
    try:
        for done, row in enumerate(rows, start=1):
            waiting.append(row)
            if time.perf_counter() - written_at > FILE_S:
                folder.add(waiting)
                waiting, written_at = [], time.perf_counter()
            yield done
    finally:
        if waiting:
            folder.add(waiting)


def row_of(case: Case, scenario: Callable[[], Scenario], evaluation: Evaluation) -> dict[str, Any]:
    """Row of a case; of one that cannot be simulated, the reason.

    Parameters
    ----------
    case : Case
    scenario : callable
        Makes its scenario.
    evaluation : Evaluation
    """
    started = time.perf_counter()
    row: dict[str, Any] = {DIGEST: case.digest}
    scratch = _of_this_thread.__dict__.setdefault("scratch", Scratch())
    scratch.reset()
    try:
        made = scenario()
        row |= {"scenario_hash": made.digest(), "scenario": made.name, "outage": case.outage}
        row |= outcome_of(made, evaluation, scratch.allocate)
    except TpssError as error:
        row |= {"status": INVALID, "problem": str(error)}
    except Exception as error:  # one case that fails must not stop the others
        row |= {"status": FAILED, "problem": f"{type(error).__name__}: {error}"}
    row["timing.case_s"] = time.perf_counter() - started
    row["timing.ended"] = dt.datetime.now(dt.UTC)
    return row


_of_this_thread = threading.local()
