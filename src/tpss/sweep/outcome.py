"""The finished cases of a study's folder, as its report, its figures and its export show them."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from tpss import units
from tpss.errors import StudyError
from tpss.report.drawings.study import Axis
from tpss.report.sampling import Indices
from tpss.sweep.design import Design, design_of
from tpss.sweep.folder import load_table, read_manifest
from tpss.sweep.study import Study, study_of_json
from tpss.sweep.summary import SHOWN

SET = "set."

PROFILE = "set.gradients.profile"

KEPT, OVERLOADED, LOST = "within the rating", "overloaded", "not carried"
"""Groups of cases: no station beyond its rating, one or more, and lines that cannot carry their load."""


@dataclass(frozen=True)
class Outcome:
    """A study and the table of its cases so far."""

    study: Study
    table: pd.DataFrame
    manifest: dict[str, Any]

    def one_in(self, count: int) -> "Outcome":
        """The study with one in so many of its cases."""
        return self if count == 1 else replace(self, table=self.table.iloc[::count])

    @cached_property
    def design(self) -> Design:
        """Its cases by their numbers."""
        return design_of(self.study)

    @cached_property
    def ran(self) -> pd.DataFrame:
        """Cases that were simulated and passed their audit."""
        usable = self.table["status"].isin(("finished", "collapsed", "stalled"))
        passed = self.table["audit_passed"] == True  # noqa: E712, it may be null
        return self.table[usable & passed].reset_index(drop=True)

    @property
    def varied(self) -> list[str]:
        """Columns of parameters that differ among the cases; numbers of drawn profiles mean nothing."""
        return [
            str(name)
            for name in self.table
            if str(name).startswith(SET)
            and not str(name).endswith(PROFILE)
            and self.table[name].nunique(dropna=False) > 1
        ]

    @property
    def figures(self) -> list[str]:
        """Columns of key figures that cases have, and that differ."""
        return [name for name in SHOWN if name in self.ran and self.ran[name].nunique() > 1]

    def axis(self, column: str) -> Axis:
        """Values of a column in the cases that ran; what came of a line that collapsed is no figure."""
        values, label = self.ran[column], heading(column)
        if pd.api.types.is_numeric_dtype(values) and not pd.api.types.is_bool_dtype(values):
            numbers = values.to_numpy(dtype=float, na_value=np.nan)
            if column in SHOWN:
                numbers = np.where(self.ran["status"] == "finished", numbers, np.nan)
            return Axis(label, numbers)
        texts = values.astype(str)
        levels = list(dict.fromkeys(sorted(texts)))
        return Axis(label, texts.map(levels.index).to_numpy(dtype=float), levels)

    @property
    def groups(self) -> dict[str, Indices]:
        """Rows of the cases that ran, by what came of them; only groups that have some."""
        finished = (self.ran["status"] == "finished").to_numpy()
        beyond = (self.ran["peak_loading"] > 1.0).to_numpy()
        every = {KEPT: finished & ~beyond, OVERLOADED: finished & beyond, LOST: ~finished}
        return {name: np.flatnonzero(rows) for name, rows in every.items() if rows.any()}


def heading(column: str) -> str:
    """Heading of a column: of a parameter its key path, which ends with its unit."""
    if column.startswith(SET):
        return column.removeprefix(SET)
    return SHOWN.get(column) or units.heading(column)


def load_outcome(folder: Path) -> Outcome:
    """The study of a folder.

    Raises
    ------
    StudyError
        It is no folder of a study, or has no cases yet.
    """
    manifest = read_manifest(folder)
    return Outcome(study_of_json(manifest["study"]), load_table(folder), manifest)


def demand_cases(outcome: Outcome, folder: Path) -> None:
    """Refuse a study of which no case was simulated.

    Raises
    ------
    StudyError
    """
    if outcome.ran.empty:
        raise StudyError(f"no case of {folder} ran and passed its audit; see tpss sweep --summary")
