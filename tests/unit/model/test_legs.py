"""On which track of its lines a route runs: that of its direction, or one that its service gives."""

from typing import Any

import numpy as np
import pytest

from lines import line, network, scenario_of, service
from tpss.model.build import build_model

STATIONS = {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0}

LOOP = [{"from_km": 0.0, "count": 2}, {"from_km": 10.0, "count": 1}, {"from_km": 30.0, "count": 2}]
"""Two tracks, but for a single one from 10 to 30 km."""


def legs_of(
    *traffic: dict[str, Any], tracks: Any = 2, **more: Any
) -> list[list[tuple[float, int]]]:
    """Where each service comes to a track, in kilometres along its route, and which one it is.

    A leg on the same track below other sections of the contact line is left out.
    """
    lines = {
        "main": line(60.0, STATIONS, tracks=tracks, **more),
        "branch": line(30.0, {"N": 0.0, "C": 30.0}, tracks=2),
    }
    document = network(lines, list(traffic))
    document["supply"]["tracks_tied"] = "no"
    rows = np.asarray(build_model(scenario_of(document))[0].legs)
    return [
        [
            (leg["from_m"] / 1e3, int(leg["track"]))
            for before, leg in zip([None, *row], row, strict=False)
            if leg["from_m"] < np.inf
            and (
                before is None or any(leg[key] != before[key] for key in ("line", "sign", "track"))
            )
        ]
        for row in rows
    ]


def at(station: str, track: int | None = None, **more: Any) -> dict[str, Any]:
    """A stop, perhaps with a track."""
    given = {} if track is None else {"track": track}
    return {"station": station, "dwell_min": 0.0, **given, **more}


def passing(station: str, track: int) -> dict[str, Any]:
    return {"station": station, "track": track}


START = -np.inf


def test_without_a_track_trains_take_that_of_their_direction():
    assert legs_of(service("up", "A", "B"), service("down", "B", "A")) == [
        [(START, 2)], [(START, 1)],
    ]  # fmt: skip


def test_a_track_that_is_given_at_the_origin_holds_for_the_whole_way():
    assert legs_of(service("up", "A", "B", track=1), service("down", "B", "A", track=2)) == [
        [(START, 1)], [(START, 2)],
    ]  # fmt: skip


def test_a_track_holds_until_a_stop_or_a_pass_gives_another_one():
    """Up it changes at 20 and 40 km, down at 60 - 40 and 60 - 20 km after its start at -60."""
    up = service("up", "A", "B", stops=[at("M", 1)], passes=[passing("N", 2)])
    down = service("down", "B", "A", stops=[at("M", 1)], passes=[passing("N", 2)])
    assert legs_of(up, down) == [
        [(START, 2), (20.0, 1), (40.0, 2)],
        [(START, 1), (-40.0, 2), (-20.0, 1)],
    ]


def test_where_there_is_no_such_track_trains_take_that_of_their_direction_and_return():
    """From 10 to 30 km there is one track only; up they are on track 1 all along, down on 2, 1, 2."""
    up, down = service("up", "A", "B", track=1), service("down", "B", "A", track=2)
    assert legs_of(up, down, tracks=LOOP) == [
        [(START, 1)], [(START, 2), (-30.0, 1), (-10.0, 2)],
    ]  # fmt: skip


@pytest.mark.parametrize(("left", "up"), [(False, [3, 2, 3]), (True, [1, 2, 1])])
def test_the_middle_of_three_tracks_on_a_part_of_the_way(left, up):
    stops = [at("M", 2), at("N", up[2])]
    (legs,) = legs_of(service("up", "A", "B", stops=stops), tracks=3, left_hand_running=left)
    assert legs == [(START, up[0]), (20.0, 2), (40.0, up[2])]


def test_a_train_that_turns_round_stays_on_its_track_unless_another_one_is_given():
    """There from 0 to 40 km, and back from there: 80 km of way."""
    stays = service("stays", "A", "A", track=1, stops=[at("N", turn_min=5.0)])
    changes = service("changes", "A", "A", track=1, stops=[at("N", 2, turn_min=5.0)])
    usual = service("usual", "A", "A", stops=[at("N", turn_min=5.0)])
    tracks = [[track for _, track in legs] for legs in legs_of(stays, changes, usual)]
    assert tracks == [[1, 1], [1, 2], [2, 1]]


def test_on_another_line_trains_take_the_track_of_their_direction_unless_one_is_given_there():
    """Both change from main, on track 1, to branch at N."""
    usual = service("usual", "A", "C", track=1)
    given = service("given", "A", "C", track=1, passes=[passing("N", 1)])
    assert legs_of(usual, given) == [[(START, 1), (40.0, 2)], [(START, 1), (40.0, 1)]]


def test_services_that_differ_in_their_tracks_only_have_legs_of_their_own():
    assert legs_of(service("one", "A", "B", track=1), service("other", "A", "B", track=2)) == [
        [(START, 1)], [(START, 2)],
    ]  # fmt: skip
