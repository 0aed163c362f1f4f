"""Checks of stores of energy at the line: their current, and what stands beside them.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss.scenario.direct_current import is_direct
from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.raw import Fault, items, number, table
from tpss.scenario.supply.supply import STATIONS, STORAGE


def check_storage(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Stores at a line of alternating current, or a hair's breadth beside a feeding point."""
    supply, simulation = table(document, "supply"), table(document, "simulation")
    yield from _beside_conductors(supply)
    stores = list(items(supply, STORAGE))
    trains = table(document, "trains").values()
    on_board = any(isinstance(train, Mapping) and "storage" in train for train in trains)
    if not stores and not on_board:
        return
    if simulation.get("load_flow") == "least-squares":
        problem = "the load flow of the original program knows no stores of energy"
        yield "simulation.load_flow", "'least-squares'", problem, "leave it out"
    if not is_direct(document):
        for i, store in stores:
            problem = "a store of energy, which follows the voltage of a direct current"
            remedy = "choose a system of direct current, such as DC-0.75kV, or leave it out"
            yield f"supply.{STORAGE}.{i}", repr(store.get("name", "")), problem, remedy
        return
    before = [_place(each) for kind in STATIONS for _, each in items(supply, kind)]
    for i, store in stores:
        line, km = place = _place(store)
        if km is not None and any(
            line == other and at is not None and 0.0 < abs(km - at) < CLOSEST_KM
            for other, at in before
        ):
            problem = "closer than a metre to another feeding point, and not at it"
            key = f"supply.{STORAGE}.{i}.position_km"
            yield key, f"{km:.17g}", problem, "place it there, or elsewhere"
        before.append(place)


def _beside_conductors(supply: Mapping[str, Any]) -> Iterator[Fault]:
    """Stores, and stretches without contact line, where rails are conductors of their own."""
    if not table(supply, "conductors"):
        return
    remedy = "leave supply.conductors out, or this"
    for i, store in items(supply, STORAGE):
        problem = "stores are known between a single conductor and earth only"
        yield f"supply.{STORAGE}.{i}", repr(store.get("name", "")), problem, remedy
    for i, _ in items(supply, "without_contact_line"):
        problem = "along it the rails would end too, which go on"
        yield f"supply.without_contact_line.{i}", "", problem, remedy


def _place(part: Mapping[str, Any]) -> tuple[object, float | None]:
    return part.get("line"), number(part, "position_km")
