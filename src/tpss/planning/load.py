"""Load a plan from its file, with the scenarios that it starts from."""

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError, no_such
from tpss.planning.plan import Future, PlanFile, PlannedMeasure, PlannedRenewal
from tpss.planning.plan_faults import (
    PRICES,
    measures_of,
    plan_faults,
    price_faults,
    renewals_of,
)
from tpss.planning.told import not_told
from tpss.scenario.files import read_toml
from tpss.scenario.given_path import named_as_given
from tpss.scenario.load import demand_no_scenario
from tpss.scenario.override import copy_of, override
from tpss.scenario.scenario import Scenario
from tpss.scenario.validate import validate

ONLY_FUTURE = "as-today"
"""Names what comes where a plan names no scenarios: today's traffic and prices."""

_OWN_KEYS = ("title", "probability")
"""Keys of a future that are no values."""


@dataclass(frozen=True)
class PlannedArea:
    """A line of a plan as it is today, and what may be built there."""

    name: str
    """Empty where there is one only."""
    document: dict[str, Any]
    """Of the scenario, as in its file."""
    source: Path
    """The scenario file."""
    today: Scenario
    measures: dict[str, PlannedMeasure]
    """By the names that they have within the area."""
    renewals: dict[str, PlannedRenewal]

    def key(self, name: str) -> str:
        """Key path in the plan file of a measure."""
        return f"measures.{self.name}.{name}" if self.name else f"measures.{name}"

    def own(self, path: str) -> str | None:
        """Key path into its scenario of a value of a future; None if it is not of this area."""
        if not self.name:
            return path
        return path.removeprefix(f"{self.name}.") if path.startswith(f"{self.name}.") else None


@dataclass(frozen=True)
class Plan:
    """A plan with the scenarios that it starts from."""

    file: PlanFile
    document: dict[str, Any]
    """Of the plan, as in its file."""
    source: Path
    areas: tuple[PlannedArea, ...]
    given: str
    """The plan file as it was named, by which findings name it."""

    def with_(self, changes: Mapping[str, Any]) -> "Plan":
        """The plan with values set by key path; its scenarios stay as they were read.

        Raises
        ------
        ScenarioError
            A path leads to no place, or the changed plan has faults.
        """
        with self.named_as_given():
            document = override(self.document, changes, self.source)
            file = read_plan_file(document, self.source)
        areas = tuple(
            replace(
                area,
                measures=measures_of(area.name, file),
                renewals=renewals_of(area.name, file),
            )
            for area in self.areas
        )
        return replace(self, file=file, document=document, areas=areas)

    def named_as_given(self) -> AbstractContextManager[None]:
        """Let findings name the plan's files as the user did."""
        return named_as_given(self.source, self.given)

    @property
    def futures(self) -> dict[str, Future]:
        """What may come, by name."""
        return self.file.scenarios or {ONLY_FUTURE: Future(probability=1.0)}

    @property
    def stages(self) -> int:
        """Number of stages."""
        return len(self.file.stages.start)

    @staticmethod
    def is_price(key: str) -> bool:
        """Whether a value of a future is a price, not one of a scenario."""
        return key.split(".")[0] == PRICES


def load_plan(path: str | Path) -> Plan:
    """Plan of a TOML file, with its scenarios.

    Raises
    ------
    ScenarioError
        The file, or a scenario that it names, cannot be read or has faults; all are listed.
    """
    source = Path(path)
    document = read_toml(source)
    demand_no_scenario(document, source, "a plan")
    return plan_of(document, source)


def plan_of(document: Mapping[str, Any], source: Path) -> Plan:
    """Plan of a document with the keys of a plan file; other files are found from `source`.

    Raises
    ------
    ScenarioError
        As `load_plan`.
    """
    file = read_plan_file(document, source)
    areas: list[PlannedArea] = []
    findings: list[Finding] = []
    for name, scenario in _scenarios(file).items():
        try:
            areas.append(_planned_area(name, scenario, file, source))
        except ScenarioError as error:
            findings += error.findings
    for area in areas:
        findings += price_faults(file, area.today, str(source))
    if len(areas) == len(_scenarios(file)):
        findings += _of_outages(file, areas, source)
        scenarios = {area.name: area.today for area in areas}
        findings += not_told(file.require, scenarios, str(source))
    if findings:
        raise ScenarioError(list(dict.fromkeys(findings)))
    return Plan(file, copy_of(document), source.absolute(), tuple(areas), str(source))


def read_plan_file(given: Mapping[str, Any], source: Path) -> PlanFile:
    """Validated keys of a plan file.

    Raises
    ------
    ScenarioError
        It has faults; all are listed.
    """
    document = copy_of(given)
    areas = document.get("areas")
    areas = set(areas) if isinstance(areas, Mapping) else set()
    for kind in ("measures", "renewals"):
        if isinstance(document.get(kind), Mapping):
            document[kind] = _by_area(document[kind], areas)
    findings: list[Finding] = []
    for kind, part in (("measures", PlannedMeasure), ("renewals", PlannedRenewal)):
        if areas and isinstance(document.get(kind), Mapping):
            _of_unknown_areas(document[kind], kind, part, areas, str(source), findings)
    measures = document.get("measures")
    if isinstance(measures, Mapping):
        document["measures"] = _with_likes(measures, areas, str(source), findings)
    futures = document.get("scenarios")
    if isinstance(futures, Mapping):
        document["scenarios"] = {name: _as_future(each) for name, each in futures.items()}
    try:
        file = validate(PlanFile, document, source)
        findings += plan_faults(file, str(source))
    except ScenarioError as error:
        findings += [
            replace(finding, key=finding.key.replace(".values.", ".", 1))
            if finding.key.startswith("scenarios.")
            else finding
            for finding in error.findings
        ]
    if findings:
        raise ScenarioError(findings)
    return file


def _by_area(tables: Mapping[str, Any], areas: set[str]) -> dict[str, Any]:
    """Tables by area and name, as tables by ``AREA.NAME``."""
    found: dict[str, Any] = {}
    for name, table in tables.items():
        if name in areas and isinstance(table, Mapping):
            found |= {f"{name}.{own}": each for own, each in table.items()}
        else:
            found[name] = table
    return found


def _of_unknown_areas(
    tables: dict[str, Any],
    kind: str,
    part: type[PlannedMeasure | PlannedRenewal],
    areas: set[str],
    source: str,
    findings: list[Finding],
) -> None:
    """Tables of tables that have no key of a measure or renewal: their area has another name."""
    keys = {field.alias or name for name, field in part.model_fields.items()}
    for name in list(tables):
        within = tables[name] if "." not in name else None
        if not isinstance(within, Mapping) or not within or keys & set(within):
            continue
        if all(isinstance(each, Mapping) for each in within.values()):
            findings.append(
                Finding(source, f"{kind}.{name}", "", *no_such("area", name, list(areas)))
            )
            del tables[name]


def _with_likes(
    measures: Mapping[str, Any], areas: set[str], source: str, findings: list[Finding]
) -> dict[str, Any]:
    """Measures completed by what those have that they are like."""

    def completed(name: str, behind: tuple[str, ...]) -> Any:
        table = measures[name]
        if not isinstance(table, Mapping) or not isinstance(table.get("like"), str):
            return table
        area, dot, _ = name.rpartition(".")
        like = table["like"]
        other = f"{area}.{like}" if dot and area in areas and like not in measures else like
        place = (source, f"measures.{name}.like", repr(like))
        if other not in measures:
            findings.append(Finding(*place, *no_such("measure", like, list(measures))))
            return table
        if other in behind:
            remedy = "let one of them give all its keys"
            findings.append(Finding(*place, "measures are like each other in a circle", remedy))
            return table
        above = completed(other, (*behind, other))
        return {**above, **table} if isinstance(above, Mapping) else table

    return {name: completed(name, (name,)) for name in measures}


def _as_future(table: Any) -> Any:
    """A row of values, these in a table of their own, by their key paths."""
    if not isinstance(table, Mapping):
        return table
    own = {key: value for key, value in table.items() if key in _OWN_KEYS}
    values = {key: value for key, value in table.items() if key not in _OWN_KEYS}
    return {**own, "values": _flat(values)}


def _flat(table: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """A table with key paths as keys."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{above}.{key}" if above else key
        flat |= _flat(value, path) if isinstance(value, Mapping) and value else {path: value}
    return flat


def _scenarios(file: PlanFile) -> dict[str, str]:
    """Scenario files by area; that of an only one has no name."""
    if file.scenario is not None:
        return {"": file.scenario}
    return {name: area.scenario for name, area in file.areas.items()}


def _planned_area(name: str, scenario: str, file: PlanFile, source: Path) -> PlannedArea:
    key = f"areas.{name}.scenario" if name else "scenario"
    place = source.parent / scenario
    try:
        document = read_toml(place, key)
        today = Scenario.from_document(document, place)
    except ScenarioError as error:
        problem = f"the scenario has {len(error.findings)} fault(s), listed below"
        first = Finding(
            str(source), key, repr(scenario), problem, "correct them, or name another scenario"
        )
        raise ScenarioError([first, *error.findings]) from error
    return PlannedArea(
        name, document, place.absolute(), today, measures_of(name, file), renewals_of(name, file)
    )


def _of_outages(file: PlanFile, areas: list[PlannedArea], source: Path) -> Iterator[Finding]:
    """Outages of the requirements that no area has, nor any measure adds, or that end."""
    own = {outage.name: outage for area in areas for outage in area.today.outages}
    added = [n for area in areas for each in area.measures.values() for n in _outages_added(each)]
    for name in file.require.also_with:
        place = (str(source), "require.also_with", repr(name))
        if name not in own and name not in added:
            yield Finding(*place, *no_such("outage", name, [*own, *added]))
        elif name in own and not own[name].is_throughout:
            problem = "it holds for a part of a run, and a year is all of one"
            yield Finding(*place, problem, "name an outage without from_min and to_min")


def _outages_added(measure: PlannedMeasure) -> list[str]:
    added = measure.additions.get("outages", ())
    items = added if isinstance(added, list | tuple) else [added]
    return [str(item.get("name")) for item in items if isinstance(item, Mapping)]
