"""First sheets of a workbook: what was run and what came out, and the scenario by its key paths."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import pandas as pd

from tpss import units
from tpss.results.workbook import MOST_TEXT

if TYPE_CHECKING:
    from tpss.results.result import Result

SUMMARY_SHEET, SCENARIO_SHEET = "summary", "scenario"

TOLD_APART = (
    "result_format", "name", "description", "status", "audit", "provenance", "step_check", "step_choice",
)  # fmt: skip
"""Parts of a summary that are no key figures: the first rows tell of them, the audit's come last."""


def overview(result: "Result") -> dict[str, pd.DataFrame]:
    """Tables by the names of their sheets, which come before those of the result."""
    summary = result.summary
    ran = {
        "scenario": summary["name"],
        "description": summary["description"],
        "status": summary["status"],
        "audit": "passed" if summary["audit"]["passed"] else "failed",
        "TPSS version": summary["provenance"]["tpss_version"],
        "simulated": summary["provenance"]["created"],
    }
    if laws := summary["provenance"].get("laws"):
        ran["laws of other packages"] = laws
    figures = {key: value for key, value in summary.items() if key not in TOLD_APART}
    audit = {key: value for key, value in summary["audit"].items() if key != "passed"}
    rows: list[tuple[str, Any, str]] = [(name, value, "") for name, value in ran.items()]
    for part in (figures, {"audit": audit}):
        for path, value in _leaves(part, ()):
            rows.append((_in_words(path), value, _unit_of(path)))
    scenario = [
        (".".join(path), value, _unit_of(path))
        for path, value in _leaves(result.scenario.as_document(), ())
    ]
    return {SUMMARY_SHEET: _table("name", rows), SCENARIO_SHEET: _table("key", scenario)}


def _table(first: str, rows: list[tuple[str, Any, str]]) -> pd.DataFrame:
    return pd.DataFrame(rows, columns=[first, "value", "unit"], dtype=object)


def _leaves(value: Any, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Values of tables and lists with their key paths; a list of plain values is one of them."""
    if isinstance(value, Mapping):
        for key, below in value.items():
            yield from _leaves(below, (*path, str(key)))
    elif isinstance(value, list | tuple):
        text = ", ".join(map(str, value))
        if any(isinstance(each, Mapping | list | tuple) for each in value) or len(text) > MOST_TEXT:
            for i, below in enumerate(value):
                yield from _leaves(below, (*path, str(i)))
        elif value:
            yield path, text
    elif value is not None:
        yield path, value


def _in_words(path: tuple[str, ...]) -> str:
    return ": ".join(units.words(key) or key for key in path)


def _unit_of(path: tuple[str, ...]) -> str:
    """Unit of the last key that has one: those below it are names, such as of stations."""
    return next((unit for key in reversed(path) if (unit := units.label(key))), "")
