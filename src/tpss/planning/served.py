"""What an area uses and misses in a year, from its outcomes: operation, trains run, trains not run.

A configuration that does not carry the traffic asked for runs less: another state of the plan that it
carries, with no more trains of any service, or no train at all.  What it does not run is missed.  So
every plan is possible, and what a weak supply costs is the value of trains.

Of a plan that is proved by bounds, what was not simulated has those of `tpss.planning.strongest`.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from tpss.errors import Finding, PlanError, ScenarioError
from tpss.planning.cases import INTACT, Case, CaseList
from tpss.planning.money import Array
from tpss.planning.outcome import trains_per_h
from tpss.planning.period import period_of
from tpss.planning.plan import BOUNDS, PlanFile
from tpss.planning.plan_faults import PRICES
from tpss.planning.prices import Flags, Quantities
from tpss.planning.requirements import records_of, verdicts
from tpss.planning.states import State
from tpss.planning.steady import FINISHED
from tpss.planning.strongest import bound_of, strongest
from tpss.planning.tree import Indices
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import DEPARTURES

NO_TRAFFIC = "no train"
"""Names what runs where a configuration carries none of the traffic."""

ENERGY, FED_BACK, FIXED = "energy_per_kwh", "fed_back_per_kwh", "fixed"
"""Components with one price for all trains."""

LOST, LATE, NOT_RUN = "lost_minute", "late_minute", "train_not_run"
"""Components with a price for each type of train."""

KWH_PER_MWH = 1e3


@dataclass(frozen=True)
class Served:
    """What an area uses and misses, and why configurations do not carry traffic."""

    quantities: Quantities
    traffic: tuple[str, ...]
    """Names of the traffic that may be run: the states of the plan, and none."""
    reasons: Mapping[tuple[int, int], list[str]]
    """By state and configuration, of those that were simulated; an empty list: it is carried."""
    is_simulated: Flags
    """Whether what a configuration uses of a traffic was simulated, not a bound, shape (traffic,
    configurations)."""
    bound: Array | None
    """Of a plan that is proved by bounds: least use of a traffic by any configuration, without its
    fixed cost, NaN where none is known, shape (states, components)."""


def components_of(file: PlanFile) -> tuple[str, ...]:
    """Names of what has a price, in the order of the quantities."""
    economics = file.economics
    per_type = [
        f"{key}.{train}" for key in (LOST, LATE, NOT_RUN) for train in getattr(economics, key)
    ]
    paid_for = (FED_BACK,) if economics.fed_back_per_kwh is not None else ()
    return (ENERGY, *paid_for, *per_type, FIXED)


def served(case_list: CaseList, number: int, table: pd.DataFrame, state_of_node: Indices) -> Served:
    """What an area uses and misses in a year.

    Parameters
    ----------
    case_list : CaseList
    number : int
        Of the area.
    table : DataFrame
        Outcomes by digest, of all its cases.
    state_of_node : array of int, shape (nodes,)
        State of traffic that each node of the tree asks for.

    Raises
    ------
    ScenarioError
        A case could not be simulated, or what it feeds back has no price.
    AuditError
        The audit of a case failed.
    PlanError
        A case was not simulated, and has no bound.
    """
    area, file = case_list.areas[number], case_list.plan.file
    own = [case for case in case_list.cases if case.area == number]
    is_bounded = file.evaluate.by == BOUNDS
    if is_bounded:
        own = whole_ones(own, table)
    reasons = verdicts(area, own, table, file.require)
    runs = [_trains(case_list, number, d) for d in range(len(area.states.states))]
    states, configurations = len(area.states.states), len(area.configurations)
    components = components_of(file)
    operation = np.zeros((states + 1, configurations, len(components)))
    carried = np.ones((states + 1, configurations), dtype=np.bool_)
    rows = _intact_rows(own, table)
    _demand_payment(case_list, number, rows)
    hours = file.economics.running_hours_per_year
    for (d, c), failed in reasons.items():
        carried[d, c] = not failed
        if not failed:
            operation[d, c] = _operation(rows[d, c], runs[d], components, hours)
    is_simulated, bound = np.ones_like(carried), None
    if is_bounded:
        is_simulated[:states] = [
            [(d, c) in reasons for c in range(configurations)] for d in range(states)
        ]
        bound = _bounds(case_list, number, rows, runs)
        _put_bounds(operation[:states], is_simulated[:states], bound)
    operation[:, :, components.index(FIXED)] += _fixed(case_list, number)
    unserved, may_serve = _missed(area.states.states, runs, components, hours)
    quantities = Quantities(components, operation, carried, unserved, may_serve, state_of_node)
    names = (*(state.name for state in area.states.states), NO_TRAFFIC)
    return Served(quantities, names, reasons, is_simulated, bound)


def whole_ones(cases: Sequence[Case], table: pd.DataFrame) -> list[Case]:
    """Cases of the configurations with a traffic that were simulated, with all outages required."""
    known = set(table.index)
    lacking = {
        (case.area, case.state, case.configuration) for case in cases if case.digest not in known
    }
    return [case for case in cases if (case.area, case.state, case.configuration) not in lacking]


def _bounds(
    case_list: CaseList,
    number: int,
    rows: Mapping[tuple[int, int], Mapping[str, Any]],
    runs: list[dict[str, "_Run"]],
) -> Array:
    """Least use of each state of traffic, NaN where no strongest supply came through."""
    file, area = case_list.plan.file, case_list.areas[number]
    components, hours = components_of(file), file.economics.running_hours_per_year
    given_back = components.index(FED_BACK) if FED_BACK in components else None
    bound = np.full((len(runs), len(components)), np.nan)
    best = strongest(area)
    for d, own in enumerate(runs):
        uses = [
            _operation(rows[d, c], own, components, hours)
            for c in best.tolist()
            if (d, c) in rows and rows[d, c]["status"] == FINISHED
        ]
        if uses:
            margin = file.evaluate.bound_margin_percent / 100.0
            bound[d] = bound_of(np.array(uses), margin, components.index(ENERGY), given_back)
    return bound


def _put_bounds(operation: Array, is_simulated: Flags, bound: Array) -> None:
    """Let what was not simulated use what is least."""
    lacking = ~is_simulated
    if unknown := int(lacking[np.isnan(bound).any(axis=1)].sum()):
        raise PlanError(
            f"{unknown:,} configurations with a traffic were neither simulated nor have a "
            "bound: the plan or its scenarios have changed; run tpss plan run again, which adds them"
        )
    operation[lacking] = np.broadcast_to(bound[:, np.newaxis], operation.shape)[lacking]


def _intact_rows(own: list[Case], table: pd.DataFrame) -> dict[tuple[int, int], Mapping[str, Any]]:
    records = records_of(table)
    return {
        (case.state, case.configuration): records[case.digest]
        for case in own
        if case.outage == INTACT
    }


def _demand_payment(
    case_list: CaseList, number: int, rows: Mapping[tuple[int, int], Mapping[str, Any]]
) -> None:
    """Refuse a plan without a price of energy that is given back, if some is."""
    file, area = case_list.plan.file, case_list.areas[number]
    if file.economics.fed_back_per_kwh is not None:
        return
    for (d, c), row in rows.items():
        if row["status"] == FINISHED and row["fed_back_to_grid_mw"] > 0.0:
            place = f"{area.configurations[c].name} with {area.states.states[d].name}"
            mwh = row["fed_back_to_grid_mw"] * file.economics.running_hours_per_year
            problem = f"the price is missing; {place} gives back {mwh:.4g} MWh a year to the grid"
            remedy = "add it, with its source; 0 only if nobody pays for it"
            key = f"{PRICES}.{FED_BACK}"
            raise ScenarioError([Finding(str(case_list.plan.source), key, "", problem, remedy)])


@dataclass(frozen=True)
class _Run:
    """Trains of a service."""

    train: str
    per_h: float
    is_scheduled: bool


def _trains(case_list: CaseList, number: int, state: int) -> dict[str, _Run]:
    """Trains that a state asks for, by service."""
    case = next(each for each in case_list.cases if (each.area, each.state) == (number, state))
    scenario = case_list.scenario(case)
    return dict(_runs(scenario, period_of(scenario, case_list.plan.file.evaluate) / 60.0))


def _runs(scenario: Scenario, hours: float) -> Iterator[tuple[str, _Run]]:
    for number, entry in enumerate(scenario.traffic):
        scheduled = entry.arrive_after_min is not None
        yield entry.name, _Run(entry.train, trains_per_h(scenario, number, hours), scheduled)


def _operation(
    row: Mapping[str, Any], runs: Mapping[str, _Run], components: tuple[str, ...], hours: float
) -> Array:
    """What a supply uses in a year of a traffic, and its trains lose, by component."""
    found = dict.fromkeys(components, 0.0)
    found[ENERGY] = row["drawn_from_grid_mw"] * hours * KWH_PER_MWH
    if FED_BACK in found:
        found[FED_BACK] = row["fed_back_to_grid_mw"] * hours * KWH_PER_MWH
    for service, run in runs.items():
        key, column = (LATE, "mean_late_min") if run.is_scheduled else (LOST, "mean_lost_min")
        minutes = float(row[f"service.{service}.{column}"])
        found[f"{key}.{run.train}"] += minutes * run.per_h * hours
    return np.array([found[name] for name in components])


def _fixed(case_list: CaseList, number: int) -> Array:
    """Fixed cost of each configuration a year, shape (configurations,)."""
    area = case_list.areas[number]
    each = [measure.fixed_per_year for measure in area.area.measures.values()]
    built = np.array([configuration.levels for configuration in area.configurations]) > 0
    fixed: Array = built.reshape(len(area.configurations), len(each)) @ np.array(each)
    return fixed


def _missed(
    states: tuple[State, ...],
    runs: list[dict[str, _Run]],
    components: tuple[str, ...],
    hours: float,
) -> tuple[Array, Any]:
    """Trains that are not run if other traffic is than asked for, and which may be."""
    none: list[dict[str, _Run]] = [{}]
    unserved = np.zeros((len(states), len(states) + 1, len(components)))
    may_serve = np.zeros((len(states), len(states) + 1), dtype=np.bool_)
    for d, asked in enumerate(runs):
        for g, run in enumerate([*runs, *none]):
            is_less = all(
                name in asked and each.per_h <= asked[name].per_h * (1.0 + 1e-12)
                for name, each in run.items()
            )
            alike = g == len(states) or _beside_trains(states[d]) == _beside_trains(states[g])
            may_serve[d, g] = is_less and alike
            for name, each in asked.items() if may_serve[d, g] else ():
                left = each.per_h - (run[name].per_h if name in run else 0.0)
                k = components.index(f"{NOT_RUN}.{each.train}")
                unserved[d, g, k] += max(0.0, left) * hours
    return unserved, may_serve


def _beside_trains(state: State) -> dict[str, Any]:
    """Values of a state that are not the number of its trains: those must be as asked for."""
    counts = (*DEPARTURES, "file")
    return {path: v for path, v in state.values.items() if path.split(".")[-1] not in counts}
