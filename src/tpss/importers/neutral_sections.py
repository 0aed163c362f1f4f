"""Neutral sections of tracks as neutral sections of the lines that are made of them.

A scenario's apply both ways and to a whole line, and keep away from where its contact line is fed or
meets others: those of either direction that overlap become one, and are cut off at stations where lines
meet and at ends of lines.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from tpss.importers.network import LineNeutral, NetworkLine
from tpss.importers.quantities import DIGITS
from tpss.importers.tracks import Neutral
from tpss.results.osrd_tracks import OsrdTrack
from tpss.scenario.line import CLOSEST_KM

RAISE_S = 15.0
"""Estimate of the time until a pantograph that was lowered is up again. [s]"""

APART_KM = 0.002
"""So far neutral sections end from where lines meet or end. [km]"""

SHORTEST_KM = 0.005
"""What is left of a neutral section beside such a place, at the least. [km]"""

Span = tuple[float, float]


class NeutralSections(NamedTuple):
    """Those of all lines, and how many of the tracks' could not be one."""

    found: list[LineNeutral]
    lost: int


def neutral_sections_of(
    tracks: Iterable[Neutral], ranges: Iterable[OsrdTrack], lines: Sequence[NetworkLine]
) -> NeutralSections:
    """Neutral sections of lines.

    Parameters
    ----------
    tracks : iterable of Neutral
        Neutral sections of tracks.
    ranges : iterable of OsrdTrack
        Where the tracks lie on the lines.
    lines : sequence of NetworkLine
    """
    of_track: dict[str, list[OsrdTrack]] = defaultdict(list)
    for each in ranges:
        of_track[each.track].append(each)
    given: dict[str, list[LineNeutral]] = defaultdict(list)
    lost = 0
    for neutral in tracks:
        placed = [_on_line(neutral, each) for each in of_track[neutral.section]]
        for found in filter(None, placed):
            given[found.line].append(found)
        lost += not any(placed)
    sections: list[LineNeutral] = []
    for line in lines:
        for one in _joined(given[line.name]):
            parts = list(_beside(one, _nodes_km(line, lines)))
            sections += parts
            lost += not parts
    return NeutralSections(sections, lost)


def _on_line(neutral: Neutral, track: OsrdTrack) -> LineNeutral | None:
    """The part of a track's neutral section on a line; None if it is elsewhere on the track."""
    low_m, high_m = sorted((track.begin_m, track.end_m))
    begin_m, end_m = max(neutral.begin_m, low_m), min(neutral.end_m, high_m)
    if end_m <= begin_m:
        return None
    slope = (track.to_km - track.from_km) / (track.end_m - track.begin_m)
    from_km, to_km = sorted(
        round(track.from_km + slope * (each - track.begin_m), DIGITS) for each in (begin_m, end_m)
    )
    return LineNeutral(track.line, from_km, to_km, RAISE_S if neutral.lowers else 0.0)


def _joined(sections: Iterable[LineNeutral]) -> list[LineNeutral]:
    """Sections of a line in order; those that overlap or touch are one, with the longer time."""
    joined: list[LineNeutral] = []
    for each in sorted(sections):
        if joined and each.from_km <= joined[-1].to_km + CLOSEST_KM:
            last = joined.pop()
            to_km, raise_s = max(last.to_km, each.to_km), max(last.raise_s, each.raise_s)
            each = last._replace(to_km=to_km, raise_s=raise_s)
        joined.append(each)
    return joined


def _nodes_km(line: NetworkLine, lines: Sequence[NetworkLine]) -> list[float]:
    """Where a line ends or meets others, ascending, in its kilometres."""
    counts = Counter(name for each in lines for name in each.stations)
    places = [km for name, km in line.stations.items() if counts[name] > 1]
    return sorted(line.begins_at_km + km for km in (0.0, *places, line.length_km))


def _beside(section: LineNeutral, nodes_km: Sequence[float]) -> Iterator[LineNeutral]:
    """The parts of a section that keep away from nodes."""
    free: list[Span] = [(section.from_km, section.to_km)]
    for node_km in nodes_km:
        low, high = node_km - APART_KM, node_km + APART_KM
        parts = [((a, min(b, low)), (max(a, high), b)) for a, b in free]
        free = [each for pair in parts for each in pair if each[0] < each[1]]
    for a, b in free:
        if b - a >= SHORTEST_KM:
            yield section._replace(from_km=round(a, DIGITS), to_km=round(b, DIGITS))
