"""Routes over the lines of a network: which way a train takes from station to station.

Lines meet at stations of the same name.  The way from one call to the next is the shortest; where two
ways are equally long, nobody but the user knows which one is meant.
"""

import heapq
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

Stations = Mapping[str, Mapping[str, float]]
"""Positions of the stations by the names of the lines, and their own. [km]"""

EQUAL_KM = 1e-6
"""Ways that differ by no more are equally long: by a millimetre."""


class Hop(NamedTuple):
    """A part of a route between neighbouring stations of a line."""

    line: str
    begin: str
    end: str
    begin_km: float
    end_km: float

    @property
    def sign(self) -> float:
        """1.0 towards rising kilometres, -1.0 towards falling ones."""
        return 1.0 if self.end_km > self.begin_km else -1.0

    @property
    def back(self) -> "Hop":
        """The same in the other direction."""
        return Hop(self.line, self.end, self.begin, self.end_km, self.begin_km)

    @property
    def length_km(self) -> float:
        """Its length. [km]"""
        return abs(self.end_km - self.begin_km)


class NoWayError(ValueError):
    """A service has no way, or not one only: what is wrong with which of its keys, and what to do."""

    def __init__(self, key: str, name: str, problem: str, remedy: str) -> None:
        super().__init__(problem)
        self.key, self.name, self.remedy = key, name, remedy


class Way(NamedTuple):
    """The way of a service."""

    hops: tuple[Hop, ...]
    stops: tuple[int, ...]
    """Numbers of the hops at whose ends it stops, the last one at its destination left out."""

    @property
    def stretches(self) -> list[Hop]:
        """Its hops, those that follow each other on a line in one direction taken together."""
        joined: list[Hop] = []
        for hop in self.hops:
            if joined and (joined[-1].line, joined[-1].sign) == (hop.line, hop.sign):
                hop = joined.pop()._replace(end=hop.end, end_km=hop.end_km)
            joined.append(hop)
        return joined

    @property
    def turns(self) -> list[int]:
        """Numbers of the hops at whose end a train turns round, to go back on the same line."""
        return [
            i
            for i, (before, after) in enumerate(pairwise(self.hops))
            if before.line == after.line and before.sign != after.sign
        ]

    def tracks(self, given: Mapping[int, int]) -> tuple[int | None, ...]:
        """Track that is given for each of its hops; None: trains take that of their direction.

        A track holds until another one is given, or the way leads on to another line.

        Parameters
        ----------
        given : mapping of int to int
            Tracks by the numbers of the hops at whose ends they are given; -1: at the origin.
        """
        found: list[int | None] = []
        for i, hop in enumerate(self.hops):
            goes_on = i > 0 and self.hops[i - 1].line == hop.line
            found.append(given.get(i - 1, found[-1] if goes_on else None))
        return tuple(found)

    def place(self, line: str, position_km: float) -> int | None:
        """Number of the hop on which a position of a line lies, its destination left out."""
        for i, hop in enumerate(self.hops):
            begin, end, here = (hop.sign * km for km in (hop.begin_km, hop.end_km, position_km))
            if hop.line == line and begin <= here < end:
                return i
        return None


def hops_of(stations: Stations) -> dict[str, list[Hop]]:
    """Hops of a network, in both directions, by the stations where they begin."""
    hops: dict[str, list[Hop]] = {name: [] for line in stations.values() for name in line}
    for line, places in stations.items():
        ordered = sorted(places, key=places.__getitem__)
        for low, high in pairwise(ordered):
            there = Hop(line, low, high, places[low], places[high])
            hops[low].append(there)
            hops[high].append(there.back)
    return hops


def find_way(
    hops: Mapping[str, Sequence[Hop]],
    origin: str,
    stops: Sequence[str],
    destination: str,
    via: Sequence[str] = (),
) -> Way:
    """The shortest way of a service that calls at its stops in order, or leads over `via`.

    Parameters
    ----------
    hops : mapping
        As from `hops_of`; it knows all the stations.
    origin, destination : str
        Stations where it begins and ends.
    stops : sequence of str
        Stations where it stops.
    via : sequence of str
        Stations that it passes, in order; the stops have to lie on the way over them.

    Raises
    ------
    NoWayError
        There is no way, or two ways are equally long.
    """
    keys = [f"via.{i}" for i in range(len(via))] or [
        f"stops.{i}.station" for i in range(len(stops))
    ]
    way: list[Hop] = []
    begin = origin
    for key, end in zip([*keys, "to"], [*(via or stops), destination], strict=True):
        if end == begin:
            raise NoWayError(key, end, f"its trains are at {end} already", "name another station")
        way += _shortest(hops, begin, end, key)
        begin = end
    return Way(tuple(way), calls_on(way, stops))


def _shortest(hops: Mapping[str, Sequence[Hop]], begin: str, end: str, key: str) -> list[Hop]:
    distance_km = _distances(hops, begin)
    if end not in distance_km:
        remedy = "lines meet at stations of the same name; name one of them on both lines"
        raise NoWayError(key, end, f"no lines lead from {begin} to {end}", remedy)
    way: list[Hop] = []
    here = end
    while here != begin:
        last = [
            hop.back
            for hop in hops[here]
            if distance_km[hop.end] + hop.length_km <= distance_km[here] + EQUAL_KM
        ]
        if len(last) > 1:
            ways = " and ".join(f"over {hop.begin} on {hop.line}" for hop in last[:2])
            problem = f"two ways from {begin} to {end} are equally long: {ways}"
            remedy = "name a station of the one that is meant in via"
            raise NoWayError(key, end, problem, remedy)
        way.append(last[0])
        here = last[0].begin
    return way[::-1]


def _distances(hops: Mapping[str, Sequence[Hop]], begin: str) -> dict[str, float]:
    """Distances of all stations that can be reached, by the method of Dijkstra. [km]"""
    found: dict[str, float] = {}
    waiting = [(0.0, begin)]
    while waiting:
        reached_km, here = heapq.heappop(waiting)
        if here in found:
            continue
        found[here] = reached_km
        for hop in hops[here]:
            if hop.end not in found:
                heapq.heappush(waiting, (reached_km + hop.length_km, hop.end))
    return found


def calls_on(way: Sequence[Hop], stops: Sequence[str], key: str = "stops") -> tuple[int, ...]:
    """Numbers of the hops at whose ends a way reaches its stops, or other stations, in order.

    Raises
    ------
    NoWayError
        It does not; of which key the stations are is said.
    """
    found: list[int] = []
    for k, name in enumerate(stops):
        first = found[-1] + 1 if found else 0
        here = next((i for i in range(first, len(way) - 1) if way[i].end == name), None)
        if here is None:
            problem = f"the way of its trains does not lead over {name}, or not in this order"
            remedy = f"list the {key} in the order of travel, or correct via"
            raise NoWayError(f"{key}.{k}.station", name, problem, remedy)
        found.append(here)
    return tuple(found)
