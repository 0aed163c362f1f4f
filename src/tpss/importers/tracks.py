"""Tracks as other formats describe them: sections that meet at their ends, and what applies along them.

Importers bring a format into this form, of which `track_network` makes lines.
"""

from collections import Counter
from dataclasses import dataclass, field
from typing import Literal

EndName = Literal["BEGIN", "END"]
End = tuple[str, str]
"""A section's id, and one of its ends: "BEGIN" or "END"."""

OTHER_END = {"BEGIN": "END", "END": "BEGIN"}

Stretch = tuple[float, float, float]
"""Beginning and end on a section [m], and the value that applies between them."""


@dataclass(frozen=True)
class Section:
    """A piece of track between places where tracks meet; positions are from its beginning. [m]"""

    id: str
    length_m: float
    joins_as: tuple[str, ...] = ()
    """Line, or line and track, of a register: sections of the same follow each other in a chain; empty:
    they follow any."""
    name: str = ""
    """Name for a line that is made of it."""
    gradients: tuple[Stretch, ...] = ()
    """Per mille, positive uphill from its beginning to its end."""
    curves: tuple[Stretch, ...] = ()
    """Radius, with either sign. [m]"""
    begins_at_km: float | None = None
    """Kilometre of its beginning in the file, if it has one. [km]"""
    rises: int = 1
    """1 if these kilometres rise towards its end, -1 if they fall."""
    jumps: tuple[tuple[float, float, float], ...] = ()
    """Positions where these kilometres jump [m], and those before and behind, towards its end. [km]"""


@dataclass(frozen=True)
class Joint:
    """A place where ends of sections meet."""

    id: str
    name: str
    pairs: tuple[tuple[End, End], ...]
    """Ends between which trains may go, the straight or first way first."""
    is_link: bool = False
    """Whether two sections merely follow each other."""


@dataclass(frozen=True)
class Place:
    """A station, or another place that timetables name."""

    id: str
    name: str
    parts: tuple[tuple[str, float], ...]
    """Sections, and positions on them. [m]"""


@dataclass(frozen=True)
class Limit:
    """A speed limit on a stretch of a section. [km/h]"""

    section: str
    begin_m: float
    end_m: float
    speed_kmh: float
    signs: tuple[int, ...] = (1, -1)
    """1: it applies to trains towards the section's end; -1: towards its beginning."""


@dataclass(frozen=True)
class Neutral:
    """A stretch of a section where two phases or systems meet: trains pass it with their power off."""

    section: str
    begin_m: float
    end_m: float
    lowers: bool = False
    """Whether they lower their pantographs."""


@dataclass(frozen=True)
class Tracks:
    """All of a file."""

    sections: dict[str, Section]
    joints: tuple[Joint, ...] = ()
    places: tuple[Place, ...] = ()
    limits: tuple[Limit, ...] = ()
    neutral: tuple[Neutral, ...] = ()
    counts: Counter[str] = field(default_factory=Counter)
    """What was left out, by why."""
