"""Runs of a scenario while it is edited: what comes of edits, as soon as can be."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.results.result import Result
from tpss.scenario.paths import NoSuchPlaceError, places_of
from tpss.scenario.scenario import Scenario
from tpss.studio.charts import CHARTS, drawn
from tpss.studio.corridor_plan import plan_of
from tpss.studio.desk import Desk, Document, Edits
from tpss.studio.newest import Newest
from tpss.studio.runs import built, run_for
from tpss.studio.shelf import Shelf
from tpss.studio.steps import moving
from tpss.studio.told import notes_of, told_of

MOVING = "moving"
"""Among the names of charts it asks for the trains over the plan."""

STEP = "simulation.time_step_min"


@dataclass
class Live:
    """Runs of the open file."""

    desk: Desk
    newest: Newest
    shelf: Shelf = field(default_factory=Shelf)
    """Reports that were made."""
    chosen_step_min: float | None = None
    """Step that was chosen for the scenario, if it gives none; edits keep it until the hand rests."""

    def see(self, page: str, number: int, edits: Edits, charts: list[str]) -> dict[str, Any]:
        """What comes of edits: document, findings, plan, and a run if there are no faults.

        Parameters
        ----------
        page : str
        number : int
            Of the request; of those of a page the newest counts.
        edits : list
        charts : list of str
            Names of the charts that are shown.

        Raises
        ------
        DroppedError
            A newer request came meanwhile.
        """
        interrupted = self.newest.begin(page, number)
        answer: dict[str, Any] = {"number": number, "findings": []}
        document: Document = {}
        try:
            document = self.desk.document(edits)
            answer["document"] = document
            scenario = self.desk.scenario(document)
            answer |= {"effective": scenario.as_document(), "plan": plan_of(scenario, document)}
            answer["result"] = self._result(scenario, interrupted, charts)
        except ScenarioError as error:
            answer["findings"] = findings_of(error, document)
        return answer

    def _result(
        self, scenario: Scenario, interrupted: list[int], charts: list[str]
    ) -> dict[str, Any]:
        result = self._run(self._with_step(scenario), interrupted)
        told = told_of(result)
        has_curves = told["audit"]["passed"] and result.dataset.sizes["time"] > 1
        return {
            **told,
            "chosen_step": scenario.simulation.time_step_min is None,
            "charts": drawn(result, charts) if has_curves else {},
            "moving": moving(result) if has_curves and MOVING in charts else None,
            "offered": [name for name, each in CHARTS.items() if each.is_there(result)],
            "simulation_ms": 1e3 * result.summary["simulation_s"],
        }

    def check(self, page: str, number: int, edits: Edits) -> dict[str, Any]:
        """Step error and notes of the scenario with edits, which take about two more runs.

        Raises
        ------
        DroppedError, ScenarioError
        """
        interrupted = self.newest.begin(page, number)
        scenario = self.desk.scenario(self.desk.document(edits))
        prepared = built(scenario)
        if scenario.simulation.time_step_min is None:
            self.chosen_step_min = prepared.scenario.simulation.time_step_min
        result = run_for(prepared, interrupted, step_check=True)
        return {"number": number, **notes_of(result)}

    def _with_step(self, scenario: Scenario) -> Scenario:
        """A scenario that leaves its step open with the one chosen last."""
        if scenario.simulation.time_step_min is None and self.chosen_step_min is not None:
            return scenario.with_({STEP: self.chosen_step_min})
        return scenario

    def _run(self, scenario: Scenario, interrupted: list[int]) -> Result:
        prepared = built(scenario)
        if scenario.simulation.time_step_min is None:
            self.chosen_step_min = prepared.scenario.simulation.time_step_min
        return run_for(prepared, interrupted)


def findings_of(error: ScenarioError, document: Document) -> list[dict[str, str]]:
    """Findings as a page shows them, their key paths by numbers, as those of fields are."""
    return [
        {**vars(each), "path": _numbered(document, each.key), "words": _words(each)}
        for each in error.findings
    ]


def _words(finding: Finding) -> str:
    return f"{finding.problem} → {finding.remedy}"


def _numbered(document: Document, key: str) -> str:
    """A key path with numbers in place of names of items; as it is if it leads nowhere."""
    try:
        found: Sequence[str] = places_of(document, key)
    except NoSuchPlaceError:
        return key
    return found[0] if found else key
