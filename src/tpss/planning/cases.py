"""The cases of a plan: what is simulated, each once ever, told apart by all that it depends on."""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from tpss.laws.registry import laws_named
from tpss.planning.configurations import (
    Configuration,
    configurations_of,
    document_of,
)
from tpss.planning.load import Plan, PlannedArea
from tpss.planning.plan import PROOF_KEYS
from tpss.planning.states import State, States, states_of
from tpss.scenario.inline import inline_files
from tpss.scenario.scenario import Scenario

NAMES = ("name", "description", "variants")
"""Keys of a scenario's document on which nothing depends."""

ENDS = ("until", "duration_min")
"""Keys that say when a run ends, which a case decides itself."""

INTACT = ""
"""Names the case of a supply without outage."""


@dataclass(frozen=True)
class Case:
    """A configuration with a traffic, intact or with an outage, of an area of a plan."""

    area: int
    configuration: int
    state: int
    outage: str
    digest: str
    """Tells it from all cases that may come out otherwise."""


@dataclass(frozen=True)
class AreaCases:
    """Configurations and states of traffic of an area: the cases are their combinations."""

    area: PlannedArea
    configurations: tuple[Configuration, ...]
    states: States
    outages: tuple[tuple[str, ...], ...]
    """Outages that each configuration must stand."""


class CaseList:
    """All cases that a plan may need, in the order of areas, configurations and states."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.areas = tuple(_area_cases(plan, area) for area in plan.areas)

    def __len__(self) -> int:
        return sum(
            len(each.states.states) * sum(1 + len(outages) for outages in each.outages)
            for each in self.areas
        )

    @cached_property
    def cases(self) -> tuple[Case, ...]:
        """The cases; those that are alike in all that counts have the same digest."""
        return tuple(case for number in range(len(self.areas)) for case in self._of(number))

    def _of(self, number: int) -> Iterator[Case]:
        area_cases = self.areas[number]
        evaluation = digest_of(self.plan.file.evaluate.model_dump(exclude=PROOF_KEYS))
        traffic = [
            digest_of([dict(state.values), _files_named(state, area_cases.area.source)])
            for state in area_cases.states.states
        ]
        for c, configuration in enumerate(area_cases.configurations):
            document = self._today(area_cases.area, configuration)
            outages = {each.get("name"): each for each in document.pop("outages", ())}
            supply = digest_of(document)
            for d in range(len(area_cases.states.states)):
                for outage in (INTACT, *area_cases.outages[c]):
                    out = digest_of(_content(outages.get(outage)))
                    yield Case(
                        number, c, d, outage, digest_of([supply, traffic[d], out, evaluation])
                    )

    def _today(self, area: PlannedArea, configuration: Configuration) -> dict[str, Any]:
        """Document of a configuration with today's traffic, with the files that it names."""
        document = document_of(self.plan, area, configuration, State({}))
        inlined = inline_files(document, area.source).document
        simulation = {k: v for k, v in inlined["simulation"].items() if k not in ENDS}
        kept = {key: value for key, value in inlined.items() if key not in NAMES}
        laws = laws_named(kept)
        return {**kept, "simulation": simulation, **({"laws": laws} if laws else {})}

    def document(self, case: Case) -> dict[str, Any]:
        """Document of the scenario of a case, with the files that it names: it can be sent anywhere."""
        area = self.areas[case.area]
        document = document_of(
            self.plan,
            area.area,
            area.configurations[case.configuration],
            area.states.states[case.state],
        )
        if case.outage:
            document["simulation"]["outage"] = case.outage
        inlined = inline_files(document, area.area.source).document
        inlined.pop("timetables", None)  # their trains are entries of the traffic now
        return inlined

    def scenario(self, case: Case) -> Scenario:
        """Scenario of a case.

        Raises
        ------
        ScenarioError
            It has faults.
        """
        return Scenario.from_own_document(self.document(case), self.areas[case.area].area.source)


def _area_cases(plan: Plan, area: PlannedArea) -> AreaCases:
    configurations = configurations_of(area, str(plan.source))
    outages = []
    for configuration in configurations:
        document = document_of(plan, area, configuration, State({}))
        named = [each.get("name") for each in document.get("outages", ())]
        outages.append(tuple(name for name in plan.file.require.also_with if name in named))
    return AreaCases(area, tuple(configurations), states_of(plan, area), tuple(outages))


def digest_of(content: Any) -> str:
    """Digest of what a document may hold."""
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]


def _content(outage: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """What is out."""
    return None if outage is None else {k: v for k, v in outage.items() if k != "name"}


def _files_named(state: State, source: Path) -> list[str]:
    """Digests of the files that values of a state name."""
    files = [source.parent / value for value in state.values.values() if isinstance(value, str)]
    return [hashlib.sha256(file.read_bytes()).hexdigest() for file in files if file.is_file()]


def distinct(cases: Sequence[Case]) -> list[Case]:
    """The first one of cases with the same digest."""
    return list({case.digest: case for case in reversed(cases)}.values())[::-1]
