"""What a supply uses in a year of a traffic, and its trains lose, by what has a price."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.planning.cases import CaseList
from tpss.planning.money import Array
from tpss.planning.outcome import trains_per_h
from tpss.planning.period import period_of
from tpss.planning.plan import PlanFile
from tpss.planning.steady import FINISHED
from tpss.scenario.scenario import Scenario

ENERGY, FED_BACK, FIXED = "energy_per_kwh", "fed_back_per_kwh", "fixed"
"""Components with one price for all trains."""

LOST, LATE, NOT_RUN = "lost_minute", "late_minute", "train_not_run"
"""Components with a price for each type of train."""

KWH_PER_MWH = 1e3

POWERS = {"drawn_from_grid_mw": float, "fed_back_to_grid_mw": float}
"""Columns of what stations draw and give back."""

NOISE = 1e-9
"""Share of what is drawn below which what is given back is that of rounding. [1]"""

Row = Mapping[str, Any]
"""Outcome of a case, by the names of its columns."""


@dataclass(frozen=True)
class Trains:
    """Trains of a service."""

    train: str
    """Their type."""
    per_h: float
    is_scheduled: bool


@dataclass(frozen=True)
class Simulated:
    """What was simulated of an area as a whole: what bounds are made from."""

    case_list: CaseList
    number: int
    """Of the area."""
    rows: Mapping[tuple[int, int], Row]
    """Outcomes of the intact supply, by state and configuration."""
    trains: list[dict[str, Trains]]
    """Trains that each state asks for, by service."""

    @property
    def components(self) -> tuple[str, ...]:
        """Names of what has a price."""
        return components_of(self.case_list.plan.file)

    @property
    def hours(self) -> float:
        """Hours of a year in which the traffic runs. [h]"""
        return self.case_list.plan.file.economics.running_hours_per_year

    @property
    def through(self) -> dict[tuple[int, int], Row]:
        """Rows of those that came through."""
        return {key: row for key, row in self.rows.items() if row["status"] == FINISHED}

    def use(self, state: int, configuration: int) -> Array:
        """What one uses in a year that came through, shape (components,)."""
        row = self.rows[state, configuration]
        return use_of(row, self.trains[state], self.components, self.hours)


def gives_back(rows: Any) -> Any:
    """Whether stations give energy back to the grid, in a case that came through, or in each of some."""
    drawn, back = (rows[name] for name in POWERS)
    return back > NOISE * drawn


def components_of(file: PlanFile) -> tuple[str, ...]:
    """Names of what has a price, in the order of the quantities."""
    economics = file.economics
    per_type = [
        f"{key}.{train}" for key in (LOST, LATE, NOT_RUN) for train in getattr(economics, key)
    ]
    paid_for = (FED_BACK,) if economics.fed_back_per_kwh is not None else ()
    return (ENERGY, *paid_for, *per_type, FIXED)


def trains_of(case_list: CaseList, number: int, state: int) -> dict[str, Trains]:
    """Trains that a state of an area asks for, by service."""
    case = next(each for each in case_list.cases if (each.area, each.state) == (number, state))
    scenario = case_list.scenario(case)
    return dict(_trains(scenario, period_of(scenario, case_list.plan.file.evaluate) / 60.0))


def _trains(scenario: Scenario, hours: float) -> Iterator[tuple[str, Trains]]:
    for number, entry in enumerate(scenario.traffic):
        scheduled = entry.arrive_after_min is not None
        yield entry.name, Trains(entry.train, trains_per_h(scenario, number, hours), scheduled)


def use_of(
    row: Row, trains: Mapping[str, Trains], components: tuple[str, ...], hours: float
) -> Array:
    """What a supply uses in a year of a traffic, and its trains lose, shape (components,)."""
    found = dict.fromkeys(components, 0.0)
    found[ENERGY] = row["drawn_from_grid_mw"] * hours * KWH_PER_MWH
    if FED_BACK in found:
        found[FED_BACK] = row["fed_back_to_grid_mw"] * hours * KWH_PER_MWH
    for service, run in trains.items():
        key, column = (LATE, "mean_late_min") if run.is_scheduled else (LOST, "mean_lost_min")
        minutes = float(row[f"service.{service}.{column}"])
        found[f"{key}.{run.train}"] += minutes * run.per_h * hours
    return np.array([found[name] for name in components])
