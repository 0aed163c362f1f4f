"""Lines that meet, as importers make them: what stands in the tables ``[lines.NAME]`` of a scenario."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from tpss.importers.quantities import DIGITS
from tpss.importers.timetable import Service, Train
from tpss.results.osrd_tracks import OsrdTrack

NO_LIMIT_KMH = 500.0
"""Where a format states no limit: the trains' own highest speeds count. [km/h]"""

Range = tuple[float, float, float]
"""Beginning and end of what applies there, and its value."""

Stair = tuple[float, float]
"""Where a value begins, and the value, which holds until the next."""


@dataclass(frozen=True)
class NetworkLine:
    """A line; positions are from its beginning, wherever its kilometres begin. [km]"""

    name: str
    length_km: float
    stations: dict[str, float]
    """Positions by name, ascending."""
    gradients: list[Stair]
    limits: list[Stair]
    limits_down: list[Stair] = field(default_factory=list)
    """Limits of trains towards falling kilometres, if they are others."""
    curves: list[Range] = field(default_factory=list)
    begins_at_km: float = 0.0

    @property
    def document(self) -> dict[str, Any]:
        """The line as in a scenario, in its kilometres."""
        down = {"speed_limits_down": self._rows(self.limits_down, "speed_kmh")}
        curves = [
            {"from_km": self._km(a), "to_km": self._km(b), "radius_m": r} for a, b, r in self.curves
        ]
        return {
            **({"begins_at_km": self.begins_at_km} if self.begins_at_km else {}),
            "length_km": self.length_km,
            "stations": [
                {"name": name, "position_km": self._km(km)} for name, km in self.stations.items()
            ],
            "speed_limits": self._rows(self.limits, "speed_kmh"),
            **(down if self.limits_down else {}),
            "gradients": self._rows(self.gradients, "permille"),
            **({"curves": curves} if curves else {}),
        }

    def _km(self, position_km: float) -> float:
        return round(self.begins_at_km + position_km, DIGITS) if self.begins_at_km else position_km

    def _rows(self, stairs: Iterable[Stair], key: str) -> list[dict[str, float]]:
        return [{"from_km": self._km(km), key: value} for km, value in stairs]


class LineNeutral(NamedTuple):
    """A neutral section of a line, in the line's kilometres."""

    line: str
    from_km: float
    to_km: float
    raise_s: float


@dataclass(frozen=True)
class ImportedNetwork:
    """Lines and trains from files of another format, and how these were used."""

    name: str
    sources: tuple[Path, ...]
    format_name: str
    lines: list[NetworkLine]
    trains: list[Train] = field(default_factory=list)
    services: list[Service] = field(default_factory=list)
    tracks: list[OsrdTrack] = field(default_factory=list)
    neutral_sections: list[LineNeutral] = field(default_factory=list)
    system: str = ""
    """Electrification system of most of the lines, if it is known."""
    stock: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Tables of trains that were imported, by the kinds of the trains."""
    taken: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)

    @property
    def stations(self) -> dict[str, dict[str, float]]:
        """Positions of the stations by the names of the lines, and their own. [km]"""
        return {line.name: line.stations for line in self.lines}


def stairs(
    begin_km: float,
    end_km: float,
    ranges: Sequence[Range],
    default: float,
    choose: Callable[[Sequence[float]], float],
) -> list[Stair]:
    """Values along a line from ranges, which may overlap or leave gaps, in kilometres from its begin.

    Parameters
    ----------
    begin_km, end_km : float
        Ends of the line, in the kilometres of the ranges.
    ranges : sequence of tuple
        Beginning, end and value of each.
    default : float
        Value where no range lies.
    choose : callable
        The value where several ranges lie, from theirs.
    """
    inside = [
        (max(begin, begin_km), min(end, end_km), value)
        for begin, end, value in ranges
        if begin < end_km and end > begin_km
    ]
    ends = {begin_km, end_km, *(km for each in inside for km in each[:2])}
    found: list[Stair] = []
    for begin, end in pairwise(sorted(ends)):
        values = [value for a, b, value in inside if a <= begin and end <= b]
        value = choose(values) if values else default
        if not found or found[-1][1] != value:
            found.append((round(begin - begin_km, DIGITS), value))
    return found


def plain_name(text: str, fallback: str = "line") -> str:
    """A name in letters, digits, hyphens and underscores, for files and key paths."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", text).strip("_-") or fallback


def own_name(wanted: str, taken: Iterable[str]) -> str:
    """A name that is not taken: the wanted one, or with a number behind it."""
    others, name, number = set(taken), wanted, 1
    while name in others:
        number += 1
        name = f"{wanted}-{number}"
    return name
