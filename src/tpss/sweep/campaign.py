"""Run a study on Dask: batches to the workers, files into the folder, few at a time.

Workers build a case from its number, so that the scheduler holds a few batches and no scenarios,
whatever the number of cases.
"""

import itertools
import os
import time
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import distributed

from tpss.errors import StudyError
from tpss.sweep.batch import Plan, run_batch, warm_up
from tpss.sweep.check import check, time_per_case
from tpss.sweep.design import Design, design_of
from tpss.sweep.folder import FORMAT, FORMAT_KEY, STEP_CHECK, Folder, batches, missing
from tpss.sweep.step_sample import sample_steps
from tpss.sweep.study import Study
from tpss.sweep.versions import versions

BATCH_S = 1.0
"""Approximate time of a batch: a hundred times the overhead of Dask and the file system. [s]"""

MOST_IN_BATCH = 5_000

BATCHES_AHEAD = 2
"""Batches per worker that are running or waiting."""

CONNECT_S = 10.0
"""How long a scheduler may take to answer. [s]"""


@dataclass(frozen=True)
class Advance:
    """Progress of a study."""

    cases: int
    done: int
    """Finished cases."""
    before: int
    """Cases that were finished at the start."""
    elapsed_s: float


@dataclass(frozen=True)
class Estimate:
    """Expected time of a study."""

    cases: int
    case_s: float
    """Time of a case in one process, without compilation."""
    workers: int

    @property
    def whole_s(self) -> float:
        """Time of all cases."""
        return self.cases * self.case_s / self.workers


def estimate(study: Study, workers: int | None = None) -> Estimate:
    """Check a study, and measure some of its cases.

    Raises
    ------
    ScenarioError
        It has faults.
    """
    design = design_of(study)
    check(design)
    case_s = time_per_case(design)
    return Estimate(design.cases, case_s, workers or os.cpu_count() or 1)


def run_study(
    study: Study,
    folder: str | Path,
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    report: Callable[[Advance], None] | None = None,
    step_check: bool = False,
) -> Advance:
    """Run the cases of a study that its folder does not hold yet.

    Parameters
    ----------
    study : Study
    folder : path
        Made, or continued if it holds a part of this study.
    scheduler : str, optional
        Address of a Dask scheduler; by default a local cluster is started.
    workers : int, optional
        Processes of the local cluster; by default one for each core.
    report : callable, optional
        Called after every batch.
    step_check : bool
        Whether to make a few of the cases again with half their step, once in the life of a study:
        what moves then stands in its ``study.json``, as ``step_check``.

    Raises
    ------
    ScenarioError
        The study has faults.
    StudyError
        The folder is another study's or cannot be written, or the scheduler does not answer.
    """
    design = design_of(study)
    target = Folder(Path(folder))
    manifest = {
        FORMAT_KEY: FORMAT,
        "name": study.file.name,
        "study_hash": study.digest,
        **versions(),
    }
    with target.opened({**manifest, "study": study.as_json()}) as begun:
        started, done = time.perf_counter(), target.done()
        todo = missing(done, design.cases)
        before = design.cases - sum(end - first for first, end in todo)
        count = before
        names = check(design)
        plan = Plan(study.as_json(), names.stations, names.services)
        if step_check and STEP_CHECK not in begun:
            target.add_to_manifest(STEP_CHECK, sample_steps(design))
        for first, end, content in _results(design, plan, todo, scheduler, workers):
            target.add(first, end, content)
            count += end - first
            if report is not None:
                report(Advance(design.cases, count, before, time.perf_counter() - started))
    return Advance(design.cases, count, before, time.perf_counter() - started)


def _results(
    design: Design,
    plan: Plan,
    todo: list[tuple[int, int]],
    scheduler: str | None,
    workers: int | None,
) -> Iterator[tuple[int, int, bytes]]:
    """Cases from the first to the one before the second, and their rows, as they are done."""
    if not todo:
        return
    # This also compiles the kernels, before any worker does.
    case_s = time_per_case(design)
    with client_of(scheduler, workers) as client:
        threads = sum(client.nthreads().values())
        prepare_workers(client, warm_up, plan)
        left = sum(end - first for first, end in todo)
        size = max(1, min(MOST_IN_BATCH, round(BATCH_S / case_s), -(-left // (4 * threads))))
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
def client_of(scheduler: str | None, workers: int | None) -> Iterator[distributed.Client]:
    """Client of a running scheduler, or of a local cluster that ends with it."""
    if scheduler is None:
        with _local_cluster(workers) as cluster, distributed.Client(cluster) as client:
            yield client
        return
    try:
        client = distributed.Client(scheduler, timeout=CONNECT_S)
    except (OSError, ValueError, TimeoutError) as error:
        raise StudyError(
            f"no scheduler answers at {scheduler} ({error}); start one (dask scheduler), check the "
            "address, or leave --scheduler out for a local cluster"
        ) from error
    with client:
        if not client.nthreads():
            raise StudyError(
                f"the scheduler at {scheduler} has no workers; start some (dask worker {scheduler})"
            )
        yield client


def _local_cluster(workers: int | None) -> distributed.LocalCluster:
    """Processes of one thread each on this computer."""
    try:
        return distributed.LocalCluster(
            n_workers=workers or os.cpu_count() or 1,
            threads_per_worker=1,
            dashboard_address="127.0.0.1:0",  # any free port, as 8787 may be taken
            silence_logs=50,
        )
    except (OSError, RuntimeError, TimeoutError) as error:
        raise StudyError(
            f"the workers cannot be started ({error}); run it again, or with fewer --workers"
        ) from error


def prepare_workers(
    client: distributed.Client, warm_up: Callable[..., None], *arguments: Any
) -> None:
    """Ensure that workers are of this version and have loaded the kernels.

    One worker on each computer compiles them first, as otherwise every worker would compile them.

    Parameters
    ----------
    client : distributed.Client
    warm_up : callable
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
    client.run(warm_up, *arguments, workers=list(hosts.values()))
    client.run(warm_up, *arguments)


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
