"""Outages of the supply in the page: the table of n-1, and the edits that show one of them."""

from typing import Any

from tpss.outages.cases import outages_of
from tpss.outages.run import compare_outages
from tpss.studio.bounds import demand_bounded
from tpss.studio.desk import Desk, Document, Edits
from tpss.studio.newest import DroppedError
from tpss.studio.told import plain, table_of

SHOWN = (
    "outage", "verdict", "lowest_voltage_kv", "useful_voltage_kv", "peak_loading",
    "energy_mwh", "lowest_voltage_kv_change", "peak_loading_change",
)  # fmt: skip
"""Columns of the table that the page shows; what differs from the intact supply last."""


def compared(desk: Desk, edits: Edits, interrupted: list[int]) -> dict[str, Any]:
    """The intact supply, and every single element and each outage of the scenario, the gravest first.

    Raises
    ------
    ScenarioError
        The scenario has faults.
    DroppedError
        A newer request came meanwhile.
    """
    document = desk.document(edits)
    scenario = desk.scenario(document)
    demand_bounded(scenario)
    comparison = compare_outages(scenario, every=True, interrupted=interrupted)
    if interrupted:
        raise DroppedError("a newer one was asked for")
    table = comparison.table()
    known = {
        outage.name: outage.model_dump(mode="json", by_alias=True, exclude_defaults=True)
        for outage in outages_of(scenario, every=True)
    }
    return {
        **table_of(table[[name for name in SHOWN if name in table]]),
        "edits": [edits_for(document, known.get(str(plain(name)))) for name in table["outage"]],
    }


def edits_for(document: Document, outage: dict[str, Any] | None) -> Edits:
    """Edits that let a scenario run with an outage, which it may have already; without one, intact."""
    if outage is None:
        return [["simulation.outage", None]] if document.get("simulation", {}).get("outage") else []
    names = [each.get("name") for each in document.get("outages", [])]
    added: Edits = [] if outage["name"] in names else [["outages.+", outage]]
    return [*added, ["simulation.outage", outage["name"]]]
