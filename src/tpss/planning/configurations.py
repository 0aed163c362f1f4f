"""Configurations of a supply: all sets of measures that may stand together, each a valid scenario."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from tpss.api import build
from tpss.errors import Finding, ScenarioError, TooLargeError
from tpss.outages.run import with_outage
from tpss.planning.load import Plan, PlannedArea
from tpss.planning.period import period_of
from tpss.planning.plan import LEVEL, PlannedMeasure
from tpss.planning.plan_faults import price_faults
from tpss.planning.states import TODAY, State, States, put_state
from tpss.scenario.open_step import with_step
from tpss.scenario.override import copy_of
from tpss.scenario.scenario import Scenario
from tpss.scenario.variants import Variant, make_changes

MOST = 100_000
"""Configurations of an area that are made at most."""


@dataclass(frozen=True)
class Configuration:
    """What is built, by the numbers of the levels of all measures of an area; 0: not built."""

    levels: tuple[int, ...]
    name: str

    @property
    def size(self) -> int:
        """Number of measures that are built."""
        return sum(level > 0 for level in self.levels)


def configurations_of(area: PlannedArea, source: str) -> list[Configuration]:
    """Configurations that exclusions and needs allow, today's first, then those of fewer measures.

    Raises
    ------
    ScenarioError
        There are too many of them.
    """
    counts = [1 if each.levels is None else len(each.levels) for each in area.measures.values()]
    found = []
    for levels in product(*(range(count + 1) for count in counts)):
        if not _may_stand(levels, area):
            continue
        found.append(Configuration(levels, _name(levels, area)))
        if len(found) > MOST:
            problem = f"more than {MOST} sets of measures may stand together"
            remedy = "exclude some from others, or leave some out"
            raise ScenarioError([Finding(source, area.key("*"), "", problem, remedy)])
    return sorted(found, key=lambda each: each.size)


def _may_stand(levels: tuple[int, ...], area: PlannedArea) -> bool:
    built = {name for name, level in zip(area.measures, levels, strict=True) if level}
    return all(
        not built & set(area.measures[name].excludes) and built >= set(area.measures[name].needs)
        for name in built
    )


def _name(levels: tuple[int, ...], area: PlannedArea) -> str:
    """Names of the measures that are built, with the values of their levels."""
    parts = []
    for (name, measure), level in zip(area.measures.items(), levels, strict=True):
        if level:
            parts.append(name if measure.levels is None else f"{name}={measure.levels[level - 1]}")
    return "+".join(parts) or TODAY


def document_of(
    plan: Plan, area: PlannedArea, configuration: Configuration, state: State
) -> dict[str, Any]:
    """Document of the scenario of a configuration and a traffic.

    Raises
    ------
    ScenarioError
        A change leads to no place.
    """
    document: dict[str, Any] = copy_of(area.document)
    document.pop("variants", None)
    for (name, measure), level in zip(area.measures.items(), configuration.levels, strict=True):
        if level:
            make_changes(document, area.key(name), variant_of(measure, level), plan.source)
    put_state(document, state, area, plan)
    simulation = dict(document.get("simulation", {}))
    if plan.file.evaluate.time_step_min is not None:
        simulation["time_step_min"] = plan.file.evaluate.time_step_min
    simulation.pop("outage", None)
    document["simulation"] = simulation
    parts = (area.today.name, configuration.name if configuration.size else "")
    document["name"] = "-".join(_slug(part) for part in parts if part)
    return document


def _slug(text: str) -> str:
    """A text as part of the name of a scenario."""
    return "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in text)


def variant_of(measure: PlannedMeasure, level: int) -> Variant:
    """Changes of a measure at a level, counted from 1."""
    value = None if measure.levels is None else measure.levels[level - 1]
    return Variant(
        changes=_at_level(measure.changes, value),
        additions=_at_level(measure.additions, value),
        removals=measure.removals,
    )


def _at_level(part: Any, value: Any) -> Any:
    """A part of the changes, with a level's value where it belongs."""
    if isinstance(part, dict):
        return {key: _at_level(each, value) for key, each in part.items()}
    if isinstance(part, list | tuple):
        return [_at_level(each, value) for each in part]
    if isinstance(part, str) and value is not None:
        return value if part == LEVEL else part.replace(LEVEL, str(value))
    return part


def check_configurations(
    plan: Plan, area: PlannedArea, configurations: list[Configuration], states: States
) -> None:
    """Build every configuration, with the outages it must stand, and every state of today's supply.

    Raises
    ------
    ScenarioError
        Some are no valid scenarios; of measures that do not go together, the smallest sets are named.
    """
    findings: list[Finding] = []
    faulty: list[Configuration] = []
    for configuration in configurations:
        if any(_contains(configuration, each) for each in faulty):
            continue
        own = list(_faults_of(plan, area, configuration, states.states[0]))
        if own:
            faulty.append(configuration)
            findings += own
    if not findings:
        for state in states.states[1:]:
            findings += _faults_of(plan, area, configurations[0], state)
    if findings:
        raise ScenarioError(list(dict.fromkeys(findings)))


def _contains(configuration: Configuration, other: Configuration) -> bool:
    """Whether all that another has is built, at its level."""
    return other.size > 0 and all(
        theirs in (0, own) for own, theirs in zip(configuration.levels, other.levels, strict=True)
    )


def _faults_of(
    plan: Plan, area: PlannedArea, configuration: Configuration, state: State
) -> Iterator[Finding]:
    """Faults of a configuration with a traffic, named by the measures that lead to them."""
    try:
        document = document_of(plan, area, configuration, state)
        scenario = Scenario.from_own_document(document, area.source)
        yield from price_faults(plan.file, scenario, str(plan.source))
        yield from _without_step(plan, area, scenario)
        yield from _without_period(plan, scenario)
        prepared = build(with_step(scenario))
        for name in outages_of(plan, scenario):
            with_outage(prepared, next(each for each in scenario.outages if each.name == name))
    except ScenarioError as error:
        for finding in error.findings:
            yield _named(finding, plan, area, configuration, state)
    except TooLargeError as error:
        finding = Finding(str(area.source), "", "", str(error), "lessen what it changes")
        yield _named(finding, plan, area, configuration, state)


def outages_of(plan: Plan, scenario: Scenario) -> list[str]:
    """Outages that a scenario must stand: those required that it has."""
    own = [outage.name for outage in scenario.outages]
    return [name for name in plan.file.require.also_with if name in own]


def _without_step(plan: Plan, area: PlannedArea, scenario: Scenario) -> Iterator[Finding]:
    if scenario.simulation.time_step_min is None:
        problem = "no time step is given, and cases of different steps are not compared"
        remedy = "add one, such as 0.5, here or to the scenario"
        place = f"evaluate.time_step_min of {area.name}" if area.name else "evaluate.time_step_min"
        yield Finding(str(plan.source), place, "", problem, remedy)


def _without_period(plan: Plan, scenario: Scenario) -> Iterator[Finding]:
    try:
        period_of(scenario, plan.file.evaluate)
    except ScenarioError as error:
        for finding in error.findings:
            yield replace(finding, file=str(plan.source))


def _named(
    finding: Finding, plan: Plan, area: PlannedArea, configuration: Configuration, state: State
) -> Finding:
    """A finding of a scenario as one of the plan."""
    if finding.file == str(plan.source):
        return finding
    shown = f" = {finding.value}" if finding.value else ""
    at = f"{finding.key}{shown}: " if finding.key else ""
    built = [area.key(n) for n, k in zip(area.measures, configuration.levels, strict=True) if k]
    if not built:
        before = f"{area.name}: " if area.name else ""
        key = "scenarios" if state.values else "scenario"
        problem = f"{before}traffic {state.name} makes no valid scenario: {at}{finding.problem}"
        return replace(finding, file=str(plan.source), key=key, value="", problem=problem)
    together = "together they make" if len(built) > 1 else "it makes"
    problem = f"{together} no valid scenario: {at}{finding.problem}"
    remedy = finding.remedy
    if len(built) > 1:
        remedy += "; or let one of the measures exclude the other, with excludes"
    return Finding(str(plan.source), " and ".join(built), "", problem, remedy)
