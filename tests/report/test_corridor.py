"""A run along a corridor of a network, or between two stations of one line."""

import numpy as np
import pytest

from lines import line, network, run, service
from tpss.errors import ResultError
from tpss.report.contact_line import line_voltage
from tpss.report.corridor import ALONG, along, landmarks, span_km
from tpss.report.figures import draw
from tpss.report.html import comparison, report
from tpss.report.tables import key_figures

from pages import Page


@pytest.fixture(scope="module")
def chain():
    """A main line with a halt at km 15, where nothing feeds, and a branch from its km 40 on."""
    lines = {
        "main": line(60.0, {"West": 0.0, "Halt": 15.0, "Fork": 40.0, "East": 60.0}),
        "branch": line(30.0, {"Fork": 100.0, "Mine": 130.0}, begins_at_km=100.0),
    }
    document = network(lines, [service("up", "West", "Mine"), service("along", "West", "East")])
    document["supply"]["catenary"] = "AT"
    return run(document)


def test_a_corridor_may_begin_where_the_contact_line_has_no_node(chain):
    """From Halt on its voltage is that of the corridor from West, 15 km farther along."""
    whole, part = (line_voltage(along(chain, [name, "Mine"]).dataset) for name in ("West", "Halt"))
    assert (part.position_km[0], part.position_km[-1]) == (0.0, 55.0)
    expected = np.interp(part.position_km + 15.0, whole.position_km, whole.mean_kv)
    np.testing.assert_allclose(part.mean_kv, expected, atol=2e-3)


def test_a_corridor_is_told_by_its_ends_and_where_it_changes_lines(chain):
    assert along(chain, ["East", "Mine"]).dataset.attrs[ALONG] == "East – Fork – Mine"
    assert draw("voltage", chain).get_suptitle() == "network: West – Fork – Mine"
    assert draw("stations", chain).get_suptitle() == "network"
    assert "Time-distance graph: West – East" in Page(report(chain, ["West", "East"])).text


def test_the_voltage_along_a_corridor_names_where_lines_meet_and_end(chain):
    """The feeder at its beginning by its own name; Halt, where the contact line has no node, is none."""
    figure = draw("voltage", chain, corridor=["West", "Mine"])
    texts = {text.get_text() for axes in figure.axes for text in axes.texts}
    assert {"feeder", "Fork", "Mine"} <= texts
    assert "Halt" not in texts


def test_a_journey_is_whole_unless_a_corridor_is_chosen(chain):
    """From West 40 km to Fork and 30 km on to Mine, of which the corridor has the last."""
    for way, begin_km in (([], 0.0), (["Fork", "Mine"], 40.0)):
        speed = draw("journey", chain, "up 1", "distance", way).axes[1].lines[0]
        km = speed.get_xdata()[np.isfinite(speed.get_ydata())]
        assert (km.min(), km.max()) == (pytest.approx(begin_km, abs=0.3), pytest.approx(70.0))


def test_a_line_is_drawn_between_two_of_its_stations_at_its_own_kilometres(short):
    """The order of the stations makes no difference."""
    seen = along(short, ["East", "Middle"])
    assert span_km(seen) == (10.0, 20.0)
    assert landmarks(seen) == {"Middle": 10.0, "East": 20.0}
    part, whole = line_voltage(seen.dataset), line_voltage(short.dataset)
    expected = np.interp(part.position_km, whole.position_km, whole.mean_kv)
    np.testing.assert_allclose(part.mean_kv, expected, atol=2e-3)
    graph = draw("time-distance", short, corridor=["Middle", "East"]).axes[0]
    assert graph.get_ylim() == (10.0, 20.0)


def test_a_corridor_to_nowhere_is_refused(short, chain):
    for result in (short, chain):
        with pytest.raises(ResultError, match="there is no station 'Nowhere'"):
            along(result, ["East", "Nowhere"])


def test_figures_of_a_network_have_the_line_of_their_place(chain):
    places = {name: value for name, _, value in key_figures(chain)}
    place = chain.summary["lowest_voltage"]
    expected = f"{place['line']} km {place['position_km']:.2f}"
    assert places["place of lowest voltage"] == expected
    assert expected in Page(comparison({"a": chain, "b": chain})).text


def test_the_station_with_the_highest_loading_is_named_with_its_place(short):
    worst = short.stations.loc[short.stations.peak_loading.idxmax()]
    figures = {name: value for name, _, value in key_figures(short)}
    assert figures["station with highest peak loading"] == worst.station
    assert figures["place of highest peak loading"] == worst.position_km
    assert figures["highest peak loading"] == pytest.approx(100.0 * worst.peak_loading)


def test_a_stretch_that_is_out_is_dark_all_along_whichever_way_it_is_drawn():
    """From 20 to 30 km of 60 the line is out, and beyond it nobody feeds: 0 V from 20 km on.

    Drawn down the line that is up to 40 km from its end; where the voltage falls two nodes stand, of
    which that of the dark side comes first then.
    """
    lines = {"main": line(60.0, {"A": 0.0, "B": 60.0}), "spur": line(5.0, {"A": 0.0, "C": 5.0})}
    document = network(lines, [service("up", "A", "B", departures_min=[89.0])])
    section = {"line": "main", "from_km": 20.0, "to_km": 30.0}
    document["outages"] = [{"name": "out", "sections": [section]}]
    document["simulation"]["outage"] = "out"
    result = run(document)
    for way, dark in ((["A", "B"], (20.2, 60.0)), (["B", "A"], (0.0, 39.8))):
        seen = line_voltage(along(result, way).dataset)
        is_dark = (seen.position_km >= dark[0]) & (seen.position_km <= dark[1])
        assert seen.highest_kv[is_dark].max() == 0.0
        beside = np.abs(seen.position_km - (20.0 if way[0] == "A" else 40.0)) < 0.4
        assert seen.lowest_kv[~is_dark & ~beside].min() > 15.0
