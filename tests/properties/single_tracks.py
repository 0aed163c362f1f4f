"""Random rules for trains that meet on single tracks, and what must hold of runs with them."""

from itertools import pairwise
from typing import Any

import numpy as np
from hypothesis import strategies as st

from tpss import Result
from tpss.results.places import line_names, train_lines

Draw = Any
Document = dict[str, Any]

INSIDE_M = 1.0
"""Trains nearer to the end of a single track than this are not on it. [m]"""


def with_single_tracks(draw: Draw, document: Document) -> None:
    """Let trains wait for each other at stations, of which some have several tracks."""
    rules = ["first-come"]
    if "duration_min" in document["simulation"]:
        rules.append("timetable-order")
    document["signalling"]["single_track"] = draw(st.sampled_from(rules))
    lines = document["lines"].values() if "lines" in document else [document["line"]]
    for line in lines:
        for station in line["stations"]:
            station["tracks"] = draw(st.sampled_from([1, 2, 2, 3]))


def judge_single_tracks(result: Result) -> None:
    """No train is on a single track while one of the other direction is, but those placed there."""
    if not result.scenario.signalling.has_gates or result.dataset.sizes["train"] < 2:
        return
    data = result.dataset
    place_m, which, signs = data.position.to_numpy(), train_lines(data), directions(result)
    names = line_names(data)
    placed = np.isnan(data.departure_time.to_numpy())
    for number, line in enumerate(result.scenario.lines_by_name.values()):
        for begin_m, end_m in single_tracks_m(line):
            with np.errstate(invalid="ignore"):
                on = (place_m > begin_m + INSIDE_M) & (place_m < end_m - INSIDE_M)
            on &= which == number
            for station in line.stations:  # at which trains begin and end beside the track
                with np.errstate(invalid="ignore"):
                    on &= ~(np.abs(place_m - 1e3 * station.position_km) <= INSIDE_M)
            on[:, placed] = False
            both = (on & (signs > 0.0)).any(axis=1) & (on & (signs < 0.0)).any(axis=1)
            assert not both.any(), (
                f"trains meet on {names[number]} {begin_m / 1e3}-{end_m / 1e3} km at step "
                f"{int(both.argmax())}"
            )


def single_tracks_m(line: Any) -> list[tuple[float, float]]:
    """Single tracks of a line between places where trains may cross. [m]"""
    found = []
    for begin_km, end_km, count in line.tracks_by_stretch:
        if count == 1:
            inside = [s.position_km for s in line.stations if s.tracks > 1]
            cuts = sorted({begin_km, end_km, *(km for km in inside if begin_km < km < end_km)})
            found += [(1e3 * low, 1e3 * high) for low, high in pairwise(cuts)]
    return found


def directions(result: Result) -> np.ndarray:
    """Direction of each train at each instant, 1 to rising kilometres; 0 where it has not moved yet."""
    data = result.dataset
    place_m, along_m, which = (
        data.position.to_numpy(), data.route_position.to_numpy(), train_lines(data),
    )  # fmt: skip
    signs = np.zeros_like(place_m)
    with np.errstate(invalid="ignore"):
        moved = (np.diff(along_m, axis=0) > 1e-3) & (which[1:] == which[:-1])
        same = np.abs(np.abs(np.diff(place_m, axis=0)) - np.diff(along_m, axis=0)) < 1e-6
        signs[:-1] = np.where(moved & same, np.sign(np.diff(place_m, axis=0)), 0.0)
    return signs
