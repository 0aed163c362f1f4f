"""Many scenarios, simulated in threads, of which only the key figures are kept."""

import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

import numpy as np

from tpss.api import Prepared, build
from tpss.results.key_figures import KeyFigures, run_for_figures
from tpss.scenario.scenario import Scenario
from tpss.step.state import Floats

_Item = TypeVar("_Item")
_Outcome = TypeVar("_Outcome")

AHEAD = 4
"""Highest number of scenarios per thread that are running or waiting."""


def simulate_many(
    scenarios: Iterable[Scenario | Prepared], threads: int | None = None
) -> Iterator[KeyFigures]:
    """Simulate scenarios in threads, and give the key figures of each, in their order.

    Scenarios are drawn as they are needed, so there may be any number of them; memory stays constant.
    The figures are those of `simulate`, whatever the number of threads.

    Parameters
    ----------
    scenarios : iterable of Scenario or Prepared
        A `Prepared` of `tpss.prepare` can be run repeatedly without being rebuilt.
    threads : int, optional
        Number of threads; by default one for each core.

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
    """
    return in_threads(key_figures, scenarios, threads)


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


def key_figures(scenario: Scenario | Prepared) -> KeyFigures:
    """Key figures of one scenario.

    Raises
    ------
    ScenarioError, TooLargeError
        As `simulate_many`.
    """
    prepared = scenario if isinstance(scenario, Prepared) else build(scenario)
    scratch = _of_this_thread.__dict__.setdefault("scratch", Scratch())
    scratch.reset()
    return run_for_figures(prepared.start, prepared.frame, prepared.clock, scratch.allocate)


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
