"""Checks of feeding points: whether stations and transformers stand apart from each other.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.raw import Fault, items, number, table
from tpss.scenario.supply.supply import STATIONS
from tpss.units import kilometres

MOST_SPACED = 100
"""More transformers between two stations are a fault of their own."""


def check_feeding_points(supply: Mapping[str, Any]) -> Iterator[Fault]:
    """Feeding points that are too close to each other."""
    stations: dict[object, list[float]] = {}
    listed = [(kind, i, each) for kind in STATIONS for i, each in items(supply, kind)]
    for kind, i, station in listed:
        key = f"supply.{kind}.{i}.position_km"
        position = number(station, "position_km")
        if position is not None:
            there = stations.setdefault(str(station.get("line", "")), [])
            yield from _too_close(key, position, [s for s in there if s != position])
            there.append(position)
    high_voltage = table(supply, "high_voltage_line")
    beside = stations.get(str(high_voltage.get("line", "")), [])
    yield from _placed_transformers(high_voltage, beside)
    yield from _spaced_transformers(high_voltage, sorted(beside))


def _too_close(key: str, position: float, others: list[float]) -> Iterator[Fault]:
    """Two feeding points closer than a metre count as one: rounding may not separate them."""
    if any(abs(position - other) < CLOSEST_KM for other in others):
        problem = "closer than a metre to another converter station or transformer"
        yield key, f"{position:.17g}", problem, "leave one of them out, or place it elsewhere"


def _placed_transformers(high_voltage: Mapping[str, Any], stations: list[float]) -> Iterator[Fault]:
    given = high_voltage.get("transformers_km")
    before: list[float] = []
    for i, position in enumerate(given if isinstance(given, list | tuple) else []):
        key = f"supply.high_voltage_line.transformers_km.{i}"
        km = number({"": position}, "")
        if km is None:
            continue
        if km in stations:
            problem = "a converter station is here, which has its own transformer"
            yield key, kilometres(km), problem, "leave it out, or place it elsewhere"
        else:
            yield from _too_close(key, km, [*stations, *(other for other in before if other != km)])
        before.append(km)


def placed_transformers(supply: Mapping[str, Any], lines: int) -> list[float]:
    """Positions of the transformers of the high-voltage line between stations, given or spaced. [km]

    Parameters
    ----------
    supply : mapping
    lines : int
        How many lines there are.
    """
    high_voltage = table(supply, "high_voltage_line")
    given, count = high_voltage.get("transformers_km"), number(high_voltage, "transformers")
    if isinstance(given, list | tuple):
        return [km for each in given if (km := number({"": each}, "")) is not None]
    beside = [
        km
        for kind in STATIONS
        for _, each in items(supply, kind)
        if lines == 1 or each.get("line") == high_voltage.get("line")
        if (km := number(each, "position_km")) is not None
    ]
    if count is None or not 1.0 <= count <= MOST_SPACED:
        return []
    shares = [(i + 1.0) / (count + 1.0) for i in range(int(count))]
    return [a + (b - a) * share for a, b in pairwise(sorted(beside)) for share in shares]


def _spaced_transformers(high_voltage: Mapping[str, Any], stations: list[float]) -> Iterator[Fault]:
    count = number(high_voltage, "transformers")
    if count is None or count <= 0.0:
        return
    key, shown = "supply.high_voltage_line.transformers", str(high_voltage["transformers"])
    if len(stations) < 2:
        problem = "there are no two converter stations between which to space them"
        yield key, shown, problem, "give transformers_km instead"
    elif min(b - a for a, b in pairwise(stations)) / (count + 1.0) < CLOSEST_KM:
        problem = "closer than a metre to each other between neighbouring converter stations"
        yield key, shown, problem, "use fewer, or give transformers_km instead"
