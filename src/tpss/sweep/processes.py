"""Cases on processes of this computer, which end with the one that started them."""

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from tpss.errors import StudyError
from tpss.sweep.batch import Plan, run_batch, run_cases, warm_up

AHEAD = 2
"""Batches per process that are running or waiting."""

READY_S = 0.05
"""How long each process sleeps once it has started, so that none takes the place of another. [s]"""

MOST_LOSSES = 3
"""How often processes may be lost without a finished batch in between."""

Batch = tuple[int, int]
"""Cases from the first to the one before the second."""


def in_processes(
    plan: Plan, batches: Iterator[Batch], count: int
) -> Iterator[tuple[int, int, bytes]]:
    """Batches of cases with their rows, as they are done.

    A process that is killed loses its batch only, which another one runs.

    Parameters
    ----------
    plan : Plan
    batches : iterator of pair of int
        Drawn as they are needed.
    count : int
        Number of processes.

    Raises
    ------
    StudyError
        A batch could not be run, or processes are lost again and again.
    """
    lost: list[Batch] = []
    losses = 0
    while True:
        with _pool(plan, count) as pool:
            running: dict[Future[bytes], Batch] = {}
            try:
                for batch, content in _as_done(pool, plan, _first(lost, batches), count, running):
                    losses = 0
                    yield *batch, content
                return
            except BrokenProcessPool as error:
                losses += 1
                lost = list(running.values())
                if losses == MOST_LOSSES:
                    raise StudyError(
                        "the processes that run the cases end again and again; run it with fewer "
                        "--workers if memory is short, and call run_study of a script of your own "
                        'below if __name__ == "__main__":'
                    ) from error


def trial(plan: Plan, cases: Sequence[int], count: int) -> tuple[float, float]:
    """How long processes take to start, and how long a case takes while all of them are busy. [s]

    Parameters
    ----------
    plan : Plan
    cases : sequence of int
        Cases that are simulated, at least one a process.
    count : int
        Number of processes.
    """
    begun = time.perf_counter()
    with _pool(plan, count) as pool:
        wait([pool.submit(time.sleep, READY_S) for _ in range(count)])
        started = time.perf_counter()
        shares = [pool.submit(run_cases, plan, cases[k::count]) for k in range(count)]
        wait(shares)
        done = time.perf_counter()
        for share in shares:
            share.result()
    return started - begun - READY_S, (done - started) * count / len(cases)


def _first(lost: list[Batch], batches: Iterator[Batch]) -> Iterator[Batch]:
    yield from lost
    yield from batches


def _as_done(
    pool: ProcessPoolExecutor,
    plan: Plan,
    batches: Iterator[Batch],
    count: int,
    running: dict["Future[bytes]", Batch],
) -> Iterator[tuple[Batch, bytes]]:
    """Results of batches; those that are not done are in `running`, at any time."""

    def submit() -> None:
        batch = next(batches, None)
        if batch is not None:
            running[pool.submit(run_batch, plan, *batch)] = batch

    for _ in range(AHEAD * count):
        submit()
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            first, end = running[future]
            try:
                content = future.result()
            except BrokenProcessPool:
                raise
            except Exception as error:
                raise StudyError(
                    f"cases {first} to {end - 1} could not be run ({type(error).__name__}: {error}); "
                    "the others are kept, and the same command continues from there"
                ) from error
            del running[future]
            submit()
            yield (first, end), content


@contextmanager
def _pool(plan: Plan, count: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that have loaded the kernels; they are ended at once if it ends early."""
    before = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        count, multiprocessing.get_context("spawn"), initializer=_begin, initargs=(plan,)
    )
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        # One that the pool was about to start is there a moment later.
        while started := set(multiprocessing.active_children()) - before:
            for process in started:
                process.terminate()
            for process in started:
                process.join()
        raise
    pool.shutdown()


def _begin(plan: Plan) -> None:
    """Prepare a process, which leaves an interrupt to the one that started it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    warm_up(plan)


def _end_with_parent() -> None:
    """End this process once the one that started it has, in whatever manner."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
