"""Random outages: stations, units and transformers, throughout or for a time."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Document = dict[str, Any]


@st.composite
def outages(draw: Any, supply: Document, span_min: float) -> Document:
    """An outage of a supply; perhaps all of it is out, or a part of the line is left unfed."""
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
    if not (out or units or open_km):
        out = names[:1]
    times = {}
    if draw(st.booleans()):
        times["from_min"] = draw(st.one_of(numbers(0.0, span_min), st.just(3.0)))
    if draw(st.booleans()):
        lasts_min = draw(numbers(0.0, span_min)) + 1e-3
        times["to_min"] = times.get("from_min", 0.0) + lasts_min
    return {
        "name": "random",
        "stations": out,
        "units": units,
        "transformers_km": open_km,
        **times,
    }
