"""Put positions in place of the stations at which something stands."""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss.scenario.override import copy_of
from tpss.scenario.raw import items, lines_of, places_of, table
from tpss.scenario.supply.supply import STATIONS, STORAGE


def stand_at_stations(document: dict[str, Any]) -> dict[str, Any]:
    """A document in which everything that names a station has its line and position too.

    Where lines meet, they are one feeding point: the first line that has the station is taken.  What is
    unknown or contradicts itself is left to be reported.
    """
    if not any("at" in part for part in _parts(document)):
        return document
    document = copy_of(document)
    stations = {name: places_of(line) for name, (_, line) in lines_of(document).items()}
    for part in _parts(document):
        station, line = part.get("at"), part.get("line")
        for name, places in stations.items():
            if isinstance(station, str) and station in places and line in (None, name):
                part.setdefault("position_km", places[station])
                if len(stations) > 1:
                    part["line"] = name
                break
    return document


def _parts(document: Mapping[str, Any]) -> Iterator[Any]:
    """Tables of all that may stand at a station."""
    supply = table(document, "supply")
    for kind in (*STATIONS, "posts", STORAGE):
        yield from (part for _, part in items(supply, kind))
