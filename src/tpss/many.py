"""Many scenarios, simulated in threads, of which only the key figures are kept."""

import os
import re
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import partial
from itertools import islice
from typing import Any, TypeVar

import numpy as np
from numba.core.errors import NumbaError

from tpss.api import Prepared, build
from tpss.errors import LanesError
from tpss.events import tell
from tpss.files.refusals import reason
from tpss.kernel import compiles
from tpss.lanes.compile import are_compiled
from tpss.lanes.known import covers
from tpss.lanes.structure import structure_of
from tpss.lanes.types import LANES
from tpss.results.key_figures import KeyFigures, run_for_figures
from tpss.scenario.scenario import Scenario
from tpss.step.state import Floats

_Item = TypeVar("_Item")
_Outcome = TypeVar("_Outcome")

AHEAD = 4
"""Highest number of scenarios per thread that are running or waiting."""

STEPS_ALONE = 10_000_000
"""Steps that the cases of a call have, in about as much time as the kernels of lanes take to compile,
before these are compiled without being asked for."""

LEAST = 4
"""Cases below which a batch is not worth its lanes."""


def simulate_many(
    scenarios: Iterable[Scenario | Prepared],
    threads: int | None = None,
    *,
    lanes: bool | None = None,
) -> Iterator[KeyFigures]:
    """Simulate scenarios in threads, and give the key figures of each, in their order.

    Scenarios are drawn as they are needed, so there may be any number of them; memory stays constant.
    The figures are those of `simulate`, whatever the number of threads.  Cases that are alike run in
    lanes, eight at once, where lanes cover them (`tpss.lanes.known`), and say so in ``way``; their
    figures differ by roundings, about 1e-12 of each, and by no more than the load flow's tolerance.

    Parameters
    ----------
    scenarios : iterable of Scenario or Prepared
        A `Prepared` of `tpss.prepare` can be run repeatedly without being rebuilt.
    threads : int, optional
        Number of threads; by default one for each core.
    lanes : bool, optional
        Whether cases may run in lanes, for which more kernels are compiled, in about a minute.  By
        default they do where these are compiled already, and after the cases before have had
        `STEPS_ALONE` steps; where they cannot, they run alone, and the logger ``tpss`` tells why.

    Yields
    ------
    KeyFigures
        Of a line that cannot carry its load, or a train that stalls, too.

    Raises
    ------
    ScenarioError
        As `simulate`, in the turn of the scenario that is at fault.
    TooLargeError
        A run would not fit into memory.
    LanesError
        With ``lanes=True``, if kernels of lanes cannot be made here.
    """
    if lanes is False or not compiles():
        return in_threads(key_figures, scenarios, threads)
    if lanes or are_compiled():
        return _together(scenarios, threads or os.cpu_count() or 1, bool(lanes))
    return _alone_at_first(scenarios, threads or os.cpu_count() or 1)


def in_threads(
    work: Callable[[_Item], _Outcome], items: Iterable[_Item], threads: int | None = None
) -> Iterator[_Outcome]:
    """What comes of items, worked on in threads, in their order; items are drawn as they are needed.

    Parameters
    ----------
    work : callable
        What is done with each.
    items : iterable
    threads : int, optional
        Number of threads; by default one for each core.
    """
    count = threads or os.cpu_count() or 1
    waiting: deque[Future[_Outcome]] = deque()
    with ThreadPoolExecutor(count, thread_name_prefix="tpss") as pool:
        try:
            for item in items:
                if len(waiting) == AHEAD * count:
                    yield waiting.popleft().result()
                waiting.append(pool.submit(work, item))
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def _alone_at_first(scenarios: Iterable[Scenario | Prepared], threads: int) -> Iterator[KeyFigures]:
    """`simulate_many` that takes to lanes when the cases before have had `STEPS_ALONE` steps."""
    drawn, steps = iter(scenarios), 0

    def few() -> Iterator[Scenario | Prepared]:
        for each in drawn:
            yield each
            if steps >= STEPS_ALONE:
                return

    for figures in in_threads(key_figures, few(), threads):
        steps += figures.steps
        yield figures
    yield from _together(drawn, threads, demanded=False)


def _together(
    scenarios: Iterable[Scenario | Prepared], threads: int, demanded: bool
) -> Iterator[KeyFigures]:
    """`simulate_many` with lanes.

    So many cases are drawn as give each thread two full batches; they are built, and sorted by their
    structures, while those that were drawn before run.
    """
    drawn = iter(scenarios)
    waiting: deque[Callable[[], KeyFigures]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="tpss") as pool:
        try:
            while window := list(islice(drawn, 2 * LANES * threads)):
                built = [pool.submit(_built, each) for each in window]
                wait(built)
                before = len(waiting)
                waiting.extend(_submit(built, pool, demanded))
                for _ in range(before):
                    yield waiting.popleft()()
            while waiting:
                yield waiting.popleft()()
        finally:
            pool.shutdown(cancel_futures=True)


def _submit(
    built: list[Future[Prepared]], pool: ThreadPoolExecutor, demanded: bool
) -> list[Callable[[], KeyFigures]]:
    """Start the runs of cases; what waits for the figures of each."""
    alike: dict[Any, list[int]] = {}
    for number, future in enumerate(built):
        if future.exception() is None:
            structure = _structure(future.result())
            alike.setdefault(number if structure is None else structure, []).append(number)
    figures: list[Callable[[], KeyFigures]] = [future.result for future in built]  # type: ignore[misc]
    for numbers in alike.values():
        for first in range(0, len(numbers), LANES):
            some = numbers[first : first + LANES]
            cases = [built[number].result() for number in some]
            if len(some) < LEAST:
                for number, case in zip(some, cases, strict=True):
                    figures[number] = pool.submit(key_figures, case).result
            else:
                batch = pool.submit(_figures_together, cases, demanded)
                for place, number in enumerate(some):
                    figures[number] = partial(_one_of, batch, place)
    return figures


def _one_of(batch: Future[list[KeyFigures]], place: int) -> KeyFigures:
    return batch.result()[place]


def _built(scenario: Scenario | Prepared) -> Prepared:
    return scenario if isinstance(scenario, Prepared) else build(scenario)


def _structure(case: Prepared) -> Any:
    """What cases that run together have in common; None: lanes do not cover this one."""
    return structure_of(case) if covers(case) else None


def _figures_together(cases: Sequence[Prepared], demanded: bool) -> list[KeyFigures]:
    """Key figures of cases of one structure, of those that leave the others too.

    Raises
    ------
    LanesError
        Lanes are demanded, and cannot be used.
    """
    found: Sequence[KeyFigures | None] = [None] * len(cases)
    if demanded or not _unusable:
        try:
            found = _in_lanes(cases)
        except (LanesError, NumbaError, OSError) as error:
            if demanded:
                raise LanesError(
                    f"cases cannot run in lanes: {_why(error)}; leave out lanes=True"
                ) from error
            _do_without(_why(error))
    return [
        key_figures(case) if each is None else each for case, each in zip(cases, found, strict=True)
    ]


def _in_lanes(cases: Sequence[Prepared]) -> list[KeyFigures | None]:
    """Key figures of cases of one structure; None of one that has to run alone."""
    from tpss.lanes.batch import figures_together  # which takes seconds to convert the kernels

    return figures_together(cases)


def _why(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename} cannot be written: {reason(error)}"
    return _COLOURS.sub("", str(error))


_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
"""What numba has for terminals in its messages."""


_unusable: list[str] = []
"""Why lanes cannot be used in this process, once that is known."""

_one_finds_out = threading.Lock()


def _do_without(problem: str) -> None:
    """Let later cases run alone at once, and tell it to those who listen, once a process."""
    with _one_finds_out:
        if _unusable:
            return
        _unusable.append(problem)
    tell("no lanes", problem=problem)


def key_figures(scenario: Scenario | Prepared) -> KeyFigures:
    """Key figures of one scenario.

    Raises
    ------
    ScenarioError, TooLargeError
        As `simulate_many`.
    """
    prepared = _built(scenario)
    return run_for_figures(prepared.start, prepared.frame, prepared.clock, _scratch().allocate)


def _scratch() -> "Scratch":
    """Memory of this thread, to be used anew."""
    scratch: Scratch = _of_this_thread.__dict__.setdefault("scratch", Scratch())
    scratch.reset()
    return scratch


class Scratch:
    """Memory that successive runs reuse."""

    def __init__(self) -> None:
        self._memory: Floats = np.empty(0)
        self._used = 0

    def reset(self) -> None:
        """Release all that was allocated, so that it is used again."""
        self._used = 0

    def allocate(self, size: int) -> Floats:
        """An array of so many numbers, not initialised."""
        begin, self._used = self._used, self._used + size
        if self._used > self._memory.size:
            # Arrays that were allocated before keep the old memory; the next run fits into the new.
            self._memory = np.empty(2 * self._used)
        return self._memory[begin : self._used]


_of_this_thread = threading.local()
