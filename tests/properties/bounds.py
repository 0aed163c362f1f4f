"""Random bounds of converter stations: highest currents, near and far, and no power back."""

from typing import Any

from hypothesis import strategies as st

from tpss import library

from .ranges import numbers

Draw = Any
Document = dict[str, Any]


def with_bounds(draw: Draw, document: Document) -> None:
    """Give converter stations a highest current, or let them take no power back."""
    for station in document["supply"].get("converter_stations", []):
        if draw(st.booleans()):
            station["feedback"] = "none"
        if draw(st.booleans()):
            kind = station["type"]
            values = library.values("converters", kind) if isinstance(kind, str) else kind
            limit = draw(numbers(50.0, 400.0))
            station["type"] = {**values, "current_limit_percent": limit}
