"""Outages of a scenario: what they name, how one is chosen, and what is found at fault."""

import copy

import pytest

import tpss
from faults import FILE, HV, WEST, faults_of, finding_at
from lines import STAR, network, scenario_of, service
from tpss import ScenarioError

from scenarios import SHORT_LINE, short_line

OUT = "outages.0"


def outage(**keys):
    return {"outages": [{"name": "a", **keys}]}


@pytest.mark.parametrize(
    ("changes", "key", "value", "remedy"),
    [
        pytest.param(outage(), OUT, "", "opens, sections, autotransformers or storage", id="nothing"),
        pytest.param(outage(stations=["Wst"]), f"{OUT}.stations.0", "'Wst'",
                     "did you mean West? stations: West, East", id="unknown-station"),
        pytest.param(outage(units={"Nowhere": 1}), f"{OUT}.units.Nowhere", "'Nowhere'",
                     "stations: West, East", id="units-of-an-unknown-station"),
        pytest.param(outage(units={"West": 7}), f"{OUT}.units.West", "7", "give 6 or less",
                     id="more-than-installed"),
        pytest.param(outage(units={"West": 0}), f"{OUT}.units.West", "0", "greater than", id="none"),
        pytest.param(outage(stations=["West"], units={"West": 1}), OUT, "",
                     "leave it out of stations or of units", id="twice"),
        pytest.param(outage(transformers_km=[81.0]), f"{OUT}.transformers_km.0", "81",
                     "transformers: 0 km, 40 km, 80 km, 120 km, 160 km",
                     id="no-such-transformer"),
        pytest.param(outage(storage=["Battery"]), f"{OUT}.storage.0", "'Battery'", "stores: none",
                     id="no-such-store"),
        pytest.param(outage(autotransformers=[{"position_km": 5.0}]),
                     f"{OUT}.autotransformers.0.position_km", "5", "autotransformers: none",
                     id="no-such-autotransformer"),
        pytest.param(outage(autotransformers=[{"position_km": 500.0}]),
                     f"{OUT}.autotransformers.0.position_km", "500", "place it between 0 and 160 km",
                     id="autotransformer-beyond-the-line"),
        pytest.param({HV: None, **outage(transformers_km=[80.0])}, f"{OUT}.transformers_km.0",
                     "80", "transformers: none", id="no-line"),
        pytest.param(outage(stations=["West"], from_min=20.0, to_min=10.0), OUT, "",
                     "a to_min after from_min", id="times-out-of-order"),
        pytest.param(outage(station=["West"]), f"{OUT}.station", "['West']",
                     "did you mean stations?", id="unknown-key"),
        pytest.param({"outages": [{"name": "a", "stations": ["West"]}] * 2}, "outages",
                     "[{'name'", "give each one its own", id="name-twice"),
        pytest.param({**outage(stations=["West"]), "simulation.outage": "b"}, "simulation.outage",
                     "'b'", "outages: a", id="unknown-outage"),
        pytest.param({**outage(stations=["West"]), "simulation.outage": "a",
                      "simulation.load_flow": "least-squares"}, "simulation.load_flow",
                     "'least-squares'", 'load_flow = "equations"', id="least-squares"),
        pytest.param({f"{WEST}.grid_reactive_power_mvar": -60.0, **outage(units={"West": 5})},
                     f"{OUT}.units.West", "5", "less reactive power", id="no-voltage-left"),
        pytest.param(outage(opens=["West>lin"]), f"{OUT}.opens.0", "'West>lin'",
                     "did you mean West>line? switches: West>line, East>line", id="feed-of-no-line"),
        pytest.param(outage(sections=[{"from_km": 9.0, "to_km": 500.0}]),
                     f"{OUT}.sections.0.to_km", "500", "place it between 0 and 160 km",
                     id="section-beyond-the-line"),
        pytest.param(outage(sections=[{"from_km": 9.0, "to_km": 5.0}]), f"{OUT}.sections.0", "",
                     "give the lower position as from_km", id="ends-reversed"),
        pytest.param(outage(sections=[{"from_km": 9.0, "to_km": 9.0005}]), f"{OUT}.sections.0", "",
                     "give it a metre or more", id="too-short"),
        pytest.param(outage(sections=[{"track": 2}]), f"{OUT}.sections.0.track", "2",
                     "give a track that is there", id="no-such-track"),
        pytest.param(outage(sections=[{"track": 0}]), f"{OUT}.sections.0.track", "0",
                     "greater than", id="track-nought"),
        pytest.param(outage(sections=[{"line": "branch"}]), f"{OUT}.sections.0.line", "'branch'",
                     "lines: line", id="no-such-line"),
        pytest.param(outage(sections=[{"to_km": 9.0}, {"from_km": 8.0, "track": 1}]),
                     f"{OUT}.sections.1", "", "give each stretch of a track once", id="overlap"),
    ],
)  # fmt: skip
def test_a_fault_of_an_outage_is_reported_with_place_value_and_remedy(changes, key, value, remedy):
    finding = finding_at(key, faults_of(changes))
    assert finding.file == str(FILE)
    assert finding.value.startswith(value)
    assert finding.problem
    assert remedy in finding.remedy


STATION = {"position_km": 40.0, "type": "Q48/Q49", "converters": 2}


def faults_of_star(stations=(), outages=(), **lines):
    """Faults of a network of two lines that meet at Fork, by their keys."""
    document = network(copy.deepcopy(STAR), [service("up", "West", "Mine")], outages=list(outages))
    document["supply"]["converter_stations"] += stations
    for name, more in lines.items():
        document["lines"][name].update(more)
    with pytest.raises(ScenarioError) as caught:
        scenario_of(document)
    return {finding.key: finding for finding in caught.value.findings}


def test_a_feed_needs_a_line_that_passes_at_its_station():
    aside = {**STATION, "name": "aside", "line": "main", "position_km": 20.0, "feeds": ["branch"]}
    odd = {**STATION, "name": "odd", "line": "main", "feeds": ["main", "brunch"]}
    found = faults_of_star([aside, odd])
    feed = found["supply.converter_stations.1.feeds.0"]
    assert (feed.value, feed.problem) == ("'branch'", "it does not pass at main 20 km")
    assert feed.remedy == "lines there: main"
    feed = found["supply.converter_stations.2.feeds.1"]
    assert (feed.value, feed.problem) == ("'brunch'", "there is no such line")
    assert feed.remedy == "did you mean branch? lines there: main, branch"


def test_feeds_are_named_once_and_not_without_any():
    twice = {**STATION, "name": "twice", "line": "main", "feeds": ["main", "main"]}
    found = faults_of_star([twice])
    assert found["supply.converter_stations.1.feeds"].problem == "main occurs twice"
    found = faults_of_star([{**twice, "feeds": []}])
    assert found["supply.converter_stations.1.feeds"].problem == "the list is too short"


def test_two_stations_do_not_share_the_place_where_lines_meet():
    """Each is the node of a voltage; of two at one node only one would be seen."""
    stations = [
        {**STATION, "name": "one", "line": "main"},
        {**STATION, "name": "other", "line": "branch", "position_km": 100.0},
    ]
    finding = faults_of_star(stations)["supply.converter_stations.2.position_km"]
    assert finding.problem == "one stands here too, where main and branch meet"


@pytest.mark.parametrize("transformers", [{"transformers": 3}, {"transformers_km": [40.0]}])
def test_a_break_does_not_stand_at_a_transformer_of_the_high_voltage_line(transformers):
    """The node that the transformer feeds would be two, of which neither is the one that is meant."""
    at = "supply.section_breaks.0.position_km"
    spaced = {HV: {"type": "132kV", **transformers}}
    breaks = {"supply.section_breaks": [{"name": "B", "position_km": 40.0}]}
    finding = finding_at(at, faults_of({**spaced, **breaks}))
    assert finding.problem == "the contact line is fed, tied or ends here"


def test_sections_of_a_network_say_their_line():
    found = faults_of_star(
        outages=[{"name": "a", "sections": [{"to_km": 9.0}, {"line": "brunch"}]}]
    )
    assert (
        found["outages.0.sections.0.line"].problem == "it is missing, and there are several lines"
    )
    assert found["outages.0.sections.1.line"].remedy == "did you mean branch? lines: main, branch"


def test_a_track_has_to_be_there_all_along_a_section():
    counts = {"tracks": [{"from_km": 0.0, "count": 2}, {"from_km": 30.0, "count": 1}]}
    section = {"line": "main", "track": 2, "from_km": 20.0, "to_km": 35.0}
    document = network(copy.deepcopy(STAR), [service("up", "West", "Mine")])
    document["lines"]["main"].update(counts)
    document["supply"]["tracks_tied"] = "posts"
    document["outages"] = [{"name": "a", "sections": [section]}]
    with pytest.raises(ScenarioError) as caught:
        scenario_of(document)
    (finding,) = caught.value.findings
    assert (finding.key, finding.value) == ("outages.0.sections.0.track", "2")
    assert finding.problem == "the line has 1 track from 30 to 60 km"
    section["to_km"] = 30.0
    scenario_of(document)


def test_one_of_two_tracks_that_are_tied_everywhere_cannot_be_out():
    section = {"line": "main", "track": 2, "from_km": 20.0, "to_km": 35.0}
    document = network(copy.deepcopy(STAR), [service("up", "West", "Mine")])
    document["lines"]["main"]["tracks"] = 2
    document["supply"]["tracks_tied"] = "posts"
    document["supply"]["contact_lines"] = [
        {"line": "main", "from_km": 30.0, "tracks_tied": "everywhere"}
    ]
    document["outages"] = [{"name": "a", "sections": [section]}]
    with pytest.raises(ScenarioError) as caught:
        scenario_of(document)
    (finding,) = caught.value.findings
    assert finding.problem.startswith("from 30 to 35 km the tracks are tied everywhere")
    assert 'tracks_tied = "posts"' in finding.remedy
    del section["track"]
    scenario_of(document)


def test_none_applies_unless_it_is_chosen():
    plain = short_line()
    held = short_line({"outages": [{"name": "East out", "stations": ["East"]}]})
    assert held.outage is None
    assert held.digest() == plain.digest()
    chosen = held.with_outage("East out")
    assert chosen.outage.stations == ("East",)
    assert chosen.name == "short-line-East-out"
    assert chosen.digest() != plain.digest()


def test_an_outage_that_there_is_not_is_told_with_those_that_there_are():
    with pytest.raises(ScenarioError) as caught:
        short_line({"outages": [{"name": "East out", "stations": ["East"]}]}).with_outage("Est out")
    (finding,) = caught.value.findings
    assert "did you mean East out?" in finding.remedy


def test_an_outage_survives_the_document():
    document = copy.deepcopy(SHORT_LINE)
    document["outages"] = [
        {"name": "06:00-06:30", "units": {"West": 1}, "from_min": 30.0, "to_min": 60.0}
    ]
    scenario = tpss.Scenario.from_document(document)
    again = tpss.Scenario.from_document(scenario.as_document())
    assert again == scenario
    assert again.outages[0].in_words == "1 of West's units out, from 30 min to 60 min"


def test_an_outage_in_words_tells_switches_and_sections():
    sections = [{"from_km": 5.0, "to_km": 9.0, "track": 1}, {"from_km": 12.0}]
    scenario = short_line(outage(opens=["West>line"], sections=sections))
    assert scenario.outages[0].in_words == (
        "West>line open, contact line 5-9 km of track 1 out, contact line from 12 km on out"
    )
