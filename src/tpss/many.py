"""Many scenarios in threads, of which nothing is kept but the key figures."""

import os
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np

from tpss.api import Prepared, build
from tpss.results.key_figures import KeyFigures, run_for_figures
from tpss.scenario.scenario import Scenario
from tpss.step.state import Floats

AHEAD = 4
"""Scenarios a thread that are begun or wait to be, at most."""


def simulate_many(
    scenarios: Iterable[Scenario | Prepared], threads: int | None = None
) -> Iterator[KeyFigures]:
    """Simulate scenarios in threads, and give the key figures of each, in their order.

    Scenarios are taken as they are needed, so there may be any number of them; memory stays flat.
    The figures are those of `simulate`, whatever the number of threads.

    Parameters
    ----------
    scenarios : iterable of Scenario or Prepared
        A `Prepared` of `tpss.prepare` can be run again and again without being built anew.
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
    count = threads or os.cpu_count() or 1
    waiting: deque[Future[KeyFigures]] = deque()
    with ThreadPoolExecutor(count, thread_name_prefix="tpss") as pool:
        try:
            for scenario in scenarios:
                if len(waiting) == AHEAD * count:
                    yield waiting.popleft().result()
                waiting.append(pool.submit(key_figures, scenario))
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
    rooms = _own.__dict__.setdefault("rooms", Rooms())
    rooms.leave()
    return run_for_figures(prepared.start, prepared.frame, prepared.clock, rooms.take)


class Rooms:
    """Memory that one run after the other works in."""

    def __init__(self) -> None:
        self._room: Floats = np.empty(0)
        self._taken = 0

    def leave(self) -> None:
        """Let all that was taken be taken again."""
        self._taken = 0

    def take(self, size: int) -> Floats:
        """Give an array of so many numbers, whatever they are."""
        begin, self._taken = self._taken, self._taken + size
        if self._taken > self._room.size:
            # Arrays that were given out keep what they lie in; the next run finds room for all.
            self._room = np.empty(2 * self._taken)
        return self._room[begin : self._taken]


_own = threading.local()
