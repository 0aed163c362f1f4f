"""Write a table where it was asked for, or at the first free place among the results."""

import os
from collections.abc import Sequence
from pathlib import Path

from tpss.errors import ResultError
from tpss.files import whole
from tpss.files.refusals import explained, refuse_to_replace
from tpss.results.store import PARENT


def save_table(
    content: bytes, stem: str, out: Path | None, force: bool, beside: Sequence[str] = ()
) -> Path:
    """Write a table, whole or not at all; print it if it cannot be written, so that nothing is lost.

    Parameters
    ----------
    content : bytes
        Of the file, CSV.
    stem : str
        Beginning of its name, if none is given.
    out : Path or None
        The file; None: ``results/<stem>-001.csv``, ``-002``, ... whichever is free first.
    force : bool
        Whether a file may be replaced.
    beside : sequence of str
        Suffixes of files that will stand beside it, and must be free too.

    Raises
    ------
    ResultError
        It cannot be written.
    """
    try:
        return _write(content, stem, out, force, beside)
    except ResultError:
        print(content.decode())
        raise


def _write(content: bytes, stem: str, out: Path | None, force: bool, beside: Sequence[str]) -> Path:
    if out is not None:
        with explained(out):
            refuse_to_replace(out, force, "a file", Path.is_file)
            out.parent.mkdir(parents=True, exist_ok=True)
            whole.write_file(out, content)
        return out
    number = 1
    while True:
        place = PARENT / f"{stem}-{number:03d}.csv"
        with explained(place):
            PARENT.mkdir(exist_ok=True)
            taken = (place, *(place.with_suffix(suffix) for suffix in beside))
            if not any(map(os.path.lexists, taken)):
                whole.write_file(place, content)
                return place
        number += 1
