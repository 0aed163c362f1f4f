"""Random lines on which many trains meet: single tracks, crossing places, junctions, both directions."""

from random import Random
from typing import Any

from hypothesis import strategies as st

from tpss.scenario.routes import NoWayError, find_way, hops_of

from .given_tracks import give_tracks

Document = dict[str, Any]

FREIGHT = {"model": "Rc4-freight-1470t", "mass_t": 600.0, "length_m": 500.0}


def crowded_scenarios() -> st.SearchStrategy[Document]:
    """Scenarios whose trains wait for each other."""
    return st.randoms(use_true_random=False).map(crowd)


def crowd(draw: Random) -> Document:
    """A scenario of a line, often with another one that meets it, and some trains on them."""
    lines = {"main": _line(draw, "A", draw.randint(3, 6))}
    if draw.random() < 0.6:
        lines["branch"] = _joined(draw, lines["main"])
    short = {"mass_t": 250.0, "length_m": draw.choice([0.0, 120.0]), "max_speed_kmh": 130.0}
    blocks = draw.choice([{"separation": "moving-block"}] * 2 + [
        {"separation": "fixed-block", "block_m": 1500.0}
    ])  # fmt: skip
    document = {
        "format": 1,
        "name": "crowded",
        "simulation": {
            "duration_min": draw.choice([90.0, 240.0]), "time_step_min": draw.choice([0.1, 0.5]),
        },
        "lines": lines,
        "supply": _supply(draw, lines),
        "trains": {"long": FREIGHT, "short": {**FREIGHT, **short}},
        "traffic": _traffic(draw, lines),
        "signalling": {**blocks, "single_track": draw.choice(["timetable-order", "first-come"])},
    }  # fmt: skip
    give_tracks(draw, document)
    return document


def _line(draw: Random, letter: str, count: int) -> Document:
    length_km = round(draw.uniform(20.0, 90.0), 3)
    inner = {round(draw.uniform(1.0, length_km - 1.0), 3) for _ in range(count - 2)}
    stations = [
        {"name": f"{letter}{k}", "position_km": km, "tracks": draw.choice([1, 2, 2, 3])}
        for k, km in enumerate(sorted({0.0, length_km, *inner}))
    ]
    line: Document = {
        "length_km": length_km,
        "gradients": [{"from_km": 0.0, "permille": draw.choice([0.0, 3.0, -4.0])}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": draw.choice([80.0, 110.0])}],
        "stations": stations,
    }
    if draw.random() < 0.5:
        ends_km = round(draw.uniform(2.0, length_km - 2.0), 3)
        some = [{"from_km": 0.0, "count": 2}, {"from_km": ends_km, "count": 1}]
        line["tracks"] = draw.choice([2, 2, some, some, 3])
    return line


def _joined(draw: Random, main: Document) -> Document:
    """A line of which a station is one of another line."""
    branch = _line(draw, "B", draw.randint(2, 4))
    branch["stations"][draw.randrange(len(branch["stations"]))] |= {
        key: value for key, value in draw.choice(main["stations"]).items() if key != "position_km"
    }
    return branch


def _supply(draw: Random, lines: dict[str, Document]) -> Document:
    ends_km = [0.0, lines["main"]["length_km"]]
    stations = [
        {"name": f"F{k}", "line": "main", "position_km": km, "type": "Q48/Q49", "converters": 12}
        for k, km in enumerate(ends_km)
    ]
    supply: Document = {"catenary": "AT", "converter_stations": stations}
    if any("tracks" in line for line in lines.values()):
        supply["tracks_tied"] = draw.choice(["everywhere", "no"])
    return supply


def _traffic(draw: Random, lines: dict[str, Document]) -> list[Document]:
    """Services between any two stations, with stops on some of those between them."""
    stations = {
        name: {station["name"]: station["position_km"] for station in line["stations"]}
        for name, line in lines.items()
    }
    hops, services = hops_of(stations), []
    while not services:
        for i in range(draw.randint(2, 5)):
            origin, destination = draw.sample(list(hops), 2)
            try:
                way = find_way(hops, origin, [], destination)
            except NoWayError:
                continue
            services.append(_service(draw, i, origin, destination, [h.end for h in way.hops[:-1]]))
    return services


def _service(draw: Random, i: int, origin: str, destination: str, between: list[str]) -> Document:
    departures = {
        round(draw.uniform(0.0, 60.0), draw.choice([0, 2])) for _ in range(draw.randint(1, 4))
    }
    service: Document = {
        "name": f"service {i}",
        "train": draw.choice(["long", "short"]),
        "from": origin,
        "to": destination,
        "departures_min": sorted(departures),
        "stops": [
            {"station": name, "dwell_min": draw.choice([0.0, 0.5, 3.0])}
            for name in between
            if draw.random() < 0.4
        ],
    }
    if draw.random() < 0.3:
        service["delays"] = {"mean_min": 5.0, "share": 0.5, "seed": draw.randrange(99)}
    return service
