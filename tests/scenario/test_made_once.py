"""Parts of scenarios that say the same are one part, whatever scenario they stand in."""

import copy

import pytest

import tpss
from tpss.errors import ScenarioError

from scenarios import SHORT_LINE


def _made(change=lambda document: None):
    document = copy.deepcopy(SHORT_LINE)
    change(document)
    return tpss.Scenario.from_document(document)


def test_scenarios_with_other_traffic_share_line_supply_and_trains():
    one = _made()
    other = _made(lambda document: document["traffic"][0].update(headway_min=30.0))
    assert one.line is other.line
    assert one.supply is other.supply
    assert one.trains["freight"] is other.trains["freight"]


def test_a_part_that_says_something_else_is_another_one():
    """A whole number equals a float in Python, and is one in no file: it is told apart too."""
    one = _made()
    stronger = _made(lambda d: d["supply"]["converter_stations"][0].update(converters=3))
    assert one.supply is not stronger.supply
    assert stronger.supply.stations[0].installed == 3
    whole = _made(lambda document: document["line"].update(length_km=20))
    assert whole.line is not one.line
    assert whole.line == one.line


def test_faults_are_told_each_time():
    def spoil(document):
        document["supply"]["converter_stations"][0]["converters"] = -1

    told = []
    for _ in range(2):
        with pytest.raises(ScenarioError) as caught:
            _made(spoil)
        told.append(str(caught.value))
    assert told[0] == told[1]
    assert "converter_stations.0.converters" in told[0]


def test_a_train_with_a_law_of_another_package_is_not_shared():
    """Another law may have been registered under its name in the meantime."""
    from tpss.scenario.made_once import OF_LAWS, _told

    class Info:
        mode, context = "python", None

    assert _told({"mass_t": 10.0}, Info()) == _told({"mass_t": 10.0}, Info())
    assert OF_LAWS in b"resistance_law"
    assert _told({"resistance_law": {"law": "tunnel"}}, Info()) is None
