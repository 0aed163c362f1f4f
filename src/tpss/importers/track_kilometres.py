"""Kilometres of a file along chains of its sections: where a line begins, and where they jump."""

from typing import NamedTuple

from tpss.importers.quantities import DIGITS
from tpss.importers.track_chains import Chain, Link

CLOSE_KM = 0.002
"""Kilometres that are so close to where they are expected go on. [km]"""


def kilometre_at(chain: Chain, place_m: float) -> float:
    """Kilometre of a place in a chain, by the section there or the next one that has kilometres. [km]

    0 if none of them has any, or if they fall along the chain.
    """
    ahead = [link for link in chain if link.end_m > place_m]
    for link in ahead:
        begin_km = _begin_km(link)
        if begin_km is not None:
            return round(begin_km + (place_m - link.start_m) / 1e3, DIGITS)
    return 0.0


class Jump(NamedTuple):
    """A place where the kilometres jump, towards the end of the chain."""

    section: str
    position_m: float
    """Position on the section. [m]"""
    before_km: float
    after_km: float

    @property
    def size_km(self) -> float:
        """Its size, however it goes. [km]"""
        return round(abs(self.after_km - self.before_km), DIGITS)


def jumps_of(chain: Chain) -> list[Jump]:
    """Where the kilometres jump along a chain: within its sections, and from one to the next."""
    found = []
    offset_km: float | None = None
    for link in chain:
        begin_km = _begin_km(link)
        if begin_km is None:
            continue
        start_km = link.start_m / 1e3
        offset_km = begin_km - start_km if offset_km is None else offset_km
        if abs(begin_km - start_km - offset_km) > CLOSE_KM:
            at_m = 0.0 if link.sign > 0 else link.section.length_m
            expected_km = round(start_km + offset_km, DIGITS)
            found.append(Jump(link.section.id, at_m, expected_km, round(begin_km, DIGITS)))
            offset_km = begin_km - start_km
        for position_m, before_km, after_km in link.section.jumps[:: link.sign]:
            ends = (before_km, after_km)[:: link.sign]
            found.append(Jump(link.section.id, position_m, *ends))
            offset_km += ends[1] - ends[0]
    return found


def has_kilometres(chain: Chain) -> bool:
    """Whether any of its sections tells kilometres that rise along it."""
    return any(_begin_km(link) is not None for link in chain)


def _begin_km(link: Link) -> float | None:
    """Kilometre where a section begins in its chain, if it has kilometres that rise along it."""
    section = link.section
    if section.begins_at_km is None or section.rises * link.sign < 0:
        return None
    if link.sign > 0:
        return section.begins_at_km
    jumped_km = sum(after_km - before_km for _, before_km, after_km in section.jumps)
    return section.begins_at_km - section.length_m / 1e3 + jumped_km
