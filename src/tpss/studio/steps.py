"""Trains of a run, step by step: their motion over the plan, and the table of one of them."""

from typing import Any

import numpy as np

from tpss.errors import ResultError, no_such
from tpss.report.moving import network_moving
from tpss.results.result import Result
from tpss.studio.desk import Desk, Edits
from tpss.studio.packed import packed
from tpss.studio.runs import built, run_for
from tpss.studio.told import table_of

MOST_ROWS = 5_000
"""Steps of a train; a run has more only with very short ones."""

COLUMNS = ("step", "line", "km", "kv", "kmh", "aside")
"""What of each train moves over the plan."""


def moving(result: Result) -> dict[str, Any]:
    """Trains over the plan: steps, lines, places and voltages of each, packed."""
    found = network_moving(result)
    return {
        "step_min": result.dataset.attrs["time_step_s"] / 60.0,
        "steps": result.dataset.sizes["time"] - 1,
        "trains": [
            {"name": train["name"], **{key: packed(_numbers(train[key])) for key in COLUMNS}}
            for train in found["trains"]
        ],
    }


def _numbers(values: list[Any]) -> np.ndarray[Any, Any]:
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def steps_of(desk: Desk, edits: Edits, train: str, interrupted: list[int]) -> dict[str, Any]:
    """Every step of a train, and the names of all trains; without a name the studied one.

    Raises
    ------
    ResultError
        There is no such train.
    ScenarioError, DroppedError
    """
    result = run_for(built(desk.scenario(desk.document(edits))), interrupted)
    if not result.audit["passed"]:
        raise ResultError("the audit failed: the steps of trains cannot be trusted")
    table = result.train_steps
    names = [str(name) for name in table.train.unique()]
    chosen = train or str(result.summary["studied_train"] or (names or [""])[0])
    if chosen not in names:
        problem, remedy = no_such("train", chosen, names)
        raise ResultError(f"{problem}: {chosen!r}; {remedy}")
    own = table[table.train == chosen].drop(columns=["train", "service"])
    return {"train": chosen, "trains": names, **table_of(own.head(MOST_ROWS))}
