"""What many cases have in common, made once: a bounded store by all that it is made of.

Cases of a study or a plan differ in little.  What is kept is only read, and its key holds the content of
all that it depends on, not where that came from: a case gets what it would have made itself.
"""

import threading
from collections.abc import Callable, Hashable
from typing import Any, Generic, TypeVar

import numpy as np

_Value = TypeVar("_Value")


class Kept(Generic[_Value]):
    """The values that were made last, up to a number of them.  Threads may share it."""

    def __init__(self, most: int) -> None:
        self.most = most
        self._values: dict[Hashable, _Value] = {}
        self._lock = threading.Lock()

    def of(self, key: Hashable, make: Callable[[], _Value]) -> _Value:
        """The value of a key; it is made if it is not there, in place of the one that was made first.

        What raises an error is not kept: it raises it again.
        """
        found = self.get(key)
        if found is not None:
            return found
        value = make()
        self.put(key, value)
        return value

    def get(self, key: Hashable) -> _Value | None:
        """The value of a key, if there is one."""
        return self._values.get(key)

    def put(self, key: Hashable, value: _Value) -> None:
        """Keep a value, in place of another one of its key, or of the one that was made first."""
        with self._lock:
            self._values.pop(key, None)
            self._values[key] = value
            while len(self._values) > self.most:
                del self._values[next(iter(self._values))]

    def __len__(self) -> int:
        return len(self._values)


def content_of(part: Any) -> Hashable:
    """Content of an array, or of a tuple of arrays and numbers, as a key: equal where all bytes are."""
    if isinstance(part, np.ndarray):
        return part.shape, np.asarray(part).tobytes()
    if isinstance(part, tuple):
        return tuple(content_of(each) for each in part)
    number: Hashable = part
    return number
