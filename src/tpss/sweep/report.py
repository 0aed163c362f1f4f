"""A report of a study: one HTML file, in the manner of that of a run."""

import math
from pathlib import Path
from typing import Any

import pandas as pd
from plotly.graph_objects import Figure

from tpss import units
from tpss.files.refusals import explained
from tpss.files.whole import write_file
from tpss.report import tables
from tpss.report.html import check_target
from tpss.report.page import fill
from tpss.report.render.interactive import render
from tpss.report.tables import Table, cell
from tpss.report.validity import limits_of_validity
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import DEVIATION, MEAN
from tpss.sweep.figures import FIGURES, PAIR, SHADE, drawable, one_in
from tpss.sweep.folder import STEP_CHECK
from tpss.sweep.outcome import (
    KEPT,
    LOST,
    OVERLOADED,
    Outcome,
    demand_cases,
    heading,
    load_outcome,
)
from tpss.sweep.step_sample import sample_in_words
from tpss.sweep.summary import SHOWN, Summary, summarise
from tpss.sweep.variation import Variation

HEIGHTS = {"parallel": 560, "trade-offs": 520}
"""Heights of the plots. [px]"""

IN_WORDS = {
    KEPT: "carry their load with no station beyond its rating",
    OVERLOADED: "carry their load with a station beyond its rating",
    LOST: "do not carry their load: voltages collapse, or a train stalls",
}

MOST_SHOWN = 20_000
"""Cases that a page holds; of more, one in so many."""

DIGITS = 7
"""Of numbers in the page; the table holds all."""


def write_study_report(folder: str | Path, file: str | Path, *, force: bool = False) -> Path:
    """Write a report of a study into one HTML file.

    Parameters
    ----------
    folder : path
        Folder of the study, which need not be finished.
    file : path
        File to write.
    force : bool
        Whether a report that is there may be replaced.

    Raises
    ------
    StudyError
        The folder is not that of a study, or no case ran.
    ResultError
        The file exists, or cannot be written.
    """
    place = Path(file)
    check_target(place, force)
    text = study_report(load_outcome(Path(folder)), Path(folder))
    with explained(place):
        place.parent.mkdir(parents=True, exist_ok=True)
        write_file(place, text.encode())
    return place


def study_report(outcome: Outcome, folder: Path) -> str:
    """Page about a study.

    Raises
    ------
    StudyError
        No case ran and passed its audit.
    """
    demand_cases(outcome, folder)
    study = outcome.study
    summary = summarise(outcome.table, outcome.design.cases)
    sample = outcome.manifest.get(STEP_CHECK)
    first = int(outcome.ran["case"].iloc[0])
    seen = outcome.one_in(-(-len(outcome.table) // MOST_SHOWN))
    return fill(
        "study.html",
        f"{study.file.name}: study",
        _figures(seen),
        _data(seen, folder),
        scripts=("report.js", "study.js"),
        name=study.file.name,
        about=study.file.description,
        base=study.base_source.name,
        made_by=outcome.manifest.get("tpss_version", ""),
        summary=summary,
        groups=[(IN_WORDS[name], len(rows), name == KEPT) for name, rows in outcome.groups.items()],
        problems=list(summary.problems.items())[:5],
        step_check="" if sample is None else sample_in_words(sample),
        varied=_varied(outcome),
        spread=_spread(summary),
        numbers=[name for name in _columns(outcome) if not outcome.axis(name).levels],
        chosen=_chosen(outcome),
        heading=heading,
        cases=_cases(outcome),
        one_in=one_in(seen),
        left_out=len(outcome.table) - len(seen.table),
        folder=str(folder),
        validity=limits_of_validity([scenario_of(outcome.design, first)]),
    )


def _figures(outcome: Outcome) -> dict[str, Figure]:
    """The plots, of key figures that differ."""
    return {name: render(FIGURES[name](outcome), HEIGHTS[name]) for name in drawable(outcome)}


def _columns(outcome: Outcome) -> list[str]:
    return [*outcome.varied, *outcome.figures]


def _chosen(outcome: Outcome) -> list[str]:
    """Columns that the plot of two figures shows at first."""
    order = [name for name in (*PAIR, SHADE, *outcome.figures) if name in outcome.figures]
    return (list(dict.fromkeys(order)) * 3)[:3]


def _data(outcome: Outcome, folder: Path) -> dict[str, Any]:
    """What the page's script knows of the cases."""
    columns = []
    for name in _columns(outcome):
        axis = outcome.axis(name)
        values = [None if math.isnan(v) else float(f"{v:.{DIGITS}g}") for v in axis.values.tolist()]
        columns.append(
            {"key": name, "label": axis.label, "values": values, "levels": list(axis.levels)}
        )
    return {
        "study": {
            "cases": outcome.ran["case"].tolist(),
            "status": outcome.ran["status"].tolist(),
            "columns": columns,
            "folder": str(folder),
            "name": outcome.study.file.name,
        }
    }


def _varied(outcome: Outcome) -> Table:
    """What varies, and its values."""
    rows = []
    for name, parameter in outcome.design.parameters.items():
        unit = units.label("_permille") if name in (MEAN, DEVIATION) else units.label(name)
        rows.append([cell(text, "") for text in (name, _values_of(parameter), unit)])
    return Table("varied", "What varied", ("key path", "values", "unit"), rows)


def _values_of(parameter: Variation) -> str:
    if parameter.values is None:
        low, high = parameter.ends
        return f"{low:g} to {high:g}"
    return ", ".join(str(value) for value in parameter.values)


def _spread(summary: Summary) -> Table:
    rows = [
        [cell(str(label), ""), *(cell(float(value), "") for value in row)]
        for label, row in zip(
            summary.spread.index, summary.spread.itertuples(index=False), strict=True
        )
    ]
    headings = ("of the cases that finished", *map(str, summary.spread.columns))
    return Table("spread", "Key figures", headings, rows)


def _cases(outcome: Outcome) -> Table:
    """All cases, those that were not run too."""
    shown = [n for n in SHOWN if n in outcome.table and outcome.table[n].notna().any()]
    columns = ["case", *outcome.varied, "status", *shown]
    frame: pd.DataFrame = outcome.table[columns]
    table = tables.of_frame("cases", "Cases", frame)
    return Table(table.key, table.caption, [heading(name) for name in columns], table.rows)
