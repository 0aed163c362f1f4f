"""Where feeding stations are assumed for an imported network, of which no format tells any.

Each part of the contact line has one at least, where most of its lines meet, and so many that none of
its stations is far from one.
"""

import heapq
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from tpss.importers.network import ImportedNetwork
from tpss.importers.quantities import DIGITS
from tpss.importers.supplies import supply_of
from tpss.scenario.routes import Hop, hops_of
from tpss.units import kilometres


class FeedingPlace(NamedTuple):
    """Where a feeding station is assumed."""

    name: str
    at: str
    """Station of the network; empty where there is none."""
    line: str = ""
    position_km: float = 0.0
    """Its place otherwise."""


class _Stretch(NamedTuple):
    """A line between two neutral sections, in the line's kilometres."""

    line: str
    from_km: float
    to_km: float
    stations: dict[str, float]


def feeding_places(network: ImportedNetwork) -> list[FeedingPlace]:
    """Feeding stations for all parts of the contact line."""
    reach_km = supply_of(network.system).reach_km
    return [place for part in _parts(_stretches(network)) for place in _places_in(part, reach_km)]


def _stretches(network: ImportedNetwork) -> Iterator[_Stretch]:
    for line in network.lines:
        neutral = sorted(each for each in network.neutral_sections if each.line == line.name)
        begin_km, end_km = line.begins_at_km, line.begins_at_km + line.length_km
        places = {name: round(begin_km + km, DIGITS) for name, km in line.stations.items()}
        begins = [begin_km, *(each.to_km for each in neutral)]
        ends = [*(each.from_km for each in neutral), round(end_km, DIGITS)]
        for a, b in zip(begins, ends, strict=True):
            inside = {name: km for name, km in places.items() if a <= km <= b}
            yield _Stretch(line.name, a, b, inside)


def _parts(stretches: Iterable[_Stretch]) -> list[list[_Stretch]]:
    """Stretches that hang together by their stations."""
    parts: list[tuple[set[str], list[_Stretch]]] = []
    for stretch in stretches:
        names, here = set(stretch.stations), [stretch]
        apart = []
        for part in parts:
            if part[0] & names:
                names |= part[0]
                here = [*part[1], *here]
            else:
                apart.append(part)
        parts = [*apart, (names, here)]
    return [here for _, here in parts]


def _places_in(part: Sequence[_Stretch], reach_km: float) -> Iterator[FeedingPlace]:
    names = [name for stretch in part for name in stretch.stations]
    if not names:
        line, from_km, to_km, _ = part[0]
        middle_km = round((from_km + to_km) / 2.0, 3)
        yield FeedingPlace(f"{line} {kilometres(middle_km)} km", "", line, middle_km)
        return
    hops = hops_of({str(i): stretch.stations for i, stretch in enumerate(part)})
    chosen = [max(names, key=names.count)]
    while True:
        distance_km, farthest = _farthest(hops, chosen)
        if distance_km <= reach_km:
            break
        chosen.append(farthest)
    yield from (FeedingPlace(name, name) for name in chosen)


def _farthest(hops: Mapping[str, Sequence[Hop]], sources: Iterable[str]) -> tuple[float, str]:
    """Distance [km] and name of the station that is farthest from the nearest of some others."""
    waiting = [(0.0, name) for name in sources]
    done: set[str] = set()
    last = waiting[0]
    while waiting:
        reached_km, here = heapq.heappop(waiting)
        if here not in done:
            done.add(here)
            last = (reached_km, here)
            for hop in hops.get(here, ()):
                heapq.heappush(waiting, (reached_km + hop.length_km, hop.end))
    return last
