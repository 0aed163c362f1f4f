"""Key paths: keys, numbers and names, all of a list, one more of it, and what is taken out."""

import pytest

import tpss
from tpss.scenario.paths import NoSuchPlaceError, places_of

from scenarios import SHORT_LINE, short_line

STATION = {"position_km": 10.0, "type": "Q48/Q49", "converters": 1}


@pytest.mark.parametrize(
    ("path", "places"),
    [
        ("traffic.0.headway_min", ["traffic.0.headway_min"]),
        ("traffic.eastbound.headway_min", ["traffic.0.headway_min"]),
        ("supply.converter_stations.East.converters", ["supply.converter_stations.1.converters"]),
        ("supply.converter_stations.*.name",
         ["supply.converter_stations.0.name", "supply.converter_stations.1.name"]),
        ("trains.*.mass_t", ["trains.freight.mass_t"]),
        ("line.stations.+", ["line.stations.3"]),
        ("line.curves.+", ["line.curves.0"]),
        ("line.speed_limits_down.*.from_km", []),
        ("standards.peak_from_min", ["standards.peak_from_min"]),
    ],
)  # fmt: skip
def test_a_path_names_places(path, places):
    assert places_of(SHORT_LINE, path) == places


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("supply.converter_stations.Nord.converters", "name one of West, East, or give its number"),
        ("line.gradients.7.permille", "give an item's number from 0 to 0"),
        ("line.length_km.x", "line.length_km is a value; name tables by their keys"),
    ],
)
def test_a_path_to_nowhere_says_what_there_is(path, words):
    with pytest.raises(NoSuchPlaceError, match=words):
        places_of(SHORT_LINE, path)
    with pytest.raises(tpss.ScenarioError, match=words):
        short_line({path: 1.0})


def test_all_items_change_at_once_and_by_name():
    scenario = short_line(
        {"supply.converter_stations.*.converters": 3, "traffic.eastbound.headway_min": 8.0}
    )
    assert [station.converters for station in scenario.supply.converter_stations] == [3, 3]
    assert scenario.traffic[0].headway_min == 8.0


def test_one_more_item_comes_behind_the_others():
    scenario = short_line({"supply.converter_stations.+": {"name": "Mid", **STATION}})
    names = [station.name for station in scenario.supply.converter_stations]
    assert names == ["West", "East", "Mid"]
    first = {"from_km": 1.0, "to_km": 2.0, "radius_m": 400.0}
    assert len(short_line({"line.curves.+": first}).line.curves) == 1


def test_what_is_none_is_taken_out_of_tables_and_lists():
    scenario = short_line(
        {"line.stations.Middle": None, "traffic.0.headway_min": None,
         "traffic.0.departures_min": [0.0, 5.0]}
    )  # fmt: skip
    assert [station.name for station in scenario.line.stations] == ["West", "East"]
    assert scenario.traffic[0].departures_min == (0.0, 5.0)
    with pytest.raises(tpss.ScenarioError, match=r"line\.stations"):
        short_line({"line.stations.*": None})
