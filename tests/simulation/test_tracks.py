"""Contact lines of several tracks: tied everywhere, at posts, or not; who runs on which track."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import double_track, run, scenario_of, service, with_posts
from tpss.results.passing import passings

# One line for all tracks


def test_tracks_tied_everywhere_are_a_line_of_half_the_impedance():
    """Two of 0.2 + j0.15 ohm/km in parallel: 0.1 + j0.075."""
    tied = run(double_track("everywhere"))
    half = run(double_track(None, tracks=1, r_ohm_per_km=0.1, x_ohm_per_km=0.075))
    for name in ("route_position", "pantograph_voltage"):
        np.testing.assert_array_equal(tied.dataset[name], half.dataset[name])


def test_what_both_have_in_common_is_not_halved():
    """(0.2 + 0.02)/2 + j (0.15 + 0.05)/2 = 0.11 + j0.1 ohm/km; twice 10 nF/km."""
    common = {
        "mutual_r_ohm_per_km": 0.02,
        "mutual_x_ohm_per_km": 0.05,
        "capacitance_nf_per_km": 10.0,
    }
    tied = run(double_track("everywhere", **common))
    one = {"r_ohm_per_km": 0.11, "x_ohm_per_km": 0.1, "capacitance_nf_per_km": 20.0}
    alone = run(double_track(None, tracks=1, **one))
    np.testing.assert_allclose(
        tied.dataset.pantograph_voltage, alone.dataset.pantograph_voltage, rtol=1e-12
    )


# Tracks with contact lines of their own


COMMON = {"mutual_r_ohm_per_km": 0.02, "mutual_x_ohm_per_km": 0.05}


def snapshot(
    result: tpss.Result, step: int, ties_km: list[float], mutual: complex = 0j, tracks: int = 2
) -> tuple[Any, Any]:
    """Recorded voltages of the trains in a step, and those of all nodes of all tracks solved at once.

    Each track has a node at every train, whatever its track, and at every tie; the tracks of a piece
    between neighbouring points have a matrix of impedances, and stations the voltage that they have.
    The trains' powers are given, their currents iterated.
    """
    data = result.dataset.isel(time=step)
    there = np.isfinite(data.pantograph_voltage.to_numpy())
    km, track = data.position.to_numpy()[there] / 1e3, data.train_track.to_numpy()[there]
    volts = (data.pantograph_voltage * np.exp(1j * data.pantograph_angle)).to_numpy()[there]
    powers = (data.active_power + 1j * data.reactive_power).to_numpy()[there]
    points_km = np.unique([*ties_km, *km])
    node = np.arange(points_km.size * tracks).reshape(-1, tracks)
    node[np.isin(points_km, ties_km)] = node[np.isin(points_km, ties_km)][:, :1]
    admittance = np.zeros((node.size, node.size), dtype=complex)
    impedance = np.full((tracks, tracks), mutual)
    np.fill_diagonal(impedance, 0.2 + 0.15j)
    for k, length_km in enumerate(np.diff(points_km)):
        y, (a, b) = np.linalg.inv(impedance * length_km), node[k : k + 2]
        for rows, columns, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
            np.add.at(admittance, (rows[:, None], columns[None, :]), sign * y)
    node_v = (data.node_voltage * np.exp(1j * data.node_angle)).to_numpy()
    place = {float(km): n for n, km in enumerate(data.node_position.to_numpy() / 1e3)}
    found = np.full(node.size, node_v[place[ties_km[0]]])
    fixed = node[[0, -1], 0]
    found[fixed] = node_v[[place[ties_km[0]], place[ties_km[-1]]]]
    free = np.setdiff1d(node, fixed)
    trains = node[np.searchsorted(points_km, km), track - 1]
    for _ in range(200):
        current = np.zeros(node.size, dtype=complex)
        np.add.at(current, trains, -np.conj(powers / found[trains]))
        rest = current[free] - admittance[np.ix_(free, fixed)] @ found[fixed]
        found[free] = np.linalg.solve(admittance[np.ix_(free, free)], rest)
    return volts, found[trains]


@pytest.mark.parametrize("common", [{}, COMMON], ids=["apart", "coupled"])
@pytest.mark.parametrize(("tied", "posts_km"), [("posts", [12.0, 25.0]), ("posts", []), ("no", [])])
def test_every_track_is_solved_with_the_other_as_all_nodes_together(tied, posts_km, common):
    result = run(with_posts(double_track(tied, **common), *posts_km))
    mutual = 0.02 + 0.05j if common else 0j
    for step in (20, 70, 100, 150):
        recorded, expected = snapshot(result, step, [0.0, *posts_km, 40.0], mutual)
        assert len(recorded) >= 2
        np.testing.assert_allclose(recorded, expected, rtol=0.0, atol=1e-6 * 15e3)


@pytest.mark.parametrize(("tied", "posts_km"), [("posts", [12.0, 25.0]), ("no", [])])
def test_three_tracks_are_solved_as_all_nodes_together(tied, posts_km):
    """Two trains each way; the third track carries none, but what is induced in it and the posts."""
    result = run(with_posts(double_track(tied, tracks=3, **COMMON), *posts_km))
    for step in (70, 100, 150):
        recorded, expected = snapshot(result, step, [0.0, *posts_km, 40.0], 0.02 + 0.05j, tracks=3)
        assert len(recorded) == 4
        np.testing.assert_allclose(recorded, expected, rtol=0.0, atol=1e-6 * 15e3)


def test_tracks_that_are_tied_often_come_close_to_those_that_are_tied_everywhere():
    """At most |Zs - Zm| d/8 per train is left: 0.025 ohm over 1 km, some volts of those 40 at 10 km."""
    whole = run(double_track("everywhere", **COMMON)).dataset.pantograph_voltage
    gaps = [
        float(
            abs(
                run(
                    with_posts(double_track("posts", **COMMON), *np.arange(d, 40.0, d).tolist())
                ).dataset.pantograph_voltage
                - whole
            ).max()
        )
        for d in (10.0, 1.0)
    ]
    assert gaps[1] < gaps[0] / 5.0


def test_least_squares_of_the_mismatches_agree_on_coupled_tracks():
    document = with_posts(double_track("posts", **COMMON, capacitance_nf_per_km=10.0), 12.0, 25.0)
    document["simulation"] = {"duration_min": 12.0, "time_step_min": 1.0}
    equations = run(document)
    document["simulation"]["load_flow"] = "least-squares"
    squares = run(document)
    for name in ("pantograph_voltage", "node_voltage", "network_losses"):
        np.testing.assert_allclose(squares.dataset[name], equations.dataset[name], rtol=1e-6)


def test_a_dead_part_of_coupled_tracks_carries_nothing_and_the_rest_goes_on():
    """Parted at km 15 with the far station out for a while: trains beyond have no voltage then."""
    document = double_track("no", **COMMON)
    document["supply"]["section_breaks"] = [
        {"name": "B", "line": "main", "position_km": 15.0, "closed": False}
    ]
    document["outages"] = [{"name": "far", "stations": ["end"], "from_min": 5.0, "to_min": 12.0}]
    result = tpss.simulate(scenario_of(document).with_outage("far"))
    assert result.audit["passed"], result.audit["failures"]
    data = result.dataset
    km, volts = data.position.to_numpy() / 1e3, data.pantograph_voltage.to_numpy()
    minute = data.time.to_numpy()[:, None] / 60.0
    out = (minute >= 5.0) & (minute < 12.0)
    assert (out & (km > 15.1)).any()
    assert (volts[out & (km > 15.1)] == 0.0).all()
    assert (out & (km < 14.9)).any()
    assert (volts[out & (km < 14.9)] > 10e3).all()
    assert (volts[~out & np.isfinite(volts)] > 10e3).all()


def test_a_coupled_line_seen_from_its_other_end_is_the_same():
    """Kilometres and tracks turned round: km -> 40 - km, up is down.

    But for a metre by which trains beside a node count as further away, from that end on.
    """
    there = double_track("posts", **COMMON)
    back = copy.deepcopy(there)
    main = back["lines"]["main"]
    main["stations"] = [{"name": "B", "position_km": 0.0}, {"name": "A", "position_km": 40.0}]
    for document, km in ((there, 12.0), (back, 28.0)):
        with_posts(document, km)
    for station, km in zip(back["supply"]["converter_stations"], (40.0, 0.0), strict=True):
        station["position_km"] = km
    one, other = run(there).dataset, run(back).dataset
    np.testing.assert_allclose(one.pantograph_voltage, other.pantograph_voltage, rtol=1e-6)
    apart = abs(one.pantograph_voltage - other.pantograph_voltage).median()
    assert float(apart) < 1e-6


def test_a_post_that_is_open_ties_nothing():
    open_post = run(with_posts(double_track("posts"), 20.0, closed=False))
    without = run(double_track("no"))
    np.testing.assert_array_equal(
        open_post.dataset.pantograph_voltage, without.dataset.pantograph_voltage
    )


def test_the_more_the_tracks_are_tied_the_less_the_voltage_falls():
    one_way = [service("up", "A", "B")]
    lowest = [
        run(document).trips.lowest_voltage_kv[0]
        for document in (
            double_track("no", one_way),
            with_posts(double_track("posts", one_way), 20.0),
            with_posts(double_track("posts", one_way), 10.0, 20.0, 30.0),
            double_track("everywhere", one_way),
        )
    ]
    assert lowest == sorted(lowest)
    assert lowest[-1] - lowest[0] > 0.1


def test_a_second_track_that_ends_is_tied_to_the_first_there():
    """From km 15 on there is one track: the same as two tied lines up to a post there, then one."""
    tracks = [{"from_km": 0.0, "count": 2}, {"from_km": 15.0, "count": 1}]
    result = run(double_track("posts", tracks=tracks))
    steps = result.train_steps
    assert set(steps.track[steps.position_km < 14.9]) == {1, 2}
    assert set(steps.track[steps.position_km > 15.1]) == {1}
    assert [str(name) for name in result.dataset.node.to_numpy()] == [
        "contact line at 0 km", "contact line at 15 km", "contact line at 40 km",
    ]  # fmt: skip


# Stretches and breaks


def test_each_stretch_has_the_contact_line_that_is_said_of_it():
    """The outer halves of one kind and another are those of two lines that meet, one of each kind."""
    other = {"r_ohm_per_km": 0.05, "x_ohm_per_km": 0.05}
    document = double_track(None, tracks=1)
    document["supply"]["contact_lines"] = [{"line": "main", "from_km": 20.0, "catenary": other}]
    mixed = run(document)
    assert list(mixed.dataset.node_position.to_numpy()) == [0.0, 20e3, 40e3]
    plain = run(double_track(None, tracks=1))
    assert (mixed.trips.lowest_voltage_kv >= plain.trips.lowest_voltage_kv).all()
    assert mixed.summary["losses_mwh"] < plain.summary["losses_mwh"]


def test_an_open_break_parts_the_line_and_a_closed_one_does_nothing():
    """Parted at km 15, each station feeds its own side: no power crosses."""
    document = double_track("everywhere")
    document["supply"]["section_breaks"] = [{"name": "B", "line": "main", "position_km": 15.0}]
    closed = run(document)
    np.testing.assert_array_equal(
        closed.dataset.pantograph_voltage,
        run(double_track("everywhere")).dataset.pantograph_voltage,
    )
    parted = copy.deepcopy(document)
    parted["supply"]["section_breaks"][0]["closed"] = False
    data = run(parted).dataset
    names = [str(name) for name in data.node.to_numpy()]
    assert names[1:3] == ["contact line at 15 km, before B", "contact line at 15 km, behind B"]
    on_first = np.isfinite(data.position) & (data.position < 15e3)
    drawn_w = data.active_power.where(on_first).sum("train").to_numpy()[:-1]
    fed_w = data.station_active_power.to_numpy()[:-1, 0]
    assert (fed_w - drawn_w >= -1e3).all()  # nothing but the losses of its side beside
    assert (fed_w[drawn_w == 0.0] < 1e3).all()


# Who runs where


@pytest.mark.parametrize(("left", "up", "down"), [(False, 2, 1), (True, 1, 2)])
def test_trains_keep_to_the_side_that_the_line_says(left, up, down):
    document = double_track("everywhere")
    document["lines"]["main"]["left_hand_running"] = left
    steps = run(document).train_steps
    assert set(steps.track[steps.service == "up"]) == {up}
    assert set(steps.track[steps.service == "down"]) == {down}


def test_trains_on_two_tracks_do_not_pass_through_each_other_and_on_one_they_do():
    assert passings(run(double_track("everywhere"))) == []
    met = passings(run(double_track(None, tracks=1)))
    assert len(met) == 4
    assert {each.one.split()[0] for each in met} == {"up"}


def test_trains_that_meet_at_a_station_of_two_tracks_cross_there():
    """Alike trains from both ends at once meet in the middle, where there is a loop or there is none."""
    pair = [service("up", "A", "B"), service("down", "B", "A")]
    document = double_track(None, pair, tracks=1)
    assert len(passings(run(document))) == 1
    middle = {"name": "M", "position_km": 20.0, "tracks": 2}
    document["lines"]["main"]["stations"].insert(1, middle)
    assert passings(run(document)) == []


# Faults


def faults_of(document: dict[str, Any]) -> list[tuple[str, str]]:
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario_of(document)
    return [(finding.key, finding.problem) for finding in caught.value.findings]


def test_two_tracks_have_to_say_whether_they_are_tied():
    assert faults_of(double_track(None)) == [
        ("supply.tracks_tied", "it is missing, and the line has 2 tracks")
    ]


def test_a_post_where_nothing_is_tied_at_posts_is_a_fault():
    ((key, problem),) = faults_of(with_posts(double_track("everywhere"), 20.0))
    assert key == "supply.posts.0"
    assert "ties nothing" in problem


@pytest.mark.parametrize("tied", ["posts", "no", "everywhere"])
def test_tracks_have_less_in_common_than_each_has_by_itself(tied):
    """Else a current could feed: the matrix of resistances is not positive, nor that of inductances."""
    ((key, problem),) = faults_of(double_track(tied, mutual_x_ohm_per_km=0.16))
    assert key == "supply.catenary"
    assert problem == "mutual_x_ohm_per_km (0.16) is no less than x_ohm_per_km (0.15)"


def test_a_break_at_a_feeding_point_is_a_fault():
    document = double_track("everywhere")
    document["supply"]["section_breaks"] = [{"name": "B", "line": "main", "position_km": 40.0}]
    ((key, _),) = faults_of(document)
    assert key == "supply.section_breaks.0.position_km"


def test_stretches_of_contact_line_may_not_overlap():
    document = double_track("everywhere")
    document["supply"]["contact_lines"] = [
        {"line": "main", "to_km": 20.0, "catenary": "AT"},
        {"line": "main", "from_km": 10.0, "catenary": "BT"},
    ]
    ((key, problem),) = faults_of(document)
    assert (key, problem) == ("supply.contact_lines.1", "overlaps supply.contact_lines.0")


# Switches that are open in an outage


def with_switches() -> dict[str, Any]:
    document = with_posts(double_track("posts"), 12.0, 25.0)
    document["supply"]["section_breaks"] = [{"name": "B", "line": "main", "position_km": 30.0}]
    document["outages"] = [
        {"name": "post open", "opens": ["P12"]},
        {"name": "parted", "opens": ["B"], "units": {"end": 1}},
    ]
    return document


def test_a_switch_that_opens_in_an_outage_is_one_that_is_open_in_the_scenario():
    scenario = scenario_of(with_switches())
    opened = tpss.simulate(scenario.with_outage("post open"))
    written = tpss.simulate(scenario.with_({"supply.posts.P12.closed": False}))
    for name in ("pantograph_voltage", "node_voltage", "branch_current"):
        np.testing.assert_array_equal(opened.dataset[name], written.dataset[name])


def test_switches_open_together_with_what_else_is_out():
    scenario = scenario_of(with_switches())
    found = tpss.simulate(scenario.with_outage("parted"))
    changes = {
        "supply.section_breaks.B.closed": False,
        "supply.converter_stations.end.converters": 1,
    }
    expected = tpss.simulate(scenario.with_(changes))
    np.testing.assert_allclose(
        found.dataset.pantograph_voltage, expected.dataset.pantograph_voltage, rtol=1e-9
    )
    assert found.audit["passed"]


def test_every_closed_switch_is_opened_once_in_the_table_of_outages():
    found = tpss.compare_outages(scenario_of(with_switches()), every=True)
    names = [row.outage for row in found.rows]
    assert {"P25 open", "B open", "post open", "parted"} <= set(names)
    assert "P12 open" not in names  # named already
    assert len(names) == found.cases


def test_a_switch_that_is_not_there_is_a_fault():
    document = with_switches()
    document["outages"] = [{"name": "odd", "opens": ["P99"]}]
    assert faults_of(document) == [("outages.0.opens.0", "there is no such switch")]
