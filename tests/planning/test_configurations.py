"""Configurations: which sets of measures may stand together, and that each is a valid scenario."""

import pytest

import tpss
from tpss.planning.configurations import check_configurations, configurations_of, document_of
from tpss.planning.states import State, states_of
from tpss.scenario.scenario import Scenario

from small_plans import plan

MID = {
    "set": {"supply.converter_stations.West.converters": "{level}"},
    "levels": [3, 4],
    "cost": [10.0, 18.0],
    "lifetime_years": 40,
}
"""Converters of the western station, of which there are two today."""


def names(loaded):
    return [each.name for each in configurations_of(loaded.areas[0], "plan.toml")]


def scenario(loaded, name, state=None):
    area = loaded.areas[0]
    found = {each.name: each for each in configurations_of(area, "plan.toml")}[name]
    document = document_of(loaded, area, found, state or State({}))
    return Scenario.from_own_document(document, area.source)


def test_all_sets_of_measures_todays_first(tmp_path):
    assert names(plan(tmp_path)) == ["as today", "AT", "Mid", "Mid+AT"]


def test_a_measure_that_excludes_another_does_not_stand_beside_it(tmp_path):
    loaded = plan(tmp_path, {"measures/AT/excludes": ["Mid"]})
    assert names(loaded) == ["as today", "AT", "Mid"]


def test_a_measure_stands_with_what_it_needs_only(tmp_path):
    loaded = plan(tmp_path, {"measures/AT/needs": ["Mid"]})
    assert names(loaded) == ["as today", "Mid", "Mid+AT"]


def test_of_levels_one_is_built(tmp_path):
    loaded = plan(tmp_path, {"measures/West": MID, "measures/AT": None})
    assert names(loaded) == ["as today", "West=3", "West=4", "Mid", "Mid+West=3", "Mid+West=4"]
    converters = [
        each.converters for each in scenario(loaded, "Mid+West=4").supply.converter_stations
    ]
    assert converters == [4, 2]


def test_a_configuration_is_todays_scenario_with_the_changes_of_its_measures(tmp_path):
    loaded = plan(tmp_path)
    built = scenario(loaded, "Mid+AT")
    assert [each.name for each in built.supply.converter_stations] == ["West", "Mid"]
    today = scenario(loaded, "as today")
    assert today.supply == loaded.areas[0].today.supply
    assert built.supply.catenary != today.supply.catenary


def test_states_of_traffic_are_those_that_futures_ask_for(tmp_path):
    """Low: 20 and 20 min; high: 20 and 5 min. Two states; both futures begin alike."""
    loaded = plan(tmp_path)
    states = states_of(loaded, loaded.areas[0])
    assert [each.values["traffic.eastbound.headway_min"] for each in states.states] == [20.0, 5.0]
    assert states.places == ((0, 0), (0, 1))
    dense = scenario(loaded, "AT", states.states[1])
    assert dense.traffic[0].headway_min == 5.0


def faults(folder, changes):
    loaded = plan(folder, changes)
    area = loaded.areas[0]
    with pytest.raises(tpss.ScenarioError) as caught:
        check_configurations(
            loaded, area, configurations_of(area, "plan.toml"), states_of(loaded, area)
        )
    return caught.value.findings


def test_a_measure_at_a_taken_place_is_named(tmp_path):
    """West stands at 0 km. That it is at fault together with others too is not said."""
    taken = {"name": "Mid", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
    (finding,) = faults(tmp_path, {"measures/Mid/add": {"supply.converter_stations": taken}})
    assert finding.key == "measures.Mid"
    assert "no valid scenario" in finding.problem
    assert finding.file.endswith("plan.toml")


def test_two_measures_at_one_place_are_named_together(tmp_path):
    station = {"name": "Other", "position_km": 10.0, "type": "Q48/Q49", "converters": 2}
    other = {"like": "Mid", "add": {"supply.converter_stations": station}}
    (finding,) = faults(tmp_path, {"measures/Other": other})
    assert finding.key == "measures.Mid and measures.Other"
    assert "together they make no valid scenario" in finding.problem
    assert "excludes" in finding.remedy


def test_a_change_that_leads_nowhere_is_named(tmp_path):
    (finding,) = faults(tmp_path, {"measures/AT/set": {"supply.converter_stations.Nord.x": 1}})
    assert finding.key.startswith("measures.AT.set.")
    assert "West" in finding.remedy


def test_a_traffic_that_is_no_valid_scenario_is_named(tmp_path):
    path = "scenarios/high/traffic.eastbound.headway_min"
    (finding,) = faults(tmp_path, {path: [20.0, -5.0]})
    assert finding.key == "scenarios"
    assert "traffic.eastbound.headway_min = -5.0" in finding.problem


def test_a_value_of_a_future_that_leads_nowhere_is_named(tmp_path):
    found = faults(tmp_path, {"scenarios/high/traffic.westbound.headway_min": [20.0, 5.0]})
    assert [each.key for each in found] == ["scenarios.high.traffic.westbound.headway_min"]
    assert found[0].value == "[20.0, 5.0]"


def test_cases_need_a_common_time_step(tmp_path):
    loaded = plan(tmp_path)
    loaded.areas[0].document["simulation"] = {}
    area = loaded.areas[0]
    with pytest.raises(tpss.ScenarioError, match=r"evaluate\.time_step_min"):
        check_configurations(
            loaded, area, configurations_of(area, "plan.toml"), states_of(loaded, area)
        )
