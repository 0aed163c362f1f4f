"""States of traffic: what the futures of a plan ask for, stage by stage, in an area."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from tpss.errors import ScenarioError
from tpss.planning.load import Plan, PlannedArea
from tpss.sweep.settings import apply

TODAY = "as today"
"""Names a traffic, or a supply, that is the scenario's own."""


@dataclass(frozen=True)
class State:
    """Values of the uncertain keys of an area's scenario."""

    values: Mapping[str, Any]
    """By key path into the scenario."""

    @property
    def name(self) -> str:
        """Its values, in words."""
        return ", ".join(f"{path} = {value}" for path, value in self.values.items()) or TODAY

    @property
    def key(self) -> str:
        """Tells it from others."""
        return json.dumps(self.values, sort_keys=True, default=str)


@dataclass(frozen=True)
class States:
    """States of an area that occur in a plan, and where they do."""

    states: tuple[State, ...]
    places: tuple[tuple[int, ...], ...]
    """Index of a state by future and stage."""


def states_of(plan: Plan, area: PlannedArea) -> States:
    """States of traffic of an area, in the order in which futures name them."""
    found: dict[str, State] = {}
    rows = []
    for future in plan.futures.values():
        own = {
            path: value for key, value in future.values.items() if (path := _own(area, key, plan))
        }
        row = []
        for stage in range(plan.stages):
            state = State({path: at_stage(value, stage) for path, value in own.items()})
            row.append(found.setdefault(state.key, state).key)
        rows.append(row)
    order = {key: index for index, key in enumerate(found)}
    places = tuple(tuple(order[key] for key in row) for row in rows)
    return States(tuple(found.values()), places)


def _own(area: PlannedArea, key: str, plan: Plan) -> str | None:
    return None if plan.is_price(key) else area.own(key)


def at_stage(value: Any, stage: int) -> Any:
    """Value of a future in a stage: one of a list, or one for all."""
    return value[stage] if isinstance(value, list | tuple) else value


def put_state(document: dict[str, Any], state: State, area: PlannedArea, plan: Plan) -> None:
    """Put the values of a state into a document of an area's scenario.

    Raises
    ------
    ScenarioError
        A path leads to no place; findings name the plan's keys.
    """
    try:
        apply(document, state.values, area.source)
    except ScenarioError as error:
        before = f"{area.name}." if area.name else ""
        findings = [
            replace(
                each,
                file=str(plan.source),
                key=f"scenarios.{name}.{before}{each.key}",
                value=repr(future.values[f"{before}{each.key}"]),
            )
            for each in error.findings
            for name, future in plan.futures.items()
            if f"{before}{each.key}" in future.values
        ]
        raise ScenarioError(findings) from error
