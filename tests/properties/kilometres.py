"""The same line at other kilometres."""

import copy
from collections.abc import Callable
from itertools import pairwise
from typing import Any

from tpss.scenario.paths import places_of
from tpss.sweep.lengths import PLACES

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
    for profile in ("gradients", "speed_limits", "speed_limits_down"):
        if profile in document["line"]:
            document["line"][profile] = _once(document["line"][profile])
    return document


def mirrored(document: Document) -> Document:
    """The same line with kilometres from its other end, and its trains, which run down it then."""
    document = copy.deepcopy(document)
    length_km, line = document["line"]["length_km"], document["line"]
    up, down = line["speed_limits"], line.get("speed_limits_down", [])
    line["gradients"] = [
        {"from_km": from_km, "permille": -item["permille"]}
        for from_km, item in _turned(line["gradients"], length_km)
    ]
    if down:
        line["speed_limits"] = [{**each, "from_km": km} for km, each in _turned(down, length_km)]
    line["speed_limits_down"] = [{**each, "from_km": km} for km, each in _turned(up, length_km)]
    if not down:
        line["speed_limits"] = line.pop("speed_limits_down")
    for curve in line.get("curves", []):
        curve["from_km"], curve["to_km"] = length_km - curve["to_km"], length_km - curve["from_km"]
    line.get("curves", []).reverse()
    for zone in document.get("standards", {}).get("zones", []):
        zone["from_km"], zone["to_km"] = length_km - zone["to_km"], length_km - zone["from_km"]
    document.get("standards", {}).get("zones", []).reverse()
    for place in (each for pattern in PLACES for each in places_of(document, pattern)):
        if place.split(".")[-1] == "position_km":
            _put(document, place, lambda km: length_km - km)
    high_voltage = document["supply"].get("high_voltage_line")
    if high_voltage and "transformers_km" in high_voltage:
        high_voltage["transformers_km"] = [
            length_km - km for km in reversed(high_voltage["transformers_km"])
        ]
    for outage in document.get("outages", []):
        outage["transformers_km"] = [length_km - km for km in outage["transformers_km"]]
        for section in outage.get("sections", []):
            ends = {"to_km": section.pop("from_km", None), "from_km": section.pop("to_km", None)}
            section |= {key: length_km - km for key, km in ends.items() if km is not None}
    return document


def _turned(profile: list[Document], length_km: float) -> list[tuple[float, Document]]:
    """Items of a profile from its other end, and where each begins from there. [km]"""
    begins = [0.0, *(length_km - item["from_km"] for item in profile[:0:-1])]
    return list(zip(begins, reversed(profile), strict=True))


def _move(document: Document, place: str, begin_km: float) -> None:
    _put(document, place, lambda km: round(km + begin_km, DIGITS))


def _put(document: Document, place: str, changed: Callable[[float], float]) -> None:
    """Change the number at a key path."""
    *above, last = place.split(".")
    container: Any = document
    for key in above:
        container = container[int(key) if isinstance(container, list) else key]
    at: Any = int(last) if isinstance(container, list) else last
    container[at] = changed(container[at])


def _once(profile: list[Document]) -> list[Document]:
    """Items of a profile without those that rounding has put to the place of the next one."""
    return [a for a, b in pairwise(profile) if a["from_km"] < b["from_km"]] + profile[-1:]
