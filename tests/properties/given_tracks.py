"""Random tracks for services on lines of several tracks, and what must hold of trains on one track."""

from random import Random
from typing import Any

import numpy as np

from tpss import Result
from tpss.results.passing import STATION_M, passings
from tpss.scenario.routes import Hop, NoWayError, find_way, hops_of

from .single_tracks import directions

Document = dict[str, Any]


def give_tracks(draw: Random, document: Document) -> None:
    """Let some services say on which tracks their trains run, at origins, stops and in between."""
    lines = document["lines"] if "lines" in document else {"line": document["line"]}
    stations = {
        name: {station["name"]: station["position_km"] for station in line["stations"]}
        for name, line in lines.items()
    }
    hops = hops_of(stations)
    for entry in document["traffic"]:
        if draw.random() < 0.8:
            _give(draw, entry, hops, lines)


def _give(draw: Random, entry: Document, hops: dict[str, list[Hop]], lines: Document) -> None:
    stops = [stop["station"] for stop in entry["stops"]]
    try:
        way = find_way(hops, entry["from"], stops, entry["to"])
    except NoWayError:
        return
    at = sorted(i for i in range(-1, len(way.hops) - 1) if draw.random() < 0.6)
    passed = [hop.end for hop in way.hops[:-1]]
    passes = []
    for i in at:
        held = [way.hops[i + 1]]
        for k in range(i + 2, len(way.hops)):
            if way.hops[k].line != held[0].line or k - 1 in at:
                break
            held.append(way.hops[k])
        most = max(_most_tracks(lines[hop.line], hop) for hop in held)
        if most == 1:
            continue
        track = draw.randint(1, most)
        if i < 0:
            entry["track"] = track
        elif i in way.stops:
            entry["stops"][way.stops.index(i)]["track"] = track
        elif passed.count(passed[i]) == 1:
            passes.append({"station": passed[i], "track": track})
    if passes:
        entry["passes"] = passes


def _most_tracks(line: Document, hop: Hop) -> int:
    """Number of tracks between two neighbouring stations, where there are most."""
    tracks = line.get("tracks", 1)
    if isinstance(tracks, int):
        return tracks
    low_km, high_km = sorted((hop.begin_km, hop.end_km))
    ends_km = [row["from_km"] for row in tracks[1:]] + [float("inf")]
    begins_km = [float("-inf"), *ends_km[:-1]]
    return max(
        row["count"]
        for begin_km, end_km, row in zip(begins_km, ends_km, tracks, strict=True)
        if begin_km < high_km and low_km < end_km
    )


def judge_given_tracks(result: Result) -> None:
    """Trains of both directions do not pass through each other on a track, but those placed there.

    Where they begin, end or turn round they stand beside the track.
    """
    data, scenario = result.dataset, result.scenario
    if not scenario.signalling.has_gates or data.sizes["train"] < 2:
        return
    names, signs = data.train.to_numpy().tolist(), directions(result)
    placed = np.isnan(data.departure_time.to_numpy())
    entries = {entry.name: entry for entry in scenario.traffic}
    for each in passings(result):
        pair = [names.index(each.one), names.index(each.other)]
        step = int(np.searchsorted(data.time.to_numpy(), 60.0 * each.time_min + 1e-6)) - 1
        if placed[pair].any() or signs[step, pair].prod() >= 0.0:
            continue
        calls = set()
        for train in pair:
            entry = entries[str(data.service.to_numpy()[train])]
            calls |= {entry.origin, entry.destination}
            calls |= {stop.station for stop in entry.stops if stop.turn_min is not None}
        line = scenario.lines_by_name[each.line or next(iter(scenario.lines_by_name))]
        beside = any(
            abs(s.position_km - each.place_km) <= 1e-3 * STATION_M
            for s in line.stations
            if s.name in calls
        )
        assert beside, f"trains pass through each other: {each.in_words}"
