"""Trains that meet on a single track, or come together: who waits, where, for whom.

Trains of 100 km/h on a flat line need 12 min for 20 km, and some seconds to accelerate.
"""

from typing import Any

import numpy as np
import pytest

import tpss
from lines import STAR, TRAIN, line, network, run, scenario_of, service
from tpss.results.passing import passings

BOTH_WAYS = [service("up", "A", "B"), service("down", "B", "A")]


def single(
    traffic: list[dict[str, Any]], rule: str = "timetable-order", **more: Any
) -> dict[str, Any]:
    """Trains on 60 km of single track, with two crossing places 20 and 40 km from its beginning."""
    track = line(60.0, {"A": 0.0, "M": 20.0, "N": 40.0, "B": 60.0})
    for station in track["stations"]:
        station["tracks"] = 2
    document = network({"main": track}, traffic)
    end = {"name": "end", "line": "main", "position_km": 60.0, "type": "Q48/Q49", "converters": 3}
    document["supply"]["converter_stations"].append(end)
    document["simulation"]["duration_min"] = 150.0
    document["signalling"] = {"separation": "moving-block", "single_track": rule}
    return {**document, **more}


def waits_of(result: tpss.Result) -> list[tuple[str, float, str]]:
    return [(w.train, round(w.position_km, 2), w.waited_for) for w in result.waits.itertuples()]


def test_trains_that_meet_between_stations_pass_at_one_of_them():
    """Both start at minute 0, would meet in the middle, and come to M and N at the same time.

    Of two that are due at once the first one goes first: the other waits at N until that is there.
    """
    result = run(single(BOTH_WAYS))
    assert waits_of(result) == [("down 1", 40.0, "up 1")]
    up_at_n = (
        float(np.interp(40e3, result.dataset.position[:250, 0], result.dataset.time[:250])) / 60
    )
    assert result.waits.to_min[0] == pytest.approx(up_at_n, abs=0.2)
    assert passings(result) == []
    assert result.summary["limited"]["too_near"] == 0


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_trains_whose_timetable_lets_them_cross_do_not_wait(rule):
    """Of 20 km each: one starts down as the other is due at M, and both are there at the same time."""
    traffic = [
        service("up", "A", "B", stops=[{"station": "M", "dwell_min": 4.0}]),
        service("down", "N", "A", departures_min=[1.0]),
    ]
    result = run(single(traffic, rule))
    assert waits_of(result) == []
    assert passings(result) == []
    free = run(single(traffic, "free"))
    for name in ("route_position", "pantograph_voltage"):
        np.testing.assert_array_equal(result.dataset[name], free.dataset[name])


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_a_train_comes_to_its_stop_at_a_crossing_place_however_near_that_is(rule):
    """Ten metres from its origin, at 1 m/s² at most, it is after 2 √(10 m / 1 m/s²) = 6.3 s and more;
    after its dwell of 4 min it asks for the track beyond, and goes on."""
    document = single([service("up", "A", "M", stops=[{"station": "L", "dwell_min": 4.0}])], rule)
    near = {"name": "L", "position_km": 0.01, "tracks": 2}
    document["lines"]["main"]["stations"].insert(1, near)
    result = run(document)
    assert waits_of(result) == []
    arrived_min, left_min = (
        float(result.dataset[f"call_{what}_time"][0, 0]) / 60.0 for what in ("arrival", "departure")
    )
    assert 0.1 < arrived_min < 1.0
    assert left_min - arrived_min == pytest.approx(4.0)
    assert result.trips.arrival_min.notna().all()


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_a_dense_traffic_both_ways_comes_through(rule):
    """Three trains each way, two of them close behind each other: all arrive, none passes through."""
    traffic = [
        service("up", "A", "B", departures_min=[0.0, 5.0, 30.0]),
        service("down", "B", "A", departures_min=[0.0, 7.0, 20.0]),
    ]
    result = run(single(traffic, rule))
    assert result.trips.arrival_min.notna().all()
    assert passings(result) == []
    assert not opposed(result).any()


def opposed(result: tpss.Result) -> np.ndarray:
    """Whether trains of both directions are between the same neighbouring stations, by instant."""
    place_km = result.dataset.position.to_numpy() / 1e3
    up = result.dataset.service.to_numpy() == "up"
    found = np.zeros(len(place_km), dtype=bool)
    for begin_km in (0.0, 20.0, 40.0):
        within = (place_km > begin_km + 0.001) & (place_km < begin_km + 19.999)
        found |= within[:, up].any(axis=1) & within[:, ~up].any(axis=1)
    return found


WEAKENED = {
    "mass_t": 900.0,
    "adhesive_mass_t": 110.0,
    "max_speed_kmh": 120.0,
    "max_retardation_m_s2": 0.6,
    "resistance_a_n": 9000.0,
    "resistance_b_n_s_per_m": 30.0,
    "resistance_c_n_s2_per_m2": 20.0,
    "rotating_mass_share": 0.07,
    "tractive_effort": {
        "max_force_kn": 200.0, "max_power_kw": 3000.0, "zero_voltage_kv": 9.0, "full_voltage_kv": 14.5,
    },
    "power_factor": 0.98,
    "efficiency": 0.85,
    "auxiliary_power_kw": 50.0,
}  # fmt: skip
"""A train that low voltage makes slower."""


@pytest.mark.parametrize(
    ("rule", "waits"),
    [("timetable-order", ("down 1", 40.0, "up 1")), ("first-come", ("up 1", 20.0, "down 1"))],
)
def test_in_timetable_order_a_late_train_keeps_its_turn(rule, waits):
    """At nominal voltage the train up, on 6 per mille, is at M before 14 min, as the other leaves N.

    Fed from the far end only it is there later: in planned order the train down waits for it all the
    same; first come, that goes on, and the train up waits at M.
    """
    traffic = [service("up", "A", "B"), service("down", "N", "A", departures_min=[14.0])]
    weak = single(traffic, rule)
    weak["trains"]["freight"] = WEAKENED
    weak["lines"]["main"]["gradients"] = [
        {"from_km": 0.0, "permille": 6.0}, {"from_km": 30.0, "permille": 0.0},
    ]  # fmt: skip
    weak["supply"]["catenary"] = {"r_ohm_per_km": 0.3, "x_ohm_per_km": 0.3}
    weak["supply"]["converter_stations"] = weak["supply"]["converter_stations"][1:]
    assert waits_of(run(weak)) == [waits]


def test_a_train_waits_where_a_double_track_ends_until_the_other_is_out_as_a_whole():
    """The first 20 km have two tracks.  400 m long, the train down is out 14.4 s after its head."""
    track = line(40.0, {"A": 0.0, "B": 40.0}, tracks=[
        {"from_km": 0.0, "count": 2}, {"from_km": 20.0, "count": 1},
    ])  # fmt: skip
    traffic = [service("down", "B", "A"), service("up", "A", "B")]
    document = single(traffic)
    document["lines"] = {"main": track}
    document["supply"]["tracks_tied"] = "everywhere"
    document["supply"]["converter_stations"][1]["position_km"] = 40.0
    document["trains"]["freight"] = {**TRAIN, "length_m": 400.0}
    result = run(document)
    down_km, up_km = result.dataset.position.to_numpy().T / 1e3
    with np.errstate(invalid="ignore"):  # before and after they are there
        first_in = int(np.argmax(up_km > 20.001))
    assert down_km[first_in] + 0.4 < 20.0 < down_km[first_in - 2] + 0.4
    assert result.summary["limited"]["too_near"] == 0


def test_a_train_that_turns_round_on_a_single_track_keeps_others_out():
    stops = [{"station": "B", "dwell_min": 0.0, "turn_min": 10.0}]
    traffic = [
        service("up", "A", "A", stops=stops),
        service("down", "N", "B", departures_min=[8.0]),
    ]
    track = line(60.0, {"A": 0.0, "N": 40.0, "B": 60.0})
    track["stations"][0]["tracks"] = track["stations"][1]["tracks"] = 2
    document = single(traffic)
    document["lines"] = {"main": track}
    result = run(document)
    assert result.trips.arrival_min.notna().all()
    assert passings(result) == []


def test_where_lines_come_together_trains_go_one_after_the_other():
    """From 40 km of the main line and 30 km of the branch, trains come to Fork at once.

    Without the rule they see each other too late; with it, the one that is not first waits at Fork.
    """
    lines = {name: {**each, "tracks": 2} for name, each in STAR.items()}
    traffic = [
        service("main", "West", "East"),
        service("branch", "Mine", "East", departures_min=[6.0]),
    ]
    document = network(lines, traffic)
    document["supply"]["tracks_tied"] = "everywhere"
    document["trains"]["freight"] = {**TRAIN, "length_m": 400.0}
    counts, waits = [], []
    for rule in ("free", "timetable-order", "first-come"):
        document["signalling"] = {"separation": "moving-block", "single_track": rule}
        result = run(document)
        counts.append(result.summary["limited"]["too_near"])
        waits.append(waits_of(result))
    assert counts[0] > 0
    assert counts[1:] == [0, 0]
    ((who, _, whom),) = waits[1]
    assert {who, whom} == {"main 1", "branch 1"}


def test_a_train_longer_than_where_it_may_have_to_wait_is_a_fault():
    document = single(BOTH_WAYS)
    document["lines"]["main"]["stations"][1]["track_length_m"] = 350.0
    document["trains"]["freight"] = {**TRAIN, "length_m": 400.0}
    with pytest.raises(tpss.ScenarioError, match=r"longer than the tracks of M, 350 m") as caught:
        run(document)
    assert "tracks = 1" in str(caught.value)


def placed(*places: tuple[str, float]) -> list[dict[str, Any]]:
    """Services up and down, with trains of 30 km/h on the line at the start."""
    ways = {"up": ("A", "B"), "down": ("B", "A")}
    trains: dict[str, list[dict[str, Any]]] = {name: [] for name in ways}
    for name, km in places:
        trains[name].append({"line": "main", "position_km": km, "speed_kmh": 30.0})
    return [
        service(name, *ends, departures_min=[140.0], initial_trains=trains[name])
        for name, ends in ways.items()
    ]


def test_trains_placed_head_to_head_are_a_fault():
    with pytest.raises(
        tpss.ScenarioError, match=r"up initial 1 and down initial 1 are in each other"
    ):
        run(single(placed(("up", 5.0), ("down", 15.0))))


STUCK = placed(("up", 19.8), ("up", 17.0), ("down", 40.2), ("down", 43.0))
"""Two trains before each of two crossing places of two tracks, heading for the other one."""


def test_a_deadlock_by_construction_is_a_fault():
    with pytest.raises(tpss.ScenarioError, match=r"not all trains come through") as caught:
        run(single(STUCK))
    assert "more tracks" in str(caught.value)


def test_a_deadlock_ends_the_run_at_once_and_tells_who_waits_for_whom():
    """Those in front come to M and N within a minute, and stand for ever: all tracks there are taken."""
    result = run(single(STUCK, "first-come"))
    assert result.status == "deadlocked"
    assert result.dataset.time[-1] < 300.0
    problem = result.summary["problem"]
    assert "up initial 1 at 20.00 km for down initial" in problem
    assert "at 40.00 km for up initial" in problem


def test_an_order_needs_an_end_of_the_run_and_trains_that_see_each_other():
    document = single(BOTH_WAYS)
    del document["simulation"]["duration_min"]
    with pytest.raises(tpss.ScenarioError, match=r"simulation\.duration_min"):
        scenario_of(document)
    document = single(BOTH_WAYS)
    document["signalling"]["separation"] = "none"
    with pytest.raises(tpss.ScenarioError, match="moving-block"):
        scenario_of(document)


def at_a_fork(rule: str) -> dict[str, Any]:
    """10 km of two tracks to a fork without a second track, from where two single tracks lead on."""
    lines = {
        "double": line(10.0, {"A": 0.0, "Fork": 10.0}, tracks=2),
        "left": line(15.0, {"Fork": 0.0, "L": 15.0}),
        "right": line(15.0, {"Fork": 0.0, "R": 15.0}),
    }
    traffic = [
        service("first", "A", "L"),
        service("second", "A", "R", departures_min=[2.0]),
        service("third", "L", "R"),
    ]
    document = network(lines, traffic)
    document["supply"]["tracks_tied"] = "everywhere"
    document["trains"]["freight"] = {**TRAIN, "length_m": 400.0}
    document["signalling"] = {"separation": "moving-block", "single_track": rule}
    return document


@pytest.mark.parametrize("rule", ["timetable-order", "first-come"])
def test_three_trains_at_a_fork_do_not_block_each_other(rule):
    """The first one, at the fork after 7 min, waits for the third, which comes from the left after 10.

    The second one is due on the right a minute before the third, but stands behind the first: it would
    wait for that, that for the third, and the third, in planned order, for the second.
    """
    result = run(at_a_fork(rule))
    assert waits_of(result) == [("first 1", 0.0, "third 1"), ("second 1", 9.55, "first 1")]
    assert result.trips.arrival_min.notna().all()
    first, second, third = result.trips.arrival_min
    assert second < first < third  # of 15 km each, left at 7, 10 and 10.6 min


def test_a_train_reaches_its_stop_at_a_gate_that_lies_before_it_by_rounding():
    """On the third line C is at -24 km and an offset, on the second at its beginning: 2e-12 m apart.

    A train that came to rest at the gate for its stop never reached that, and stood there for ever.
    """
    lines = {
        "one": line(18.51, {"B": 0.0, "A": 18.51}),
        "two": line(16.01, {"C": 0.0, "B": 16.01}, tracks=[
            {"from_km": 0.0, "count": 1}, {"from_km": 6.4, "count": 2}
        ]),
        "three": line(24.0, {"D": 0.0, "C": 24.0}),
    }  # fmt: skip
    for each in lines.values():
        for station in each["stations"]:
            station["tracks"] = 2
    down = service("down", "A", "D", stops=[{"station": "C", "dwell_min": 1.0}])
    document = network(lines, [down, service("up", "D", "A", departures_min=[6.0])])
    document["supply"]["tracks_tied"] = "no"
    document["signalling"] = {"separation": "moving-block", "single_track": "timetable-order"}
    result = run(document)
    assert result.trips.arrival_min.notna().all()
