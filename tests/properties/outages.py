"""Random outages: stations, units, transformers, switches and sections, throughout or for a time."""

from random import Random
from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]

ONLY = "line"
"""Name of the line of a scenario with one."""


@st.composite
def outages(draw: Draw, document: Document, span_min: float, moves_continuously: bool) -> Document:
    """An outage of a scenario; perhaps all of the supply is out, or a part of a line is left unfed.

    Sections leave their part unfed, which asks for trains that move continuously.
    """
    supply = document["supply"]
    stations = [*supply.get("converter_stations", ()), *supply.get("transformer_stations", ())]
    names = [station["name"] for station in stations]
    out = draw(st.lists(st.sampled_from(names), max_size=2, unique=True))
    units = {
        station["name"]: draw(st.integers(1, count))
        for station in stations
        if station["name"] not in out
        and (count := station.get("converters", station.get("transformers", 1)))
        and draw(st.booleans())
    }
    line = supply.get("high_voltage_line")
    places = [] if line is None else [each["position_km"] for each in stations]
    places += (line or {}).get("transformers_km", [])
    open_km = draw(st.lists(st.sampled_from(places), max_size=2, unique=True)) if places else []
    times = {}
    if draw(st.booleans()):
        times["from_min"] = draw(st.one_of(numbers(0.0, span_min), st.just(3.0)))
    if draw(st.booleans()):
        lasts_min = draw(numbers(0.0, span_min)) + 1e-3
        times["to_min"] = times.get("from_min", 0.0) + lasts_min
    opens = draw(st.lists(st.sampled_from(_switches(draw, document)), max_size=2, unique=True))
    sections = []
    if moves_continuously and draw(st.booleans()):
        sections = [_section(draw, document)]
    if not (out or units or open_km or opens or sections):
        out = names[:1]
    return {
        "name": "random",
        "stations": out,
        "units": units,
        "transformers_km": open_km,
        "opens": opens,
        "sections": sections,
        **times,
    }


def _lines(document: Document) -> Document:
    return {ONLY: document["line"]} if "line" in document else document["lines"]


def _switches(draw: Draw, document: Document) -> list[str]:
    """Names of all switches; a section break is added to the supply, and a station moved to a junction.

    Where the break happens to stand at a node, the scenario has a fault, as a user's might.
    """
    supply, lines = document["supply"], _lines(document)
    stations = [*supply.get("converter_stations", ()), *supply.get("transformer_stations", ())]
    if len(lines) > 1 and "high_voltage_line" not in supply and draw(st.booleans()):
        _move_to_a_junction(draw, stations[0], lines)
    feeds = [
        f"{each['name']}>{name}"
        for each in stations
        for name in each.get("feeds")
        or _lines_at(each.get("line", ONLY), each["position_km"], lines)
    ]
    if draw(st.booleans()):
        name = draw(st.sampled_from(list(lines)))
        km = draw(numbers(*_ends_km(lines[name])))
        here = {"name": "break", "position_km": km} | ({"line": name} if len(lines) > 1 else {})
        supply["section_breaks"] = [here]
    switches = [*supply.get("posts", ()), *supply.get("section_breaks", ())]
    return [*feeds, *(each["name"] for each in switches)]


def _move_to_a_junction(draw: Draw, station: Document, lines: Document) -> None:
    """Let a station stand where lines meet, perhaps with feeds for some of them only."""
    places = [
        (name, each["position_km"])
        for name, line in lines.items()
        for each in line["stations"]
        if len(_lines_at(name, each["position_km"], lines)) > 1
    ]
    station["line"], station["position_km"] = draw(st.sampled_from(places))
    fed = _lines_at(station["line"], station["position_km"], lines)
    if draw(st.booleans()):
        station["feeds"] = draw(st.lists(st.sampled_from(fed), min_size=1, unique=True))


def _lines_at(line: str, position_km: float, lines: Document) -> list[str]:
    """Lines that a station on one of them feeds, if it does not say which."""
    here = {each["name"] for each in lines[line]["stations"] if each["position_km"] == position_km}
    met = [
        name
        for name, other in lines.items()
        if name != line and here & {each["name"] for each in other["stations"]}
    ]
    return [line, *met]


def _ends_km(line: Document) -> tuple[float, float]:
    begin_km = line.get("begins_at_km", 0.0)
    return begin_km, begin_km + line["length_km"]


def _section(draw: Draw, document: Document) -> Document:
    """A section of one track or of all, perhaps from or to the end of its line."""
    lines = _lines(document)
    name = draw(st.sampled_from(list(lines)))
    begin_km, end_km = _ends_km(lines[name])
    shares = sorted(draw(st.lists(st.floats(0.02, 0.98), min_size=2, max_size=2, unique=True)))
    section: Document = {"line": name} if len(lines) > 1 else {}
    if draw(st.booleans()):
        section["from_km"] = begin_km + shares[0] * (end_km - begin_km)
    if draw(st.booleans()):
        section["to_km"] = begin_km + shares[1] * (end_km - begin_km)
    tied = document["supply"].get("tracks_tied")
    if lines[name].get("tracks", 1) == 2 and tied != "everywhere":
        section |= draw(st.sampled_from([{}, {"track": 1}, {"track": 2}]))
    return section


def take_parts_out(draw: Random, document: Document) -> None:
    """Let a random outage name some stores of energy and autotransformers too, where there are any."""
    supply = document["supply"]
    for outage in document.get("outages", ()):
        stores = [store["name"] for store in supply.get("storage", ()) if draw.random() < 0.5]
        places = [
            {key: each[key] for key in ("line",) if key in each} | {"position_km": km}
            for each in supply.get("autotransformers", ())
            for km in each["positions_km"]
            if draw.random() < 0.5
        ]
        outage |= {"storage": stores, "autotransformers": places}
