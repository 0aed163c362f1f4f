"""Findings that name files as the user did, where these are read by their absolute paths."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from tpss.errors import ScenarioError


@contextmanager
def named_as_given(source: Path, given: str) -> Iterator[None]:
    """Let findings name a file, and those beside it and below, as it was given.

    Parameters
    ----------
    source : Path
        Absolute path of the file.
    given : str
        The path by which it was named.

    Raises
    ------
    ScenarioError
        Raised within, with its files renamed.
    """
    try:
        yield
    except ScenarioError as error:
        findings = [
            replace(each, file=_as_given(each.file, source, given)) for each in error.findings
        ]
        raise ScenarioError(findings) from error


def from_here(path: Path) -> str:
    """A path of which nobody knows how it was named: from the working folder, if it lies there."""
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


def _as_given(file: str, source: Path, given: str) -> str:
    if file.startswith(str(source)):
        return given + file.removeprefix(str(source))
    folder = f"{source.parent}{os.sep}"
    return str(Path(given).parent / file.removeprefix(folder)) if file.startswith(folder) else file
