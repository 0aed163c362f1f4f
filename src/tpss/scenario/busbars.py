"""Checks of busbars at which several transformer stations stand: their grid is told alike by all.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tpss.scenario.raw import Fault, items, number, table
from tpss.scenario.supply.transformer_station import TransformerStation

OF_THE_GRID = ("grid_kv", "grid_short_circuit_mva", "grid_r_over_x", "unbalance_limit_percent")
"""Keys of stations that describe the grid, and so are the same at one busbar."""

REMEDIES = {
    "phases": 'add phases = "RS", "ST" or "TR", or leave busbar out',
    "grid_short_circuit_mva": "add it: stations share the impedance of the grid",
}
"""What a station at a busbar with others has to tell, and what to do if it does not."""


IN_PLACE = {"phases": ("phases", "connection", "phases_before", "phases_behind")}
"""Keys that tell the same, or have a fault of their own."""


class _Standing(NamedTuple):
    """A station at a busbar as far as it is written."""

    key: str
    part: Mapping[str, Any]
    busbar: str


def check_busbars(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Stations at one busbar that tell no phases or no grid, or another one; other load flows."""
    shared = list(_shared(table(document, "supply")))
    for each in shared:
        for key, remedy in REMEDIES.items():
            if not any(other in each.part for other in IN_PLACE.get(key, (key,))):
                yield f"{each.key}.{key}", "", f"missing at the busbar {each.busbar}", remedy
        yield from _ideal(each)
        first = next(other for other in shared if other.busbar == each.busbar)
        yield from _another_grid(each, first)
    if shared and table(document, "simulation").get("load_flow") == "least-squares":
        problem = (
            f"it knows no grid that stations share, as those at the busbar {shared[0].busbar} do"
        )
        remedy = 'use "equations", or leave busbar out'
        yield "simulation.load_flow", "'least-squares'", problem, remedy


def _shared(supply: Mapping[str, Any]) -> Iterator[_Standing]:
    """Stations that share a grid with others, or by their connection with themselves."""
    standing = [
        _Standing(f"supply.transformer_stations.{i}", each, str(each.get("busbar", name)))
        for i, each in items(supply, "transformer_stations")
        if isinstance(name := each.get("name"), str)
    ]
    for each in standing:
        others = [other for other in standing if other.busbar == each.busbar]
        if len(others) > 1 or each.part.get("connection") == "V/V":
            yield each


def _ideal(station: _Standing) -> Iterator[Fault]:
    """A transformer without impedance: two of them between the same phases would be a short circuit."""
    unit = table(station.part, "transformer")
    if number(unit, "short_circuit_percent") == 0.0:
        key = f"{station.key}.transformer.short_circuit_percent"
        problem = f"no impedance, at the busbar {station.busbar} with others"
        yield key, "0", problem, "give its short-circuit voltage, some 10 %"


def _another_grid(station: _Standing, first: _Standing) -> Iterator[Fault]:
    """What a station says of the grid in another way than the first one of its busbar."""
    for key in OF_THE_GRID:
        default = TransformerStation.model_fields[key].default
        here, there = station.part.get(key, default), first.part.get(key, default)
        if here is not None and there is not None and here != there:
            problem = f"{first.part['name']} says {there} of the same busbar, {station.busbar}"
            remedy = f"give both the same {key}, or another busbar"
            yield f"{station.key}.{key}", str(here), problem, remedy
