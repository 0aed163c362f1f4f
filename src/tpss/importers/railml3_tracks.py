"""What railML 3 says of its tracks: lines, operational points, limits, gradients, curves.

References
----------
https://wiki3.railml.org: ``line``, ``track``, ``operationalPoint``, ``speedSection``, ``gradientCurve``,
``horizontalCurve``, ``switchIS``, ``electrificationSection``.  Gradients are in per mille, positive
uphill in the direction of their location, speeds in km/h.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import replace
from xml.etree.ElementTree import Element

from tpss.importers.network import NO_LIMIT_KMH, own_name
from tpss.importers.railml3_places import Places, Span
from tpss.importers.railml3_topology import Topology
from tpss.importers.railml_file import RailmlFile, name_of
from tpss.importers.track_joints import Way, joints_of
from tpss.importers.track_lines import LEAST_LIMIT_KMH
from tpss.importers.tracks import Limit, Neutral, Place, Section, Stretch, Tracks

MAIN = "mainTrack"

CLOSE_M = 1.0
"""Gradients that are no farther apart follow each other. [m]"""

SEPARATIONS = ("phaseSeparationSection", "systemSeparationSection")

LONGEST_NEUTRAL_M = 2000.0
"""What separates phases or systems on a longer stretch only tells that it is somewhere on it. [m]"""

OWNED = ("ownsPlatform", "ownsPlatformEdge", "ownsStoppingPlace", "ownsTrack")
"""Equipment that tells where an operational point is, if it does not tell so itself."""


class Reader:
    """Reader of a file's functional infrastructure."""

    def __init__(self, file: RailmlFile) -> None:
        self.file = file
        self.topology = Topology(file)
        self.places = Places(self.topology)
        self.counts: Counter[str] = Counter()
        """What is left out, by why."""
        self.lost: list[str] = []
        """Names of operational points without a place."""
        top = file.root.find(".//functionalInfrastructure")
        self._top = Element("functionalInfrastructure") if top is None else top
        self._by_id = {each.get("id", ""): each for each in self._top.iter() if each.get("id")}

    def tracks(self) -> Tracks:
        """All of the file."""
        kinds, names = self._tracks()
        sections = self._sections(kinds, names)
        places = tuple(self._operational_points())
        limits = (*self._line_limits(), *self._limits())
        neutral = tuple(self._neutral_sections())
        joints = joints_of(self._ways(kinds))
        return Tracks(sections, joints, places, limits, neutral, self.counts)

    def _tracks(self) -> tuple[dict[str, str], dict[str, str]]:
        """Types and names of the tracks on which sections lie."""
        kinds: dict[str, str] = {}
        names: dict[str, str] = {}
        for track in self._top.iter("track"):
            for span in self.places.spans(track):
                kinds.setdefault(span.section, track.get("type", ""))
                names.setdefault(span.section, name_of(track))
        return kinds, names

    def _sections(self, kinds: dict[str, str], names: dict[str, str]) -> dict[str, Section]:
        gradients, curves = self._gradients(), self._curves()
        lines = self._lines()
        found = {}
        for ident, element in self.topology.elements.items():
            line, line_name = lines.get(ident, ("", ""))
            words = [line_name] if line_name and kinds.get(ident, MAIN) == MAIN else [
                line_name, names.get(ident, ""),
            ]  # fmt: skip
            begins_at_km, rises = element.begin_and_rise
            found[ident] = Section(
                ident,
                element.length_m,
                (line,) if line else (),
                "_".join(filter(None, words)) or ident,
                tuple(gradients.get(ident, [])),
                tuple(curves.get(ident, [])),
                begins_at_km,
                rises,
                element.jumps,
            )
        return found

    def _lines(self) -> dict[str, tuple[str, str]]:
        """Id and name of the line of each section, the first one of several."""
        found: dict[str, tuple[str, str]] = {}
        taken: list[str] = []
        for line in self._top.iter("line"):
            name = own_name(name_of(line), taken)
            taken.append(name)
            for span in self.places.spans(line):
                found.setdefault(span.section, (line.get("id", ""), name))
        return found

    def _ways(self, kinds: dict[str, str]) -> Iterator[Way]:
        """Ends that meet: on main tracks first, then straight on."""
        names, straight = self._switches()
        for way in self.topology.relations:
            beside = sum(kinds.get(section, MAIN) != MAIN for section, _ in way.ends)
            rank = (beside, int(way.id not in straight))
            yield replace(way, name=names.get(way.id, ""), rank=rank)

    def _switches(self) -> tuple[dict[str, str], set[str]]:
        """Names of switches by the relations over them, and the relations that go straight on."""
        names: dict[str, str] = {}
        straight: set[str] = set()
        for switch in (*self._top.iter("switchIS"), *self._top.iter("switch")):
            for side in ("left", "right"):
                for branch in switch.iter(f"{side}Branch"):
                    relation = branch.get("netRelationRef", "")
                    names.setdefault(relation, name_of(switch))
                    if switch.get("continueCourse") == side:
                        straight.add(relation)
        return names, straight

    def _operational_points(self) -> Iterator[Place]:
        for point in self._top.iter("operationalPoint"):
            parts = self._parts_of(point) or [
                part
                for each in point.iter()
                if each.tag in OWNED and each.get("ref") in self._by_id
                for part in self._parts_of(self._by_id[each.get("ref", "")])
            ]
            if parts:
                own = {section: (section, position_m) for section, position_m in reversed(parts)}
                yield Place(point.get("id", ""), name_of(point), tuple(own.values()))
            else:
                self.lost.append(name_of(point))

    def _parts_of(self, element: Element) -> list[tuple[str, float]]:
        """Where an element is: its spots, or the middles of its stretches."""
        middles = [
            (span.section, (span.begin_m + span.end_m) / 2.0) for span in self.places.spans(element)
        ]
        return self.places.spots(element) or middles

    def _line_limits(self) -> Iterator[Limit]:
        """Highest speeds of whole lines."""
        for line in self._top.iter("line"):
            for given in line.iter("linePerformance"):
                speed_kmh = self.file.number(given, "maxSpeed")
                if speed_kmh is not None and LEAST_LIMIT_KMH <= speed_kmh < NO_LIMIT_KMH:
                    yield from _limits(self.places.spans(line), speed_kmh)

    def _limits(self) -> Iterator[Limit]:
        """Limits of all trains: those of the basic speed profile, if there are several."""
        profiles = list(self.file.root.iter("speedProfile"))
        basic = {each.get("id") for each in profiles if each.get("isBasicSpeedProfile") == "true"}
        basic = basic or {each.get("id") for each in profiles if len(profiles) == 1}
        for section in self._top.iter("speedSection"):
            valid = {each.get("ref") for each in section.iter("validForSpeedProfile")}
            value = section.get("maxSpeed", section.get("vMax", ""))
            if section.get("isTemporary") == "true":
                self.counts["temporary"] += 1
            elif valid and not valid & basic:
                self.counts["profile"] += 1
            elif not value:
                self.file.blame(section, "it has no maxSpeed", remedy="add it, in km/h")
            elif value != "end":
                speed_kmh = self.file.number(section, "maxSpeed", "vMax") or 0.0
                if speed_kmh < LEAST_LIMIT_KMH:
                    self.counts["slow"] += 1
                elif speed_kmh < NO_LIMIT_KMH:
                    yield from _limits(self.places.spans(section), speed_kmh)

    def _neutral_sections(self) -> Iterator[Neutral]:
        """Sections of the contact line that separate phases or systems, as far as they are short."""
        for section in self._top.iter("electrificationSection"):
            separations = [each for each in section if each.tag in SEPARATIONS]
            if not separations:
                continue
            spans = self.places.spans(section)
            if not spans or any(span.end_m - span.begin_m > LONGEST_NEUTRAL_M for span in spans):
                self.counts["neutral"] += 1
                continue
            lowers = any(each.get("lowerPantograph") == "true" for each in separations)
            for span in spans:
                yield Neutral(span.section, span.begin_m, span.end_m, lowers)

    def _curves(self) -> dict[str, list[Stretch]]:
        found: dict[str, list[Stretch]] = defaultdict(list)
        for curve in self._top.iter("horizontalCurve"):
            radius_m = self.file.number(curve, "radius")
            if curve.get("curveType") == "straight" or not radius_m:
                continue
            for span in self.places.spans(curve):
                found[span.section].append((span.begin_m, span.end_m, radius_m))
        return found

    def _gradients(self) -> dict[str, list[Stretch]]:
        """Gradients by section; those of arcs are the mean of what they lie between."""
        found: dict[str, list[Stretch]] = defaultdict(list)
        arcs: list[tuple[Span, float]] = []
        for curve in self._top.iter("gradientCurve"):
            gradient = self.file.number(curve, "gradient")
            change = self.file.number(curve, "deltaGradient")
            spans = self.places.spans(curve)
            if gradient is None and change is None:
                remedy = "give its gradient or deltaGradient in per mille"
                self.file.blame(curve, "it has no gradient", remedy=remedy)
            if not spans:
                remedy = "give it a linearLocation with an associatedNetElement"
                self.file.blame(curve, "it lies nowhere", remedy=remedy)
            for span in spans:
                sign = span.signs[0]
                if gradient is not None:
                    mean = gradient + (change or 0.0) / 2.0
                    found[span.section].append((span.begin_m, span.end_m, sign * mean))
                elif change is not None:
                    arcs.append((span, sign * change))
        self._fill_arcs(found, arcs)
        return found

    def _fill_arcs(self, found: dict[str, list[Stretch]], arcs: list[tuple[Span, float]]) -> None:
        """Add arcs that tell only how the gradient changes along them."""
        straight = {section: list(stretches) for section, stretches in found.items()}
        for span, change in arcs:
            beside = straight.get(span.section, [])
            before = [value for _, end_m, value in beside if abs(end_m - span.begin_m) <= CLOSE_M]
            after = [value for begin_m, _, value in beside if abs(begin_m - span.end_m) <= CLOSE_M]
            if before or after:
                mean = before[0] + change / 2.0 if before else after[0] - change / 2.0
                found[span.section].append((span.begin_m, span.end_m, mean))
            else:
                self.counts["arc"] += 1


def _limits(spans: Iterable[Span], speed_kmh: float) -> list[Limit]:
    return [Limit(span.section, span.begin_m, span.end_m, speed_kmh, span.signs) for span in spans]
