"""Simulate the cases of a plan that its folder does not hold yet."""

import time
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing
from typing import Any

import pandas as pd

from tpss.events import tell
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import Case, CaseList, distinct
from tpss.planning.cluster import rows_on_cluster
from tpss.planning.local import rows_here
from tpss.sweep.progress import Advance

FILE_S = 1.0
"""Time after which finished cases are written. [s]"""


def simulate_cases(
    case_list: CaseList,
    folder: CaseFolder,
    cases: Sequence[Case],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    report: Callable[[Advance], None] | None = None,
) -> pd.DataFrame:
    """Rows of cases, by their digests, of which those are simulated that a folder does not hold.

    Parameters
    ----------
    case_list : CaseList
    folder : CaseFolder
        Opened.
    cases : sequence of Case
    workers : int, optional
        How many are simulated at a time; by default one for each core.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers simulate in place of this computer.
    report : callable, optional
        Called after every case.

    Raises
    ------
    StudyError
        The folder cannot be written, or the scheduler does not answer.
    """
    wanted = distinct(cases)
    known = set(folder.table().index)
    todo = [case for case in wanted if case.digest not in known]
    started, before = time.perf_counter(), len(wanted) - len(todo)
    if scheduler is None:
        rows = rows_here(case_list, todo, workers)
    else:
        rows = rows_on_cluster(case_list, todo, scheduler)
    # Closed at once, whatever ends it: processes end with it.
    with closing(rows), closing(_written(rows, folder)) as written:
        for done in written:
            tell("cases", name=case_list.plan.file.name, done=before + done, cases=len(wanted))
            if report is not None:
                elapsed_s = time.perf_counter() - started
                report(Advance(len(wanted), before + done, before, elapsed_s))
    return folder.table()


def _written(rows: Iterable[dict[str, Any]], folder: CaseFolder) -> Generator[int, None, None]:
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
