"""Kilometres of tracks of railML 2: marks along a track, and where they jump.

References
----------
https://wiki2.railml.org: ``mileageChange``, with the kilometre ``absPosIn`` that ends there and the
kilometre ``absPos`` that begins there, and ``absPos`` of other elements.  All are in metres.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple
from xml.etree.ElementTree import Element

from tpss.importers.railml_file import RailmlFile

LEAST_JUMP_M = 10.0
"""Kilometres of elements that differ by less from the way between these are rounded. [m]"""


class Mark(NamedTuple):
    """A position on a track, and its kilometre. [m]"""

    pos_m: float
    side: int
    """-1: the kilometre holds up to there only, 1: from there on, 0: on both sides."""
    km_m: float


def marks_of(file: RailmlFile, track: Element) -> list[Mark]:
    """Marks along a track, ascending."""
    marks = []
    for element in track.iter():
        pos_m = file.number(element, "pos")
        if pos_m is None:
            continue
        changes = element.tag == "mileageChange"
        for key, side in (("absPosIn", -1), ("absPos", 1 if changes else 0)):
            if element.get(key):
                marks.append(Mark(pos_m, side, file.number(element, key) or 0.0))
    return sorted(marks)


def jumps_m(marks: Sequence[Mark]) -> Iterator[float]:
    """Positions from which on the kilometres do not follow from those before. [m]"""
    for before, after in pairwise(marks):
        way_m = after.pos_m - before.pos_m
        if way_m > 0.0 and abs(abs(after.km_m - before.km_m) - way_m) > LEAST_JUMP_M:
            yield after.pos_m


def kilometre(begin_m: float, end_m: float, marks: Sequence[Mark]) -> tuple[float | None, int]:
    """Kilometre where a piece of track begins [km], and 1 or -1 as kilometres rise or fall along it.

    Parameters
    ----------
    begin_m, end_m : float
        Where the piece begins and ends on its track.
    marks : sequence of Mark
        Those of the track, ascending.
    """
    own = [mark for mark in marks if mark.pos_m == begin_m and mark.side >= 0][-1:]
    own += [mark for mark in marks if begin_m < mark.pos_m < end_m]
    own = own or [mark for mark in marks if mark.pos_m == end_m and mark.side <= 0][:1]
    if not own:
        return None, 1
    whole = own if len(own) > 1 and own[0].km_m != own[-1].km_m else marks
    first, last = whole[0], whole[-1]
    rises = -1 if (last.km_m - first.km_m) * (last.pos_m - first.pos_m) < 0.0 else 1
    return (own[0].km_m + rises * (begin_m - own[0].pos_m)) / 1e3, rises
