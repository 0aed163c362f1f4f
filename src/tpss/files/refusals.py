"""What is refused before anything is written, and a message for an error of the system."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tpss.errors import ResultError, TpssError

ANOTHER = "give another --out"


def reason(error: Exception) -> str:
    """Why the system refused something, without the place, which the message names anyway."""
    return str(getattr(error, "strerror", None) or error)


@contextmanager
def explained(
    place: Path,
    remedy: str = ANOTHER,
    kind: type[TpssError] = ResultError,
    within: bool = False,
) -> Iterator[None]:
    """Turn an error of the system into one that says what cannot be written, why, and what to do.

    Parameters
    ----------
    place : Path
    remedy : str
    kind : type
        Of the error that is raised.
    within : bool
        Whether the file within `place` is named that the system names.
    """
    try:
        yield
    except OSError as error:
        named = (error.filename if within else None) or place
        raise kind(f"{named} cannot be written: {reason(error)}; {remedy}") from error


def refuse_to_replace(place: Path, force: bool, what: str, is_one: Callable[[Path], bool]) -> None:
    """Refuse to replace what is there, unless `force` is set and it is of the expected sort.

    Raises
    ------
    ResultError
    """
    if not os.path.lexists(place):
        return
    if not force:
        raise ResultError(f"{place} exists already; {ANOTHER}, or --force to replace it")
    if not is_one(place):
        raise ResultError(f"{place} is not {what}, so it is not replaced; {ANOTHER}")
