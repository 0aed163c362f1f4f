"""Random networks: a line becomes one of several that meet, with tracks, posts and ways over them."""

import copy
from typing import Any

from hypothesis import strategies as st

from tpss import library
from tpss.scenario.routes import NoWayError, find_way, hops_of

from .ranges import numbers

Draw = Any
Document = dict[str, Any]

MAIN = "main"


def into_network(draw: Draw, document: Document, lines: st.SearchStrategy[Document]) -> Document:
    """A scenario of one line with one to three others that meet it or each other, in trees or rings."""
    document = copy.deepcopy(document)
    network = {MAIN: document.pop("line")}
    for i in range(draw(st.integers(1, 3))):
        network[f"line {i}"] = _joined(draw, i, draw(lines), network)
    document["lines"] = network
    _feed(draw, document)
    for entry in document["traffic"]:
        for train in entry.get("initial_trains", []):
            train["line"] = MAIN
    _lay_tracks(draw, document)
    for i in range(draw(st.integers(1, 2))):
        service = _service(draw, i, document)
        if service is not None:
            document["traffic"].append(service)
    return document


def _joined(draw: Draw, i: int, line: Document, network: dict[str, Document]) -> Document:
    """A line of which one station, or two, are those of others."""
    for k, station in enumerate(line["stations"]):
        station["name"] = f"L{i}S{k}"
    known = [station["name"] for other in network.values() for station in other["stations"]]
    count = min(draw(st.sampled_from([1, 1, 2])), len(line["stations"]))
    places = draw(st.permutations(range(len(line["stations"]))))[:count]
    for place, name in zip(places, draw(st.permutations(known)), strict=False):
        line["stations"][place]["name"] = name
    return line


def _feed(draw: Draw, document: Document) -> None:
    """Feeding stations of the main line, some of them moved to others."""
    supply, network = document["supply"], document["lines"]
    placed: list[tuple[str, float]] = []
    for kind in ("converter_stations", "transformer_stations"):
        for station in supply.get(kind, []):
            station["line"] = MAIN
            if "high_voltage_line" not in supply and draw(st.integers(0, 2)) == 2:
                name = draw(st.sampled_from(list(network)))
                line = network[name]
                begin_km = line.get("begins_at_km", 0.0)
                km = draw(numbers(begin_km, begin_km + line["length_km"]))
                if all(name != other or abs(km - place) >= 0.001 for other, place in placed):
                    station["line"], station["position_km"] = name, km
            placed.append((station["line"], station["position_km"]))
    if len(set(placed)) < len(placed) or _too_close(placed):
        for kind in ("converter_stations", "transformer_stations"):
            supply[kind] = supply.get(kind, [])[:1]
        if supply["converter_stations"]:
            supply["transformer_stations"] = []
    if "high_voltage_line" in supply:
        supply["high_voltage_line"]["line"] = MAIN


def _too_close(placed: list[tuple[str, float]]) -> bool:
    return any(
        one[0] == other[0] and abs(one[1] - other[1]) < 0.001
        for i, one in enumerate(placed)
        for other in placed[:i]
    )


def _lay_tracks(draw: Draw, document: Document) -> None:
    """Two tracks on some lines, tied everywhere, at posts, or not."""
    supply, network = document["supply"], document["lines"]
    double = [name for name in network if draw(st.integers(0, 2)) == 2]
    for name in double:
        line = network[name]
        begin_km = line.get("begins_at_km", 0.0)
        line["tracks"] = 2
        if draw(st.booleans()):
            km = draw(numbers(begin_km, begin_km + line["length_km"]))
            counts = [{"from_km": begin_km, "count": 2}, {"from_km": km, "count": 1}]
            line["tracks"] = counts if km > begin_km else 2
        line["left_hand_running"] = draw(st.booleans())
    if not double:
        return
    supply["tracks_tied"] = tied = draw(st.sampled_from(["everywhere", "posts", "no"]))
    _couple(draw, supply)
    if tied == "posts":
        name = draw(st.sampled_from(double))
        line = network[name]
        begin_km = line.get("begins_at_km", 0.0)
        supply["posts"] = [
            {"name": "post", "line": name, "position_km": begin_km + 0.01 * line["length_km"],
             "closed": draw(st.booleans())}
        ]  # fmt: skip
        if (
            isinstance(line["tracks"], list)
            and line["tracks"][1]["from_km"] < (supply["posts"][0]["position_km"])
        ):
            del supply["posts"]


COMMON = [(0.0, 0.0), (0.1, 0.3), (0.3, 0.0), (0.0, 0.6), (0.95, 0.95)]
"""Shares of resistance and reactance that the contact lines of two tracks have in common. [1]"""


def _couple(draw: Draw, supply: Document) -> None:
    """Let the contact lines of two tracks have something in common: nothing, some, or nearly all."""
    catenary = supply["catenary"]
    if isinstance(catenary, str):
        catenary = dict(library.entries("catenaries")[catenary])
        del catenary["source"]
    for axis, share in zip(("r", "x"), draw(st.sampled_from(COMMON)), strict=True):
        if share > 0.0:
            catenary[f"mutual_{axis}_ohm_per_km"] = share * catenary[f"{axis}_ohm_per_km"]
            supply["catenary"] = catenary


def _service(draw: Draw, i: int, document: Document) -> Document | None:
    """A service over the network, perhaps there and back; None if there is no way, or two."""
    stations = {
        name: {station["name"]: station["position_km"] for station in line["stations"]}
        for name, line in document["lines"].items()
    }
    hops = hops_of(stations)
    origin, destination = draw(st.permutations(list(hops)))[:2]
    back = draw(st.integers(0, 3)) == 3
    try:
        way = find_way(hops, origin, [], destination)
    except NoWayError:
        return None
    between = [hop.end for hop in way.hops[:-1]]
    if len(set(between)) < len(between) or origin in between:
        return None
    dwell = numbers(0.0, 6.0 * document["simulation"]["time_step_min"])
    stops = [{"station": name, "dwell_min": draw(dwell)} for name in between if draw(st.booleans())]
    if back:
        turn = {"station": destination, "dwell_min": 0.0, "turn_min": draw(dwell)}
        stops, destination = [*stops, turn], origin
    return {
        "name": f"over {i}",
        "train": draw(st.sampled_from(list(document["trains"]))),
        "from": origin,
        "to": destination,
        "stops": stops,
        "departures_min": [0.0, document["simulation"]["time_step_min"] * draw(st.integers(1, 40))],
    }
