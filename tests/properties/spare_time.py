"""Random spare time: little and much of it, used by a held speed, by coasting, or by both."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]

MANNERS = st.sampled_from(["coasting", "least-energy", "held-speed"])


def with_spare_time(draw: Draw, document: Document) -> None:
    """Let services use time to spare, and perhaps start apart from each other."""
    for entry in document["traffic"]:
        if not entry.get("initial_trains"):
            entry["supplement_percent"] = draw(numbers(0.1, 60.0))
            entry["spare_time"] = draw(MANNERS)
    if draw(st.booleans()):
        apart_s = draw(numbers(0.0, 300.0))
        document["signalling"] = {**document.get("signalling", {}), "starts_apart_s": apart_s}
