"""Several files of a folder, which are written all or none."""

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from tpss.errors import ResultError
from tpss.files.refusals import ANOTHER, explained, refuse_to_replace
from tpss.files.whole import real, settle, write_file, write_new
from tpss.files.workplace import NEW, OLD, clear_left, workplace

JOURNAL = "journal.json"
"""File of a workplace: which files are about to be put into their places, and which were there."""


def check_files(folder: Path, names: Iterable[str], force: bool) -> None:
    """Find out whether files can be written into a folder.

    Raises
    ------
    ResultError
        The folder is not one, or files exist and may not be replaced.
    """
    _clear_left(real(folder))
    if os.path.lexists(folder) and not folder.is_dir():
        raise ResultError(f"{folder} is not a folder; {ANOTHER}")
    there = [folder / name for name in names if os.path.lexists(folder / name)]
    if there and not force:
        more = f" (and {len(there) - 1} more)" if len(there) > 1 else ""
        raise ResultError(f"{there[0]}{more} exists already; {ANOTHER}, or --force to replace it")
    for place in there:
        refuse_to_replace(place, force, "a file", Path.is_file)


def save_files(folder: Path, contents: Mapping[str, bytes], force: bool) -> list[Path]:
    """Write files into a folder, all of them or none; the folder is made if it is not there.

    Names may be those of files in folders within it, parted by slashes.

    Raises
    ------
    ResultError
        As `check_files`, or the folder cannot be written.
    """
    target = real(folder)
    _clear_left(target)
    with explained(folder), workplace(_named(target), take_back) as work:
        new = work / NEW
        new.mkdir()
        for name, content in contents.items():
            (new / name).parent.mkdir(parents=True, exist_ok=True)
            write_new(new / name, content)
        check_files(folder, contents, force)
        if target.exists():
            _move_files(work, target)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            new.rename(target)
    return [folder / name for name in contents]


def _named(target: Path) -> Path:
    """By what the workplaces of a folder are named: they lie within it, or where it is to be."""
    return target / "export"


def _clear_left(target: Path) -> None:
    """Put right what killed processes left in a folder, or above it while it was not there."""
    for folder in (target, target.parent):
        clear_left(_named(folder), take_back)


def _move_files(work: Path, target: Path) -> None:
    """Put written files into a folder; if one cannot be moved, everything is restored."""
    new, old = work / NEW, work / OLD
    names = sorted(file.relative_to(new).as_posix() for file in new.rglob("*") if file.is_file())
    there = [name for name in names if os.path.lexists(target / name)]
    write_file(work / JOURNAL, json.dumps({"names": names, "there": there}).encode())
    settle(work)
    try:
        for name in names:
            if name in there:
                (old / name).parent.mkdir(parents=True, exist_ok=True)
                (target / name).rename(old / name)
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            (new / name).rename(target / name)
    except BaseException:
        take_back(work)
        raise
    settle(target)
    (work / JOURNAL).unlink()


def take_back(work: Path) -> None:
    """Bring a folder back to what it held before files of a workplace were put into it."""
    target, journal = work.parent, work / JOURNAL
    if not journal.exists():
        return
    listed = json.loads(journal.read_text())
    for name in listed["names"]:
        if (work / OLD / name).exists():
            (work / OLD / name).replace(target / name)
        elif name not in listed["there"] and not (work / NEW / name).exists():
            (target / name).unlink(missing_ok=True)
    settle(target)
    journal.unlink()
