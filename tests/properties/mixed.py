"""Random stations whose converters are of two or three types; how these share, once more."""

from typing import Any

from hypothesis import strategies as st

from .feeding import OWN_CONVERTERS
from .ranges import numbers

Draw = Any
Document = dict[str, Any]

KEPT = {"name", "line", "at", "position_km", "feeds", "grid_angle_deg", "station_kw"}
"""What a converter station keeps when it becomes a mixed one."""


@st.composite
def units(draw: Draw) -> list[Document]:
    """Converters of two or three types of one voltage without load, each with droop and reactance."""
    kinds = draw(st.lists(OWN_CONVERTERS, min_size=2, max_size=3))
    made = []
    for kind in kinds:
        shares = {
            "no_load_voltage_kv": kinds[0]["no_load_voltage_kv"],
            "droop_kv_per_mvar": draw(numbers(0.005, 0.2)),
            "generator_reactance_pu": draw(numbers(0.05, 1.0)),
        }
        made.append({"type": {**kind, **shares}, "converters": draw(st.integers(1, 4))})
    return made


def with_mixed_stations(draw: Draw, document: Document) -> None:
    """Put several types into some of the converter stations of which no unit alone is out."""
    supply = document["supply"]
    parted = {name for outage in document.get("outages", ()) for name in outage["units"]}
    plain = []
    for station in supply.get("converter_stations", ()):
        if station["name"] in parted or not draw(st.booleans()):
            plain.append(station)
            continue
        made = {key: value for key, value in station.items() if key in KEPT}
        made |= {"units": draw(units()), "feedback": draw(st.sampled_from(["grid", "resistor"]))}
        supply.setdefault("mixed_stations", []).append(made)
    if "mixed_stations" in supply:
        supply["converter_stations"] = plain
