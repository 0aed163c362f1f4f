"""What railML 2 says of its tracks: lines, operational points, limits, gradients, curves, kilometres.

References
----------
https://wiki2.railml.org: ``line``, ``ocp``, ``crossSection``, ``mileageChange`` and the changes along
tracks.  Positions ``pos`` are from a track's beginning, ``absPos`` in kilometres of the line, in metres.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from xml.etree.ElementTree import Element

from tpss.importers.network import NO_LIMIT_KMH, own_name
from tpss.importers.railml2_changes import Change, Courses
from tpss.importers.railml2_kilometres import kilometre
from tpss.importers.railml2_topology import Topology
from tpss.importers.railml_file import RailmlFile, name_of
from tpss.importers.track_chains import joins_of
from tpss.importers.track_joints import joints_of
from tpss.importers.track_lines import LEAST_LIMIT_KMH
from tpss.importers.tracks import Limit, Place, Section, Tracks

MAIN = "mainTrack"

NO_STATEMENT_KMH = 999.0
"""Such a speed ended a restriction before the word "end" did. [km/h]"""

AT_STATIONS = ("platformEdge", "stopPost")
"""Elements that tell where an operational point is on a track without a cross section."""


class Reader:
    """Reader of a file's tracks."""

    def __init__(self, file: RailmlFile, point_names: dict[str, str]) -> None:
        self.file = file
        self.topology = Topology(file)
        self.counts: Counter[str] = Counter()
        self.lost: list[str] = []
        """Names of operational points without a place."""
        self._point_names = point_names
        self.electrified_m: Counter[tuple[float, float]] = Counter()
        """Lengths of track by voltage [V] and frequency [Hz]. [m]"""

    def tracks(self) -> Tracks:
        """All of the file."""
        sections = dict(self._sections())
        joints = joints_of(self.topology.ways)
        tracks = Tracks(sections, joints, tuple(self._places()), counts=self.counts)
        joins = joins_of(tracks)
        rising, bends = (
            Courses(self.topology, joins, self._changes(*kind)).stretches(1)
            for kind in (("gradientChange", "slope"), ("radiusChange", "radius"))
        )
        for ident, section in sections.items():
            sections[ident] = replace(
                section, gradients=tuple(rising[ident]), curves=tuple(bends[ident])
            )
        speeds = Courses(self.topology, joins, self._speeds())
        limits = [
            Limit(ident, begin_m, end_m, speed_kmh, (sign,))
            for sign in (1, -1)
            for ident, stretches in speeds.stretches(sign).items()
            for begin_m, end_m, speed_kmh in stretches
        ]
        self._note_electrification(joins)
        return replace(tracks, limits=tuple(limits))

    def _sections(self) -> Iterator[tuple[str, Section]]:
        lines = self._lines()
        for ident, track in self.topology.tracks.items():
            line, line_name = lines.get(ident, ("", ""))
            is_main = track.get("type", MAIN) == MAIN
            words = [line_name] if line_name and is_main else [line_name, name_of(track)]
            marks = self.topology.marks[ident]
            for piece in self.topology.pieces[ident]:
                begins_at_km, rises = kilometre(piece.begin_m, piece.end_m, marks)
                yield (
                    piece.id,
                    Section(
                        piece.id,
                        piece.end_m - piece.begin_m,
                        (line,) if line else (),
                        "_".join(filter(None, words)),
                        begins_at_km=begins_at_km,
                        rises=rises,
                    ),
                )

    def _lines(self) -> dict[str, tuple[str, str]]:
        """Id and name of the line of each track, the first one of several."""
        found: dict[str, tuple[str, str]] = {}
        taken: list[str] = []
        for line in self.file.root.iter("line"):
            name = own_name(name_of(line), taken)
            taken.append(name)
            for reference in line.iter("trackRef"):
                track = reference.get("ref", reference.get("id", ""))
                found.setdefault(track, (line.get("id", ""), name))
        return found

    def _places(self) -> Iterator[Place]:
        parts: dict[str, dict[str, float]] = defaultdict(dict)
        for ident, track in self.topology.tracks.items():
            for point, pos_m in self._points_of(ident, track):
                parts[point].setdefault(ident, pos_m)
        for ident, name in self._point_names.items():
            if parts.get(ident):
                where = [self.topology.place(track, pos_m) for track, pos_m in parts[ident].items()]
                yield Place(ident, name, tuple(where))
            else:
                self.lost.append(name)

    def _points_of(self, ident: str, track: Element) -> Iterator[tuple[str, float]]:
        """Operational points of a track with their positions, what tells them best first. [m]"""
        for section in track.iter("crossSection"):
            yield section.get("ocpRef", ""), self.file.number(section, "pos") or 0.0
        for tag, pos_m in (("trackBegin", 0.0), ("trackEnd", self.topology.length_m(ident))):
            for node in track.iter(tag):
                for macroscopic in node.iter("macroscopicNode"):
                    yield macroscopic.get("ocpRef", ""), pos_m
        for tag in AT_STATIONS:
            for element in track.iter(tag):
                if element.get("ocpRef"):
                    half_m = (self.file.number(element, "length") or 0.0) / 2.0
                    yield (
                        element.get("ocpRef", ""),
                        (self.file.number(element, "pos") or 0.0) + half_m,
                    )

    def _changes(self, tag: str, key: str) -> Iterator[Change]:
        for ident, track in self.topology.tracks.items():
            for element in track.iter(tag):
                pos_m, value = self.file.number(element, "pos"), self.file.number(element, key)
                if pos_m is None:
                    self.file.blame(element, "it has no pos", remedy="add it, in metres")
                elif value is None:
                    self.file.blame(element, f"it has no {key}", remedy=f"add its {key}")
                else:
                    yield Change(ident, pos_m, value)

    def _speeds(self) -> Iterator[Change]:
        """Changes of the speed of all trains, or of the profile that has most of them."""
        profiles = {each.get("id", "") for each in self.file.root.iter("speedProfile")}
        given: dict[str, list[tuple[str, Element]]] = defaultdict(list)
        for ident, track in self.topology.tracks.items():
            for element in track.iter("speedChange"):
                ref = element.get("profileRef", "")
                category = element.get("etcsTrainCategory", element.get("trainCategory", ""))
                given[ref if ref in profiles else category].append((ident, element))
        chosen = "" if "" in given else max(given, key=lambda key: len(given[key]), default="")
        self.counts["profile"] += sum(len(those) for key, those in given.items() if key != chosen)
        for ident, element in given.get(chosen, []):
            pos_m = self.file.number(element, "pos")
            if pos_m is None or not element.get("vMax"):
                key = "pos" if pos_m is None else "vMax"
                self.file.blame(element, f"it has no {key}", remedy=f"add its {key}")
                continue
            for sign in {"up": (1,), "down": (-1,)}.get(element.get("dir", ""), (1, -1)):
                yield Change(ident, pos_m, self._speed(element), sign)

    def _speed(self, element: Element) -> float | None:
        """Speed from a change on; None where it ends a restriction. [km/h]"""
        if element.get("vMax") == "end":
            return None
        speed_kmh = self.file.number(element, "vMax") or 0.0
        if speed_kmh < LEAST_LIMIT_KMH:
            self.counts["slow"] += 1
            return None
        return speed_kmh if speed_kmh < min(NO_LIMIT_KMH, NO_STATEMENT_KMH) else None

    def _note_electrification(self, joins: dict[tuple[str, str], tuple[str, str]]) -> None:
        systems = [(0.0, 0.0)]
        changes = []
        for ident, track in self.topology.tracks.items():
            for element in track.iter("electrificationChange"):
                voltage, frequency = (
                    self.file.number(element, key) or 0.0 for key in ("voltage", "frequency")
                )
                is_none = element.get("type", "none") == "none"
                system = (0.0, 0.0) if is_none else (voltage or -1.0, frequency)
                systems += [system] if system not in systems else []
                pos_m = self.file.number(element, "pos") or 0.0
                changes.append(Change(ident, pos_m, float(systems.index(system))))
        for stretches in Courses(self.topology, joins, changes).stretches(1).values():
            for begin_m, end_m, number in stretches:
                if number:
                    self.electrified_m[systems[int(number)]] += round(end_m - begin_m)
