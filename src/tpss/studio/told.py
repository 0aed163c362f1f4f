"""What a run comes to, as a page tells it: verdicts, key figures and tables, of plain types."""

import math
from typing import Any

from tpss import units
from tpss.report import tables
from tpss.report.status import STATUS_IN_WORDS
from tpss.report.validity import limits_of_validity
from tpss.results.notes import notes
from tpss.results.result import Result
from tpss.results.step_words import step_lines

MOST_TOLD = 50
"""Sentences of a kind."""


def told_of(result: Result) -> dict[str, Any]:
    """Verdicts, key figures, violations and validity of a run.

    Of a run whose audit failed there are no figures: they cannot be trusted.
    """
    summary, outage = result.summary, result.scenario.outage
    trusted, stepped = bool(result.audit["passed"]), result.dataset.sizes["time"] > 1
    violations: list[Any] = list(result.standards.violations.words) if trusted and stepped else []
    return {
        "status": result.status,
        "status_words": STATUS_IN_WORDS[result.status],
        "outage": outage.name if outage else None,
        "outage_words": outage.in_words if outage else "",
        "problem": summary.get("problem", ""),
        "advice": summary.get("advice", ""),
        "audit": {"passed": trusted, "failures": list(map(str, result.audit["failures"]))},
        "violations": [str(words) for words in violations[:MOST_TOLD]],
        "violation_count": len(violations),
        "step_min": summary["time_step_min"],
        "step_lines": step_lines(summary),
        "validity": limits_of_validity([result.scenario]),
        "figures": _figures(result) if trusted else [],
        "stations": table_of(result.stations) if trusted else None,
    }


def notes_of(result: Result) -> dict[str, Any]:
    """What takes longer, and is told once the hand rests: step error and notes."""
    check = result.summary.get("step_check") or {}
    return {
        "step_lines": step_lines(result.summary),
        "within": check.get("within"),
        "notes": [*notes(result), *result.standards.notes][:MOST_TOLD],
    }


def _figures(result: Result) -> list[list[Any]]:
    """Key figures, each its words, unit, value, and decimals."""
    return [
        [words, unit, plain(value), tables.DIGITS.get(unit, 2)]
        for words, unit, value in tables.key_figures(result)
    ]


def table_of(frame: Any) -> dict[str, Any]:
    """A table of pandas as headings, their units, and rows."""
    names = [str(name) for name in frame.columns]
    rows = [[plain(value) for value in row] for row in frame.itertuples(index=False)]
    return {
        "headings": [units.words(name) for name in names],
        "units": [units.label(name) for name in names],
        "digits": [tables.DIGITS.get(units.label(name), 2) for name in names],
        "rows": rows,
    }


def plain(value: Any) -> Any:
    """A value that JSON knows; None for a number that is none, text for all else."""
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, bool | int | str):
        return value
    return str(value)
