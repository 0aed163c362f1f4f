"""Files that were made for a page, kept until they are taken."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from threading import Lock

MOST_KEPT = 4
"""Files that are kept; the oldest one goes first."""


@dataclass(frozen=True)
class Made:
    """A file: its name, content, type and headers of its own."""

    name: str
    content: bytes
    media_type: str
    headers: Mapping[str, str]


@dataclass
class Shelf:
    """Files that were made, by the numbers in their addresses."""

    _made: dict[int, Made] = field(default_factory=dict)
    _last: int = 0
    _lock: Lock = field(default_factory=Lock)

    def put(self, made: Made) -> int:
        """Keep a file, in place of the oldest one."""
        with self._lock:
            self._last = number = self._last + 1
            self._made[number] = made
            while len(self._made) > MOST_KEPT:
                del self._made[next(iter(self._made))]
            return number

    def get(self, number: int) -> Made | None:
        """The file of a number, if it is still there."""
        return self._made.get(number)
