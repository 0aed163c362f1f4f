"""Cases on the workers of a Dask scheduler: few tasks at a time are with it, whatever their number."""

import itertools
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

import distributed

from tpss.errors import StudyError
from tpss.sweep.batch import Plan, batch_size, run_batch, warm_up
from tpss.sweep.folder import Ranges, batches
from tpss.sweep.versions import versions

BATCHES_AHEAD = 2
"""Batches per worker that are running or waiting."""

CONNECT_S = 10.0
"""How long a scheduler may take to answer. [s]"""


def batches_on_cluster(
    plan: Plan, todo: Ranges, scheduler: str, case_s: float
) -> Iterator[tuple[int, int, bytes]]:
    """Cases from the first to the one before the second, and their rows, as they are done.

    Parameters
    ----------
    plan : Plan
    todo : list of pair of int
    scheduler : str
        Its address.
    case_s : float
        Time of a case. [s]

    Raises
    ------
    StudyError
        The scheduler does not answer, its workers are of another version, or cases could not be run.
    """
    with client_of(scheduler) as client:
        threads = sum(client.nthreads().values())
        prepare_workers(client, warm_up, plan)
        size = batch_size(sum(end - first for first, end in todo), case_s, threads)
        tasks = (
            Task(f"cases {first} to {end - 1}", run_batch, (plan, first, end))
            for first, end in batches(todo, size)
        )
        for task, content in in_turn(client, tasks, BATCHES_AHEAD * threads):
            _, first, end = task.arguments
            yield first, end, content


@dataclass(frozen=True)
class Task:
    """A call that is made by a worker."""

    name: str
    """What it works on, in words."""
    function: Callable[..., Any]
    arguments: tuple[Any, ...]


def in_turn(
    client: distributed.Client, tasks: Iterator[Task], ahead: int
) -> Iterator[tuple[Task, Any]]:
    """Tasks with their results, as they are done; only so many are with the scheduler at a time.

    Raises
    ------
    StudyError
        One of them failed.
    """
    own, count = uuid.uuid4().hex[:8], itertools.count()
    running = distributed.as_completed([], with_results=False)
    sent: dict[str, Task] = {}

    def submit() -> None:
        task = next(tasks, None)
        if task is not None:
            key = f"tpss-{own}-{next(count)}"
            sent[key] = task
            running.add(client.submit(task.function, *task.arguments, key=key, pure=False))

    for _ in range(ahead):
        submit()
    for future in running:
        task = sent.pop(future.key)
        try:
            content = future.result()
        except Exception as error:
            raise StudyError(
                f"{task.name} could not be run ({type(error).__name__}: {error}); the others are kept, "
                "and the same command continues from there"
            ) from error
        future.release()
        submit()
        yield task, content


@contextmanager
def client_of(scheduler: str) -> Iterator[distributed.Client]:
    """Client of a running scheduler.

    Raises
    ------
    StudyError
        It does not answer, or has no workers.
    """
    try:
        client = distributed.Client(scheduler, timeout=CONNECT_S)
    except (OSError, ValueError, TimeoutError) as error:
        raise StudyError(
            f"no scheduler answers at {scheduler} ({error}); start one (dask scheduler), check the "
            "address, or leave --scheduler out for processes on this computer"
        ) from error
    with client:
        if not client.nthreads():
            raise StudyError(
                f"the scheduler at {scheduler} has no workers; start some (dask worker {scheduler})"
            )
        yield client


def prepare_workers(
    client: distributed.Client, prepare: Callable[..., None], *arguments: Any
) -> None:
    """Ensure that workers are of this version and have loaded the kernels.

    One worker on each computer compiles them first, as otherwise every worker would compile them.

    Parameters
    ----------
    client : distributed.Client
    prepare : callable
        Compiles the kernels, or loads them; called with the arguments that follow.

    Raises
    ------
    StudyError
        Workers are of another version.
    """
    try:
        theirs: dict[str, Any] = client.run(versions)
    except Exception as error:
        raise StudyError(
            f"the workers cannot import TPSS ({error}); install the same version there, with its extra "
            "study"
        ) from error
    demand_version(theirs)
    hosts = {urlsplit(address).hostname: address for address in theirs}
    client.run(prepare, *arguments, workers=list(hosts.values()))
    client.run(prepare, *arguments)


def demand_version(workers: Mapping[str, Mapping[str, str]]) -> None:
    """Demand that workers, by their addresses, are of this version.

    Raises
    ------
    StudyError
    """
    for address, version in workers.items():
        if version != versions():
            raise StudyError(
                f"the worker at {address} is of another version ({version}, here {versions()}); install "
                "the same version there"
            )
