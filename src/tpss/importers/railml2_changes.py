"""What changes along the tracks of railML 2: a value holds until the next change, on the next track too.

References
----------
https://wiki2.railml.org: ``speedChange``, ``gradientChange``, ``radiusChange``,
``electrificationChange``.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import NamedTuple

from tpss.importers.railml2_topology import Topology
from tpss.importers.tracks import End, Stretch

Values = dict[str, list[Stretch]]
"""Stretches by the pieces of tracks on which they lie."""


class Change(NamedTuple):
    """A value from a position of a track on, for trains of one direction; None: no statement.

    Values of the track itself, such as its gradient, are told towards its end only.
    """

    track: str
    pos_m: float
    value: float | None
    sign: int = 1
    """1: towards the track's end; -1: towards its beginning."""


Course = tuple[str, int]
"""A piece of track, and the direction in which it is travelled."""


class Courses:
    """Changes along pieces of track, in both directions."""

    def __init__(
        self, topology: Topology, joins: Mapping[End, End], changes: Iterable[Change]
    ) -> None:
        self._joins = joins
        self.pieces = {piece.id: piece for pieces in topology.pieces.values() for piece in pieces}
        self._changes: dict[Course, list[tuple[float, float | None]]] = defaultdict(list)
        for change in changes:
            for piece in topology.pieces[change.track]:
                at_m = change.pos_m - piece.begin_m
                ends = (piece.begin_m, piece.end_m)
                if ends[0] <= change.pos_m <= ends[1] and change.pos_m != ends[change.sign > 0]:
                    self._changes[piece.id, change.sign].append((at_m, change.value))
        for (_, sign), found in self._changes.items():
            found.sort(key=lambda each: sign * each[0])
        self._signs = {sign for _, sign in self._changes}

    def stretches(self, sign: int) -> Values:
        """Stretches on which values hold for trains of a direction; where none does there is none."""
        found: Values = {}
        for ident, piece in self.pieces.items():
            length_m = piece.end_m - piece.begin_m
            begin_m, end_m = (0.0, length_m) if sign > 0 else (length_m, 0.0)
            here = [(begin_m, self._value_at_entry((ident, sign)))]
            here += self._changes.get((ident, sign), [])
            parts = []
            for (a, value), (b, _) in pairwise([*here, (end_m, None)]):
                if value is not None and a != b:
                    parts.append((min(a, b), max(a, b), value))
            found[ident] = sorted(parts)
        return found

    def _value_at_entry(self, course: Course) -> float | None:
        """Value that holds where a train enters a piece: that of the piece it comes from.

        None if nothing tells it, as on a track that begins where another does, for values of the track.
        """
        seen = {course}
        while True:
            piece, sign = course
            came = self._joins.get((piece, "BEGIN" if sign > 0 else "END"))
            if came is None:
                return None
            course = (came[0], 1 if came[1] == "END" else -1)
            if course in seen or course[1] not in self._signs:
                return None
            seen.add(course)
            if self._changes.get(course):
                return self._changes[course][-1][1]
