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
"""How often processes may be lost without a finished batch in between."""

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


def in_processes(
    work: Work[Batch, Rows], batches: Iterator[Batch], count: int
) -> Iterator[tuple[Batch, Rows]]:
    """Batches of cases with their rows, as they are done.

    A process that is killed loses its batch only, which another one runs.

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
        A batch could not be run, or processes are lost again and again.
    """
    lost: list[Batch] = []
    losses = 0
    while True:
        with _pool(work.warm_up, count) as pool:
            running: dict[Future[Rows], Batch] = {}
            try:
                for done in _as_done(pool, work, _first(lost, batches), count, running):
                    losses = 0
                    yield done
                return
            except BrokenProcessPool as error:
                losses += 1
                lost = list(running.values())
                if losses == MOST_LOSSES:
                    raise StudyError(
                        "the processes that run the cases end again and again; run it with fewer "
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
    """
    begun = time.perf_counter()
    with _pool(warm_up, count) as pool:
        wait([pool.submit(time.sleep, READY_S) for _ in range(count)])
        started = time.perf_counter()
        shares = [pool.submit(run, cases[k::count]) for k in range(count)]
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
    work: Work[Batch, Rows],
    batches: Iterator[Batch],
    count: int,
    running: dict["Future[Rows]", Batch],
) -> Iterator[tuple[Batch, Rows]]:
    """Results of batches; those that are not done are in `running`, at any time."""

    def submit() -> None:
        batch = next(batches, None)
        if batch is not None:
            running[pool.submit(work.run, batch)] = batch

    for _ in range(AHEAD * count):
        submit()
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            batch = running[future]
            try:
                rows = future.result()
            except BrokenProcessPool:
                raise
            except Exception as error:
                raise StudyError(
                    f"{work.name(batch)} could not be run ({type(error).__name__}: {error}); "
                    "the others are kept, and the same command continues from there"
                ) from error
            del running[future]
            submit()
            yield batch, rows


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
