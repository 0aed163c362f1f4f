"""Files that are read whole: of a bounded size, and nothing but files, which end."""

import errno
import os
import stat
from pathlib import Path

from tpss.printable import in_nfc

MEGABYTE = 1_000_000

_KINDS = (
    (stat.S_ISDIR, errno.EISDIR, "Is a directory"),
    (stat.S_ISFIFO, errno.EINVAL, "it is a pipe, not a file"),
    (stat.S_ISSOCK, errno.EINVAL, "it is a socket, not a file"),
    (stat.S_ISCHR, errno.EINVAL, "it is a device, not a file"),
    (stat.S_ISBLK, errno.EINVAL, "it is a device, not a file"),
)
"""What is no file, by its mode; and how the system or we call that."""


def read_bytes(path: Path, most_bytes: int) -> bytes:
    """What is in a file.

    Parameters
    ----------
    path : Path
    most_bytes : int
        Longer files are not read.

    Raises
    ------
    OSError
        It cannot be read, is no file, such as a pipe, which might never end, or is longer.
    ValueError
        The path is none.
    """
    # Without waiting: a pipe is opened at once, to be refused, and not when somebody writes into it.
    handle = os.open(
        _as_stored(path), os.O_RDONLY | _without_waiting() | getattr(os, "O_BINARY", 0)
    )
    with open(handle, "rb") as file:  # noqa: PTH123  (of a handle, not of a path)
        _demand_file(os.fstat(handle), most_bytes)
        content = file.read(most_bytes + 1)
    if len(content) > most_bytes:  # it has grown
        raise _too_long(len(content), most_bytes)
    return content


def demand_readable(path: Path, most_bytes: int) -> None:
    """Refuse what `read_bytes` would, for those who leave the reading to others.

    Raises
    ------
    OSError
    """
    _demand_file(path.stat(), most_bytes)


def _demand_file(status: os.stat_result, most_bytes: int) -> None:
    for is_one, number, words in _KINDS:
        if is_one(status.st_mode):
            raise OSError(number, words)
    if status.st_size > most_bytes:
        raise _too_long(status.st_size, most_bytes)


def _without_waiting() -> int:
    return getattr(os, "O_NONBLOCK", 0)  # Windows has no such pipes


def _too_long(found: int, most: int) -> OSError:
    words = f"it has {found / MEGABYTE:.3g} MB, more than the {most / MEGABYTE:g} MB that are read"
    return OSError(errno.EFBIG, words)


def _as_stored(path: Path) -> Path:
    """A path as its file is called: the name of a file may be in another form of Unicode."""
    if path.name.isascii() or path.exists():
        return path
    alike = (each for each in _beside(path) if in_nfc(each.name) == in_nfc(path.name))
    return next(alike, path)


def _beside(path: Path) -> list[Path]:
    return list(path.parent.iterdir()) if path.parent.is_dir() else []
