"""Of the runs that a page asks for, only the newest one counts."""

from threading import Lock

from tpss.errors import TpssError

MOST_PAGES = 64
"""Pages that are remembered; one opened anew is another one."""


class DroppedError(TpssError):
    """A newer run of the same page was asked for."""


class Newest:
    """Numbers of the newest runs of pages, and lists that end older ones once they are filled."""

    def __init__(self) -> None:
        self._runs: dict[str, tuple[int, list[int]]] = {}
        self._lock = Lock()

    def begin(self, page: str, number: int) -> list[int]:
        """End the run before, and give the list that ends this one.

        Raises
        ------
        DroppedError
            The page has begun a newer one.
        """
        with self._lock:
            before = self._runs.pop(page, None)
            if before is not None and before[0] > number:
                self._runs[page] = before
                raise DroppedError("a newer run was asked for")
            if before is not None:
                before[1].append(number)
            interrupted: list[int] = []
            self._runs[page] = number, interrupted
            while len(self._runs) > MOST_PAGES:
                _, oldest = self._runs.pop(next(iter(self._runs)))
                oldest.append(number)
            return interrupted
