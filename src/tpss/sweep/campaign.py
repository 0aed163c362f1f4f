"""Run a study: batches to the workers, files into the folder, few at a time.

Workers build a case from its number, so that a few batches and no scenarios wait for them, whatever the
number of cases.
"""

import os
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tpss.events import tell
from tpss.sweep.batch import (
    Plan,
    batch_size,
    file_of_killer,
    run_batch,
    run_case,
    run_cases,
    warm_up,
)
from tpss.sweep.check import TRIAL_CASES, TRIAL_S, check, spread, time_per_case
from tpss.sweep.design import Design, design_of
from tpss.sweep.folder import (
    FORMAT,
    FORMAT_KEY,
    STEP_CHECK,
    Folder,
    Ranges,
    batches,
    missing,
)
from tpss.sweep.processes import Work, in_processes, trial
from tpss.sweep.progress import Advance
from tpss.sweep.step_sample import sample_steps
from tpss.sweep.study import Study
from tpss.sweep.versions import versions

WORTHWHILE_S = 4.0
"""Computing time from which on processes are started, which takes them some seconds. [s]"""


@dataclass(frozen=True)
class Estimate:
    """Expected time of a study, each part of which has been measured."""

    cases: int
    case_s: float
    """Time of a case in a process, while as many as are expected run."""
    workers: int
    before_s: float
    """Time until the first case is run: checks, a measurement, and the start of processes."""

    @property
    def whole_s(self) -> float:
        """Time of all."""
        return self.before_s + self.cases * self.case_s / self.workers


def estimate(study: Study, workers: int | None = None, *, step_check: bool = False) -> Estimate:
    """Check a study, and measure some of its cases and all that comes before the first.

    Parameters
    ----------
    study : Study
    workers : int, optional
        Number of processes, as of `run_study`.
    step_check : bool
        Whether the study will make some of its cases with half their step.

    Raises
    ------
    ScenarioError
        It has faults.
    """
    design = design_of(study)
    run_case(design, 0)  # which compiles
    started = time.perf_counter()
    names = check(design)
    if step_check:
        sample_steps(design)
    case_s = time_per_case(design)
    before_s = time.perf_counter() - started
    count = processes_for(design.cases, case_s, workers)
    if count > 1:
        plan = Plan(study.as_json(), names.stations, names.services)
        each = max(1, min(TRIAL_CASES, round(TRIAL_S / case_s)))
        tried = list(spread(design.cases, count * each))
        prepare, run = partial(warm_up, plan), partial(run_cases, plan)
        start_s, case_s = trial(prepare, run, tried, min(count, len(tried)))
        before_s += start_s
    return Estimate(design.cases, case_s, count, before_s)


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
        Address of a Dask scheduler; by default processes of this computer are started.
    workers : int, optional
        Number of these processes; by default one for each core.
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
        # Closed at once, whatever ends it: the processes end with it.
        with closing(_results(design, plan, todo, scheduler, workers)) as results:
            for first, end, content in results:
                target.add(first, end, content)
                count += end - first
                tell("cases", name=study.file.name, done=count, cases=design.cases)
                if report is not None:
                    report(Advance(design.cases, count, before, time.perf_counter() - started))
    return Advance(design.cases, count, before, time.perf_counter() - started)


def _results(
    design: Design,
    plan: Plan,
    todo: Ranges,
    scheduler: str | None,
    workers: int | None,
) -> Generator[tuple[int, int, bytes], None, None]:
    """Cases from the first to the one before the second, and their rows, as they are done."""
    if not todo:
        return
    # This also compiles the kernels, before any worker does.
    case_s = time_per_case(design)
    left = sum(end - first for first, end in todo)
    if scheduler is not None:
        # Dask takes long to import, and is needed here only.
        from tpss.sweep.cluster import batches_on_cluster

        yield from batches_on_cluster(plan, todo, scheduler, case_s)
        return
    count = processes_for(left, case_s, workers)
    cut = batches(todo, batch_size(left, case_s, count))
    if count == 1:
        yield from ((first, end, run_batch(plan, first, end)) for first, end in cut)
    else:
        killer = partial(_rows_of_killer, plan)
        work = Work(partial(warm_up, plan), partial(_batch, plan), _name, _halves, killer)
        yield from ((*batch, rows) for batch, rows in in_processes(work, cut, count))


def _batch(plan: Plan, batch: tuple[int, int]) -> bytes:
    return run_batch(plan, *batch)


def _halves(batch: tuple[int, int]) -> Sequence[tuple[int, int]]:
    first, end = batch
    middle = (first + end) // 2
    return ((first, middle), (middle, end)) if middle > first else ()


def _rows_of_killer(plan: Plan, batch: tuple[int, int]) -> bytes:
    return file_of_killer(plan, batch[0])


def _name(batch: tuple[int, int]) -> str:
    return f"cases {batch[0]} to {batch[1] - 1}"


def processes_for(left: int, case_s: float, workers: int | None) -> int:
    """Processes that run so many cases: this one only, if that is done before others have started."""
    if workers is None and left * case_s < WORTHWHILE_S:
        return 1
    return min(workers or os.cpu_count() or 1, left)
