"""Files that are there whole, and on the disk, or not at all."""

import os
import time
from contextlib import suppress
from pathlib import Path
from secrets import token_hex
from typing import BinaryIO

UNFINISHED = ".unfinished"
"""Ends the name of a file that is being written."""

ABANDONED_S = 3600.0
"""What is unfinished and has not been written to for so long is not being written. [s]"""

Content = bytes | memoryview


def write_file(place: Path, content: Content) -> None:
    """Write a file, or replace one, whole or not at all, whoever else writes it at the same time.

    Raises
    ------
    OSError
    """
    clear_unfinished(place)
    unfinished = place.with_name(f".{place.name}-{token_hex(4)}{UNFINISHED}")
    try:
        write_new(unfinished, content)
        unfinished.replace(place)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise
    settle(place.parent)


def write_new(place: Path, content: Content) -> None:
    """Write a file that must not be there.

    Raises
    ------
    OSError
    """
    with place.open("xb") as file:
        _write_through(file, content)


def _write_through(file: BinaryIO, content: Content) -> None:
    """Write into a file through to the disk."""
    file.write(content)
    file.flush()
    os.fsync(file.fileno())


def clear_unfinished(place: Path) -> None:
    """Remove what processes that ended while they wrote a file have left of it."""
    for left in place.parent.glob(f".{literal(place.name)}-*{UNFINISHED}"):
        with suppress(OSError):  # it may be gone, or not ours
            if is_abandoned(left):
                left.unlink()


def is_abandoned(left: Path) -> bool:
    """Whether something unfinished has not been written to for so long that nobody works on it."""
    return time.time() - left.stat().st_mtime > ABANDONED_S


def literal(name: str) -> str:
    """A name as a pattern that fits nothing else."""
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)


def settle(folder: Path) -> None:
    """Write the names in a folder through to the disk, where the system can."""
    if os.name == "nt":
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def real(folder: Path) -> Path:
    """A folder's place on the disk, links followed."""
    return Path(os.path.realpath(folder))
