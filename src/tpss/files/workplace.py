"""Hidden folders in which something is made ready, and what killed processes have left in them.

While a process works in such a folder, it holds its lock; the system lets go of it when the process
ends, in whatever manner.  So a folder whose lock is free has been left behind, and whoever comes next
puts things right and removes it.
"""

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from tpss.files.exchange import exchange
from tpss.files.whole import is_abandoned, literal, settle

LOCK, NEW, OLD = "lock", "new", "replaced"
"""Files and folders of a workplace: its lock, what is made ready, and what that replaces."""

TRIAL_BYTES = 2**16
"""A disk without space for so many bytes is full."""

PutRight = Callable[[Path], None]
"""What is done about a workplace that was left behind, before it is removed."""


def nothing_to_put_right(_: Path) -> None:
    """Of what was left behind, nothing is of any use."""


@contextmanager
def workplace(target: Path, put_right: PutRight = nothing_to_put_right) -> Iterator[Path]:
    """A hidden folder to work in, on the disk of the nearest folder above `target` that exists.

    Parameters
    ----------
    target : Path
        What is to be made.
    put_right : callable
        Called first for every workplace of the same target that was left behind, and for this one if
        the work ends in an error.
    """
    clear_left(target, put_right)
    work, lock = _locked(target)
    is_right = True
    try:
        yield work
    except BaseException:
        is_right = _can_put_right(work, put_right)
        raise
    finally:
        if is_right:
            _empty(work)
        lock.release()
        if is_right:
            _remove(work)


def _can_put_right(work: Path, put_right: PutRight) -> bool:
    """Put a workplace right if the system lets us; else it is left to whoever comes next."""
    try:
        put_right(work)
    except OSError:
        return False
    return True


def _above(target: Path) -> Path:
    """The nearest folder above that exists, in which workplaces of a target are made."""
    return next(folder for folder in target.parents if os.path.lexists(folder))


def _locked(target: Path) -> tuple[Path, FileLock]:
    """A new hidden folder, and its lock, which is held.

    Between the two, another process may take the folder for one that was left behind, and remove it;
    then the next one is made.
    """
    while True:
        work = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=_above(target)))
        lock = FileLock(work / LOCK)
        try:
            lock.acquire()
        except OSError:
            if work.exists():
                _remove(work)
                raise
            continue
        if (work / LOCK).exists():
            return work, lock
        lock.release()


def _empty(work: Path) -> None:
    """Remove everything from a workplace but its lock, as far as that can be done."""
    for path in work.iterdir():
        if path.name != LOCK and path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        elif path.name != LOCK:
            with suppress(OSError):
                path.unlink()


def _remove(work: Path) -> None:
    """Remove a workplace with its lock, which nobody holds; not one in which something is left."""
    with suppress(OSError):
        if all(path.name == LOCK for path in work.iterdir()):
            (work / LOCK).unlink(missing_ok=True)
            work.rmdir()


def clear_left(target: Path, put_right: PutRight = nothing_to_put_right) -> None:
    """Put right and remove what processes that were killed have left of their work on a target."""
    for left in _above(target).glob(f".{literal(target.name)}-*"):
        with suppress(Timeout, OSError):  # somebody works there, or clears it too
            if (left / LOCK).exists():
                with FileLock(left / LOCK, timeout=0):
                    put_right(left)
                    _empty(left)
                    _remove(left)  # while it is held, so that nobody who waits for it works in it
                _remove(left)  # where no file can be removed that is open
            elif is_abandoned(left):
                left.rmdir()  # before it was locked there was nothing in it


def try_out(target: Path) -> None:
    """Write a trial file next to a folder to be made, to prove that it can be made."""
    with workplace(target) as work:
        (work / "trial").write_bytes(bytes(TRIAL_BYTES))


def put_in_place(work: Path, target: Path, carry_over: Callable[[Path, Path], None]) -> None:
    """Move the new folder of a workplace to its target; one that it replaces is removed afterwards.

    Where the system cannot let them take each other's place in one step, there is none for a moment;
    `restore` then finds the old one.

    Parameters
    ----------
    work, target : Path
    carry_over : callable
        Moves what is to be kept of the old folder into the new one.
    """
    new, old = work / NEW, work / OLD
    if not target.exists():
        new.rename(target)
    elif not exchange(new, target):
        target.rename(old)
        try:
            new.rename(target)
        except BaseException:
            old.rename(target)
            raise
    settle(target.parent)
    _carry_over_all(work, target, carry_over)


def _carry_over_all(work: Path, target: Path, carry_over: Callable[[Path, Path], None]) -> None:
    """Move what is to be kept of what was replaced, wherever in the workplace it lies."""
    for replaced in (work / NEW, work / OLD):
        if replaced.exists():
            carry_over(replaced, target)


def restore(work: Path, target: Path, carry_over: Callable[[Path, Path], None]) -> None:
    """Finish or undo a `put_in_place` of a process that was killed."""
    old = work / OLD
    if old.exists() and not target.exists():
        old.rename(target)
    if target.exists():
        _carry_over_all(work, target, carry_over)
