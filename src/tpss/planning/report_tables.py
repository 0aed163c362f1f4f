"""Tables of a plan's report: decisions, costs, values, what configurations carry."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd

from tpss.planning.wording import (
    component_in_words,
    number,
    traffic_in_words,
    varied_in_words,
)
from tpss.planning.written import Written
from tpss.report.tables import Cell, Table, cell, of_frame

MOST_CELLS, MOST_COLUMNS = 1_500, 40
"""Cells and columns of a table of the page; those in the folder have all."""

YEARS = ("in_service", "ordered")
"""Columns of years, which may be missing."""

MORE = {"surplus": "more than the best"}


def tables_of(written: Written) -> list[Table]:
    """All tables of a plan's answer."""
    return [
        decisions(written),
        first_decisions(written),
        *([best_plans(written)] if len(written.tables["best_plans"]) else []),
        *([_budget(written)] if written.file.budget else []),
        *(costs(written, kind) for kind in ("discounted", "plain")),
        _shown(
            "regret", "Regret: what each plan costs more than the best one would, were the scenario "
            f"known [{written.money}]", written, written.tables["regret"],
        ),
        switching_values(written),
        configurations(written),
        *_numbered_traffic(written),
    ]  # fmt: skip


def values(written: Written) -> Table:
    """What the plan, knowledge and freedom are worth."""
    frame = written.tables["values"]
    shown = pd.DataFrame({"": frame.meaning, f"[{written.money}]": frame.cost})
    return of_frame("values", "What the plan is worth", shown)


def decisions(written: Written) -> Table:
    """What is ordered and in service when, if which scenarios may still come."""
    frame = written.tables["decisions"]
    caption = (
        "Decisions: what comes into service when, if which scenarios may still come "
        f"[{written.money}]"
    )
    names = {"operation_per_year": "operation a year"}
    return _shown("decisions", caption, written, frame.rename(columns=names))


def first_decisions(written: Written) -> Table:
    """Every first decision with what the best plan costs that contains it."""
    frame = written.tables["first_decisions"]
    caption = f"First decisions, each with the best plan that contains it [{written.money}]"
    return _shown("first-decisions", caption, written, frame.rename(columns=MORE))


def best_plans(written: Written) -> Table:
    """The best plans, a row each, with what is in service where they are not all alike."""
    frame = written.tables["best_plans"]
    several = frame.area.nunique() > 1
    where = [
        f"{f'{area}: ' if several else ''}{year} if {written.futures_in_words(futures)}"
        for area, year, futures in zip(frame.area, frame.in_service, frame["if"], strict=True)
    ]
    wide = frame.assign(where=where).pivot_table(
        index=["rank", "cost", "surplus"], columns="where", values="configuration",
        aggfunc="first", sort=False,
    )  # fmt: skip
    wide = wide.loc[:, wide.nunique() > 1].reset_index()
    caption = (
        f"The best {len(wide)} plans, with what is in service where they differ [{written.money}]"
    )
    return cut("best-plans", caption, wide.rename(columns=MORE))


def costs(written: Written, kind: str) -> Table:
    """Costs of the plan by component and stage, a column a scenario, and the expected one.

    Parameters
    ----------
    written : Written
    kind : {"plain", "discounted"}
    """
    frame = written.tables["costs"]
    chances = {name: each.probability for name, each in written.futures.items()}
    wide = frame.pivot_table(
        index=["component", "stage"], columns="scenario", values=kind, sort=False
    )
    wide = wide[[name for name in chances if name in wide]]
    if len(chances) > 1:
        wide.insert(
            0, "expected", sum(wide[name] * p for name, p in chances.items() if name in wide)
        )
    wide = wide[(wide != 0.0).any(axis=1)].reset_index()
    wide["component"] = [component_in_words(each) for each in wide.component]
    total = {"component": "all", "stage": None, **wide.iloc[:, 2:].sum().to_dict()}
    wide["stage"] = wide.stage.astype(object)
    wide = pd.concat([wide, pd.DataFrame([total])], ignore_index=True)
    caption = f"Costs of the plan, {kind} [{written.money}]"
    return cut(f"costs-{kind}", caption, _whole(wide, ("stage",)))


def switching_values(written: Written) -> Table:
    """Values at which the first decision turns, and to what."""
    frame = written.tables["switching_values"]
    frame = frame.assign(key=[varied_in_words(key) for key in frame.key])
    caption = "Where the first decision turns: each number alone, the others as they are"
    shown = _shown("switching-values", caption, written, frame)
    exact = {k: name for k, name in enumerate(shown.headings) if name in ("now", "below", "above")}
    rows = [
        [_exact(float(frame[exact[k]].iloc[r])) if k in exact else one for k, one in enumerate(row)]
        for r, row in enumerate(shown.rows)
    ]
    return replace(shown, rows=rows)


def _exact(value: float) -> Cell:
    """A number in four digits, however small it is."""
    if math.isnan(value):
        return cell(None, "")
    return Cell(number(value), f"{value:.7g}", is_number=True)


def configurations(written: Written) -> Table:
    """Every configuration with every traffic: whether it carries it, why not, and its outcome."""
    return _shown(
        "configurations",
        "Configurations: what they carry, and what is simulated",
        written,
        written.tables["configurations"],
    )


def _budget(written: Written) -> Table:
    """What is spent of the budget of each stage, if which scenarios may still come."""
    per_stage = written.file.budget.per_stage if written.file.budget else ()
    limits = dict(zip(written.file.stages.start, per_stage, strict=True))
    frame = written.tables["decisions"]
    spent = frame.groupby(["in_service", "if"], sort=False).spent.sum().reset_index()
    spent["budget"] = [limits[year] for year in spent.in_service]
    return _shown("budget", f"Budget, and what is spent of it [{written.money}]", written, spent)


def _numbered_traffic(written: Written) -> Iterable[Table]:
    """Values of states of traffic that have numbers."""
    for k, (area, states) in enumerate(written.traffic.items()):
        words = traffic_in_words(states)
        if words.numbered:
            rows = [{"traffic": words.full[name], **states[name].values} for name in states]
            caption = f"Traffic of {area}" if len(written.areas) > 1 else "Traffic"
            yield cut(f"traffic-{k}", caption, pd.DataFrame(rows))


def _shown(key: str, caption: str, written: Written, frame: pd.DataFrame) -> Table:
    """A table with its traffic in words, without the area where there is one only."""
    frame = _whole(frame, YEARS)
    if "if" in frame:
        frame["if"] = [written.futures_in_words(text) for text in frame["if"]]
    words = {area: traffic_in_words(states).full for area, states in written.traffic.items()}
    for name in ("traffic", "traffic_asked_for", "traffic_run"):
        if name in frame:
            pairs = zip(frame.area, frame[name], strict=True)
            frame[name] = [words[area].get(state, state) for area, state in pairs]
    if len(written.areas) == 1 and "area" in frame:
        frame = frame.drop(columns="area")
    return cut(key, caption, frame)


def cut(key: str, caption: str, frame: pd.DataFrame) -> Table:
    """Table of a pandas table; of a wide or long one the first columns and rows, which it says."""
    columns = min(len(frame.columns), MOST_COLUMNS)
    rows = min(len(frame), MOST_CELLS // max(columns, 1))
    lacks = [
        f"{shown} of {there} {what}"
        for shown, there, what in (
            (rows, len(frame), "rows"),
            (columns, len(frame.columns), "columns"),
        )
        if shown < there
    ]
    if lacks:
        caption += f" (the first {' and '.join(lacks)}; the folder of the plan has all)"
    return of_frame(key, caption, frame.iloc[:rows, :columns])


def _whole(frame: pd.DataFrame, names: Iterable[str]) -> pd.DataFrame:
    """A table whose years are whole numbers, or missing."""
    years: Mapping[str, Any] = {
        name: [None if pd.isna(year) else int(year) for year in frame[name]]
        for name in names
        if name in frame
    }
    return frame.assign(
        **{name: pd.Series(each, frame.index, object) for name, each in years.items()}
    )
