"""Trains on tracks that their services give: what they see there, whom they meet, whom they overtake.

Trains of 100 km/h on a flat line need 12 min for 20 km, and some seconds to accelerate.
"""

from typing import Any

import numpy as np
import pytest

import tpss
from lines import TRAIN, double_track, line, network, run, service
from tpss.results.passing import passings

UP, DOWN = service("up", "A", "B"), service("down", "B", "A")


# The contact line above them


@pytest.mark.parametrize("tied", ["no", "everywhere"])
def test_a_train_on_the_other_track_is_one_of_a_line_where_trains_keep_to_the_other_side(tied):
    """Up on track 1, down on track 2, as with left-hand running."""
    given = run(double_track(tied, [{**UP, "track": 1}, {**DOWN, "track": 2}]))
    mirrored = double_track(tied, [UP, DOWN])
    mirrored["lines"]["main"]["left_hand_running"] = True
    for name in ("route_position", "pantograph_voltage", "train_track", "network_losses"):
        np.testing.assert_array_equal(given.dataset[name], run(mirrored).dataset[name])


def test_trains_of_one_direction_on_one_untied_track_share_its_voltage_drop():
    """Together on track 2 they draw through one contact line, apart through one each.

    At 20 km, in the middle of 40, a train alone sees the two halves of 0.2 + j0.15 ohm/km in parallel.
    """
    later = service("later", "A", "B", departures_min=[2.0])
    together = run(double_track("no", [UP, later]))
    apart = run(double_track("no", [UP, {**later, "track": 1}]))
    middle = int(np.argmax(apart.dataset.position.to_numpy()[:, 1] > 20e3))
    drops_v = []
    for result in (together, apart):
        data = result.dataset.isel(time=middle)
        volts, km = data.pantograph_voltage.to_numpy(), data.position.to_numpy() / 1e3
        assert km == pytest.approx([22.0, 20.0], abs=3.0)
        drops_v.append(16.5e3 - volts[1])
    assert drops_v[0] > 1.3 * drops_v[1]
    data = apart.dataset.isel(time=middle)
    volts = (data.pantograph_voltage * np.exp(1j * data.pantograph_angle)).to_numpy()
    ends = (data.node_voltage * np.exp(1j * data.node_angle)).to_numpy()
    power = (data.active_power + 1j * data.reactive_power).to_numpy()
    km = float(data.position[1]) / 1e3
    share = (ends[0] * (40.0 - km) + ends[1] * km) / 40.0
    z = (0.2 + 0.15j) * km * (40.0 - km) / 40.0
    assert volts[1] == pytest.approx(share - z * np.conj(power[1] / volts[1]), abs=1e-3)


def test_results_tell_the_track():
    steps = run(double_track("no", [{**UP, "track": 1}])).train_steps
    assert set(steps.track) == {1}


# Trains of one direction


def two_fast_and_slow(**fast: Any) -> dict[str, Any]:
    """A train of 60 km/h, and five minutes behind it one of 100 km/h."""
    slow = {**service("slow", "A", "B"), "train": "slow"}
    document = double_track(
        "everywhere", [slow, service("fast", "A", "B", departures_min=[5.0], **fast)]
    )
    document["trains"]["slow"] = {**TRAIN, "max_speed_kmh": 60.0}
    document["signalling"] = {"separation": "moving-block", "single_track": "timetable-order"}
    return document


def test_a_train_on_a_track_of_its_own_overtakes_one_that_is_slower():
    """40 km take 24 min at 100 km/h, and 40 min at 60 km/h: on one track it comes behind it."""
    document = two_fast_and_slow(track=1)
    overtakes = run(document)
    assert passings(overtakes) == []
    assert overtakes.waits.empty
    slow, fast = overtakes.trips.arrival_min
    assert fast < 31.0 < slow
    alone = {**document, "traffic": document["traffic"][1:]}
    np.testing.assert_allclose(fast, run(alone).trips.arrival_min[0], atol=0.05)
    slow, fast = run(two_fast_and_slow()).trips.arrival_min
    assert fast > slow


# Trains of both directions on one track


def wrong_track(rule: str, given: dict[str, Any], **tracks: int) -> dict[str, Any]:
    """Trains both ways on 60 km of two tracks, those up on the track of those down for some way."""
    main = line(60.0, {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0}, tracks=2)
    for station in main["stations"]:
        station["tracks"] = tracks.get(station["name"], 1)
    traffic = [
        service("up", "A", "B", departures_min=[0.0, 5.0, 30.0], **given),
        service("down", "B", "A", departures_min=[0.0, 7.0, 20.0]),
    ]
    document = network({"main": main}, traffic)
    end = {"name": "end", "line": "main", "position_km": 60.0, "type": "Q48/Q49", "converters": 3}
    document["supply"]["converter_stations"].append(end)
    document["supply"]["tracks_tied"] = "everywhere"
    document["simulation"]["duration_min"] = 200.0
    document["trains"]["freight"] = {**TRAIN, "length_m": 400.0}
    document["signalling"] = {"separation": "moving-block", "single_track": rule}
    return document


FROM_M_TO_N = {"passes": [{"station": "M", "track": 1}, {"station": "N", "track": 2}]}
"""Between M and N all trains run on track 1, as if the other one were closed."""


def on_track_1_between(result: tpss.Result, begin_km: float, end_km: float) -> np.ndarray:
    """Whether trains of both directions are on track 1 between two places, by instant."""
    km = result.dataset.position.to_numpy() / 1e3
    there = (km > begin_km + 0.001) & (km < end_km - 0.001)
    there &= result.dataset.train_track.to_numpy() == 1
    up = result.dataset.service.to_numpy() == "up"
    return there[:, up].any(axis=1) & there[:, ~up].any(axis=1)


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_a_track_that_both_directions_use_is_kept_as_a_single_one(rule):
    result = run(wrong_track(rule, FROM_M_TO_N))
    assert result.trips.arrival_min.notna().all()
    assert passings(result) == []
    assert not on_track_1_between(result, 20.0, 40.0).any()
    assert {round(km) for km in result.waits.position_km} <= {20, 40}
    assert not result.waits.empty


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_trains_on_one_track_all_along_cross_at_a_station_of_several_tracks(rule):
    result = run(wrong_track(rule, {"track": 1}, A=2, M=3, B=2))
    assert result.trips.arrival_min.notna().all()
    assert passings(result) == []
    for stretch_km in ((0.0, 20.0), (20.0, 60.0)):
        assert not on_track_1_between(result, *stretch_km).any()


@pytest.mark.parametrize("signalling", [{"separation": "none"}, {"separation": "moving-block"}])
def test_without_a_rule_trains_that_meet_on_one_of_several_tracks_are_counted(signalling):
    """Of three trains each way, all meet that are on track 1 between M and N at once."""
    document = wrong_track("free", FROM_M_TO_N)
    document["signalling"] = signalling
    met = passings(run(document))
    assert met
    assert all(20.0 < each.place_km < 40.0 for each in met)
    assert {(each.one.split()[0], each.other.split()[0]) for each in met} == {("up", "down")}


def test_from_a_single_track_onto_the_track_of_the_other_direction_trains_wait_for_both():
    """The first 20 km are single; trains up go on on track 1, on which the others come to them.

    Up, each waits at its origin until it can go all the way: at 20 km it would be in others' way.
    """
    for rule in ("timetable-order", "first-come"):
        document = wrong_track(rule, {"track": 1}, A=2, N=2, B=2)
        counts = [{"from_km": 0.0, "count": 1}, {"from_km": 20.0, "count": 2}]
        document["lines"]["main"]["tracks"] = counts
        result = run(document)
        assert result.trips.arrival_min.notna().all()
        assert passings(result) == []
