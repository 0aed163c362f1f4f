"""Several lines that meet: routes over them, and a line that is cut, turned or renamed."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import TRAIN, line, network, run, scenario_of, service

SAME = 1e-9
"""A line that is cut has one more node: voltages are found to a tolerance, not by the same way."""

STAR = {
    "main": line(60.0, {"West": 0.0, "Fork": 40.0, "East": 60.0}),
    "branch": line(30.0, {"Fork": 100.0, "Mine": 130.0}, begins_at_km=100.0),
}


def assert_same(found: tpss.Result, expected: tpss.Result, same: float = SAME) -> None:
    """Assert that trains do the same, at the same times and voltages."""
    assert found.status == expected.status
    for name in ("route_position", "speed", "pantograph_voltage", "active_power", "braking_force"):
        one, other = (each.dataset[name].to_numpy() for each in (found, expected))
        largest = np.nanmax(np.abs(other))
        np.testing.assert_allclose(one, other, rtol=0.0, atol=same * largest, err_msg=name)
    for name, energy in expected.summary["station_energy_mwh"].items():
        assert found.summary["station_energy_mwh"][name] == pytest.approx(energy, rel=same)


# Routes


def test_a_route_leads_over_the_station_where_lines_meet():
    """From West 40 km to Fork, and from km 100 of the branch on to its km 130: 70 km in all."""
    result = run(network(STAR, [service("up", "West", "Mine")]))
    (trip,) = result.trips.itertuples()
    assert trip.distance_km == pytest.approx(70.0, abs=1e-6)
    steps = result.train_steps
    assert list(dict.fromkeys(steps.line)) == ["main", "branch"]
    assert steps.position_km[steps.line == "main"].max() < 40.0 + 1e-6
    on_branch = steps.position_km[steps.line == "branch"]
    assert (on_branch.min(), on_branch.max()) == (pytest.approx(100.0, abs=3.0), 130.0)


def test_kilometres_may_fall_on_the_second_line():
    """From East down to Fork, and up the branch: 20 and 30 km."""
    result = run(network(STAR, [service("down", "East", "Mine")]))
    assert result.trips.distance_km[0] == pytest.approx(50.0, abs=1e-6)
    main = result.train_steps[result.train_steps.line == "main"]
    assert (np.diff(main.position_km) <= 0.0).all()


def test_a_train_turns_round_where_it_has_time_for_it():
    """To East and back to Fork, with 6 min at East: 20 km each way."""
    stops = [{"station": "East", "dwell_min": 1.0, "turn_min": 6.0}]
    result = run(network(STAR, [service("shuttle", "Fork", "Fork", stops=stops)]))
    assert result.trips.distance_km[0] == pytest.approx(40.0, abs=1e-6)
    begin, east, end = result.stops.itertuples()
    assert (begin.station, east.station, end.station) == ("Fork", "East", "Fork")
    assert east.dwell_min == pytest.approx(6.0)
    there_min = east.arrival_min - begin.departure_min
    # But for the voltage, which is lower the farther it starts from the feeder.
    assert end.arrival_min - east.departure_min == pytest.approx(there_min, rel=0.01)


def test_limits_of_the_next_line_are_met_at_the_border():
    """The branch allows 40 km/h: nobody is faster there, and braking for it begins on the main line."""
    lines = copy.deepcopy(STAR)
    lines["branch"]["speed_limits"][0]["speed_kmh"] = 40.0
    steps = run(network(lines, [service("up", "West", "Mine")])).train_steps
    assert steps.speed_kmh[steps.line == "branch"].max() <= 40.0 + 1e-9
    assert steps.speed_kmh[steps.line == "main"].max() > 90.0
    assert (steps.state[steps.line == "main"] == "braking").any()


def test_the_nearer_of_two_ways_is_taken_unless_via_names_the_other():
    """A ring: from A to C 20 km over B, or 35 km over D."""
    ring = {
        "south": line(20.0, {"A": 0.0, "B": 10.0, "C": 20.0}),
        "north": line(35.0, {"A": 0.0, "D": 15.0, "C": 35.0}),
    }
    traffic = [service("near", "A", "C"), service("far", "A", "C", via=["D"])]
    assert run(network(ring, traffic)).trips.distance_km.tolist() == pytest.approx([20.0, 35.0])


def test_a_train_passes_from_line_to_line_where_its_position_is_nought():
    """Down a line to its kilometre 0, and on along another: 10 and 20 km at the limit."""
    lines = {
        "first": line(10.0, {"B": 0.0, "A": 10.0}),
        "second": line(20.0, {"B": 0.0, "C": 20.0}),
    }
    for step_min in (0.05, 0.1, 0.2, 0.5, 1.0, 2.0):
        document = network(lines, [service("through", "A", "C")])
        document["simulation"]["time_step_min"] = step_min
        (trip,) = run(document).trips.itertuples()
        assert trip.distance_km == pytest.approx(30.0, abs=1e-6)


# The supply


def test_lines_that_meet_are_tied_and_a_branch_is_fed_through():
    """A train at Mine hangs behind 40 km of main line and 30 of branch, as at the end of 70 km."""
    traffic = [service("out", "Mine", "West")]
    alone = {"one": line(70.0, {"West": 0.0, "Mine": 70.0})}
    forked, straight = network(STAR, traffic), network(alone, traffic)
    for document in (forked, straight):
        document["supply"]["catenary"] = {"r_ohm_per_km": 0.0335, "x_ohm_per_km": 0.031}
    assert_same_energies(run(forked), run(straight))


def assert_same_energies(found: tpss.Result, expected: tpss.Result) -> None:
    for one, other in zip(found.trips.itertuples(), expected.trips.itertuples(), strict=True):
        assert one.energy_mwh == pytest.approx(other.energy_mwh, rel=1e-6)
        assert one.trip_min == pytest.approx(other.trip_min, rel=1e-6)
        assert one.lowest_voltage_kv == pytest.approx(other.lowest_voltage_kv, rel=1e-6)
    assert found.summary["losses_mwh"] == pytest.approx(expected.summary["losses_mwh"], rel=1e-6)


def test_the_ring_shares_a_train_s_current_between_both_ways():
    """Two ways of 10 km from feeder to train halve the impedance: the drop is that of 5 km alone.

    The train stands in the middle of a ring of 20 km, and draws what its auxiliaries take.
    """
    stands = [{"line": "south", "position_km": 10.0, "speed_kmh": 0.0}]
    ring = {
        "south": line(10.0, {"A": 0.0, "B": 5.0, "C": 10.0}),
        "north": line(10.0, {"A": 0.0, "C": 10.0}),
    }
    both = run(
        network(
            ring,
            [service("back", "C", "A", via=["B"], initial_trains=stands, departures_min=[89.0])],
        )
    )
    alone = run(network({"one": line(5.0, {"A": 0.0, "C": 5.0})}, [service("back", "C", "A")]))
    drops = [result.dataset.pantograph_voltage.to_numpy()[0, 0] for result in (both, alone)]
    assert drops[0] == pytest.approx(drops[1], rel=1e-3)


# A line that is cut, renamed, reordered, mirrored


def cut(document: dict[str, Any], at_km: float) -> dict[str, Any]:
    """The single line of a document cut in two, which keep its kilometres and share a station."""
    cut_one = copy.deepcopy(document)
    whole = cut_one.pop("line")
    length_km = whole["length_km"]
    meeting = {"name": "Cut", "position_km": at_km}
    low = {**whole, "length_km": at_km}
    high = {**whole, "begins_at_km": at_km, "length_km": length_km - at_km}
    high["speed_limits"] = _from(whole["speed_limits"], at_km)
    low["stations"] = [*(s for s in whole["stations"] if s["position_km"] < at_km), meeting]
    high["stations"] = [meeting, *(s for s in whole["stations"] if s["position_km"] > at_km)]
    cut_one["lines"] = {"low": low, "high": high}
    for kind in ("converter_stations", "transformer_stations"):
        for station in cut_one["supply"].get(kind, []):
            station["line"] = "low" if station["position_km"] <= at_km else "high"
    return cut_one


def _from(limits: list[dict[str, float]], at_km: float) -> list[dict[str, float]]:
    before = [limit for limit in limits if limit["from_km"] <= at_km][-1]
    return [{**before, "from_km": at_km}, *(each for each in limits if each["from_km"] > at_km)]


TWO_WAYS = {
    "format": 1,
    "name": "two-ways",
    "simulation": {"duration_min": 40.0, "time_step_min": 0.1},
    "line": {
        "length_km": 50.0,
        "gradients": [{"from_km": 0.0, "permille": 3.0}, {"from_km": 22.0, "permille": -5.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 120.0}, {"from_km": 30.0, "speed_kmh": 90.0}],
        "stations": [
            {"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 35.0},
            {"name": "C", "position_km": 50.0},
        ],
    },
    "supply": {
        "catenary": "BT",
        "converter_stations": [
            {"name": "W", "position_km": 5.0, "type": "Q48/Q49", "converters": 3},
            {"name": "E", "position_km": 45.0, "type": "Q48/Q49", "converters": 2},
        ],
    },
    "trains": {"freight": {**TRAIN, "length_m": 400.0}},
    "traffic": [
        service("up", "A", "C", stops=[{"station": "B", "dwell_min": 1.0}]),
        service("down", "C", "A"),
    ],
}  # fmt: skip


@pytest.mark.parametrize("motion", ["continuous", "stepped"])
def test_a_line_that_is_cut_in_two_is_the_same_line(motion):
    whole = copy.deepcopy(TWO_WAYS)
    whole["simulation"]["motion"] = motion
    assert_same(run(cut(whole, 20.0)), run(whole), 1e-7)


def test_names_and_order_of_lines_change_nothing():
    """To the last bit: the trains, and the supply as they see it, are the same."""
    traffic = [service("up", "West", "Mine"), service("down", "East", "West")]
    one = run(network(STAR, traffic))
    names = {"main": "M", "branch": "B"}
    renamed = {names[key]: value for key, value in STAR.items()}
    other = network(renamed, traffic)
    assert_same(run(other), one, 0.0)
    turned = network(dict(reversed(renamed.items())), traffic)
    turned["supply"]["converter_stations"][0]["line"] = "M"
    assert_same(run(turned), one, SAME)


def test_a_scenario_of_one_named_line_is_that_of_the_line():
    document = copy.deepcopy(TWO_WAYS)
    document["lines"] = {"main": document.pop("line")}
    assert_same(run(document), run(TWO_WAYS), 0.0)


def test_a_mirrored_line_among_others_gives_the_same():
    """The main line counted from its other end, its gradients turned: trains do the same."""
    traffic = [service("up", "West", "Mine"), service("down", "East", "West")]
    lines = copy.deepcopy(STAR)
    lines["main"]["gradients"] = [
        {"from_km": 0.0, "permille": 4.0},
        {"from_km": 30.0, "permille": -2.0},
    ]
    there = run(network(lines, traffic))
    turned = copy.deepcopy(lines)
    turned["main"] |= {
        "gradients": [{"from_km": 0.0, "permille": 2.0}, {"from_km": 30.0, "permille": -4.0}],
        "stations": [
            {**each, "position_km": 60.0 - each["position_km"]}
            for each in lines["main"]["stations"]
        ],
    }
    back = network(turned, traffic)
    back["supply"]["converter_stations"][0]["position_km"] = 60.0
    found = run(back)
    assert_same_energies(found, there)


def test_of_lines_apart_only_the_one_that_no_station_reaches_is_without_power():
    """Two lines that do not meet, each with its station; that of the second is out from 5 to 10 min."""
    lines = {
        "north": line(60.0, {"A": 0.0, "B": 60.0}),
        "south": line(60.0, {"C": 0.0, "D": 60.0}),
    }
    document = network(lines, [service("n", "A", "B"), service("s", "C", "D")])
    (feeder,) = document["supply"]["converter_stations"]
    document["supply"]["converter_stations"] += [{**feeder, "name": "other", "line": "south"}]
    document["simulation"]["outage"] = "other out"
    document["outages"] = [
        {"name": "other out", "stations": ["other"], "from_min": 5.0, "to_min": 10.0}
    ]
    result = run(document)
    volts = result.dataset.pantograph_voltage.isel(time=slice(50, 100))
    assert (volts.sel(train="s 1") == 0.0).all()
    assert (volts.sel(train="n 1") > 14e3).all()
    calm = run({**document, "simulation": {"duration_min": 90.0, "time_step_min": 0.1}})
    np.testing.assert_allclose(
        result.dataset.speed.sel(train="n 1"), calm.dataset.speed.sel(train="n 1"), rtol=SAME
    )
    assert result.trips.arrival_min[1] > calm.trips.arrival_min[1]


# Faults


def faults_of(document: dict[str, Any]) -> list[tuple[str, str]]:
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario_of(document)
    return [(finding.key, finding.problem) for finding in caught.value.findings]


def test_lines_that_do_not_meet_have_no_route_between_them():
    lines = copy.deepcopy(STAR)
    lines["branch"]["stations"][0]["name"] = "Forc"
    traffic = [service(f"{k}", "West", "Mine") for k in range(3)]
    assert faults_of(network(lines, traffic)) == [
        ("traffic.0.to", "no lines lead from West to Mine; and 2 more like it")
    ]


def test_two_ways_of_one_length_are_both_named():
    ring = {"south": line(20.0, {"A": 0.0, "C": 20.0}), "north": line(20.0, {"A": 0.0, "C": 20.0})}
    ((key, problem),) = faults_of(network(ring, [service("round", "A", "C")]))
    assert key == "traffic.0.to"
    assert "over A on south and over A on north" in problem


@pytest.mark.parametrize(
    ("stop", "key"),
    [
        ({"station": "East", "dwell_min": 1.0}, "traffic.0.stops.0.turn_min"),
        ({"station": "Fork", "dwell_min": 1.0, "turn_min": 5.0}, "traffic.0.stops.0.turn_min"),
    ],
)
def test_a_train_turns_where_it_says_so_and_nowhere_else(stop, key):
    ((found, _),) = faults_of(network(STAR, [service("round", "West", "Mine", stops=[stop])]))
    assert found == key


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"line": "mian"}, "supply.converter_stations.0.line"),
        ({"line": None}, "supply.converter_stations.0.line"),
        ({"line": "branch", "position_km": 5.0}, "supply.converter_stations.0.position_km"),
        ({"line": None, "position_km": None, "at": "Wets"}, "supply.converter_stations.0.at"),
        ({"line": "branch", "position_km": None, "at": "East"}, "supply.converter_stations.0.at"),
        ({"at": "East"}, "supply.converter_stations.0.position_km"),
    ],
)
def test_a_station_that_is_nowhere_or_in_two_places_is_told(change, key):
    document = network(STAR, [service("up", "West", "East")])
    station = document["supply"]["converter_stations"][0] | change
    document["supply"]["converter_stations"] = [
        {name: value for name, value in station.items() if value is not None}
    ]
    assert key in [found for found, _ in faults_of(document)]


def test_a_number_of_tracks_that_is_none_is_told_by_its_key():
    lines = copy.deepcopy(STAR)
    lines["main"]["tracks"] = 0
    assert faults_of(network(lines, [service("up", "West", "East")])) == [
        ("lines.main.tracks", "out of range")
    ]


def test_without_any_line_only_that_is_told():
    document = network({}, [service("up", "West", "East")])
    document["supply"]["converter_stations"][0].pop("line", None)
    assert ("line", "it is missing") in faults_of(document)


def test_a_gradient_as_far_from_kilometre_0_as_may_be_stands_beyond_the_line_both_ways():
    """At 100,000 km, far beyond the end of the line: its trains down it run as without it."""
    far = {"from_km": 100_000.0, "permille": 0.0}
    plain = network({"main": line(10.0, {"A": 0.0, "B": 10.0})}, [service("down", "B", "A")])
    with_it = copy.deepcopy(plain)
    with_it["lines"]["main"]["gradients"].append(far)
    results = [run(document) for document in (plain, with_it)]
    np.testing.assert_array_equal(*(each.dataset.route_position for each in results))
