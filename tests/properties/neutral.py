"""Random neutral sections, some of them too long to coast through."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]


def with_neutral_section(draw: Draw, document: Document) -> None:
    """Lay a neutral section on a line, perhaps with a time until power is back.

    Where it happens to lie at a node, or a train stops in it, the scenario has a fault.
    """
    lines = {"": document["line"]} if "line" in document else document["lines"]
    name = draw(st.sampled_from(list(lines)))
    line = lines[name]
    begin_km = line.get("begins_at_km", 0.0)
    length_km = min(line["length_km"] / 10.0, draw(st.sampled_from([0.05, 0.2, 0.4, 3.0])))
    from_km = draw(numbers(begin_km, begin_km + line["length_km"] - length_km))
    section = {"from_km": from_km, "to_km": from_km + length_km}
    section["raise_s"] = draw(st.sampled_from([0.0, 5.0, 60.0]))
    document["supply"]["neutral_sections"] = [section | ({"line": name} if name else {})]
