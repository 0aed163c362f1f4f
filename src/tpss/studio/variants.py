"""Variants side by side: the file, what was edited, and the scenario's own variants."""

from collections.abc import Mapping
from typing import Any

from tpss.errors import ScenarioError
from tpss.many import in_threads
from tpss.results.result import Result
from tpss.scenario.scenario import Scenario
from tpss.studio.changed import Change, changes_between
from tpss.studio.desk import Desk, Edits
from tpss.studio.runs import built, run_for
from tpss.studio.told import plain

FILE, EDITED = "the file", "edited"
"""Rows that are no variants of the scenario."""

SET, ADD, REMOVE = "set", "add", "remove"

MOST = 40
"""Variants that are run at once."""

APART = ("name", "description", "variants")
"""Keys that a variant does not change."""


def as_variant(changes: list[Change]) -> dict[str, Any]:
    """Changes as a variant of a scenario's file."""
    changed: dict[str, Any] = {}
    added: dict[str, list[Any]] = {}
    removed = []
    for path, value in changes:
        if path.partition(".")[0] in APART:
            continue
        if value is None:
            removed.append(path)
        elif path.endswith(".+"):
            added.setdefault(path.removesuffix(".+"), []).append(value)
        else:
            changed[path] = value
    parts: dict[str, Any] = {SET: changed, ADD: added, REMOVE: removed}
    return {key: part for key, part in parts.items() if part}


def kept(desk: Desk, edits: Edits) -> dict[str, Any]:
    """The edits of a page as a variant of its file; empty if there are none."""
    return as_variant(changes_between(desk.content.document, desk.document(edits)))


def edits_of(variant: Mapping[str, Any]) -> Edits:
    """Edits that make a variant of the scenario that has it."""
    edits = [[path, value] for path, value in _flat(variant.get(SET, {}))]
    for path, items in _flat(variant.get(ADD, {})):
        edits += [[f"{path}.+", each] for each in (items if isinstance(items, list) else [items])]
    return [*edits, *([path, None] for path in variant.get(REMOVE, []))]


def _flat(table: Mapping[str, Any], above: str = "") -> list[tuple[str, Any]]:
    found: list[tuple[str, Any]] = []
    for key, value in table.items():
        if isinstance(value, Mapping) and value and "." not in key:
            found += _flat(value, f"{above}{key}.")
        else:
            found.append((f"{above}{key}", value))
    return found


def compared(desk: Desk, edits: Edits, interrupted: list[int]) -> dict[str, Any]:
    """Rows of the tray: what each variant changes, and what comes of it.

    Raises
    ------
    ScenarioError
        The document with edits has faults.
    """
    document = desk.document(edits)
    edited = desk.scenario(document)
    cases: dict[str, tuple[Scenario | ScenarioError, int, str]] = {}
    if edits:
        cases[FILE] = _tried(lambda: desk.scenario(desk.content.document)), 0, ""
        count = len(changes_between(desk.content.document, document))
        cases[EDITED] = edited, count, ""
    else:
        cases[FILE] = edited, 0, ""
    for name, variant in list(edited.variants.items())[:MOST]:
        made = _tried(lambda name=name: edited.variant(name))
        cases[name] = made, len(variant.paths), variant.description

    def work(case: tuple[Scenario | ScenarioError, int, str]) -> dict[str, Any]:
        return _figures(case[0], interrupted)

    rows = in_threads(work, cases.values())
    own = document.get("variants", {})
    return {
        "rows": [
            {"name": name, "changes": count, "description": words, "is_variant": name in own,
             "edits": edits_of(own[name]) if name in own else [], **figures}
            for (name, (_, count, words)), figures in zip(cases.items(), rows, strict=True)
        ]
    }  # fmt: skip


def _tried(make: Any) -> Scenario | ScenarioError:
    try:
        scenario: Scenario = make()
    except ScenarioError as error:
        return error
    return scenario


def _figures(case: Scenario | ScenarioError, interrupted: list[int]) -> dict[str, Any]:
    """Figures of a run; of a variant with faults the first of them."""
    if isinstance(case, ScenarioError):
        return {"fault": f"{case.findings[0].key}: {case.findings[0].problem}"}
    try:
        return figures_of(run_for(built(case), interrupted))
    except ScenarioError as error:
        return {"fault": error.findings[0].problem}


def figures_of(result: Result) -> dict[str, Any]:
    """How a run ended, and the figures by which variants are compared."""
    if not result.audit["passed"]:
        return {"fault": "the audit failed"}
    lowest, stops = result.summary["lowest_voltage"] or {}, result.stops
    late = stops["late_min"].max() if "late_min" in stops else None
    figures = {
        "lowest_kv": lowest.get("voltage_kv"),
        "peak_loading_percent": 100.0 * float(result.stations.peak_loading.max()),
        "trip_min": result.summary["trip_time_min"],
        "late_min": late,
        "energy_mwh": result.summary["total_energy_mwh"],
        "losses_mwh": result.summary["losses_mwh"],
        "violations": len(result.standards.violations),
    }
    return {"status": result.status, **{name: plain(value) for name, value in figures.items()}}
