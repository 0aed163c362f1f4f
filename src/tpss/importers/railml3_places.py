"""Places of railML 3's elements: spots and stretches on sections of track.

References
----------
https://wiki3.railml.org: ``spotLocation``, ``linearLocation``, ``areaLocation``, ``networkLocation``,
``associatedNetElement``.
"""

from collections.abc import Iterator
from typing import NamedTuple
from xml.etree.ElementTree import Element

from tpss.importers.railml3_topology import NetElement, Topology

SIGNS = {"normal": (1,), "reverse": (-1,)}
"""Signs of directions; of others it is both."""

POSITIONS = {"Begin": ("posBegin", "fromPos"), "End": ("posEnd", "toPos")}
"""Attributes of distances from an element's beginning, as different versions name them."""


class Span(NamedTuple):
    """A stretch of a section of track."""

    section: str
    begin_m: float
    end_m: float
    signs: tuple[int, ...]
    """1: for trains towards the section's end; -1: towards its beginning."""


class Places:
    """Where elements of a file are."""

    def __init__(self, topology: Topology) -> None:
        self.topology = topology
        self.file = topology.file
        self.whole = 0
        """Stretches told by kilometres on sections without these, taken for the whole section."""

    def spots(self, element: Element) -> list[tuple[str, float]]:
        """Sections and positions of an element's spot locations. [m]"""
        found: list[tuple[str, float]] = []
        for location in element:
            if location.tag == "spotLocation":
                found += self._spots(location)
        return found

    def spans(self, element: Element) -> list[Span]:
        """Stretches of an element's linear locations; all the network if it lies on that."""
        found: list[Span] = []
        for location in element:
            if location.tag == "networkLocation":
                found += [_whole(each, (1, -1)) for each in self.topology.elements.values()]
            elif location.tag in ("linearLocation", "areaLocation"):
                direction = SIGNS.get(location.get("applicationDirection", "both"), (1, -1))
                for part in location.iter("associatedNetElement"):
                    turns = part.get("keepsOrientation", "true") == "false"
                    signs = tuple(-sign for sign in direction) if turns else direction
                    found += self._spans(part, signs)
        return found

    def _sections(self, element: Element) -> list[NetElement]:
        found = self.topology.sections_in(element.get("netElementRef", ""))
        if found is None:
            self.file.blame(element, "there is no such netElement", "netElementRef")
        return found or []

    def _spots(self, location: Element) -> Iterator[tuple[str, float]]:
        sections = self._sections(location)
        distances = [self.topology.distance_m(each) for each in location.iter("linearCoordinate")]
        for section in sections:
            if len(sections) == 1:
                pos, share = (self.file.number(location, key) for key in ("pos", "intrinsicCoord"))
                if pos is not None or share is not None:
                    yield section.id, pos if pos is not None else (share or 0.0) * section.length_m
                    continue
            for distance in distances:
                position_m = distance and section.position_m(*distance)
                if position_m is not None:
                    yield section.id, position_m
                    break

    def _spans(self, part: Element, signs: tuple[int, ...]) -> Iterator[Span]:
        sections, told = self._sections(part), self._told(part)
        for section in sections:
            ends_m = self._ends_m(part, section) if len(sections) == 1 else None
            if ends_m is None and told is not None:
                system, low_m, high_m = told
                if section.kilometres.get(system):
                    ends_m = _between(section, system, low_m, high_m)
                    if ends_m is None:
                        continue  # on other sections of the same element
                else:
                    self.whole += 1
            begin_m, end_m = ends_m or (0.0, section.length_m)
            yield Span(section.id, min(begin_m, end_m), max(begin_m, end_m), signs)

    def _told(self, part: Element) -> tuple[str, float, float] | None:
        """Positioning system of a stretch, and its lower and its higher distance in that. [m]"""
        ends = [
            distance
            for tag in ("linearCoordinateBegin", "linearCoordinateEnd")
            for coordinate in part.iter(tag)
            if (distance := self.topology.distance_m(coordinate)) is not None
        ]
        if len(ends) != 2 or ends[0][0] != ends[1][0]:
            return None
        low_m, high_m = sorted(distance_m for _, distance_m in ends)
        return ends[0][0], low_m, high_m

    def _ends_m(self, part: Element, section: NetElement) -> tuple[float, float] | None:
        """Ends of a stretch by their distances from the section's beginning, or shares of its length."""
        ends = []
        for word, keys in POSITIONS.items():
            pos = self.file.number(part, *keys)
            share = self.file.number(part, f"intrinsicCoord{word}")
            if pos is None and share is not None:
                pos = share * section.length_m
            ends.append(pos)
        begin_m, end_m = ends
        return None if begin_m is None or end_m is None else (begin_m, end_m)


def _between(
    section: NetElement, system: str, low_m: float, high_m: float
) -> tuple[float, float] | None:
    """Part of a section between two distances, cut off at its ends; None if it is not between them."""
    own_m = [distance_m for _, distance_m in section.kilometres[system]]
    low_m, high_m = max(low_m, min(own_m)), min(high_m, max(own_m))
    if high_m <= low_m:
        return None
    cut = section.position_m(system, low_m), section.position_m(system, high_m)
    return None if cut[0] is None or cut[1] is None else (cut[0], cut[1])


def _whole(section: NetElement, signs: tuple[int, ...]) -> Span:
    return Span(section.id, 0.0, section.length_m, signs)
