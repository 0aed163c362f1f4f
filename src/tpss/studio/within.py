"""Files that a scenario names: below the opened folder, or not at all."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding

ENDINGS = (".toml", ".csv", ".xlsx", ".xlsm", ".parquet", ".json")
"""Ends of names of files that a scenario may refer to."""

KEYS = ("file", "_file")
"""Ends of keys whose values are names of files."""


def files_outside(document: Mapping[str, Any], source: Path, folder: Path) -> list[Finding]:
    """Findings on names of files that lie outside a folder, by whatever way they lead there.

    Parameters
    ----------
    document : mapping
        Of a scenario.
    source : Path
        Its file, beside which relative names lie.
    folder : Path
        The opened folder, its links followed.
    """
    remedy = f"name one below {folder}, or open a folder that holds it: tpss studio --folder"
    return [
        Finding(str(source), key, repr(name), "a file outside the opened folder", remedy)
        for key, name in _names(document, "")
        if not (source.parent / name).resolve().is_relative_to(folder)
    ]


def _names(part: Any, path: str) -> Iterator[tuple[str, str]]:
    """Key paths and values of all texts that may name files."""
    if isinstance(part, Mapping):
        for key, inside in part.items():
            yield from _names(inside, f"{path}.{key}" if path else str(key))
    elif isinstance(part, list | tuple):
        for number, inside in enumerate(part):
            yield from _names(inside, f"{path}.{number}")
    elif isinstance(part, str) and (path.endswith(KEYS) or part.lower().endswith(ENDINGS)):
        yield path, part
