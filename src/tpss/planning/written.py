"""A plan that was solved, as its folder tells it: all that its report needs, without its scenarios."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from tpss.errors import PlanError
from tpss.files.refusals import reason
from tpss.planning.excel import HOLDS
from tpss.planning.load import ONLY_FUTURE, read_plan_file
from tpss.planning.plan import Future, PlanFile
from tpss.planning.plan_faults import PRICES
from tpss.planning.states import State, at_stage
from tpss.planning.write import PLAN, TABLES, read_document

TEXTS = (
    "area", "if", "builds", "configuration", "traffic_asked_for", "traffic_run", "component", "scenario",
    "plan", "value", "meaning", "traffic", "why_not", "key", "first", "below_to", "above_to",
    "known",
)  # fmt: skip
"""Columns that hold text, also where it looks like a number."""

MOST_NAMED = 6
"""Futures that are named; of more the first ones."""

ANY = "any of them"
"""Stands for all futures."""


@dataclass(frozen=True)
class Written:
    """What a folder says of its plan."""

    document: dict[str, Any]
    """All of ``plan.json``."""
    file: PlanFile
    tables: dict[str, pd.DataFrame]
    """By name."""

    @property
    def areas(self) -> list[str]:
        """Names of the areas, as in the tables."""
        return list(self.file.areas) or [self.file.name]

    @property
    def money(self) -> str:
        """Currency and year of all prices."""
        return f"{self.file.economics.currency} of {self.file.economics.price_year}"

    @property
    def futures(self) -> dict[str, Future]:
        """What may come, by name."""
        return self.file.scenarios or {ONLY_FUTURE: Future(probability=1.0)}

    def futures_in_words(self, text: str) -> str:
        """Futures that may still come, as tables tell them, in short words."""
        names = text.split(" or ")
        if len(names) == len(self.futures) > 1:
            return ANY
        if len(names) > MOST_NAMED:
            return f"{', '.join(names[: MOST_NAMED - 1])} or {len(names) - MOST_NAMED + 1} others"
        return text

    def of(self, name: str, area: str) -> pd.DataFrame:
        """Rows of a table that are of an area."""
        table = self.tables[name]
        return table[table.area == area].reset_index(drop=True)

    def rows(self, name: str, area: str) -> list[dict[str, Any]]:
        """Rows of a table that are of an area, by the names of their columns."""
        return rows_of(self.of(name, area))

    @cached_property
    def traffic(self) -> dict[str, dict[str, State]]:
        """States of traffic by area, and by the names that they have in the tables."""
        found: dict[str, dict[str, State]] = {}
        for area in self.areas:
            before = f"{area}." if self.file.areas else ""
            found[area] = {}
            for future in self.futures.values():
                own = {
                    key.removeprefix(before): value
                    for key, value in future.values.items()
                    if key.startswith(before) and key.split(".")[0] != PRICES
                }
                for stage in range(len(self.file.stages.start)):
                    state = State({key: at_stage(value, stage) for key, value in own.items()})
                    found[area].setdefault(state.name, state)
        return found


def rows_of(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of a table by the names of their columns."""
    return [{str(k): value for k, value in row.items()} for row in table.to_dict("records")]


def read_written(folder: Path) -> Written:
    """What the folder of a plan says of it.

    Raises
    ------
    PlanError
        It is no folder of a plan that was solved, or something in it is missing or damaged.
    """
    document = read_document(folder)
    file = read_plan_file(document["plan"], folder / PLAN)
    tables = {}
    for name in HOLDS:
        place = folder / TABLES / f"{name}.csv"
        try:
            tables[name] = _read(place)
        except (OSError, ValueError) as error:
            raise PlanError(
                f"{place} cannot be read: {reason(error)}; run tpss plan run again, which writes it"
            ) from error
    return Written(document, file, tables)


def _read(place: Path) -> pd.DataFrame:
    table = pd.read_csv(
        place, dtype=dict.fromkeys(TEXTS, str), keep_default_na=False, na_values=[""]
    )
    texts = [name for name in TEXTS if name in table]
    return table.fillna(dict.fromkeys(texts, ""))
