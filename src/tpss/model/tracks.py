"""Tracks of the routes: those that services give, elsewhere those of their direction."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import NamedTuple

from tpss.model.routes import Route
from tpss.scenario.line import Line
from tpss.scenario.routes import Hop


class Piece(NamedTuple):
    """A part of a course on one track of its line."""

    begin_km: float
    """Its ends, in ascending order."""
    end_km: float
    track: int

    def entered_km(self, sign: float) -> float:
        """Where trains of a direction come to it. [km]"""
        return self.begin_km if sign > 0.0 else self.end_km


def pieces_of(route: Route, lines: Mapping[str, Line]) -> list[list[Piece]]:
    """Parts of each course of a route in the order of travel, of which neighbours differ in track."""
    hops = zip(route.way.hops, route.tracks, strict=True)
    return [
        list(_joined(_pieces(list(course), lines[name])))
        for (name, _), course in groupby(hops, key=lambda each: (each[0].line, each[0].sign))
    ]


def _pieces(hops: Sequence[tuple[Hop, int | None]], line: Line) -> Iterator[Piece]:
    """Parts of hops on one line, each with the track that is given for it, in the order of travel."""
    for hop, given in hops:
        low_km, high_km = sorted((hop.begin_km, hop.end_km))
        inside = [
            (max(low_km, begin), min(high_km, end), int(count))
            for begin, end, count in line.tracks_by_stretch
            if begin < high_km and low_km < end
        ]
        for begin_km, end_km, count in inside if hop.sign > 0.0 else inside[::-1]:
            own = track_of(hop.sign, count, line.left_hand_running)
            yield Piece(begin_km, end_km, own if given is None or given > count else given)


def _joined(pieces: Iterator[Piece]) -> Iterator[Piece]:
    """Pieces of which those that follow each other on a track are taken together."""
    for track, alike in groupby(pieces, key=lambda piece: piece.track):
        ends_km = [km for piece in alike for km in (piece.begin_km, piece.end_km)]
        yield Piece(min(ends_km), max(ends_km), track)


def track_of(sign: float, count: int, left_hand: bool) -> int:
    """Track that trains take in a direction; tracks count from the left, seen in rising kilometres."""
    return 1 if (sign > 0.0) == left_hand else count
