"""Which lines a feeding station feeds: those that share its busbar, and those parted from it."""

from collections.abc import Sequence
from typing import NamedTuple

from tpss.model.contact_line import LineLayout
from tpss.model.parting import Parting
from tpss.scenario.supply import Station, Supply
from tpss.scenario.supply.feeds import feeds_of


class Feeding(NamedTuple):
    """A station and the lines that it feeds."""

    station: Station
    home: str
    """Line on which it stands."""
    junction: str | None
    """Station where lines meet at its place; None: there is only one line."""
    places_km: dict[str, float]
    """Where it stands on each line that it feeds. [km]"""
    shared: tuple[str, ...]
    """Those whose contact line is its busbar there."""
    parted: tuple[str, ...]
    """Those whose feeds are open in the layout."""


def feedings_of(supply: Supply, lines: Sequence[LineLayout], parting: Parting) -> list[Feeding]:
    """Feedings of all stations, in their order."""
    places = {line.name: {name: km for km, name in line.junctions} for line in lines}
    found = []
    for station in supply.stations:
        home = next(line for line in lines if line.holds(station.line))
        feeds = list(feeds_of(station, places))
        here = [name for km, name in home.junctions if km == station.position_km]
        places_km = {f.line: places[f.line][here[0]] for f in feeds if f.line != home.name}
        if home.name in [f.line for f in feeds]:
            places_km[home.name] = station.position_km
        found.append(
            Feeding(
                station,
                home.name,
                here[0] if here else None,
                places_km,
                tuple(f.line for f in feeds if f.name not in parting.feeds),
                tuple(f.line for f in feeds if f.name in parting.feeds),
            )
        )
    return found
