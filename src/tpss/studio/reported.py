"""Reports and workbooks of what is open, with the words of their author, as files to take away."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tpss.errors import ResultError
from tpss.report.cover import Cover
from tpss.report.html import report
from tpss.report.tables import Cell, Table, cell
from tpss.results.result import Result
from tpss.studio.desk import Desk, Edits
from tpss.studio.runs import built, run_for
from tpss.studio.shelf import Made
from tpss.studio.variants import compared

WORDS = ("title", "project", "author", "remarks")
"""What an author may say."""

COLUMNS = {
    "lowest_kv": ("lowest voltage [kV]", "kV"),
    "peak_loading_percent": ("peak loading [%]", "%"),
    "trip_min": ("trip [min]", "min"),
    "late_min": ("late [min]", "min"),
    "energy_mwh": ("energy [MWh]", "MWh"),
    "losses_mwh": ("losses [MWh]", "MWh"),
    "violations": ("violations", ""),
}
"""Figures of variants, with their headings and units."""

OF_HTML = {
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
    "sandbox allow-scripts allow-downloads allow-modals"
}
"""A report runs its own script, and reaches neither the network nor the studio."""


def made(
    desk: Desk, edits: Edits, kind: str, words: Mapping[str, Any], interrupted: list[int]
) -> Made:
    """A report or a workbook of the scenario with edits.

    Parameters
    ----------
    desk, edits, interrupted
        As elsewhere.
    kind : str
        Of `KINDS`.
    words : mapping
        What the author says, by `WORDS`.

    Raises
    ------
    ResultError
        There is no such kind.
    ScenarioError, DroppedError
        The scenario has faults; a newer request came.
    """
    if kind not in KINDS:
        raise ResultError(f"there is no file of the kind {kind!r}; kinds: {', '.join(KINDS)}")
    scenario = desk.scenario(desk.document(edits))
    result = run_for(built(scenario), interrupted, step_check=True)
    said = {name: str(words.get(name, "")) for name in WORDS}
    cover = Cover(**said, variants=_table(compared(desk, edits, interrupted)))
    return KINDS[kind](result, cover)


def _html(result: Result, cover: Cover) -> Made:
    text = report(result, cover=cover)
    return Made(f"{result.scenario.name}-report.html", text.encode(), "text/html", OF_HTML)


def _workbook(result: Result, _: Cover) -> Made:
    with tempfile.TemporaryDirectory() as folder:
        file = result.to_excel(Path(folder) / "result.xlsx")
        content = file.read_bytes()
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
    return Made(f"{result.scenario.name}.xlsx", content, kind, {})


KINDS: dict[str, Callable[[Result, Cover], Made]] = {"html": _html, "xlsx": _workbook}
"""Kinds of files, and how they are made."""


def _table(found: Mapping[str, Any]) -> Table | None:
    """Variants side by side, as the report shows them; None if there is nothing to compare."""
    rows = found["rows"]
    if len(rows) < 2:
        return None
    headings = ["variant", "ended", *(heading for heading, _ in COLUMNS.values())]
    return Table("variants", "Variants", headings, [_row(row) for row in rows])


def _row(row: Mapping[str, Any]) -> list[Cell]:
    ended = row.get("fault") or row["status"]
    figures = [cell(row.get(name), unit) for name, (_, unit) in COLUMNS.items()]
    return [cell(row["name"], ""), cell(ended, ""), *figures]
