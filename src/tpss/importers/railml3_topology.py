"""Topology of railML 3: net elements with their lengths and kilometres, and how they meet.

References
----------
https://wiki3.railml.org: ``netElement``, ``netRelation``, ``network``, ``intrinsicCoordinate``.

Elements of the finest level are sections of track; those of other levels stand for the sections in them.
"""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from xml.etree.ElementTree import Element

from tpss.importers.railml3_kilometres import Point, jumps_of, way_m, with_jumps
from tpss.importers.railml_file import RailmlFile
from tpss.importers.track_joints import Way
from tpss.importers.tracks import End

LEVELS = ("Micro", "Meso", "Macro", "Corridor")
"""Levels of a network, the finest first."""

CLOSE_M = 1.0
"""A place that is so close to an element is on it. [m]"""

NO_LENGTH = "give it a length, kilometres at both ends (linearCoordinate), or a track with a length"


@dataclass(frozen=True)
class NetElement:
    """A section of track."""

    id: str
    length_m: float
    kilometres: dict[str, list[Point]] = field(default_factory=dict)
    """Intrinsic coordinate and distance [m] by positioning system, ascending in the coordinate."""

    def position_m(self, system: str, measure_m: float) -> float | None:
        """Position on the element of a distance in a positioning system; None if it is not on it. [m]"""
        for (a, a_m), (b, b_m) in pairwise(self.kilometres.get(system, [])):
            low_m, high_m = min(a_m, b_m), max(a_m, b_m)
            if low_m < high_m and low_m - CLOSE_M <= measure_m <= high_m + CLOSE_M:
                share = (min(max(measure_m, low_m), high_m) - a_m) / (b_m - a_m)
                return self.length_m * (a + share * (b - a))
        return None

    @property
    def begin_and_rise(self) -> tuple[float | None, int]:
        """Kilometre of its beginning [km], and 1 or -1 as kilometres rise or fall along it."""
        points = self._own_points
        if not points:
            return None, 1
        return points[0][1] / 1e3, 1 if points[-1][1] > points[0][1] else -1

    @property
    def jumps(self) -> tuple[tuple[float, float, float], ...]:
        """Where these kilometres jump [m], and those before and behind, towards its end. [km]"""
        return tuple(
            (self.length_m * a, a_m / 1e3, b_m / 1e3)
            for (a, a_m), (b, b_m) in pairwise(self._own_points)
            if a == b
        )

    @property
    def _own_points(self) -> list[Point]:
        """Points of the first positioning system that tells its beginning, and how it counts."""
        for points in self.kilometres.values():
            if len(points) > 1 and points[0][0] == 0.0 and points[0][1] != points[-1][1]:
                return points
        return []


class Topology:
    """Sections of track, and what stands for several of them."""

    def __init__(self, file: RailmlFile) -> None:
        self.file = file
        self.one_way = 0
        """Relations that may be travelled in one direction only."""
        self._units_m = {
            each.get("id", ""): 1e3 if each.get("units", "m").lower() == "km" else 1.0
            for each in file.root.iter("linearPositioningSystem")
        }
        self._jumps = jumps_of(file, self._units_m)
        given = [each for each in file.root.iter("netElement") if each.get("id")]
        self._parts = _parts(given)
        chosen = self._finest(given)
        own: dict[str, Element] = {}
        for element in given:
            ident = element.get("id", "")
            if ident in chosen and own.setdefault(ident, element) is not element:
                file.blame(element, "another netElement has this id")
        kilometres = {ident: self._kilometres(element) for ident, element in own.items()}
        lengths_m = {
            ident: self._length_m(element, kilometres[ident]) for ident, element in own.items()
        }
        self.shared = share_tracks(file, own, lengths_m)
        """Sections whose lengths are shares of their track's."""
        for ident, element in own.items():
            if lengths_m[ident] <= 0.0:
                file.blame(element, "it has no length", remedy=NO_LENGTH)
        self.elements = {
            ident: NetElement(ident, max(lengths_m[ident], CLOSE_M), kilometres[ident])
            for ident in own
        }
        known = {each.get("id", "") for each in given}
        self.relations = list(self._relations(known))

    def sections_in(self, ident: str) -> list[NetElement] | None:
        """Sections that an element is or stands for; None if there is no such element."""
        if ident in self.elements:
            return [self.elements[ident]]
        if ident not in self._parts:
            return None
        found: dict[str, NetElement] = {}
        waiting, seen = [ident], set[str]()
        while waiting:
            name = waiting.pop(0)
            if name in self.elements:
                found[name] = self.elements[name]
            elif name not in seen:
                seen.add(name)
                waiting += self._parts.get(name, [])
        return list(found.values())

    def distance_m(self, coordinate: Element) -> tuple[str, float] | None:
        """Positioning system and distance of a linear coordinate. [m]"""
        measure = self.file.number(coordinate, "measure")
        system = coordinate.get("positioningSystemRef", "")
        return None if measure is None else (system, measure * self._units_m.get(system, 1.0))

    def _finest(self, given: list[Element]) -> set[str]:
        """Elements of the finest level that has any; without levels, those that have no parts."""
        idents = {each.get("id", "") for each in given}
        levels = {
            level.get("descriptionLevel", ""): {
                each.get("ref", "") for each in level.iter("networkResource")
            }
            & idents
            for level in self.file.root.iter("level")
        }
        found = next((levels[name] for name in LEVELS if levels.get(name)), None)
        return found or {name for name in idents if not self._parts[name]}

    def _kilometres(self, element: Element) -> dict[str, list[Point]]:
        """Intrinsic coordinates and distances [m] of an element, by positioning system."""
        found: dict[str, list[Point]] = defaultdict(list)
        for point in element.iter("intrinsicCoordinate"):
            at = self.file.number(point, "intrinsicCoord")
            for coordinate in point.iter("linearCoordinate"):
                distance = self.distance_m(coordinate)
                if at is not None and distance is not None:
                    found[distance[0]].append((at, distance[1]))
        return {
            system: with_jumps(sorted(points), self._jumps.get(system, ()))
            for system, points in found.items()
        }

    def _length_m(self, element: Element, kilometres: dict[str, list[Point]]) -> float:
        """Length of an element, else between its kilometres; 0 without any. [m]"""
        given = self.file.number(element, "length")
        if given is not None:
            return given
        whole = [
            way_m(points)
            for points in kilometres.values()
            if (points[0][0], points[-1][0]) == (0.0, 1.0)
        ]
        return next((each for each in whole if each), 0.0)

    def _relations(self, known: set[str]) -> Iterator[Way]:
        for relation in self.file.root.iter("netRelation"):
            refs = [
                next((each.get("ref", "") for each in relation.iter(tag)), "")
                for tag in ("elementA", "elementB")
            ]
            missing = [ref for ref in refs if ref not in known]
            for ref in missing:
                self.file.blame(relation, f"there is no netElement {ref!r}")
            if missing or not all(ref in self.elements for ref in refs):
                continue  # of another level
            ends = [self._end(relation, ref, key) for ref, key in zip(refs, "AB", strict=True)]
            navigability = relation.get("navigability", "Both")
            self.one_way += navigability in ("AB", "BA")
            is_open = navigability != "None"
            yield Way(relation.get("id", ""), (ends[0], ends[1]), is_open=is_open)

    def _end(self, relation: Element, ref: str, letter: str) -> End:
        key = f"positionOn{letter}"
        if relation.get(key) not in ("0", "1"):
            self.file.blame(relation, "neither 0 nor 1", key, "say which end of the element meets")
        return ref, "END" if relation.get(key) == "1" else "BEGIN"


def share_tracks(
    file: RailmlFile, elements: dict[str, Element], lengths_m: dict[str, float]
) -> int:
    """Give elements without a length their share of what is left of their track's. [m]

    Shares are as the elements are drawn, by their geometric coordinates.  Return the number of elements
    that have others beside them without a length.
    """
    shared = 0
    for track in file.root.iter("track"):
        parts = [each.get("netElementRef", "") for each in track.iter("associatedNetElement")]
        parts = [part for part in dict.fromkeys(parts) if part in elements]
        lacking = [part for part in parts if lengths_m[part] <= 0.0]
        whole_m = next((file.number(each, "value") for each in track.iter("length")), None)
        left_m = (whole_m or 0.0) - sum(lengths_m[part] for part in parts)
        drawn = {part: _drawn(file, elements[part]) for part in lacking}
        if len(lacking) == 1:
            drawn = dict.fromkeys(lacking, 1.0)
        if left_m > 0.0 and lacking and all(drawn.values()):
            for part in lacking:
                lengths_m[part] = left_m * drawn[part] / sum(drawn.values())
            shared += len(lacking) if len(lacking) > 1 else 0
    return shared


def _drawn(file: RailmlFile, element: Element) -> float:
    """Length of an element as it is drawn; 0 if it is not."""
    points = [
        (file.number(each, "x") or 0.0, file.number(each, "y") or 0.0)
        for each in element.iter("geometricCoordinate")
    ]
    return sum(math.dist(a, b) for a, b in pairwise(points))


def _parts(given: list[Element]) -> dict[str, list[str]]:
    """Elements that each element is made of."""
    parts: dict[str, list[str]] = {each.get("id", ""): [] for each in given}
    for element in given:
        parts[element.get("id", "")] += [
            each.get("ref", "") for each in element.iter("elementPart")
        ]
    return parts
