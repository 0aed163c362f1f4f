"""The plan of a network: where its lines lie, what it shows of them, and trains that move on it."""

import numpy as np
import pytest

import tpss
from lines import STAR, line, run, scenario_of, service
from lines import network as document_of
from tpss.report.contact_line import line_voltage
from tpss.report.corridor import on_line
from tpss.report.drawings.network import GAP_ROWS, network, track_rows
from tpss.report.drawings.parts import Curve, Places
from tpss.report.html import report
from tpss.report.layout import layout
from tpss.report.moving import network_moving
from tpss.results.places import train_lines

BOTH = [service("up", "West", "Mine"), service("along", "West", "East")]


def plan(lines):
    return layout(scenario_of(document_of(lines, [service("s", *_ends(lines))])))


def _ends(lines):
    first = next(iter(lines.values()))["stations"]
    return first[0]["name"], first[-1]["name"]


@pytest.fixture(scope="module")
def double() -> tpss.Result:
    """40 km of two tracks that nothing ties but their ends, with trains on one of them only."""
    lines = {**STAR, "main": {**STAR["main"], "tracks": 2}}
    document = document_of(lines, BOTH)
    document["supply"] |= {
        "tracks_tied": "posts",
        "posts": [
            {"name": "P1", "line": "main", "position_km": 20.0},
            {"name": "P2", "line": "main", "position_km": 30.0, "closed": False},
        ],
        "section_breaks": [
            {"name": "B", "line": "branch", "position_km": 129.0, "closed": False},
            {"name": "C", "line": "branch", "position_km": 105.0},
        ],
    }
    document["traffic"] = BOTH[1:]
    return run(document)


# The plan


def test_the_longest_line_lies_level_at_its_kilometres():
    main = plan(STAR)["main"]
    assert [each.tolist() for each in main.at(np.array([0.0, 40.0]))] == [[0.0, 40.0], [0.0, 0.0]]


def test_a_branch_leaves_where_it_meets_the_line_and_is_true_to_length():
    """30 km long, it lies to the side of the main line and between km 10 and 40, or 40 and 70, of it."""
    branch = plan(STAR)["branch"]
    assert [float(each) for each in branch.at(100.0)] == [40.0, 0.0]
    x, y = branch.at(np.array([100.0, 110.0, 120.0, 130.0]))
    np.testing.assert_allclose(np.abs(np.diff(x)), 10.0)
    assert y[-1] != 0.0


def test_a_line_that_begins_where_another_ends_goes_straight_on():
    lines = {**STAR, "more": line(25.0, {"East": 0.0, "Far": 25.0})}
    assert [float(each) for each in plan(lines)["more"].at(25.0)] == [85.0, 0.0]


def test_a_line_between_two_stations_of_another_is_stretched_from_one_to_the_other():
    lines = {**STAR, "bypass": line(50.0, {"West": 0.0, "Mill": 25.0, "Fork": 50.0})}
    bypass = plan(lines)["bypass"]
    x, y = bypass.at(np.array([0.0, 25.0, 50.0]))
    assert x.tolist() == [0.0, 20.0, 40.0]
    assert (y[0], y[2]) == (0.0, 0.0)
    assert y[1] != 0.0


def test_a_line_that_crosses_comes_from_one_side_and_leaves_on_the_other():
    lines = {**STAR, "cross": line(40.0, {"North": 0.0, "Fork": 20.0, "South": 40.0})}
    x, y = plan({"main": STAR["main"], "cross": lines["cross"]})["cross"].at(
        np.array([0.0, 20.0, 40.0])
    )
    assert (x[1], y[1]) == (40.0, 0.0)
    assert (x[0] - x[1]) * (x[2] - x[1]) < 0.0
    assert y[0] * y[2] < 0.0


def test_lines_that_leave_at_one_station_do_not_lie_on_each_other():
    """Three branches of 15 km at Fork: their ends are a row or their lengths apart."""
    lines = {"main": STAR["main"]}
    lines |= {f"to {i}": line(15.0, {"Fork": 0.0, f"End {i}": 15.0}) for i in range(3)}
    ends = [
        tuple(map(float, path.at(15.0))) for name, path in plan(lines).items() if name != "main"
    ]
    for i, (x, y) in enumerate(ends):
        assert y != 0.0
        for other, row in ends[:i]:
            assert abs(row - y) >= 1.0 or abs(other - x) >= 15.0


def test_a_line_that_meets_none_lies_below():
    lines = {**STAR, "island": line(10.0, {"P": 5.0, "Q": 10.0})}
    paths = plan(lines)
    assert paths["island"].y.max() < min(paths[name].y.min() for name in STAR)


# What is drawn


def contact_line(result):
    (panel,) = network(result).panels
    return next(each for each in panel.items if isinstance(each, Curve) and each.colours)


def places(result):
    (panel,) = network(result).panels
    return {each.name: each for each in panel.items if isinstance(each, Places)}


def test_colours_are_the_lowest_voltages_of_each_line(star):
    """The trains that ran on the branch had no lower voltage than its colours say."""
    data = star.dataset
    kv = data.pantograph_voltage.to_numpy()[:-1] / 1e3
    on_branch = train_lines(data)[:-1] == 1
    seen = contact_line(star)
    branch = [k for k, words in enumerate(seen.words) if words.startswith("branch")]
    assert seen.colours.values[branch].min() == pytest.approx(np.nanmin(kv[on_branch]), abs=2e-3)


def test_a_run_of_one_line_is_coloured_as_its_envelope(short):
    seen, voltage = contact_line(short), line_voltage(short.dataset)
    np.testing.assert_allclose(seen.x[:-1], voltage.position_km)
    np.testing.assert_allclose(seen.colours.values[:-1], voltage.lowest_kv)


def test_stations_stand_once_and_where_lines_meet_they_are_junctions(star):
    shown = places(star)
    assert shown["junction"].labels == ["Fork"]
    assert shown["junction"].words == ["Fork: main km 40, branch km 100"]
    assert shown["station"].labels == ["West", "East", "Mine"]


def test_feeding_stations_have_their_peak_loading(star):
    ((_, feeder),) = star.stations.iterrows()
    percent = 100.0 * feeder.peak_loading
    assert places(star)["feeding station, peak loading"].labels == [f"feeder\n{percent:.0f} %"]


def test_tracks_lie_side_by_side_where_there_are_two():
    two = (
        scenario_of(document_of(STAR, BOTH)).lines_by_name["main"].model_copy(update={"tracks": 2})
    )
    km = np.array([10.0])
    apart = track_rows(two, km, 1) - track_rows(two, km, 2)
    assert apart == pytest.approx(GAP_ROWS)


def test_tracks_that_are_not_tied_have_voltages_of_their_own(double):
    """Trains towards rising kilometres run on track 2; track 1 has what the closed post hands over."""
    other, used = (line_voltage(on_line(double, "main", track)) for track in (1, 2))
    assert used.lowest_kv.min() < other.lowest_kv.min() < 16.4
    words = [each for each in contact_line(double).words if ", track 2" in each]
    assert len(words) >= len(other.lowest_kv)


def test_posts_and_breaks_are_marked_and_open_ones_are_hollow(double):
    shown = places(double)
    assert shown["coupling post"].x.tolist() == [20.0]
    assert shown["section break"].words == ["section break C: km 105"]
    assert shown["open post"].words == ["open post P2: km 30"]
    assert shown["open section break"].words == ["open section break B: km 129"]
    for closed, opened in (("coupling post", "open post"), ("section break", "open section break")):
        assert shown[closed].symbol == shown[opened].symbol
        assert (shown[closed].hollow, shown[opened].hollow) == (False, True)


def test_what_an_outage_opens_is_drawn_open(double):
    """Of a run of the same scenario: P1 and C are closed but for the outage."""
    document = double.scenario.as_document()
    document["outages"] = [{"name": "both", "opens": ["P1", "C"]}]
    scenario = tpss.Scenario.from_document(document).with_outage("both")
    shown = places(tpss.Result(scenario, double.dataset, double.summary))
    assert not {"coupling post", "section break"} & set(shown)
    assert shown["open post"].words == [
        "open post P1: km 20, opened by both",
        "open post P2: km 30",
    ]
    assert shown["open section break"].words == [
        "open section break B: km 129",
        "open section break C: km 105, opened by both",
    ]


def test_at_an_open_break_the_voltage_jumps():
    """The branch is fed at Mine too, 15 km behind the break; before it hang the main line's trains."""
    document = document_of(STAR, BOTH[1:])
    feeder = {**document["supply"]["converter_stations"][0], "name": "Mine"}
    document["supply"]["converter_stations"].append(
        {**feeder, "line": "branch", "position_km": 130.0}
    )
    document["supply"]["section_breaks"] = [
        {"name": "B", "line": "branch", "position_km": 115.0, "closed": False}
    ]
    voltage = line_voltage(on_line(run(document), "branch"))
    before = voltage.position_km < 115.0
    assert voltage.lowest_kv[before].max() < voltage.lowest_kv[~before].min() - 0.5


# The page


def test_a_report_of_a_network_shows_its_plan_and_one_of_a_line_does_not(star, page):
    assert 'id="network"' in report(star)
    assert 'id="network"' not in page


def test_trains_move_from_line_to_line(star):
    """The train to Mine is on the main line as far as its km 40, then on the branch from km 100."""
    moving = network_moving(star)
    up = next(train for train in moving["trains"] if train["name"] == "up 1")
    assert [moving["lines"][k]["name"] for k in sorted(set(up["line"]))] == ["main", "branch"]
    first = up["line"].index(1)
    assert up["km"][first - 1] <= 40.0
    assert up["km"][first] >= 100.0
    assert up["step"][first] - up["step"][first - 1] == 1
