"""The file that explains columns: its form, and whether it fits a table."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, shortened, suggest
from tpss.measured.times import COUNTED_S

KEYS = ("time", "time_unit", "ignore", "columns")
OF_A_COLUMN = ("quantity", "element", "unit", "factor")


def faults_of_map(file: Path, document: Mapping[str, Any], names: list[str]) -> Iterator[Finding]:
    """What is wrong with a file that explains columns of a table.

    Parameters
    ----------
    file : Path
    document : mapping
        What it says.
    names : list of str
        Columns of the table.
    """
    for key, value, problem, remedy in (
        *_of_form(document),
        *_of_columns(document.get("columns", {})),
        *_of_names(document, names),
    ):
        yield Finding(str(file), key, shortened(repr(value)), problem, remedy)


Fault = tuple[str, object, str, str]
"""Key, value, problem and remedy."""


def _of_form(document: Mapping[str, Any]) -> Iterator[Fault]:
    for key, value in document.items():
        if key not in KEYS:
            yield key, value, "no such key", suggest(key, KEYS)
    unit = document.get("time_unit", "s")
    if unit not in list(COUNTED_S):
        yield "time_unit", unit, "not a unit of time", f"choose from {', '.join(COUNTED_S)}"
    ignored = document.get("ignore", [])
    if not isinstance(ignored, list):
        yield "ignore", ignored, "not a list", 'write a list of columns, ["remark"]'


def _of_columns(given: object) -> Iterator[Fault]:
    if not isinstance(given, Mapping):
        yield "columns", given, "not a table", 'write a table [columns."NAME"] for each column'
        return
    for name, entry in given.items():
        if not isinstance(entry, Mapping):
            remedy = f"write quantity, element and unit below [columns.{name!r}]"
            yield f"columns.{name}", entry, "not a table", remedy
            continue
        for key in entry:
            if key not in OF_A_COLUMN:
                remedy = suggest(key, OF_A_COLUMN)
                yield f"columns.{name}.{key}", entry[key], "no such key", remedy


def _of_names(document: Mapping[str, Any], names: list[str]) -> Iterator[Fault]:
    """Columns that the table does not have, and those that are named twice."""
    ignored, given = document.get("ignore"), document.get("columns")
    named = [("time", document["time"])] if "time" in document else []
    named += [("ignore", each) for each in ignored] if isinstance(ignored, list) else []
    named += [(f"columns.{each}", each) for each in given] if isinstance(given, Mapping) else []
    for k, (key, name) in enumerate(named):
        if name not in names:
            yield key, name, "the table has no such column", suggest(str(name), names)
        elif name in (before := [each for _, each in named[:k]]):
            first = named[before.index(name)][0]
            yield key, name, f"the column is named in {first} too", "leave it out of one of them"
