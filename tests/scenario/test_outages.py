"""Outages of a scenario: what they name, how one is chosen, and what is found at fault."""

import copy

import pytest

import tpss
from faults import FILE, HV, WEST, faults_of, finding_at
from tpss import ScenarioError

from scenarios import SHORT_LINE, short_line

OUT = "outages.0"


def outage(**keys):
    return {"outages": [{"name": "a", **keys}]}


@pytest.mark.parametrize(
    ("changes", "key", "value", "remedy"),
    [
        pytest.param(outage(), OUT, "", "give stations, units, transformers_km or opens", id="nothing"),
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
    ],
)  # fmt: skip
def test_a_fault_of_an_outage_is_reported_with_place_value_and_remedy(changes, key, value, remedy):
    finding = finding_at(key, faults_of(changes))
    assert finding.file == str(FILE)
    assert finding.value.startswith(value)
    assert finding.problem
    assert remedy in finding.remedy


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
