"""The same line at other kilometres."""

import copy
from itertools import pairwise
from typing import Any

from tpss.sweep.settings import PLACES, places_of

Document = dict[str, Any]

DIGITS = 9
"""Decimals in which kilometres are written."""

GROUND = "line.gradients.*.from_km"


def moved(document: Document, begin_km: float) -> Document:
    """A scenario whose line begins at 0, with the same line from another kilometre on."""
    document, begin_km = copy.deepcopy(document), round(begin_km, DIGITS)
    for pattern in (*PLACES, GROUND):
        for place in places_of(document, pattern):
            _move(document, place, begin_km)
    document["line"]["begins_at_km"] = begin_km
    for profile in ("gradients", "speed_limits"):
        document["line"][profile] = _once(document["line"][profile])
    return document


def _move(document: Document, place: str, begin_km: float) -> None:
    *above, last = place.split(".")
    container: Any = document
    for key in above:
        container = container[int(key) if isinstance(container, list) else key]
    at: Any = int(last) if isinstance(container, list) else last
    container[at] = round(container[at] + begin_km, DIGITS)


def _once(profile: list[Document]) -> list[Document]:
    """Items of a profile without those that rounding has put to the place of the next one."""
    return [a for a, b in pairwise(profile) if a["from_km"] < b["from_km"]] + profile[-1:]
