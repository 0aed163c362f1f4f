"""The drawing to edit: lines with what stands at them, and the key paths by which that is moved."""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss.report.layout import layout
from tpss.scenario.line import Line
from tpss.scenario.raw import items, lines_of, table
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply.supply import STATIONS, STORAGE
from tpss.scenario.supply.transformers import transformer_positions_km

FEEDING, POSTS, BREAKS = "feeding", "post", "break"

KINDS = {
    **dict.fromkeys(STATIONS, FEEDING),
    "posts": POSTS,
    "section_breaks": BREAKS,
    STORAGE: "storage",
}
"""Lists of the supply whose items stand at a place, by what they are drawn as."""

STRETCHES = {
    "neutral_sections": "neutral section",
    "without_contact_line": "without contact line",
    "contact_lines": "other contact line",
}
"""Lists of the supply whose items reach from one place to another."""

Place = dict[str, Any]


def plan_of(scenario: Scenario, document: Mapping[str, Any]) -> dict[str, Any]:
    """Lines with their profiles, and places with the key paths of their positions, where they have one.

    Parameters
    ----------
    scenario : Scenario
    document : mapping
        What it was made from, in which key paths are.
    """
    paths = layout(scenario)
    lines = [
        {"name": name, "path": {axis: getattr(paths[name], axis).tolist() for axis in ("km", "x", "y")},
         **_profile(line)}
        for name, line in scenario.lines_by_name.items()
    ]  # fmt: skip
    supply = scenario.as_document()["supply"]
    own = table(document, "supply")
    first = next(iter(scenario.lines_by_name))
    places = [
        *_stations(scenario, document),
        *_feeding(supply, own, first),
        *_transformers(scenario, own, first),
    ]
    for place in places:
        place["out"] = _is_out(place, scenario)
    return {"lines": lines, "places": places, "stretches": list(_stretches(supply, first))}


def _profile(line: Line) -> dict[str, Any]:
    limits = [[each.from_km, each.speed_kmh] for each in line.speed_limits]
    return {
        "begin_km": line.begins_at_km,
        "end_km": line.end_km,
        "tracks": [list(each) for each in line.tracks_by_stretch],
        "gradients": [[each.from_km, each.permille] for each in line.gradients],
        "limits": limits,
    }


def _stations(scenario: Scenario, document: Mapping[str, Any]) -> Iterator[Place]:
    """Stations of the lines; those of a file have no key paths."""
    written = lines_of(document)
    for name, line in scenario.lines_by_name.items():
        above, own = written.get(name, ("", {}))
        numbers = {each.get("name"): number for number, each in items(own, "stations")}
        for station in line.stations:
            number = numbers.get(station.name)
            path = None if number is None else f"{above}.stations.{number}.position_km"
            yield _place("station", station.name, name, station.position_km, path)


def _feeding(supply: Mapping[str, Any], own: Mapping[str, Any], first: str) -> Iterator[Place]:
    """What feeds or switches; what stands at a station by its name moves with that."""
    for key, kind in KINDS.items():
        written = dict(items(own, key))
        for number, each in items(supply, key):
            moved = "position_km" in written.get(number, {})
            path = f"supply.{key}.{number}.position_km" if moved else None
            name, line = each.get("name") or f"{kind} {number + 1}", each.get("line") or first
            yield {
                **_place(kind, name, line, each["position_km"], path),
                "item": f"supply.{key}.{number}" if number in written else None,
                "detail": _detail(each),
            }


def _detail(station: Mapping[str, Any]) -> str:
    """What a feeding station consists of, in words."""
    for key in ("converters", "transformers", "rectifiers", "units"):
        if isinstance(station.get(key), int):
            number = station[key]
            return f"{number} {key if number != 1 else key[:-1]}"
    return ""


def _transformers(scenario: Scenario, own: Mapping[str, Any], first: str) -> Iterator[Place]:
    """Transformers of the high-voltage line between stations; equally spaced ones are not moved."""
    written = table(own, "high_voltage_line")
    given = isinstance(written.get("transformers_km"), list)
    high_voltage = scenario.supply.high_voltage_line
    line = first if high_voltage is None else high_voltage.line or first
    for number, km in enumerate(transformer_positions_km(scenario.supply)):
        path = f"supply.high_voltage_line.transformers_km.{number}" if given else None
        yield _place("transformer", f"transformer {number + 1}", line, km, path)


def _stretches(supply: Mapping[str, Any], first: str) -> Iterator[dict[str, Any]]:
    for key, kind in STRETCHES.items():
        for _, each in items(supply, key):
            ends = [each.get("from_km"), each.get("to_km")]
            if None not in ends:
                yield {"kind": kind, "line": each.get("line") or first, "ends_km": ends}


def _is_out(place: Place, scenario: Scenario) -> bool:
    """Whether a station or transformer is out of service in the outage that applies."""
    outage = scenario.outage
    if outage is None:
        return False
    if place["kind"] == "transformer":
        return place["km"] in outage.transformers_km
    return place["kind"] == FEEDING and place["name"] in outage.stations


def _place(kind: str, name: str, line: str, km: float, path: str | None) -> Place:
    return {"kind": kind, "name": name, "line": line, "km": km, "path": path}
