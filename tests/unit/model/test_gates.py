"""Where routes have gates: before single tracks, and where they come together."""

from typing import Any

import numpy as np

from lines import STAR, line, network, scenario_of, service
from tpss.model.gates import build_gates, crossing_places
from tpss.model.routes import routes_of
from tpss.model.two_way_tracks import single_tracks, two_way_tracks

MARGIN_M = 50.0


def gates_of(
    lines: dict[str, Any], *traffic: dict[str, Any], tied: bool = False
) -> list[list[Any]]:
    """Gates of each route: from where to where [km], and whether the rear has to leave too."""
    document = network(lines, list(traffic))
    if tied:
        document["supply"]["tracks_tied"] = "everywhere"
    scenario = scenario_of(document)
    rules = build_gates(routes_of(scenario), scenario.lines_by_name, MARGIN_M)
    return [[gate for gate in row if np.isfinite(gate.from_m)] for row in np.asarray(rules.gates)]


def bounds_km(row: list[Any]) -> list[tuple[float, float]]:
    return [(gate["from_m"] / 1e3, gate["until_m"] / 1e3) for gate in row]


def with_tracks(lines: dict[str, Any], **tracks: int) -> dict[str, Any]:
    """Lines with numbers of tracks at stations."""
    for each in lines.values():
        for station in each["stations"]:
            station["tracks"] = tracks.get(station["name"], 1)
    return lines


def test_single_tracks_lie_between_stations_of_several_tracks_and_ends():
    """Of 60 km, 20 have two tracks; a station at 30 has one track, one at 50 has two."""
    stretches = [{"from_km": 0.0, "count": 2}, {"from_km": 20.0, "count": 1}]
    stations = {"A": 0.0, "B": 30.0, "C": 50.0, "D": 60.0}
    lines = with_tracks({"main": line(60.0, stations, tracks=stretches)}, C=2)
    document = network(lines, [service("up", "A", "D")])
    document["supply"]["tracks_tied"] = "everywhere"
    main = scenario_of(document).lines_by_name["main"]
    found = [(track.begin_km, track.end_km) for track in single_tracks("main", main)]
    assert found == [(20.0, 50.0), (50.0, 60.0)]


def test_a_route_has_a_gate_where_each_single_track_begins_in_its_direction():
    lines = with_tracks({"main": line(60.0, {"A": 0.0, "M": 20.0, "B": 60.0})}, A=2, M=2, B=2)
    up, down = gates_of(lines, service("up", "A", "B"), service("down", "B", "A"))
    assert bounds_km(up) == [(0.0, 20.0), (20.0, 60.0)]
    assert bounds_km(down) == [(-60.0, -20.0), (-20.0, 0.0)]
    assert [gate["stretch"] for gate in up] == [gate["stretch"] for gate in down][::-1]
    assert [gate["direction"] for gate in (*up, *down)] == [0, 0, 1, 1]
    assert [gate["place"] for gate in (*up, *down)] == [0, -1, 0, -1]
    assert not any(gate["clears_whole"] for gate in (*up, *down))


def test_a_train_that_begins_on_a_single_track_has_its_gate_there():
    lines = with_tracks({"main": line(60.0, {"A": 0.0, "M": 20.0, "B": 60.0})}, A=2, B=2)
    (row,) = gates_of(lines, service("up", "M", "B"))
    assert bounds_km(row) == [(20.0, 60.0)]
    assert row[0]["aside"]


def test_a_single_track_that_ends_at_several_is_left_by_the_rear():
    tracks = [{"from_km": 0.0, "count": 2}, {"from_km": 20.0, "count": 1}]
    lines = {"main": line(60.0, {"A": 0.0, "B": 60.0}, tracks=tracks)}
    (row,) = gates_of(lines, service("down", "B", "A"), tied=True)
    assert bounds_km(row) == [(-60.0, -20.0)]
    assert row[0]["clears_whole"]


def test_lines_of_two_tracks_have_gates_where_routes_come_together_only():
    """At Fork, 40 km from West: trains from West go through, those from Mine join them to East."""
    lines = {name: {**each, "tracks": 2} for name, each in STAR.items()}
    through, joins, back = gates_of(
        lines, service("a", "West", "East"), service("b", "Mine", "East"),
        service("c", "East", "West"), tied=True,
    )  # fmt: skip
    assert bounds_km(through) == [(40.0, 40.0 + MARGIN_M / 1e3)]
    ((begins_km, _),) = bounds_km(joins)
    assert begins_km == -130.0 + 30.0  # 30 km after Mine, at 130 km of the branch
    assert through[0]["stretch"] == joins[0]["stretch"]
    assert back == []


def test_trains_may_have_to_wait_where_two_single_tracks_meet():
    lines = with_tracks({"main": line(60.0, {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0})}, A=2, M=3)
    scenario = scenario_of(network(lines, [service("up", "A", "B")]))
    (route,), lines = routes_of(scenario), scenario.lines_by_name
    assert [s.name for s in crossing_places(route, two_way_tracks([route], lines), lines)] == ["M"]


# Several tracks, of which trains of both directions use one

DOUBLE = {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0}


def double(**tracks: int) -> dict[str, Any]:
    """Lines of 60 km of two tracks: to rising kilometres trains take the second one."""
    return with_tracks({"main": line(60.0, DOUBLE, tracks=2)}, **tracks)


def from_to(name: str, origin: int | None = None, *passed: int | None) -> dict[str, Any]:
    """A service from A to B with the tracks that it gives at A, M and N."""
    passes = [
        {"station": station, "track": track}
        for station, track in zip(("M", "N"), passed, strict=False)
        if track is not None
    ]
    return service(name, "A", "B", passes=passes, **({} if origin is None else {"track": origin}))


def test_a_track_that_both_directions_use_has_gates_where_one_of_them_leaves_it():
    """Up from M to N on the track of those down: they wait at N, it waits at M."""
    up, down = gates_of(double(), from_to("up", None, 1, 2), service("down", "B", "A"), tied=True)
    assert bounds_km(up) == [(20.0, 40.0)]
    assert bounds_km(down) == [(-40.0, -20.0)]
    assert up[0]["stretch"] == down[0]["stretch"]
    assert [gate["direction"] for gate in (*up, *down)] == [0, 1]
    assert up[0]["clears_whole"]
    assert not up[0]["aside"]


def test_trains_cross_on_it_at_stations_of_several_tracks():
    up, down = gates_of(double(M=2), from_to("up", 1), service("down", "B", "A"), tied=True)
    assert bounds_km(up) == [(0.0, 20.0), (20.0, 60.0)]
    assert bounds_km(down) == [(-60.0, -20.0), (-20.0, 0.0)]
    assert [gate["place"] for gate in up] == [0, -1]


def test_trains_of_one_direction_on_two_tracks_have_no_gates():
    assert gates_of(double(), from_to("slow", 1), from_to("fast", 2), tied=True) == [[], []]


def test_where_trains_come_to_a_track_from_the_one_beside_it_they_and_others_on_it_have_gates():
    """At N the slow train comes back to the track on which the fast one runs through."""
    slow, fast = gates_of(double(), from_to("slow", 1, None, 2), from_to("fast"), tied=True)
    assert bounds_km(slow) == bounds_km(fast) == [(40.0, 40.0 + MARGIN_M / 1e3)]
    assert slow[0]["stretch"] == fast[0]["stretch"]


def test_between_two_way_tracks_that_follow_each_other_there_is_room_for_one_train():
    """Up on a single track, then from 30 km on on the track of those down, who then come to it too.

    Neither may go on the one track before the other train has left both, or one of them would stand in
    the other's way at 30 km.
    """
    counts = [{"from_km": 0.0, "count": 1}, {"from_km": 30.0, "count": 2}]
    lines = {"main": line(60.0, {"A": 0.0, "B": 60.0}, tracks=counts)}
    document = network(lines, [service("up", "A", "B", track=1), service("down", "B", "A")])
    document["supply"]["tracks_tied"] = "everywhere"
    scenario = scenario_of(document)
    rules = build_gates(routes_of(scenario), scenario.lines_by_name, MARGIN_M)
    up, down = np.asarray(rules.gates)
    assert [gate["from_m"] for gate in (*up, *down)][:2] == [0.0, 30e3]
    assert [up[0]["place"], down[0]["place"]] == [0, 0]
    assert rules.tracks.tolist() == [1]


def test_a_train_that_turns_round_on_its_track_uses_it_both_ways():
    stops = [{"station": "N", "dwell_min": 0.0, "turn_min": 5.0}]
    (row,) = gates_of(double(), service("shuttle", "A", "A", track=1, stops=stops), tied=True)
    assert bounds_km(row) == [(0.0, 40.0), (40.0, 80.0)]
    assert [gate["direction"] for gate in row] == [0, 1]
