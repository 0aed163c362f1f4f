"""Random networks of single and double tracks that meet at junctions of few tracks, with many trains."""

from random import Random
from typing import Any

from tpss.scenario.routes import NoWayError, find_way, hops_of

from .crowds import FREIGHT

Document = dict[str, Any]


def junctions(draw: Random) -> Document:
    """A scenario whose trains wait for each other at junctions, in timetable order.

    Trains begin at ends of lines: those that join a single track between its crossing places may do so
    before or behind others, whatever was planned.
    """
    lines = _lines(draw)
    document = {
        "format": 1,
        "name": "junctions",
        "simulation": {"duration_min": 600.0, "time_step_min": 0.5},
        "lines": lines,
        "supply": {"catenary": "AT", "converter_stations": [
            {"name": f"F{name}", "line": name, "position_km": 0.01 + 0.003 * k, "type": "Q48/Q49",
             "converters": 12} for k, name in enumerate(lines)
        ]},
        "trains": {"long": {**FREIGHT, "length_m": draw.choice([500.0, 120.0, 0.0])}},
        "traffic": _traffic(draw, lines),
        "signalling": {"separation": "moving-block", "single_track": "timetable-order"},
    }  # fmt: skip
    if any("tracks" in line for line in lines.values()):
        document["supply"]["tracks_tied"] = "no"
    return document


def _lines(draw: Random) -> dict[str, Document]:
    """A tree of junctions, sometimes with a ring, and lines that lead out of it."""
    inner = [f"J{k}" for k in range(draw.randint(1, 4))]
    tracks = {name: draw.choice([1, 1, 2, 2, 3]) for name in inner}
    pairs = [(inner[draw.randrange(k)], inner[k]) for k in range(1, len(inner))]
    if len(inner) > 2 and draw.random() < 0.5:
        one, other = draw.sample(inner, 2)
        pairs.append((one, other))
    for k in range(draw.randint(3, 5)):
        tracks[f"E{k}"] = draw.choice([1, 2, 4])
        pairs.append((draw.choice(inner), f"E{k}"))
    return {
        f"line {k}": _line(draw, (one, tracks[one]), (other, tracks[other]))
        for k, (one, other) in enumerate(pairs)
    }


def _line(draw: Random, *ends: tuple[str, int]) -> Document:
    length_km = round(draw.uniform(5.0, 30.0), 2)
    line: Document = {
        "length_km": length_km,
        "gradients": [{"from_km": 0.0, "permille": 0.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "stations": [
            {"name": name, "position_km": km, "tracks": tracks}
            for (name, tracks), km in zip(ends, (0.0, length_km), strict=True)
        ],
    }
    if draw.random() < 0.3:
        counts = draw.choice([(2, 1), (1, 2)])
        places_km = (0.0, round(0.4 * length_km, 2))
        line["tracks"] = [
            {"from_km": km, "count": count} for km, count in zip(places_km, counts, strict=True)
        ]
    return line


def _traffic(draw: Random, lines: dict[str, Document]) -> list[Document]:
    stations = {
        name: {each["name"]: each["position_km"] for each in line["stations"]}
        for name, line in lines.items()
    }
    hops, services = hops_of(stations), list[Document]()
    count, hurry_min = draw.randint(3, 9), draw.choice([5.0, 20.0, 40.0])
    while len(services) < count:
        origin, destination = draw.sample(list(hops), 2)
        try:
            way = find_way(hops, origin, [], destination)
        except NoWayError:
            continue
        departures = {round(draw.uniform(0.0, hurry_min), 2) for _ in range(draw.randint(1, 3))}
        services.append({
            "name": f"service {len(services)}", "train": "long", "from": origin, "to": destination,
            "departures_min": sorted(departures),
            "stops": [
                {"station": hop.end, "dwell_min": draw.choice([0.0, 0.5, 3.0])}
                for hop in way.hops[:-1] if draw.random() < 0.4
            ],
        })  # fmt: skip
    return services
