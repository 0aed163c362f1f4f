"""A scenario's file with changes, in which all else, comments too, stays as it was written."""

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import AoT

from tpss.errors import TpssError
from tpss.scenario.override import put_in
from tpss.scenario.paths import ONE_MORE
from tpss.studio.changed import changes_between


class NotSavedError(TpssError):
    """A file cannot be changed without a loss."""


def changed_text(text: str, document: Mapping[str, Any], source: Path) -> str:
    """Text of a file with the changes that make it say another document.

    Parameters
    ----------
    text : str
        Of the file, as TOML.
    document : mapping
        What it is to say.
    source : Path
        Its name, for errors.

    Raises
    ------
    NotSavedError
        The changed text would not say that; nothing is lost, as nothing is written here.
    """
    written = tomlkit.parse(text)
    whole: set[str] = set()
    for path, value in changes_between(tomllib.loads(text), document):
        above = path.rpartition(".")[0]
        if any(path.startswith(f"{each}.") for each in whole):
            continue
        if _is_of_tables(written, above) and not isinstance(value, Mapping | None):
            # A list of tables, each with its heading, cannot hold another value: it is written anew.
            whole.add(above)
            path, value = above, _at(document, above)
        put_in(written, {path: value}, source)
        if path.endswith(f".{ONE_MORE}") and isinstance(value, Mapping):
            _part_from_what_follows(_at(written, above))
    changed = _with_what_is_missing(tomlkit.dumps(written), document)
    if tomllib.loads(changed) != document:
        raise NotSavedError(
            f"{source} is not changed: written into it, the changes would say something else; "
            "copy them from the list of changes"
        )
    return changed


def _with_what_is_missing(text: str, document: Mapping[str, Any]) -> str:
    """A text in which tables that do not say what they should are written anew, without comments.

    So is one that lost its only part, and with it the heading that implied it.
    """
    said = tomllib.loads(text)
    missing = {key: part for key, part in document.items() if said.get(key) != part}
    if not missing:
        return text
    written = tomlkit.parse(text)
    for key, part in missing.items():
        written.pop(key, None)
        written[key] = part
    return tomlkit.dumps(written)


def _at(document: Any, path: str) -> Any:
    """What stands at a path of keys and numbers."""
    for key in path.split("."):
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document


def _is_of_tables(document: Any, path: str) -> bool:
    """Whether a list of tables with headings stands there."""
    found = _at(document, path) if path else None
    return isinstance(found, AoT)


def _part_from_what_follows(items: Any) -> None:
    """Leave an empty line behind a table that was added."""
    if isinstance(items, AoT):
        items[-1].add(tomlkit.nl())


def difference(before: str, after: str, name: str) -> str:
    """Lines that differ between two texts, with those around them."""
    lines = difflib.unified_diff(
        before.splitlines(), after.splitlines(), name, f"{name} (edited)", lineterm=""
    )
    return "\n".join(lines)
