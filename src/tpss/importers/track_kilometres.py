"""Kilometres of a file along chains of its sections: where a line begins, and where they jump."""

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


def jumps_km(chain: Chain) -> list[float]:
    """By how much the kilometres jump along a chain, at each place where they do. [km]"""
    found = []
    begins = [
        (link.start_m / 1e3, begin_km)
        for link in chain
        if (begin_km := _begin_km(link)) is not None
    ]
    offset_km = begins[0][1] - begins[0][0] if begins else 0.0
    for place_km, begin_km in begins:
        jump_km = begin_km - place_km - offset_km
        if abs(jump_km) > CLOSE_KM:
            found.append(round(jump_km, DIGITS))
            offset_km += jump_km
    return found


def has_kilometres(chain: Chain) -> bool:
    """Whether any of its sections tells kilometres that rise along it."""
    return any(_begin_km(link) is not None for link in chain)


def _begin_km(link: Link) -> float | None:
    """Kilometre where a section begins in its chain, if it has kilometres that rise along it."""
    section = link.section
    if section.begins_at_km is None or section.rises * link.sign < 0:
        return None
    return section.begins_at_km if link.sign > 0 else section.begins_at_km - section.length_m / 1e3
