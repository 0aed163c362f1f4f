"""Ways of imported trains: what they pass where the shortest way is not the only one."""

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from tpss.importers.timetable import Call, Train
from tpss.scenario.routes import Hop, NoWayError, Stations, find_way, hops_of

DECIMALS = 6
"""Of lengths that are compared: millimetres."""


def with_passes(trains: Sequence[Train], stations: Stations) -> tuple[list[Train], int]:
    """Trains with the stations that they pass where two ways are equally long; one of them is taken.

    Returns
    -------
    trains : list of Train
        Those that have a way.
    lost : int
        Number of the others.
    """
    hops = hops_of(_longest_first(stations))
    known: dict[tuple[str, str], list[str] | None] = {}
    found = []
    for train in trains:
        calls = [train.calls[0]]
        for before, after in pairwise(train.calls):
            ends = (before.station, after.station)
            if ends not in known:
                known[ends] = _passed(hops, *ends)
            passed = known[ends]
            if passed is None:
                break
            calls += [*map(Call, passed), after]
        else:
            found.append(replace(train, calls=tuple(calls)))
    return found, len(trains) - len(found)


def _longest_first(stations: Stations) -> Stations:
    """The lines in the order of their lengths: of ways of one length, that over long lines is meant."""
    lengths_km = {line: max(km.values()) - min(km.values()) for line, km in stations.items()}
    return {line: stations[line] for line in sorted(stations, key=lambda name: -lengths_km[name])}


def _passed(hops: Mapping[str, Sequence[Hop]], begin: str, end: str) -> list[str] | None:
    """Stations that tell a way from others of its length; None if there is no way at all."""
    if begin not in hops or end not in hops:
        return None
    if _is_unique(hops, begin, end, []):
        return []
    # A way without a station between its ends cannot be named; then another one is taken.
    passed = (
        _stations_between(hops, begin, end) or _stations_between(hops, begin, end, most=True) or []
    )
    for name in list(passed):
        fewer = [each for each in passed if each != name]
        if _is_unique(hops, begin, end, fewer):
            passed = fewer
    return passed or None


def _is_unique(
    hops: Mapping[str, Sequence[Hop]], begin: str, end: str, passed: Sequence[str]
) -> bool:
    """Whether there is one way over some stations."""
    try:
        find_way(hops, begin, [], end, passed)
    except NoWayError:
        return False
    return True


def _stations_between(
    hops: Mapping[str, Sequence[Hop]], begin: str, end: str, most: bool = False
) -> list[str] | None:
    """Stations of the shortest way; of equally long ones the first, or that with most stations."""
    came: dict[str, str] = {}
    waiting = [(0.0, 0, 0, begin, begin)]
    count = 0
    while waiting:
        reached_km, fewer, _, here, before = heapq.heappop(waiting)
        if here in came:
            continue
        came[here] = before
        if here == end:
            break
        for hop in hops[here]:
            count += 1
            total_km = round(reached_km + hop.length_km, DECIMALS)
            heapq.heappush(waiting, (total_km, fewer - most, count, hop.end, here))
    if end not in came:
        return None
    way = [came[end]]
    while way[-1] != begin:
        way.append(came[way[-1]])
    return way[-2::-1]


def example_way(stations: Stations) -> tuple[str, str, list[str]]:
    """Two stations that are far apart, and what lies between them where two ways are equally long."""
    hops = hops_of(_longest_first(stations))
    begin = _farthest(hops, next(iter(hops)))
    end = _farthest(hops, begin)
    return begin, end, _passed(hops, begin, end) or []


def _farthest(hops: Mapping[str, Sequence[Hop]], begin: str) -> str:
    """The station that is farthest from another along the shortest ways."""
    done: set[str] = set()
    waiting = [(0.0, begin)]
    here = begin
    while waiting:
        reached_km, place = heapq.heappop(waiting)
        if place in done:
            continue
        done.add(place)
        here = place
        for hop in hops[place]:
            heapq.heappush(waiting, (reached_km + hop.length_km, hop.end))
    return here
