"""Kilometres of railML 3 that jump: where a positioning system says so, and what it means to elements.

References
----------
https://wiki3.railml.org: ``anchor`` of a ``linearPositioningSystem``, whose ``measure`` is the kilometre
there and whose ``measureToNext`` the way to the next one, and ``mileageChange`` with a spot location for
the kilometre that ends and one for the kilometre that begins.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from xml.etree.ElementTree import Element

from tpss.importers.railml_file import RailmlFile

CLOSE_M = 1.0
"""Kilometres that differ by less follow from each other. [m]"""

Point = tuple[float, float]
"""Share of the way along an element, and the distance in a positioning system there [m]; two at one
place where that jumps."""

Jumps = dict[str, list[tuple[float, float]]]
"""Distances before and behind each jump, by positioning system. [m]"""


def jumps_of(file: RailmlFile, units_m: dict[str, float]) -> Jumps:
    """Jumps of the positioning systems of a file, in the direction in which these count.

    Parameters
    ----------
    file : RailmlFile
    units_m : dict
        Units of the positioning systems. [m]
    """
    found: Jumps = defaultdict(list)
    for system in file.root.iter("linearPositioningSystem"):
        ident = system.get("id", "")
        found[ident] += _at_anchors(file, system, units_m.get(ident, 1.0))
    for change in file.root.iter("mileageChange"):
        ends = [
            (each.get("positioningSystemRef", ""), measure) for each, measure in _ends(file, change)
        ]
        if len(ends) == 2:
            ident = ends[0][0]
            before, after = (measure * units_m.get(ident, 1.0) for _, measure in ends)
            found[ident].append((before, after))
    return found


def _ends(file: RailmlFile, change: Element) -> list[tuple[Element, float]]:
    """Coordinates before and behind a mileage change, with their distances."""
    spots = [each for each in change if each.tag == "spotLocation"]
    named = {each.get("id", ""): each for each in spots}
    told = [named[ref] for key in ("from", "to") if (ref := change.get(key, "")) in named]
    coordinates = (
        next(spot.iter("linearCoordinate"), None)
        for spot in (told if len(told) == 2 else spots[:2])
    )
    return [
        (each, measure)
        for each in coordinates
        if each is not None and (measure := file.number(each, "measure")) is not None
    ]


def _at_anchors(file: RailmlFile, system: Element, unit_m: float) -> Iterator[tuple[float, float]]:
    first, last = (file.number(system, key) or 0.0 for key in ("startMeasure", "endMeasure"))
    sign = 1.0 if last >= first else -1.0
    anchors = [
        (measure * unit_m, way * unit_m)
        for each in system.iter("anchor")
        if (measure := file.number(each, "measure")) is not None
        and (way := file.number(each, "measureToNext")) is not None
    ]
    for (measure_m, way_m), (next_m, _) in pairwise(anchors):
        expected_m = measure_m + sign * way_m
        if abs(next_m - expected_m) > CLOSE_M:
            yield expected_m, next_m


def with_jumps(points: Sequence[Point], jumps: Iterable[tuple[float, float]]) -> list[Point]:
    """Points along an element with the jumps between its ends.

    Parameters
    ----------
    points : sequence of tuple
        Those of the file, ascending.
    jumps : iterable of tuple
        Jumps of the positioning system.
    """
    if len(points) < 2 or (points[0][0], points[-1][0]) != (0.0, 1.0):
        return list(points)
    begin_m, end_m = points[0][1], points[-1][1]
    sign = 1.0 if end_m >= begin_m else -1.0
    low_m, high_m = sorted((begin_m, end_m))
    inside = [each for each in jumps if low_m <= min(each) and max(each) <= high_m]
    inside.sort(key=lambda each: sign * min(each))
    if not inside:
        return list(points)
    # A falling element meets what is behind a jump first, if its system rises.
    met = [each if sign > 0.0 else each[::-1] for each in inside]
    distances = [begin_m, *(distance for each in met for distance in each), end_m]
    ways_m = [sign * (b - a) for a, b in zip(distances[::2], distances[1::2], strict=True)]
    if min(ways_m) < 0.0 or sum(ways_m) <= 0.0:
        return list(points)
    found = [points[0]]
    way_m = 0.0
    for (before_m, after_m), part_m in zip(met, ways_m, strict=False):
        way_m += part_m
        found += [(way_m / sum(ways_m), before_m), (way_m / sum(ways_m), after_m)]
    return [*found, points[-1]]


def way_m(points: Sequence[Point]) -> float:
    """Way along points, without jumps. [m]"""
    return sum(abs(b_m - a_m) for (a, a_m), (b, b_m) in pairwise(points) if a != b)
