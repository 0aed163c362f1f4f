"""Timetables that vary in a study: files and densities are values like others.

Otherwise the trains of timetables are put into the traffic of the base scenario once and for all.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from tpss.scenario.inline_tables import with_timetables
from tpss.scenario.timetable_rows import text_of_timetable
from tpss.sweep.settings import Settings, apply

TIMETABLES, FILE = "timetables", "file"


def is_of_timetables(path: str) -> bool:
    """Whether a key path leads to a timetable."""
    return path.split(".", 1)[0] == TIMETABLES


def texts_of(
    base: Mapping[str, Any], varied: Iterable[tuple[str, Any]], source: Path
) -> dict[str, str]:
    """What the files of all timetables hold that cases may name; nothing unless timetables vary.

    Parameters
    ----------
    base : mapping
        Document of the base scenario.
    varied : iterable of str and value
        Key paths of what varies, and values at their ends.
    source : Path
        The scenario file, next to which they are.

    Raises
    ------
    ScenarioError
        One cannot be read.
    """
    own = [(path, value) for path, value in varied if is_of_timetables(path)]
    if not own:
        return {}
    tables = [(f"{TIMETABLES}.{i}", each) for i, each in enumerate(base.get(TIMETABLES, ()))]
    named: dict[str, str] = {}
    for key, value in [*tables, *own]:
        name = value.get(FILE) if isinstance(value, Mapping) else value
        if isinstance(name, str) and (isinstance(value, Mapping) or key.endswith(f".{FILE}")):
            named.setdefault(name, key)
    return {name: text_of_timetable(source.parent / name, key) for name, key in named.items()}


def apply_timetables(
    document: dict[str, Any],
    settings: Settings,
    texts: Mapping[str, str],
    source: Path,
    base_source: Path,
) -> Settings:
    """Set what concerns timetables, and put their trains into the traffic; give the other values.

    Raises
    ------
    ScenarioError
        A path leads to no place, or a timetable has faults.
    """
    own = {path: value for path, value in settings.items() if is_of_timetables(path)}
    apply(document, own, source)
    with_timetables(document, base_source, texts)
    return {path: value for path, value in settings.items() if path not in own}
