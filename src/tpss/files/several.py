"""Several files of a folder, which are written all or none."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from tpss.errors import ResultError
from tpss.files.refusals import ANOTHER, explained, refuse_to_replace
from tpss.files.whole import folder_beside, real, write_new


def check_files(folder: Path, names: Iterable[str], force: bool) -> None:
    """Find out whether files can be written into a folder.

    Raises
    ------
    ResultError
        The folder is not one, or files exist and may not be replaced.
    """
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

    Raises
    ------
    ResultError
        As `check_files`, or the folder cannot be written.
    """
    target = real(folder)
    with explained(folder), folder_beside(target / "export") as work:
        new, old = work / "new", work / "old"
        new.mkdir()
        old.mkdir()
        for name, content in contents.items():
            write_new(new / name, content)
        check_files(folder, contents, force)
        if target.exists():
            _move_files(new, target, old)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            new.rename(target)
    return [folder / name for name in contents]


def _move_files(new: Path, target: Path, old: Path) -> None:
    """Put written files into a folder; if one cannot be moved, everything is restored."""
    moved: list[str] = []
    try:
        for file in sorted(new.iterdir()):
            place = target / file.name
            if os.path.lexists(place):
                place.rename(old / file.name)
            file.rename(place)
            moved.append(file.name)
    except BaseException:
        for name in moved:
            (target / name).unlink()
        for file in old.iterdir():
            file.rename(target / file.name)
        raise
