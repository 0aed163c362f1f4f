"""Cases on processes of this computer, which end with the one that started them."""

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from tpss.errors import StudyError

AHEAD = 2
"""Batches per process that are running or waiting."""

READY_S = 0.05
"""How long each process sleeps once it has started, so that none takes the place of another. [s]"""

MOST_LOSSES = 3
"""How often a process may end before it is ready."""

Batch = TypeVar("Batch")
Rows = TypeVar("Rows")


@dataclass(frozen=True)
class Work(Generic[Batch, Rows]):
    """What processes do: functions that can be sent to them, with all that they need."""

    warm_up: Callable[[], Any]
    """Prepares a process: compiles the kernels, or loads them."""
    run: Callable[[Batch], Rows]
    """Simulates a batch."""
    name: Callable[[Batch], str]
    """What a batch is called if it cannot be run; it is not sent."""
    parts: Callable[[Batch], Sequence[Batch]]
    """Halves of a batch; nothing of a single case.  It is not sent."""
    rows_of_killer: Callable[[Batch], Rows]
    """Rows of a single case that ends the process that runs it.  It is not sent."""


def in_processes(
    work: Work[Batch, Rows], batches: Iterator[Batch], count: int
) -> Iterator[tuple[Batch, Rows]]:
    """Batches of cases with their rows, as they are done.

    Where a process is killed, the batches that were under way are run by themselves, one by one: one
    that kills again is cut in halves, until the case is alone that does so, which is marked.

    Parameters
    ----------
    work : Work
    batches : iterator
        Drawn as they are needed.
    count : int
        Number of processes.

    Raises
    ------
    StudyError
        A batch could not be run, or processes end before they run any.
    """
    suspects: list[Batch] = []
    while True:
        yield from _one_by_one(work, suspects)
        running: dict[Future[Rows], Batch] = {}
        try:
            with _pool(work.warm_up, count) as pool:
                yield from _as_done(pool, work, batches, count, running)
            return
        except BrokenProcessPool:
            suspects = list(running.values())


def _one_by_one(work: Work[Batch, Rows], suspects: list[Batch]) -> Iterator[tuple[Batch, Rows]]:
    """Batches one of which may have killed a process, each with nothing beside it; all are taken out."""
    unready = 0
    while suspects:
        is_ready = False
        try:
            with _pool(work.warm_up, 1) as pool:
                pool.submit(time.sleep, 0.0).result()
                is_ready, unready = True, 0
                while suspects:
                    rows = _result(pool.submit(work.run, suspects[0]), work, suspects[0])
                    yield suspects.pop(0), rows
        except BrokenProcessPool as error:
            if is_ready:
                killer = suspects.pop(0)
                parts = work.parts(killer)
                suspects[:0] = parts
                if not parts:
                    yield killer, work.rows_of_killer(killer)
                continue
            unready += 1
            if unready == MOST_LOSSES:
                raise StudyError(
                    "the processes that run the cases end before they run any; run it with fewer "
                    "--workers if memory is short, and call run_study or run_plan of a script of "
                    'your own below if __name__ == "__main__":'
                ) from error


def trial(
    warm_up: Callable[[], Any],
    run: Callable[[Sequence[int]], Any],
    cases: Sequence[int],
    count: int,
) -> tuple[float, float]:
    """How long processes take to start, and how long a case takes while all of them are busy. [s]

    Parameters
    ----------
    warm_up : callable
        Prepares a process.
    run : callable
        Simulates some cases.
    cases : sequence of int
        Cases that are simulated, at least one a process.
    count : int
        Number of processes.

    Raises
    ------
    StudyError
        A process was killed.
    """
    begun = time.perf_counter()
    try:
        with _pool(warm_up, count) as pool:
            wait([pool.submit(time.sleep, READY_S) for _ in range(count)])
            started = time.perf_counter()
            shares = [pool.submit(run, cases[k::count]) for k in range(count)]
            wait(shares)
            done = time.perf_counter()
            for share in shares:
                share.result()
    except BrokenProcessPool as error:
        raise StudyError(
            "a process that tried some cases was killed, perhaps as memory was short; try it with fewer "
            "--workers, or run the study, which marks a case that kills"
        ) from error
    return started - begun - READY_S, (done - started) * count / len(cases)


def _as_done(
    pool: ProcessPoolExecutor,
    work: Work[Batch, Rows],
    batches: Iterator[Batch],
    count: int,
    running: dict["Future[Rows]", Batch],
) -> Iterator[tuple[Batch, Rows]]:
    """Results of batches; those that are not done are in `running`, at any time."""

    def submit() -> None:
        batch = next(batches, None)
        if batch is not None:
            try:
                running[pool.submit(work.run, batch)] = batch
            except BrokenProcessPool:
                running[Future()] = batch  # so that it is not lost
                raise

    for _ in range(AHEAD * count):
        submit()
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            batch = running[future]
            rows = _result(future, work, batch)
            del running[future]
            submit()
            yield batch, rows


def _result(future: "Future[Rows]", work: Work[Batch, Rows], batch: Batch) -> Rows:
    """Rows of a batch.

    Raises
    ------
    StudyError
        It could not be run.
    BrokenProcessPool
        A process was killed.
    """
    try:
        return future.result()
    except BrokenProcessPool:
        raise
    except Exception as error:
        raise StudyError(
            f"{work.name(batch)} could not be run ({type(error).__name__}: {error}); "
            "the others are kept, and the same command continues from there"
        ) from error


@contextmanager
def _pool(warm_up: Callable[[], Any], count: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that have loaded the kernels; they are ended at once if it ends early."""
    before = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        count, multiprocessing.get_context("spawn"), initializer=_begin, initargs=(warm_up,)
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


def _begin(warm_up: Callable[[], Any]) -> None:
    """Prepare a process, which leaves an interrupt to the one that started it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    warm_up()


def _end_with_parent() -> None:
    """End this process once the one that started it has, in whatever manner."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
