"""Feeds: the switches between the busbar of a feeding station and the lines at its place."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, Field

from tpss.scenario.fields import Name, fault


def _once(names: tuple[str, ...]) -> tuple[str, ...]:
    twice = next((name for i, name in enumerate(names) if name in names[:i]), None)
    if twice is not None:
        raise fault(f"{twice} occurs twice", "name each line once")
    return names


Feeds = Annotated[tuple[Name, ...], Field(min_length=1), AfterValidator(_once)]


def feeds() -> Any:
    """Field with the lines that a station feeds."""
    return Field(
        default=None,
        description="Lines that it feeds, of those that meet at its place; leave it out: all of them.",
    )


class Feed(NamedTuple):
    """The feed of a line from a station, a switch."""

    station: str
    line: str

    @property
    def name(self) -> str:
        """By which an outage opens it."""
        return f"{self.station}>{self.line}"


Places = Mapping[str, Mapping[str, float]]
"""Positions of the stations of each line, by their names. [km]"""


def places_on(lines: Mapping[str, Any]) -> Places:
    """Places of the stations of lines, by the names of these."""
    return {
        name: {station.name: station.position_km for station in line.stations}
        for name, line in lines.items()
    }


def lines_at(line: str, position_km: float, places: Places) -> list[str]:
    """Lines that meet at a position on one of them, that one included."""
    here = {name for name, km in places[line].items() if km == position_km}
    return [name for name in places if name == line or here & places[name].keys()]


def feeds_of(station: Any, places: Places) -> Iterator[Feed]:
    """Feeds of a station, in the order of the lines.

    Parameters
    ----------
    station : Station
    places : mapping
        All lines, with at least the stations where they meet.
    """
    own = station.line or next(iter(places))
    for line in lines_at(own, station.position_km, places):
        if station.feeds is None or line in station.feeds:
            yield Feed(station.name, line)
