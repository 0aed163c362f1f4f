"""Tracks of an OSRD infrastructure, as lines are made of them."""

from collections import Counter

from tpss.importers.network import NO_LIMIT_KMH
from tpss.importers.osrd_infra import Infra, SpeedSection, TrackSection
from tpss.importers.quantities import DIGITS
from tpss.importers.track_lines import LEAST_LIMIT_KMH
from tpss.importers.tracks import Joint, Limit, Neutral, Place, Section, Tracks

BOTH_WAYS = {"BOTH": (1, -1), "START_TO_STOP": (1,), "STOP_TO_START": (-1,)}
"""Signs of the directions of a track section."""


def tracks_of(infra: Infra) -> Tracks:
    """Tracks of an infrastructure; speed sections of single routes or kinds of train are left out."""
    counts: Counter[str] = Counter()
    limits = [limit for section in infra.speed_sections for limit in _limits(section, counts)]
    return Tracks(
        {each.id: _section(each) for each in infra.track_sections},
        tuple(
            Joint(each.id, each.name, tuple(infra.connections(each)), each.switch_type == "link")
            for each in infra.switches
        ),
        tuple(
            Place(each.id, each.name, tuple((part.track, part.position) for part in each.parts))
            for each in infra.operational_points
        ),
        tuple(limits),
        tuple(
            Neutral(part.track, part.begin, part.end, each.lower_pantograph)
            for each in infra.neutral_sections
            for part in each.track_ranges
        ),
        counts,
    )


def _section(given: TrackSection) -> Section:
    names = given.names
    words = [each for each in (names.line_name or str(names.line_code), names.track_name) if each]
    return Section(
        given.id,
        given.length,
        (str(names.line_code), names.track_name),
        "_".join(words),
        tuple((each.begin, each.end, each.gradient) for each in given.slopes),
        tuple((each.begin, each.end, each.radius) for each in given.curves),
    )


def _limits(given: SpeedSection, counts: Counter[str]) -> list[Limit]:
    """Limits of a speed section, or none, which is counted."""
    speed_kmh = round((given.speed_limit or 0.0) * 3.6, DIGITS)
    if given.on_routes is not None:
        counts["route"] += 1
    elif given.speed_limit is None:
        counts["tag"] += 1
    elif speed_kmh < LEAST_LIMIT_KMH:
        counts["slow"] += 1
    elif speed_kmh < NO_LIMIT_KMH:
        return [
            Limit(
                each.track, each.begin, each.end, speed_kmh, BOTH_WAYS[each.applicable_directions]
            )
            for each in given.track_ranges
        ]
    return []
