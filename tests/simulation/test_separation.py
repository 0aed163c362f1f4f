"""Trains that follow each other: how near they come, how they wait, and what is left alone."""

import math
from typing import Any

import numpy as np
import pytest

import tpss
from lines import TRAIN, line, network, run, scenario_of, service

MARGIN_M, REACTION_S = 50.0, 5.0
LENGTH_M = 300.0
"""Of the slow train, which runs ahead."""


def behind_a_slow_train(separation: str, step_min: float = 0.1, **more: Any) -> dict[str, Any]:
    """Two trains of 100 km/h that follow one of 60 km/h over 40 km, fed from both ends."""
    traffic = [
        service("slow", "A", "B", train="slow"),
        service("fast", "A", "B", departures_min=[4.0, 8.0]),
    ]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, traffic)
    document["simulation"]["time_step_min"] = step_min
    document["trains"] = {
        "freight": {**TRAIN, "length_m": 400.0},
        "slow": {**TRAIN, "max_speed_kmh": 60.0, "length_m": LENGTH_M},
    }
    end = {"name": "end", "line": "main", "position_km": 40.0, "type": "Q48/Q49", "converters": 2}
    document["supply"]["converter_stations"].append(end)
    document["signalling"] = {"separation": separation, **more}
    return document


def gaps_m(result: tpss.Result) -> Any:
    """Distances from the head of a train to that of the one before it, where both are there."""
    place_m = result.dataset.position.to_numpy()
    return place_m[:, :-1] - place_m[:, 1:]


@pytest.mark.parametrize("step_min", [0.02, 0.1, 0.5])
def test_a_train_never_comes_nearer_than_the_margin_behind_the_rear(step_min):
    result = run(behind_a_slow_train("moving-block", step_min))
    gap = gaps_m(result)
    assert np.nanmin(gap[:, 0]) >= LENGTH_M + MARGIN_M - 1e-3
    assert np.nanmin(gap[:, 1]) >= 400.0 + MARGIN_M - 1e-3
    assert result.summary["limited"]["too_near"] == 0


def test_a_train_that_follows_keeps_its_braking_distance_and_reaction():
    """At 60 km/h = 16.67 m/s and b = 0.5 m/s², with steps of 6 s: 300 + 50 + 16.67 · 6 + 16.67² / 2b.

    It is the step that it reacts after, as that is longer than 5 s.
    """
    document = behind_a_slow_train("moving-block")
    for train in document["trains"].values():
        train["max_retardation_m_s2"] = 0.5
    result = run(document)
    speed = 60.0 / 3.6
    kept_m = LENGTH_M + MARGIN_M + speed * 6.0 + speed**2 / (2.0 * 0.5)
    following = gaps_m(result)[180:240, 0]
    np.testing.assert_allclose(following, kept_m, rtol=1e-3)
    speeds = result.dataset.speed.to_numpy()[180:240, 1]
    np.testing.assert_allclose(speeds, speed, rtol=1e-3)


def test_fixed_blocks_keep_a_train_out_of_the_block_in_which_the_rear_is():
    """Blocks of 2 km from kilometre 0: the follower ends each step before that of the rear ahead."""
    result = run(behind_a_slow_train("fixed-block", block_m=2000.0))
    place_m = result.dataset.position.to_numpy()
    block = np.floor((place_m[:, 0] - LENGTH_M) / 2000.0)
    followed = np.isfinite(place_m[:, :2]).all(axis=1) & (place_m[:, 1] > 2000.0)
    assert (place_m[followed, 1] <= 2000.0 * block[followed] - MARGIN_M + 1e-3).all()
    assert result.summary["limited"]["too_near"] == 0


def test_trains_that_follow_freely_are_not_touched():
    """Alike trains 10 min apart never come near each other: the same to the last bit."""
    traffic = [service("up", "A", "B", departures_min=[0.0, 10.0])]
    apart = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, traffic)
    free = run(apart)
    kept = run({**apart, "signalling": {"separation": "moving-block"}})
    for name in ("route_position", "pantograph_voltage", "active_power"):
        np.testing.assert_array_equal(kept.dataset[name], free.dataset[name])
    assert len(kept.waits) == 0


def test_a_train_waits_behind_one_that_dwells_and_that_is_told():
    """The first stands 10 min at M; the second, 4 min later, waits for it, at the margin behind it.

    M lies at km 20, the first train is 400 m long: the second stands at 20 - 0.4 - 0.05 km.
    """
    stops = [{"station": "M", "dwell_min": 10.0}]
    traffic = [
        service("first", "A", "B", stops=stops),
        service("second", "A", "B", departures_min=[4.0]),
    ]
    document = network({"main": line(40.0, {"A": 0.0, "M": 20.0, "B": 40.0})}, traffic)
    document["trains"]["freight"]["length_m"] = 400.0
    document["signalling"] = {"separation": "moving-block"}
    result = run(document)
    (wait,) = result.waits.itertuples()
    assert (wait.train, wait.waited_for) == ("second 1", "first 1")
    assert wait.position_km == pytest.approx(19.55, abs=0.01)
    leaves_min = result.stops.departure_min[result.stops.station == "M"].iloc[0]
    assert wait.to_min == pytest.approx(leaves_min, abs=1.0)
    assert wait.waited_min == pytest.approx(wait.to_min - wait.from_min)


def test_a_train_waits_at_its_origin_until_the_one_ahead_has_left():
    traffic = [service("up", "A", "B", departures_min=[0.0, 0.1])]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, traffic)
    document["trains"]["freight"]["length_m"] = 400.0
    document["signalling"] = {"separation": "moving-block"}
    result = run(document)
    assert np.nanmin(gaps_m(result)[20:]) >= 450.0 - 1e-3
    assert result.waits.waited_for.tolist() == ["up 1"]


def test_trains_are_kept_apart_beyond_the_station_where_lines_meet():
    """One train is on the branch already when the other comes from the main line."""
    lines = {
        "main": line(20.0, {"A": 0.0, "F": 20.0}),
        "branch": line(20.0, {"F": 0.0, "C": 20.0}),
    }
    traffic = [
        service("slow", "A", "C", train="slow"),
        service("fast", "A", "C", departures_min=[2.0]),
    ]
    document = network(lines, traffic)
    document["trains"]["slow"] = {**TRAIN, "max_speed_kmh": 50.0, "length_m": LENGTH_M}
    document["signalling"] = {"separation": "moving-block"}
    result = run(document)
    along_m = result.dataset.route_position.to_numpy()
    gap = along_m[:, 0] - along_m[:, 1]
    assert np.nanmin(gap) >= LENGTH_M + MARGIN_M - 1e-3
    assert result.summary["limited"]["too_near"] == 0


def test_trains_down_the_line_are_kept_apart_too():
    document = behind_a_slow_train("moving-block")
    for entry in document["traffic"]:
        entry["from"], entry["to"] = entry["to"], entry["from"]
    result = run(document)
    assert np.nanmax(gaps_m(result)[:, 0]) <= -(LENGTH_M + MARGIN_M) + 1e-3


def test_trains_of_the_other_direction_or_track_do_not_matter():
    both = [service("up", "A", "B"), service("down", "B", "A")]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, both)
    free = run(document)
    kept = run({**document, "signalling": {"separation": "moving-block"}})
    np.testing.assert_array_equal(kept.dataset.speed, free.dataset.speed)


def test_stepped_motion_knows_no_separation():
    document = behind_a_slow_train("moving-block")
    document["simulation"]["motion"] = "stepped"
    with pytest.raises(tpss.ScenarioError, match=r"signalling\.separation"):
        scenario_of(document)


def test_blocks_have_a_length_and_only_they_do():
    for given in ({"separation": "fixed-block"}, {"separation": "moving-block", "block_m": 500.0}):
        document = behind_a_slow_train("moving-block")
        document["signalling"] = given
        with pytest.raises(tpss.ScenarioError, match="block_m belongs to"):
            scenario_of(document)


def test_a_train_placed_too_near_brakes_as_hard_as_it_may_and_is_counted():
    """200 m behind the rear of a standing train at 80 km/h it cannot stop in time."""
    stands = [
        {"line": "main", "position_km": 10.0, "speed_kmh": 0.0},
        {"line": "main", "position_km": 9.8, "speed_kmh": 80.0},
    ]
    traffic = [service("up", "A", "B", initial_trains=stands, departures_min=[80.0])]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, traffic)
    document["signalling"] = {"separation": "moving-block"}
    result = run(document)
    assert result.summary["limited"]["too_near"] > 0
    assert math.isfinite(result.summary["total_energy_mwh"])
