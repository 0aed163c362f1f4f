"""Faults of sections of the contact line that are out: tracks that are not there, or tied; overlaps."""

from collections.abc import Iterator, Mapping
from itertools import pairwise

from tpss.scenario.line import CLOSEST_KM, Line
from tpss.scenario.outages import Outage, OutSection
from tpss.scenario.raw import Fault
from tpss.scenario.supply import Supply
from tpss.units import kilometres


def section_faults(outage: Outage, supply: Supply, lines: Mapping[str, Line]) -> Iterator[Fault]:
    """Sections of tracks that are not there, or that have no contact line of their own; overlaps."""
    only = next(iter(lines)) if len(lines) == 1 else ""
    for i, section in enumerate(outage.sections):
        key, name = f"sections.{i}", section.line or only
        line = lines[name]
        begin, end = section.ends_km(line.begins_at_km, line.end_km)
        if end - begin < CLOSEST_KM:
            problem = f"it reaches from {kilometres(begin)} to {kilometres(end)} km"
            yield key, "", problem, "give it a metre or more"
            continue
        if section.track is not None:
            yield from _track(key, section.track, begin, end, line)
            yield from _tied(key, section, begin, end, line, supply)
        for k, other in enumerate(outage.sections[:i]):
            first, last = other.ends_km(line.begins_at_km, line.end_km)
            same = other.track == section.track or None in (other.track, section.track)
            if (other.line or only) == name and same and begin < last and first < end:
                yield key, "", f"overlaps sections.{k}", "give each stretch of a track once"


def _track(key: str, track: int, begin_km: float, end_km: float, line: Line) -> Iterator[Fault]:
    """A track that a line does not have all along a section."""
    for first, last, count in line.tracks_by_stretch:
        if track > count and begin_km < last and first < end_km:
            tracks = f"{count:g} tracks" if count > 1 else "1 track"
            problem = f"the line has {tracks} from {kilometres(first)} to {kilometres(last)} km"
            remedy = "give a track that is there, or end the section where it does"
            yield f"{key}.track", str(track), problem, remedy
            return


def _tied(
    key: str, section: OutSection, begin_km: float, end_km: float, line: Line, supply: Supply
) -> Iterator[Fault]:
    """One of several tracks whose contact lines are one."""
    several = [piece for piece in line.tracks_by_stretch if piece[2] > 1]
    stretches = [each for each in supply.contact_lines if each.line in (None, section.line)]
    borders = {begin_km, end_km, *(km for piece in several for km in piece[:2])}
    borders |= {km for each in stretches for km in (each.from_km, each.to_km) if km is not None}
    inside = sorted(km for km in borders if begin_km <= km <= end_km)
    for first, last in pairwise(inside):
        tied = supply.tracks_tied
        for each in stretches:
            from_km = line.begins_at_km if each.from_km is None else each.from_km
            to_km = line.end_km if each.to_km is None else each.to_km
            if from_km <= first and last <= to_km:
                tied = each.tracks_tied or tied
        beside = any(piece[0] <= first and last <= piece[1] for piece in several)
        if beside and tied == "everywhere":
            problem = (
                f"from {kilometres(first)} to {kilometres(last)} km the tracks are tied everywhere, so "
                "that their contact lines are one"
            )
            remedy = 'leave track out, for all of them, or give tracks_tied = "posts" there'
            yield f"{key}.track", str(section.track), problem, remedy
            return
