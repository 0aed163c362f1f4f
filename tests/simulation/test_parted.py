"""What outages part of a supply: sections of contact line, feeds and other switches, for a time too."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import STAR, line, network, scenario_of, service
from tpss.model.outages import layout_of, service_of
from tpss.outages.cases import single_outages
from tpss.results.stranded import stranded_trains
from tpss.scenario.outages import Outage

SAME = 1e-9
"""Where a node more or less divides a section, voltages are found to a tolerance."""

LAST_MIN = 1e4
"""Beyond the end of any run here. [min]"""


def with_outage(document: dict[str, Any], **outage: Any) -> tpss.Result:
    """Result of a run with an outage, which passes its audit."""
    held = {**copy.deepcopy(document), "outages": [{"name": "out", **outage}]}
    result = tpss.simulate(scenario_of(held).with_outage("out"))
    assert result.audit["passed"], result.audit["failures"]
    return result


def run(document: dict[str, Any]) -> tpss.Result:
    result = tpss.simulate(scenario_of(copy.deepcopy(document)))
    assert result.audit["passed"], result.audit["failures"]
    return result


def assert_same_trains(one: tpss.Result, other: tpss.Result, steps: slice = slice(None)) -> None:
    """Assert that trains are where they are, with their voltages, in two runs."""
    for name in ("route_position", "pantograph_voltage", "active_power"):
        found, expected = (each.dataset[name].to_numpy()[steps] for each in (one, other))
        largest = np.nanmax(np.abs(expected))
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=SAME * largest, err_msg=name)


def station(name: str, position_km: float, on: str = "main", **more: Any) -> dict[str, Any]:
    return {
        "name": name, "line": on, "position_km": position_km, "type": "Q48/Q49", "converters": 2,
        **more,
    }  # fmt: skip


def one_track() -> dict[str, Any]:
    """40 km of a single track, fed at both ends and in the middle, a train each way."""
    traffic = [service("up", "A", "B"), service("down", "B", "A", departures_min=[7.0])]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0})}, traffic)
    document["supply"]["converter_stations"] += [station("mid", 20.0), station("end", 40.0)]
    document["simulation"]["duration_min"] = 40.0
    return document


KIND = {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.15}
POSTS_KM = [12.0, 25.0]


def two_tracks() -> dict[str, Any]:
    """40 km of two tracks, fed at both ends and tied at posts, trains both ways."""
    traffic = [
        service("up", "A", "B", departures_min=[0.0, 6.0]),
        service("down", "B", "A", departures_min=[0.0, 4.0]),
    ]
    document = network({"main": line(40.0, {"A": 0.0, "B": 40.0}, tracks=2)}, traffic)
    document["simulation"]["duration_min"] = 30.0
    document["supply"] |= {"catenary": KIND, "tracks_tied": "posts"}
    document["supply"]["converter_stations"].append(station("end", 40.0))
    document["supply"]["posts"] = [
        {"name": f"P{km:g}", "line": "main", "position_km": km} for km in POSTS_KM
    ]
    document["supply"]["section_breaks"] = [{"name": "B30", "line": "main", "position_km": 30.0}]
    return document


def star(feeds: list[str] | None = None) -> dict[str, Any]:
    """A branch that leaves a main line at Fork, where one station of two stands; it is 20 km long."""
    lines = {
        "main": STAR["main"],
        "branch": line(20.0, {"Fork": 100.0, "Mine": 120.0}, begins_at_km=100.0),
    }
    traffic = [service("up", "West", "Mine"), service("through", "East", "West")]
    document = network(copy.deepcopy(lines), traffic)
    document["simulation"]["duration_min"] = 60.0
    at_fork = station("fork", 40.0) | ({} if feeds is None else {"feeds": feeds})
    document["supply"]["converter_stations"].append(at_fork)
    return document


# Sections


def breaks(*places_km: float) -> list[dict[str, Any]]:
    return [
        {"name": f"B{km:g}", "line": "main", "position_km": km, "closed": False} for km in places_km
    ]


def test_a_section_that_is_out_is_what_two_open_breaks_part_from_all_else():
    """Breaks at its ends, and the station within it is out: the contact line there has no voltage."""
    out = with_outage(one_track(), sections=[{"from_km": 15.0, "to_km": 25.0}])
    parted = one_track()
    parted["supply"]["section_breaks"] = breaks(15.0, 25.0)
    del parted["supply"]["converter_stations"][1]
    assert_same_trains(out, run(parted))
    km, volts = out.dataset.position / 1e3, out.dataset.pantograph_voltage
    inside = ((km > 15.0) & (km < 25.0)).to_numpy()
    assert inside.any()
    np.testing.assert_array_equal(volts.to_numpy()[:-1][inside[:-1]], 0.0)
    assert (volts.to_numpy()[(km < 14.9).to_numpy()] > 10e3).all()


def test_a_station_within_a_section_of_all_tracks_feeds_nothing():
    out = with_outage(one_track(), sections=[{"from_km": 15.0, "to_km": 25.0}])
    fed = out.dataset.station_active_power.sel(station="mid").to_numpy()[:-1]
    np.testing.assert_allclose(fed, 0.0, atol=1e-3)


def test_a_whole_line_that_is_out_strands_its_trains():
    out = with_outage(one_track(), sections=[{"line": "main"}], from_min=5.0, to_min=30.0)
    steps = out.dataset.isel(time=slice(50, 300))
    volts = steps.pantograph_voltage.to_numpy()
    np.testing.assert_array_equal(volts[np.isfinite(volts)], 0.0)
    assert {each.train for each in stranded_trains(out.dataset)} == {"up 1", "down 1"}


def test_stepped_motion_is_refused_with_a_section_and_taken_with_a_station_switched_off():
    """A train may come to stand without power on the one, and none under the busbar of the other."""
    document = one_track()
    document["simulation"]["motion"] = "stepped"
    with pytest.raises(tpss.ScenarioError) as caught:
        with_outage(document, sections=[{"from_km": 15.0, "to_km": 25.0}])
    (finding,) = caught.value.findings
    assert finding.key == "outages.0"
    assert "contact line at 15 km, out" in finding.problem
    with_outage(document, stations=["mid"], opens=["mid>main"])


def all_nodes(
    result: tpss.Result, step: int, posts_km: list[float], gone: tuple[int, float, float] | None
) -> tuple[Any, Any]:
    """Recorded voltages of the trains in a step, and those of all nodes of both tracks solved at once.

    Every train and tie is a node, pieces between neighbours of a track have their impedance, stations
    their voltage; of a track what is gone, from one place to another, is left out with its trains, which
    are at 0.
    """
    data = result.dataset.isel(time=step)
    there = np.isfinite(data.pantograph_voltage.to_numpy())
    km, track = data.position.to_numpy()[there] / 1e3, data.train_track.to_numpy()[there]
    volts = (data.pantograph_voltage * np.exp(1j * data.pantograph_angle)).to_numpy()[there]
    powers = (data.active_power + 1j * data.reactive_power).to_numpy()[there]
    ties_km = [0.0, *posts_km, 40.0]
    ties, trains = len(ties_km), len(km)
    admittance = np.zeros((ties + trains, ties + trains), dtype=complex)
    dead = np.zeros(trains, dtype=bool)
    for number in (1, 2):
        points = [*zip(ties_km, range(ties), strict=True)]
        points += [(km[i], ties + i) for i in range(trains) if track[i] == number]
        sides = [points]
        if gone is not None and gone[0] == number:
            sides = [[p for p in points if p[0] <= gone[1]], [p for p in points if p[0] >= gone[2]]]
            dead |= (track == number) & (km >= gone[1]) & (km <= gone[2])
        for side in map(sorted, sides):
            for (begin_km, a), (end_km, b) in zip(side, side[1:], strict=False):
                y = 1.0 / ((0.2 + 0.15j) * max(end_km - begin_km, 1e-3))
                admittance[[a, b], [a, b]] += y
                admittance[[a, b], [b, a]] -= y
    node_v = (data.node_voltage * np.exp(1j * data.node_angle)).to_numpy()
    names = [str(name) for name in data.node.to_numpy()]
    fixed = [0, ties - 1]
    free = [
        n for n in range(ties + trains) if n not in fixed and not (n >= ties and dead[n - ties])
    ]
    found = np.full(ties + trains, node_v[0])
    found[fixed] = [node_v[names.index(f"contact line at {km} km")] for km in (0, 40)]
    for _ in range(200):
        current = np.zeros(ties + trains, dtype=complex)
        current[ties:] = -np.conj(powers / found[ties:])
        rest = current[free] - admittance[np.ix_(free, fixed)] @ found[fixed]
        found[free] = np.linalg.solve(admittance[np.ix_(free, free)], rest)
    found[ties:][dead] = 0.0
    return volts, found[ties:]


def assert_as_all_nodes(
    result: tpss.Result,
    steps: list[int],
    posts_km: list[float],
    gone: tuple[int, float, float] | None = None,
) -> None:
    for step in steps:
        recorded, expected = all_nodes(result, step, posts_km, gone)
        assert len(recorded) >= 2
        np.testing.assert_allclose(recorded, expected, rtol=0.0, atol=1e-6 * 15e3)


@pytest.mark.parametrize(
    ("track", "ends_km"), [(2, (8.0, 20.0)), (1, (26.0, 33.0)), (2, (12.0, 25.0))]
)
def test_a_track_is_solved_without_what_is_out_of_it_as_all_nodes_together(track, ends_km):
    """Across a post, between posts, and from post to post: the other track and its ties stay."""
    section = {"track": track, "from_km": ends_km[0], "to_km": ends_km[1]}
    result = with_outage(two_tracks(), sections=[section])
    assert_as_all_nodes(result, [20, 60, 100, 150], POSTS_KM, (track, *ends_km))
    assert (result.dataset.pantograph_voltage.to_numpy() == 0.0).any()


def test_a_section_is_out_for_a_time_and_back_after_it():
    """As a section that was always there before and after, and as one that was never there between."""
    section = {"track": 2, "from_km": 8.0, "to_km": 20.0}
    result = with_outage(two_tracks(), sections=[section], from_min=8.0, to_min=16.0)
    assert_same_trains(result, run(two_tracks()), slice(0, 80))
    assert_as_all_nodes(result, [50, 79, 160, 200], POSTS_KM)
    assert_as_all_nodes(result, [80, 120, 159], POSTS_KM, (2, 8.0, 20.0))


def test_nodes_stand_in_the_order_of_the_line():
    """As drawn along it: before the section, its beginning; its end, behind it."""
    outage = {"name": "out", "sections": [{"from_km": 15.0, "to_km": 25.0}]}
    laid = layout_of(scenario_of({**one_track(), "outages": [outage]}), Outage(**outage))
    assert laid.plan.nodes == [
        "contact line at 0 km", "contact line at 15 km", "contact line at 15 km, out",
        "contact line at 20 km, out", "contact line at 20 km", "contact line at 25 km, out",
        "contact line at 25 km", "contact line at 40 km",
    ]  # fmt: skip


# Switches for a time


SWITCHES = {
    "post": {"opens": ["P12"]},
    "break": {"opens": ["B30"]},
    "feed": {"opens": ["end>main"]},
    "section": {"sections": [{"track": 1, "from_km": 10.0, "to_km": 20.0}]},
    "all at once": {
        "opens": ["P12", "B30", "end>main"],
        "sections": [{"track": 1, "from_km": 10.0, "to_km": 20.0}],
        "units": {"feeder": 1},
    },
}
"""Outages by what they part."""


@pytest.mark.parametrize("outage", SWITCHES.values(), ids=SWITCHES)
def test_what_is_whole_for_a_whole_run_is_the_supply_that_was_never_parted(outage):
    """The layout knows the switch, which opens after the end: all as if it did not."""
    assert_same_trains(with_outage(two_tracks(), **outage, from_min=LAST_MIN), run(two_tracks()))


@pytest.mark.parametrize("outage", SWITCHES.values(), ids=SWITCHES)
def test_what_is_parted_for_a_time_as_long_as_the_run_is_parted_throughout(outage):
    for_a_time = with_outage(two_tracks(), **outage, to_min=LAST_MIN)
    assert_same_trains(for_a_time, with_outage(two_tracks(), **outage))


@pytest.mark.parametrize("outage", SWITCHES.values(), ids=SWITCHES)
def test_both_states_have_the_same_shapes(outage):
    """What a run goes from to what it goes to: nodes, blocks, sections, branches, sources."""
    held = {**two_tracks(), "outages": [{"name": "out", **outage, "from_min": 5.0, "to_min": 9.0}]}
    service = service_of(scenario_of(held).with_outage("out"))
    states = [service.network, *(each.network for each in service.switchings)]
    shapes = [
        (s.source_of_node.shape, s.admittance_s.shape, s.sections.shape, s.branches.shape,
         s.sources.shape, s.pattern.places.tolist())
        for s in states
    ]  # fmt: skip
    assert len(states) == 3
    assert shapes[0] == shapes[1] == shapes[2]


COMMON = {"mutual_r_ohm_per_km": 0.02, "mutual_x_ohm_per_km": 0.05}
"""What the tracks have in common, as of a line whose current returns in the rails."""


def coupled_tracks() -> dict[str, Any]:
    document = two_tracks()
    catenary = {"r_ohm_per_km": 0.13, "x_ohm_per_km": 0.14, **COMMON}
    document["supply"]["catenary"] = catenary
    return document


@pytest.mark.parametrize("outage", SWITCHES.values(), ids=SWITCHES)
def test_tracks_that_are_coupled_are_parted_for_a_time_too(outage):
    """Before and while: as never parted, and as parted throughout, from where the trains are at once."""
    never, ever = run(coupled_tracks()), with_outage(coupled_tracks(), **outage)
    assert_same_trains(with_outage(coupled_tracks(), **outage, from_min=LAST_MIN), never)
    assert_same_trains(with_outage(coupled_tracks(), **outage, to_min=LAST_MIN), ever)
    held = {**coupled_tracks(), "outages": [{"name": "out", **outage, "to_min": 9.0}]}
    service = service_of(scenario_of(held).with_outage("out"))
    states = [service.network, *(each.network for each in service.switchings)]
    patterns = [each.pattern.places.tolist() for each in states]
    assert patterns[0] == patterns[1]


def test_a_post_opens_and_closes_within_a_run():
    """Both tracks meet at 12 km before and after, and between only at 25 km and at the ends."""
    result = with_outage(two_tracks(), opens=["P12"], from_min=8.0, to_min=16.0)
    assert_as_all_nodes(result, [50, 79, 160, 200], POSTS_KM)
    assert_as_all_nodes(result, [80, 120, 159], [25.0])
    volts = result.dataset.node_voltage.to_numpy()
    names = [str(name) for name in result.dataset.node.to_numpy()]
    sides = [volts[:, names.index(f"contact line at 12 km, track {k}")] for k in (1, 2)]
    apart = np.abs(sides[0] - sides[1])[:-1]
    assert apart[:80].max() < 1e-6
    assert apart[160:].max() < 1e-6
    assert apart[80:160].min() > 0.1


def test_a_break_opens_and_closes_within_a_run():
    """Parted, what the stations feed is what trains of their sides draw, and losses."""
    result = with_outage(two_tracks(), opens=["B30"], from_min=8.0, to_min=16.0)
    assert_same_trains(result, run(two_tracks()), slice(0, 80))
    data = result.dataset.isel(time=slice(80, 160))
    beyond = np.isfinite(data.position) & (data.position > 30e3)
    drawn_w = data.active_power.where(beyond).sum("train").to_numpy()
    fed_w = data.station_active_power.sel(station="end").to_numpy()
    assert (fed_w >= drawn_w - 1.0).all()
    assert (fed_w < 1.1 * drawn_w + 1e3).all()


def test_a_switch_that_is_open_already_stays_so_after_an_outage():
    document = two_tracks()
    document["supply"]["posts"][0]["closed"] = False
    out = with_outage(document, opens=["P12", "P25"], from_min=8.0, to_min=16.0)
    assert_as_all_nodes(out, [79, 160, 200], [25.0])
    assert_as_all_nodes(out, [80, 120, 159], [])


# Feeds


def fed_or_not(result: tpss.Result) -> Any:
    """Steps of the trains, without the instants of their arrival."""
    return result.train_steps.dropna(subset=["pantograph_voltage_kv"])


def test_a_station_feeds_all_lines_at_its_place_unless_it_says_which():
    assert_same_trains(run(star(["main", "branch"])), run(star()))


def test_a_line_that_is_not_fed_is_parted_from_the_others_there():
    """The busbar is what ties the lines: without its feed, the branch is without power."""
    lonely = run(star(["main"]))
    steps = fed_or_not(lonely)
    volts = steps.pantograph_voltage_kv.to_numpy()
    np.testing.assert_array_equal(volts[(steps.line == "branch").to_numpy()], 0.0)
    assert (volts[(steps.line == "main").to_numpy()] > 10.0).all()


@pytest.mark.parametrize("line_of_it", ["main", "branch"])
def test_an_open_feed_is_one_that_was_never_there(line_of_it):
    """The line on which the station stands may be the one that loses its feed."""
    kept = [name for name in ("main", "branch") if name != line_of_it]
    opened = with_outage(star(), opens=[f"fork>{line_of_it}"])
    assert_same_trains(opened, run(star(kept)))


def test_a_feed_opens_and_closes_within_a_run():
    result = with_outage(star(), opens=["fork>branch"], from_min=30.0, to_min=40.0)
    assert_same_trains(result, run(star()), slice(0, 300))
    steps = fed_or_not(result)
    on_branch = steps[steps.line == "branch"]
    parted = (on_branch.time_min > 29.99) & (on_branch.time_min < 39.99)
    assert parted.any()
    np.testing.assert_array_equal(on_branch.pantograph_voltage_kv[parted], 0.0)
    assert (on_branch.pantograph_voltage_kv[~parted] > 10.0).all()


def test_the_only_feed_of_a_station_is_as_much_as_the_station():
    opened = with_outage(two_tracks(), opens=["end>main"])
    assert_same_trains(opened, with_outage(two_tracks(), stations=["end"]))
    fed = opened.dataset.station_active_power.sel(station="end").to_numpy()[:-1]
    np.testing.assert_allclose(fed, 0.0, atol=1e-3)


def test_behind_an_impedance_the_feeds_part_at_the_busbar():
    """As an AT station has one, between its source and its busbar, which all of its feeds share."""
    kind = {**KIND, "connection_r_ohm": 0.3, "connection_x_ohm": 1.2}
    document, kept = star(), star(["branch"])
    document["supply"]["catenary"] = kept["supply"]["catenary"] = kind
    assert_same_trains(with_outage(document, opens=["fork>main"]), run(kept))
    opened = with_outage(document, opens=["fork>main", "fork>branch"])
    assert_same_trains(opened, with_outage(kept, stations=["fork"]))


def test_every_feed_of_several_and_every_closed_switch_is_a_case_of_n_1():
    feeds = [each.name for each in single_outages(scenario_of(star())) if each.opens]
    assert feeds == ["fork>main open", "fork>branch open"]
    document = two_tracks()
    document["supply"]["posts"][0]["closed"] = False
    switches = [each.name for each in single_outages(scenario_of(document)) if each.opens]
    assert switches == ["P25 open", "B30 open"]


def test_a_row_of_the_table_is_that_of_the_run():
    """The table makes its cases from one model; a run of each makes it anew."""
    sections = [{"track": 2, "from_km": 8.0, "to_km": 20.0}]
    outages = [{"name": name, **outage} for name, outage in SWITCHES.items()]
    outages.append({"name": "for a time", "sections": sections, "from_min": 3.0, "to_min": 9.0})
    scenario = scenario_of({**two_tracks(), "outages": outages})
    found = tpss.compare_outages(scenario)
    for row in found.rows[1:]:
        result = tpss.simulate(scenario.with_outage(row.outage))
        lowest = result.summary["lowest_voltage"]
        assert row.figures["lowest_voltage_kv"] == lowest["voltage_kv"], row.outage
        assert row.figures["stranded"] == len({e.train for e in stranded_trains(result.dataset)})
