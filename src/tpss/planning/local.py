"""Cases on this computer: few in threads, many on processes of their own.

Half of a short case is not the kernels' time but that of building it, in which threads wait for each
other.
"""

import time
from collections.abc import Generator, Sequence
from contextlib import closing
from functools import partial

from tpss.many import in_threads
from tpss.planning.cases import Case, CaseList
from tpss.planning.documents import Row, Sent, run_documents, warm_up
from tpss.planning.rows import row_of, row_of_killer

TRIED = 2
"""Cases that are simulated first, in turn: the first compiles the kernels, the last one is measured."""


def rows_here(
    case_list: CaseList, cases: Sequence[Case], workers: int | None
) -> Generator[Row, None, None]:
    """Rows of cases, as they are done.

    Parameters
    ----------
    case_list : CaseList
    cases : sequence of Case
    workers : int, optional
        How many are simulated at a time; by default one for each core.

    Raises
    ------
    StudyError
        Processes are lost again and again.
    """
    evaluation = case_list.plan.file.evaluate

    def work(case: Case) -> Row:
        return row_of(case, lambda: case_list.scenario(case), evaluation)

    first, rest = cases[:TRIED], cases[TRIED:]
    started = time.perf_counter()
    for case in first:
        started = time.perf_counter()
        yield work(case)
    case_s = time.perf_counter() - started
    # Parquet and processes take long to import, and are not needed for a few cases.
    from tpss.sweep.campaign import WORTHWHILE_S

    if workers == 1 or len(rest) * case_s < WORTHWHILE_S:
        yield from in_threads(work, rest, workers)
    else:
        with closing(_in_processes(case_list, rest, case_s, workers)) as rows:
            yield from rows


def _in_processes(
    case_list: CaseList, cases: Sequence[Case], case_s: float, workers: int | None
) -> Generator[Row, None, None]:
    """Rows of cases from processes, to which they are sent as documents."""
    from tpss.sweep.batch import batch_size
    from tpss.sweep.campaign import processes_for
    from tpss.sweep.processes import Work, in_processes

    def sent(some: Sequence[Case]) -> list[Sent]:
        return [(case, case_list.document(case)) for case in some]

    count = processes_for(len(cases), case_s, workers)
    size = batch_size(len(cases), case_s, count)
    batches = (sent(cases[begin : begin + size]) for begin in range(0, len(cases), size))
    how = case_list.plan.file.evaluate.model_dump_json()
    work: Work[list[Sent], list[Row]] = Work(
        warm_up=partial(warm_up, sent(cases[:1]), how),
        run=partial(run_documents, evaluation=how),
        name=lambda batch: f"{len(batch)} cases",
        parts=lambda batch: (
            [batch[: len(batch) // 2], batch[len(batch) // 2 :]] if len(batch) > 1 else []
        ),
        rows_of_killer=lambda batch: [row_of_killer(batch[0][0])],
    )
    for _, rows in in_processes(work, batches, count):
        yield from rows
