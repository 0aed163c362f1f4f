"""Scenarios of lines that meet, in a few words each, and runs of them that pass their audit."""

from typing import Any

import tpss

TRAIN = {"model": "Rc4-freight-1470t", "mass_t": 600.0}


def line(length_km: float, stations: dict[str, float], **more: Any) -> dict[str, Any]:
    return {
        "length_km": length_km,
        "gradients": [{"from_km": more.get("begins_at_km", 0.0), "permille": 0.0}],
        "speed_limits": [{"from_km": more.get("begins_at_km", 0.0), "speed_kmh": 100.0}],
        "stations": [{"name": name, "position_km": km} for name, km in stations.items()],
        **more,
    }


def service(name: str, origin: str, destination: str, **more: Any) -> dict[str, Any]:
    return {
        "name": name, "train": "freight", "from": origin, "to": destination,
        "departures_min": [0.0], **more,
    }  # fmt: skip


def network(lines: dict[str, Any], traffic: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    first = next(iter(lines), None)
    station = {"name": "feeder", "line": first, "position_km": 0.0, "type": "Q48/Q49"}
    return {
        "format": 1,
        "name": "network",
        "simulation": {"duration_min": 90.0, "time_step_min": 0.1},
        "lines": lines,
        "supply": {"catenary": "BT", "converter_stations": [{**station, "converters": 3}]},
        "trains": {"freight": TRAIN},
        "traffic": traffic,
        **more,
    }


def scenario_of(document: dict[str, Any]) -> tpss.Scenario:
    return tpss.Scenario.from_document(document, "network")


def run(document: dict[str, Any]) -> tpss.Result:
    result = tpss.simulate(scenario_of(document))
    assert result.audit["passed"], result.audit["failures"]
    return result


STAR = {
    "main": line(60.0, {"West": 0.0, "Fork": 40.0, "East": 60.0}),
    "branch": line(30.0, {"Fork": 100.0, "Mine": 130.0}, begins_at_km=100.0),
}
"""A branch that leaves a main line 20 km before its end."""

KIND = {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.15}

BOTH_WAYS = [
    service("up", "A", "B", departures_min=[0.0, 6.0]),
    service("down", "B", "A", departures_min=[0.0, 4.0]),
]


def double_track(
    tied: str | None, traffic: list[dict[str, Any]] = BOTH_WAYS, tracks: Any = 2, **kind: float
) -> dict[str, Any]:
    """40 km of two tracks between two stations."""
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0}, tracks=tracks)}, traffic)
    document["supply"]["catenary"] = {**KIND, **kind}
    end = {"name": "end", "line": "main", "position_km": 40.0, "type": "Q48/Q49", "converters": 2}
    document["supply"]["converter_stations"].append(end)
    if tied is not None:
        document["supply"]["tracks_tied"] = tied
    return document


def with_posts(document: dict[str, Any], *places_km: float, **more: Any) -> dict[str, Any]:
    document["supply"]["posts"] = [
        {"name": f"P{km:g}", "line": "main", "position_km": km, **more} for km in places_km
    ]
    return document
