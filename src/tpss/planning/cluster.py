"""Cases on the workers of a Dask scheduler: they are sent as documents, and rows come back."""

import time
from collections.abc import Generator, Sequence

from tpss.planning.cases import Case, CaseList
from tpss.planning.documents import Row, run_documents, warm_up

MOST_IN_BATCH = 200
"""Documents that are sent at a time, some thousand bytes each."""


def rows_on_cluster(
    case_list: CaseList, cases: Sequence[Case], scheduler: str
) -> Generator[Row, None, None]:
    """Rows of cases, as they are done.

    Parameters
    ----------
    case_list : CaseList
    cases : sequence of Case
    scheduler : str
        Address of a Dask scheduler.

    Raises
    ------
    StudyError
        It does not answer, its workers are of another version, or some cases could not be run.
    """
    # Dask takes long to import, and is needed here only.
    from tpss.sweep.batch import batch_size
    from tpss.sweep.cluster import BATCHES_AHEAD, Task, client_of, in_turn, prepare_workers

    if not cases:
        return
    evaluation = case_list.plan.file.evaluate.model_dump_json()
    first = (cases[0], case_list.document(cases[0]))
    run_documents([first], evaluation)  # which compiles
    started = time.perf_counter()
    run_documents([first], evaluation)
    case_s = time.perf_counter() - started
    with client_of(scheduler) as client:
        threads = sum(client.nthreads().values())
        prepare_workers(client, warm_up, [first], evaluation)
        size = min(MOST_IN_BATCH, batch_size(len(cases), case_s, threads))
        batches = (cases[begin : begin + size] for begin in range(0, len(cases), size))
        tasks = (
            Task(
                f"{len(batch)} cases",
                run_documents,
                ([(case, case_list.document(case)) for case in batch], evaluation),
            )
            for batch in batches
        )
        for _, rows in in_turn(client, tasks, BATCHES_AHEAD * threads):
            yield from rows
