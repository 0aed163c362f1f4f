"""Random transformer stations at phases of one or several grids, on either side of neutral sections."""

from typing import Any

from hypothesis import strategies as st

from .feeding import OWN_CATENARIES, transformer_stations
from .ranges import numbers
from .strategies import sound_scenarios

Draw = Any
Document = dict[str, Any]

KINDS = ("converter_stations", "transformer_stations")

PAIRS = st.sampled_from(["RS", "ST", "TR", "SR", "TS", "RT"])

GRIDS = st.fixed_dictionaries(
    {
        "grid_kv": numbers(60.0, 400.0),
        "grid_short_circuit_mva": numbers(300.0, 5000.0),
        "grid_r_over_x": numbers(0.0, 0.5),
    }
)


def _is_plain(document: Document) -> bool:
    """Whether a scenario has one line of 15 kV along which trains move continuously."""
    simulation = document["simulation"]
    stepped = {"motion", "braking", "driver", "power_sampling", "gradient_sampling", "load_flow"}
    return (
        "line" in document
        and any(document["supply"].get(kind) for kind in KINDS)
        and "system" not in document["supply"]
        and not stepped & simulation.keys()
        and document["line"].get("tracks", 1) == 1
    )


@st.composite
def scenarios_at_phases(draw: Draw) -> Document:
    """Scenarios on one line that is fed at phases of a grid; some lose a station."""
    document = draw(sound_scenarios().filter(_is_plain))
    document.pop("outages", None)
    document["simulation"].pop("outage", None)
    with_phases(draw, document)
    if draw(st.integers(0, 3)) == 3:
        first = document["supply"]["transformer_stations"][0]
        name = first["name"]
        if "connection" in first:
            name += f" {first['phases_behind']}"
        times = draw(st.sampled_from([{}, {"from_min": 1.0}, {"from_min": 1.0, "to_min": 3.0}]))
        document["outages"] = [{"name": "random", "stations": [name], **times}]
        document["simulation"]["outage"] = "random"
    return document


def with_phases(draw: Draw, document: Document) -> None:
    """Feed a line of 15 kV by transformer stations at phases, with a neutral section in its middle.

    Stations on one side are at the same phases.  Where a station or the end of a section lies within the
    neutral section, the scenario has a fault.
    """
    line, supply = document["line"], document["supply"]
    begin_km = line.get("begins_at_km", 0.0)
    middle_km = begin_km + line["length_km"] * draw(st.sampled_from([0.5, 0.3, 0.62]))
    half_km = min(0.1, line["length_km"] / 100.0)
    places_km = [each["position_km"] for kind in KINDS for each in supply.get(kind, [])]
    pairs, grid, shared = draw(PAIRS), draw(GRIDS), draw(st.booleans())
    behind = draw(PAIRS)
    stations = []
    for k, km in enumerate(places_km):
        own = draw(transformer_stations((15.5, 17.0)))
        percent = max(own["transformer"]["short_circuit_percent"], 2.0)
        stations.append(
            {
                **own,
                **(grid if shared else draw(GRIDS)),
                "transformer": {**own["transformer"], "short_circuit_percent": percent},
                "name": f"T{k}",
                "position_km": km,
                "phases": pairs if km < middle_km else behind,
                **({"busbar": "north"} if shared else {}),
            }
        )
    document["supply"] = {
        "catenary": draw(OWN_CATENARIES),
        "transformer_stations": stations,
        "neutral_sections": [{"from_km": middle_km - half_km, "to_km": middle_km + half_km}],
    }
    if draw(st.booleans()):
        _connect(draw, document, middle_km, grid)


def _connect(draw: Draw, document: Document, middle_km: float, grid: Document) -> None:
    """A station with a connection in place of all others."""
    own = draw(transformer_stations((15.5, 17.0)))
    percent = max(own["transformer"]["short_circuit_percent"], 2.0)
    sides = draw(
        st.sampled_from(
            [("V/V", "RS", "ST"), ("V/V", "TR", "ST"), ("Scott", "ST", "R"), ("Scott", "T", "RS")]
        )
    )
    document["supply"]["transformer_stations"] = [
        {
            **own,
            **grid,
            "transformer": {**own["transformer"], "short_circuit_percent": percent},
            "name": "Middle",
            "position_km": middle_km,
            **dict(zip(("connection", "phases_before", "phases_behind"), sides, strict=True)),
        }
    ]
