"""What an area uses and misses in a year, from its outcomes: operation, trains run, trains not run.

A configuration that does not carry the traffic asked for runs less: another state of the plan that it
carries, with no more trains of any service, or no train at all.  What it does not run is missed.  So
every plan is possible, and what a weak supply costs is the value of trains.

Of a plan that is proved by bounds, what was not simulated has those of `tpss.planning.ways`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from tpss.errors import Finding, PlanError, ScenarioError
from tpss.planning.cases import INTACT, Case, CaseList
from tpss.planning.learnt import Learnt
from tpss.planning.money import Array
from tpss.planning.plan_faults import PRICES
from tpss.planning.prices import Flags, Quantities
from tpss.planning.requirements import records_of, verdicts
from tpss.planning.states import State
from tpss.planning.tree import Indices
from tpss.planning.ways import WAYS
from tpss.planning.yearly_use import (
    FED_BACK,
    FIXED,
    NOT_RUN,
    Simulated,
    Trains,
    components_of,
    gives_back,
    trains_of,
)
from tpss.scenario.traffic import DEPARTURES

NO_TRAFFIC = "no train"
"""Names what runs where a configuration carries none of the traffic."""


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
    """Of a plan that is proved by bounds: least use of a traffic by a configuration, without its fixed
    cost, NaN where none is known, shape (states, configurations, components)."""


def served(
    case_list: CaseList, number: int, table: pd.DataFrame, state_of_node: Indices, learnt: Learnt
) -> Served:
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
    learnt : Learnt
        What was learnt before for bounds.

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
    way = WAYS.get(file.evaluate.by)
    if way is not None:
        own = whole_ones(own, table)
    reasons = verdicts(area, own, table, file.require)
    simulated = _simulated(case_list, number, own, table)
    states, configurations = len(area.states.states), len(area.configurations)
    components = components_of(file)
    operation = np.zeros((states + 1, configurations, len(components)))
    carried = np.ones((states + 1, configurations), dtype=np.bool_)
    _demand_payment(simulated)
    for (d, c), failed in reasons.items():
        carried[d, c] = not failed
        if not failed:
            operation[d, c] = simulated.use(d, c)
    is_simulated, bound = np.ones_like(carried), None
    if way is not None:
        is_simulated[:states] = [
            [(d, c) in reasons for c in range(configurations)] for d in range(states)
        ]
        bound = way.bound(simulated, learnt)
        _put_bounds(operation[:states], is_simulated[:states], bound)
    operation[:, :, components.index(FIXED)] += _fixed(case_list, number)
    unserved, may_serve = _missed(area.states.states, simulated)
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


def _put_bounds(operation: Array, is_simulated: Flags, bound: Array) -> None:
    """Let what was not simulated use what is least."""
    lacking = ~is_simulated
    if unknown := int((lacking & np.isnan(bound).any(axis=2)).sum()):
        raise PlanError(
            f"{unknown:,} configurations with a traffic were neither simulated nor have a "
            "bound: the plan or its scenarios have changed; run tpss plan run again, which adds them"
        )
    operation[lacking] = bound[lacking]


def with_outcomes(
    known: Served, case_list: CaseList, number: int, own: Sequence[Case], table: pd.DataFrame
) -> Served:
    """What an area uses and misses, with some outcomes in the place of those that are known.

    Only those that are put in count as simulated, and traffic of no train.

    Parameters
    ----------
    known : Served
    case_list : CaseList
        Of the same configurations and traffic.
    number : int
        Of the area.
    own : sequence of Case
        Whose outcomes are put in, with all outages of each.
    table : DataFrame
        Outcomes by digest.

    Raises
    ------
    ScenarioError, AuditError
        As `served`.
    """
    reasons = verdicts(case_list.areas[number], list(own), table, case_list.plan.file.require)
    simulated = _simulated(case_list, number, list(own), table)
    operation, carried = known.quantities.operation.copy(), known.quantities.carried.copy()
    is_simulated = np.zeros_like(carried)
    is_simulated[-1] = True
    fixed = operation[-1]
    for (d, c), failed in reasons.items():
        carried[d, c], is_simulated[d, c] = not failed, True
        operation[d, c] = fixed[c] if failed else simulated.use(d, c) + fixed[c]
    quantities = replace(known.quantities, operation=operation, carried=carried)
    return replace(known, quantities=quantities, is_simulated=is_simulated)


def bounds_of(case_list: CaseList, number: int, table: pd.DataFrame, learnt: Learnt) -> Array:
    """Least use of each traffic by each configuration of an area, as `Served.bound`.

    Parameters
    ----------
    case_list : CaseList
        Of a plan that is proved by bounds.
    number : int
        Of the area.
    table : DataFrame
        Outcomes by digest.
    learnt : Learnt
        What was learnt before for bounds.
    """
    own = [case for case in case_list.cases if case.area == number]
    simulated = _simulated(case_list, number, whole_ones(own, table), table)
    return WAYS[case_list.plan.file.evaluate.by].bound(simulated, learnt)


def _simulated(case_list: CaseList, number: int, own: list[Case], table: pd.DataFrame) -> Simulated:
    """Rows of some cases of an area, and the trains of its traffic."""
    records = records_of(table)
    rows = {
        (case.state, case.configuration): records[case.digest]
        for case in own
        if case.outage == INTACT
    }
    states = range(len(case_list.areas[number].states.states))
    return Simulated(case_list, number, rows, [trains_of(case_list, number, d) for d in states])


def _demand_payment(simulated: Simulated) -> None:
    """Refuse a plan without a price of energy that is given back, if some is."""
    case_list = simulated.case_list
    file, area = case_list.plan.file, case_list.areas[simulated.number]
    if file.economics.fed_back_per_kwh is not None:
        return
    for (d, c), row in simulated.through.items():
        if gives_back(row):
            place = f"{area.configurations[c].name} with {area.states.states[d].name}"
            mwh = row["fed_back_to_grid_mw"] * file.economics.running_hours_per_year
            problem = f"the price is missing; {place} gives back {mwh:.4g} MWh a year to the grid"
            remedy = "add it, with its source; 0 only if nobody pays for it"
            key = f"{PRICES}.{FED_BACK}"
            raise ScenarioError([Finding(case_list.plan.given, key, "", problem, remedy)])


def _fixed(case_list: CaseList, number: int) -> Array:
    """Fixed cost of each configuration a year, shape (configurations,)."""
    area = case_list.areas[number]
    each = [measure.fixed_per_year for measure in area.area.measures.values()]
    built = np.array([configuration.levels for configuration in area.configurations]) > 0
    fixed: Array = built.reshape(len(area.configurations), len(each)) @ np.array(each)
    return fixed


def _missed(states: tuple[State, ...], simulated: Simulated) -> tuple[Array, Any]:
    """Trains that are not run if other traffic is than asked for, and which may be."""
    runs, components, hours = simulated.trains, simulated.components, simulated.hours
    none: list[dict[str, Trains]] = [{}]
    unserved = np.zeros((len(states), len(states) + 1, len(components)))
    may_serve = np.zeros((len(states), len(states) + 1), dtype=np.bool_)
    for d, asked in enumerate(runs):
        for g, run in enumerate([*runs, *none]):
            is_less = all(
                name in asked and each.per_h <= asked[name].per_h * (1.0 + 1e-12)
                for name, each in run.items()
            )
            alike = g == len(states) or beside_trains(states[d]) == beside_trains(states[g])
            may_serve[d, g] = is_less and alike
            for name, each in asked.items() if may_serve[d, g] else ():
                left = each.per_h - (run[name].per_h if name in run else 0.0)
                k = components.index(f"{NOT_RUN}.{each.train}")
                unserved[d, g, k] += max(0.0, left) * hours
    return unserved, may_serve


def beside_trains(state: State) -> dict[str, Any]:
    """Values of a state that are not the number of its trains: those must be as asked for."""
    counts = (*DEPARTURES, "file")
    return {path: v for path, v in state.values.items() if path.split(".")[-1] not in counts}
