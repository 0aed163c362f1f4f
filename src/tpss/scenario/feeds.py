"""Checks of feeds: whether the lines that stations feed pass there, and no two stations share a place.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tpss.errors import closest
from tpss.scenario.raw import Fault, items, lines_of, number, places_of, table
from tpss.scenario.supply.feeds import lines_at
from tpss.scenario.supply.supply import STATIONS
from tpss.units import kilometres


class _Standing(NamedTuple):
    """A feeding station as far as it is written."""

    key: str
    part: Mapping[str, Any]
    line: str
    position_km: float


def check_feeds(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Lines that are fed and do not pass there; two stations where lines meet."""
    places = {name: places_of(line) for name, (_, line) in lines_of(document).items()}
    standing = list(_standing(table(document, "supply"), list(places)))
    for each in standing:
        yield from _elsewhere(each, places)
    for i, each in enumerate(standing):
        passing = lines_at(each.line, each.position_km, places)
        for other in standing[:i]:
            if other.line != each.line and _is_there(other, each, passing, places):
                problem = (
                    f"{other.part.get('name')} stands here too, where {' and '.join(passing)} meet"
                )
                remedy = "make them one station, or place one of them elsewhere"
                yield f"{each.key}.position_km", kilometres(each.position_km), problem, remedy


def _standing(supply: Mapping[str, Any], lines: list[str]) -> Iterator[_Standing]:
    only = lines[0] if len(lines) == 1 else None
    for kind in STATIONS:
        for i, part in items(supply, kind):
            line, km = part.get("line", only), number(part, "position_km")
            if line in lines and km is not None:
                yield _Standing(f"supply.{kind}.{i}", part, str(line), km)


def _elsewhere(station: _Standing, places: Mapping[str, Mapping[str, float]]) -> Iterator[Fault]:
    """Lines that a station feeds and that do not pass at its place."""
    feeds = station.part.get("feeds")
    passing = lines_at(station.line, station.position_km, places)
    for k, name in enumerate(feeds if isinstance(feeds, list | tuple) else []):
        if not isinstance(name, str) or name in passing:
            continue
        hint = f"did you mean {close}? " if (close := closest(name, list(places))) else ""
        at = f"{station.line} {kilometres(station.position_km)} km"
        known = name in places
        problem = f"it does not pass at {at}" if known else "there is no such line"
        remedy = f"{'' if known else hint}lines there: {', '.join(passing)}"
        yield f"{station.key}.feeds.{k}", repr(name), problem, remedy


def _is_there(
    other: _Standing,
    station: _Standing,
    passing: list[str],
    places: Mapping[str, Mapping[str, float]],
) -> bool:
    """Whether another station stands at the place of a station, on another line."""
    if other.line not in passing:
        return False
    shared = {name for name, km in places[station.line].items() if km == station.position_km}
    return any(places[other.line].get(name) == other.position_km for name in shared)
