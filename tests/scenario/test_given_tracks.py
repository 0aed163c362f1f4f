"""Tracks that services give: faults name key, value and remedy."""

from typing import Any

import pytest

import tpss
from lines import line, network, scenario_of, service

STATIONS = {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0}


def document(*traffic: dict[str, Any], tracks: Any = 2) -> dict[str, Any]:
    lines = {
        "main": line(60.0, STATIONS, tracks=tracks),
        "branch": line(30.0, {"N": 0.0, "C": 30.0}),
    }
    found = network(lines, list(traffic))
    found["supply"]["tracks_tied"] = "no"
    return found


def faults_of(*traffic: dict[str, Any], **more: Any) -> list[tuple[str, str, str, str]]:
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario_of(document(*traffic, **more))
    return [(f.key, f.value, f.problem, f.remedy) for f in caught.value.findings]


def passing(station: str, track: int) -> dict[str, Any]:
    return {"station": station, "track": track}


def test_a_track_may_be_given_at_the_origin_a_stop_and_a_pass():
    stop = {"station": "M", "dwell_min": 1.0, "track": 1}
    (entry,) = scenario_of(
        document(service("up", "A", "B", track=2, stops=[stop], passes=[passing("N", 2)]))
    ).traffic
    assert (entry.track, entry.stops[0].track, entry.passes[0].track) == (2, 1, 2)


def test_lines_of_a_file_with_a_single_line_take_tracks_too():
    one = document(service("up", "A", "B", track=1))
    one["line"] = one["lines"]["main"]
    del one["lines"]
    for station in one["supply"]["converter_stations"]:
        del station["line"]
    assert scenario_of(one).traffic[0].track == 1
    one["traffic"][0]["track"] = 3
    with pytest.raises(tpss.ScenarioError, match="from A to B the line has 2 tracks at most"):
        scenario_of(one)


@pytest.mark.parametrize("track", [0, -1, 9])
def test_a_number_that_no_track_has_is_a_fault(track):
    ((key, value, _, _),) = faults_of(service("up", "A", "B", track=track))
    assert (key, value) == ("traffic.0.track", str(track))


@pytest.mark.parametrize("track", [1.0, "1", True])
def test_a_track_is_a_whole_number(track):
    assert faults_of(service("up", "A", "B", track=track))[0][0] == "traffic.0.track"


def test_more_tracks_than_the_line_has_are_a_fault():
    ((key, value, problem, remedy),) = faults_of(
        service("up", "A", "B", track=1, passes=[passing("M", 3)])
    )
    assert (key, value) == ("traffic.0.passes.0.track", "3")
    assert problem == "from M to B main has 2 tracks at most"
    assert remedy == "give a track that is there, or leave it out"


COUNTS = [
    {"from_km": 0.0, "count": 2},
    {"from_km": 20.0, "count": 1},
    {"from_km": 40.0, "count": 2},
]
"""A single track from M to N."""


def test_what_counts_is_the_way_on_which_a_track_would_hold():
    """Given at A, track 2 is there before M; given at M until N, it is nowhere."""
    scenario_of(document(service("up", "A", "B", track=2), tracks=COUNTS))
    calls = [passing("M", 2), passing("N", 1)]
    ((key, _, problem, _),) = faults_of(service("up", "A", "B", passes=calls), tracks=COUNTS)
    assert (key, problem) == ("traffic.0.passes.0.track", "from M to N main has a single track")


def test_a_track_of_a_line_that_is_single_all_the_way_is_a_fault():
    """The first track of a single one before a double one is told in vain, but rightly."""
    scenario_of(document(service("up", "A", "B", passes=[passing("M", 1), passing("N", 1)]),
                         tracks=COUNTS))  # fmt: skip
    ((key, value, problem, remedy),) = faults_of(
        service("up", "A", "C", track=1, passes=[passing("N", 1)])
    )
    assert (key, value) == ("traffic.0.passes.0.track", "1")
    assert problem == "from N to C branch has a single track"
    assert remedy == "leave it out: trains take the track of their direction then"


def test_a_stop_and_a_pass_at_one_station_give_one_track():
    stops = [{"station": "M", "dwell_min": 1.0, "track": 1}]
    ((key, value, problem, remedy),) = faults_of(
        service("up", "A", "B", stops=stops, passes=[passing("M", 2)])
    )
    assert (key, value) == ("traffic.0.passes.0.track", "2")
    assert problem == "stops.0 gives another track at the same station, 1"
    assert remedy == "leave one of them out"


def test_the_same_fault_of_many_services_is_told_once():
    trains = [service(f"train {i}", "A", "B", track=3) for i in range(5)]
    ((key, _, problem, _),) = faults_of(*trains)
    assert key == "traffic.0.track"
    assert problem.endswith("; and 4 more like it")


def test_where_the_way_is_at_fault_nothing_is_said_of_its_tracks():
    stops = [{"station": "N", "dwell_min": 0.0}, {"station": "M", "dwell_min": 0.0}]
    keys = [key for key, *_ in faults_of(service("up", "A", "B", track=3, stops=stops))]
    assert keys == ["traffic.0.stops.0.turn_min", "traffic.0.stops.1.turn_min"]
