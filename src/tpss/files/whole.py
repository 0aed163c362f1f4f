"""Files and folders that are there whole, and on the disk, or not at all."""

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

TRIAL_BYTES = 2**16
"""A disk without space for so many bytes is full."""

Content = bytes | memoryview


def write_file(place: Path, content: Content) -> None:
    """Write a file, or replace one, whole or not at all.

    Raises
    ------
    OSError
    """
    unfinished = place.with_name(f"{place.name}.unfinished")
    try:
        _write(unfinished, content, "wb")
        unfinished.replace(place)
    except OSError:
        unfinished.unlink(missing_ok=True)
        raise


def write_new(place: Path, content: Content) -> None:
    """Write a file that must not be there.

    Raises
    ------
    OSError
    """
    _write(place, content, "xb")


def _write(place: Path, content: Content, mode: str) -> None:
    """Write a file through to the disk."""
    with place.open(mode) as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def real(folder: Path) -> Path:
    """A folder's place on the disk, links followed."""
    return Path(os.path.realpath(folder))


@contextmanager
def folder_beside(target: Path) -> Iterator[Path]:
    """A hidden folder to work in, on the disk of the nearest folder above `target` that exists."""
    parent = next(folder for folder in target.parents if os.path.lexists(folder))
    with tempfile.TemporaryDirectory(
        prefix=f".{target.name}-", dir=parent, ignore_cleanup_errors=True
    ) as work:
        yield Path(work)


def try_out(target: Path) -> None:
    """Write a trial file next to a folder to be made, to prove that it can be made."""
    with folder_beside(target) as work:
        (work / "trial").write_bytes(bytes(TRIAL_BYTES))


def move_folder(
    new: Path, target: Path, old: Path, carry_over: Callable[[Path, Path], None]
) -> None:
    """Put a written folder into its place; one that it replaces is removed only afterwards.

    Parameters
    ----------
    new, target, old : Path
        The folder, its place, and where one that it replaces is kept meanwhile.
    carry_over : callable
        Moves what is to be kept of the old folder into the new one.
    """
    try:
        if target.exists():
            target.rename(old)
        new.rename(target)
    finally:
        if old.exists() and not target.exists():
            old.rename(target)
    if old.exists():
        carry_over(old, target)
        shutil.rmtree(old, ignore_errors=True)
