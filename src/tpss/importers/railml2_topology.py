"""Topology of railML 2: tracks cut at switches and jumps of kilometres, and how the pieces meet.

References
----------
https://wiki2.railml.org: ``track``, ``trackBegin``, ``switch``, ``connection``, and on connections
between tracks.  A branch of a switch is "outgoing" if it leaves its track in the direction towards the
track's end, "incoming" if it joins it in that direction.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple
from xml.etree.ElementTree import Element

from tpss.importers.railml2_kilometres import jumps_m, marks_of
from tpss.importers.railml_file import RailmlFile, name_of
from tpss.importers.track_joints import Way
from tpss.importers.tracks import End

CLOSE_M = 0.5
"""A switch that is so close to an end of its track stands there. [m]"""

SIMPLE = "simpleCrossing"
"""Type of a crossing over which trains may not change to another track."""

STRAIGHT, BRANCH = (0,), (1,)
"""Ranks of ways."""


@dataclass(frozen=True)
class Piece:
    """A part of a track between two of its cuts."""

    id: str
    track: str
    begin_m: float
    end_m: float
    """Where it begins and ends on its track. [m]"""


class Branch(NamedTuple):
    """A branch of a switch."""

    switch: Element
    connection: Element
    track: str
    """Track on which the switch is."""


class Topology:
    """Tracks with a topology, their pieces, and the ways between these."""

    def __init__(self, file: RailmlFile) -> None:
        self.file = file
        self.broken = 0
        """Connections to what the file does not have."""
        self.tracks = {each.get("id", ""): each for each in tracks_with_topology(file)}
        self.marks = {ident: marks_of(file, track) for ident, track in self.tracks.items()}
        """Kilometres along the tracks."""
        self.pieces = {ident: self._pieces(track) for ident, track in self.tracks.items()}
        self._at_ends: dict[str, End] = {}
        """Ends of pieces by the connections there."""
        self._branches: dict[str, Branch] = {}
        """Branches of switches by their connections."""
        for ident, track in self.tracks.items():
            self._note_connections(ident, track)
        self.ways = [*self._through(), *self._links(), *self._branching(), *self._crossing()]

    def length_m(self, ident: str) -> float:
        """Length of a track. [m]"""
        return self.pieces[ident][-1].end_m

    def place(self, ident: str, pos_m: float) -> tuple[str, float]:
        """Piece on which a position of a track lies, and the position on it. [m]"""
        pieces = self.pieces[ident]
        piece = next((each for each in pieces if pos_m <= each.end_m), pieces[-1])
        return piece.id, min(max(pos_m, piece.begin_m), piece.end_m) - piece.begin_m

    def _pieces(self, track: Element) -> list[Piece]:
        end = next(track.iter("trackEnd"))
        length_m = self.file.number(end, "pos")
        if length_m is None or length_m <= 0.0:
            remedy = "give its end a pos, in metres from its beginning"
            self.file.blame(track, "it has no length", remedy=remedy)
            length_m = 2.0 * CLOSE_M
        ident = track.get("id", "")
        cuts = [
            *(self.file.number(each, "pos") or 0.0 for each in switches_of(track)),
            *(self.file.number(each, "pos") or 0.0 for each in track.iter("mileageChange")),
            *jumps_m(self.marks[ident]),
        ]
        inside = {pos_m for pos_m in cuts if CLOSE_M < pos_m < length_m - CLOSE_M}
        return [
            Piece(f"{ident} from {a:g} m" if a else ident, ident, a, b)
            for a, b in pairwise([0.0, *sorted(inside), length_m])
        ]

    def _note_connections(self, ident: str, track: Element) -> None:
        for tag, piece, end in (
            ("trackBegin", self.pieces[ident][0], "BEGIN"),
            ("trackEnd", self.pieces[ident][-1], "END"),
        ):
            for node in track.iter(tag):
                for connection in node.iter("connection"):
                    self._at_ends[connection.get("id", "")] = (piece.id, end)
        for switch in switches_of(track):
            for connection in switch.iter("connection"):
                self._branches[connection.get("id", "")] = Branch(switch, connection, ident)

    def _through(self) -> Iterator[Way]:
        """Along a track, past its switches."""
        for ident, pieces in self.pieces.items():
            names = {
                self.file.number(each, "pos"): name_of(each)
                for each in switches_of(self.tracks[ident])
            }
            for before, after in pairwise(pieces):
                ends = ((before.id, "END"), (after.id, "BEGIN"))
                yield Way(after.id, ends, names.get(after.begin_m, ""), STRAIGHT)

    def _links(self) -> Iterator[Way]:
        """From the end of a track to that of another."""
        known = {*self._at_ends, *self._branches, *self.tracks}
        known |= {
            connection.get("id", "")
            for crossing in self.file.root.iter("crossing")
            for connection in crossing.iter("connection")
        }
        seen: set[frozenset[End]] = set()
        for track in self.tracks.values():
            for tag in ("trackBegin", "trackEnd"):
                for node in track.iter(tag):
                    for connection in node.iter("connection"):
                        ref = connection.get("ref", "")
                        here = self._at_ends[connection.get("id", "")]
                        there = self._at_ends.get(ref)
                        self.broken += ref not in known
                        if there is not None and frozenset((here, there)) not in seen:
                            seen.add(frozenset((here, there)))
                            yield Way(connection.get("id", ""), (here, there), "", STRAIGHT)

    def _branching(self) -> Iterator[Way]:
        """Over the branches of switches."""
        seen: set[frozenset[End]] = set()
        for branch in self._branches.values():
            ref = branch.connection.get("ref", "")
            if ref in self._at_ends:
                theirs = [self._at_ends[ref]]
            elif ref in self._branches:
                theirs = self._stems(self._branches[ref])
            else:
                self.broken += 1
                continue
            ident, name = branch.switch.get("id", ""), name_of(branch.switch)
            is_open = branch.connection.get("passable", "true") != "false"
            for here in self._stems(branch):
                for there in theirs:
                    if frozenset((here, there)) not in seen:
                        seen.add(frozenset((here, there)))
                        yield Way(ident, (here, there), name, BRANCH, is_open)

    def _crossing(self) -> Iterator[Way]:
        """Across a track, from a connection that comes in to one that goes out."""
        for track in self.tracks.values():
            for crossing in track.iter("crossing"):
                ends: dict[str, list[End]] = {"incoming": [], "outgoing": []}
                for connection in crossing.iter("connection"):
                    end = self._at_ends.get(connection.get("ref", ""))
                    if end is not None and connection.get("orientation") in ends:
                        ends[connection.get("orientation", "")].append(end)
                for here, there in zip(ends["incoming"], ends["outgoing"], strict=False):
                    yield Way(crossing.get("id", ""), (here, there), name_of(crossing), STRAIGHT)

    def _stems(self, branch: Branch) -> list[End]:
        """Ends from which a branch of a switch is travelled: on its track, or on what that leads to."""
        pos_m = self.file.number(branch.switch, "pos") or 0.0
        pieces = self.pieces[branch.track]
        if branch.connection.get("orientation") == "incoming":
            after = next((each for each in pieces if each.begin_m >= pos_m - CLOSE_M), None)
            return [(after.id, "BEGIN")] if after else self._beyond(branch.track, "trackEnd")
        before = next((each for each in pieces[::-1] if each.end_m <= pos_m + CLOSE_M), None)
        return [(before.id, "END")] if before else self._beyond(branch.track, "trackBegin")

    def _beyond(self, track: str, tag: str) -> list[End]:
        """Ends of other tracks to which an end of a track leads."""
        return [
            self._at_ends[ref]
            for node in self.tracks[track].iter(tag)
            for connection in node.iter("connection")
            if (ref := connection.get("ref", "")) in self._at_ends
        ]


def switches_of(track: Element) -> list[Element]:
    """Switches of a track, and crossings over which trains may change to another."""
    slips = [each for each in track.iter("crossing") if each.get("type", SIMPLE) != SIMPLE]
    return [*track.iter("switch"), *slips]


def tracks_with_topology(file: RailmlFile) -> list[Element]:
    """Tracks that have a beginning and an end."""
    return [
        track
        for track in file.root.iter("track")
        if all(track.find(f".//{tag}") is not None for tag in ("trackBegin", "trackEnd"))
    ]
