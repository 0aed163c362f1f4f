"""Variants of a scenario: what they change, and what is wrong with them."""

import copy
import math

import pytest

import tpss
from tpss.scenario.variants import Variant, apply_variant

from scenarios import SHORT_LINE, short_line

MID = {"name": "Mid", "position_km": 10.0, "type": "Q48/Q49", "converters": 1}


def with_variants(**variants) -> tpss.Scenario:
    return tpss.Scenario.from_document({**copy.deepcopy(SHORT_LINE), "variants": variants}, "short")


def test_a_variant_is_a_scenario_of_its_own_that_is_named_after_both():
    scenario = with_variants(
        AT={"description": "another catenary", "set": {"supply.catenary": "AT"}}
    )
    varied = scenario.variant("AT")
    assert (varied.name, varied.description) == ("short-line-AT", "another catenary")
    assert varied.variants == {}
    assert varied == scenario.with_(
        {"supply.catenary": "AT", "name": "short-line-AT", "description": "another catenary",
         "variants": None}
    )  # fmt: skip
    assert "variants" not in varied.as_document()


def test_sets_come_before_additions_and_these_before_what_is_taken_out():
    scenario = with_variants(
        other={
            "set": {
                "supply.converter_stations.*.converters": 4,
                "traffic.eastbound.headway_min": 9.0,
            },
            "add": {"supply.converter_stations": [MID]},
            "remove": ["supply.converter_stations.East", "line.stations.Middle"],
        }
    ).variant("other")
    stations = [(each.name, each.converters) for each in scenario.supply.converter_stations]
    assert stations == [("West", 4), ("Mid", 1)]
    assert [station.name for station in scenario.line.stations] == ["West", "East"]
    assert scenario.traffic[0].headway_min == 9.0


def test_keys_may_be_nested_and_a_quoted_path_replaces_a_table_as_a_whole():
    own = {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.2}
    nested = {"traffic": {"*": {"headway_min": 9.0}}, "simulation": {"rail": "wet"}}
    scenario = with_variants(it={"set": {**nested, "supply.catenary": own}}).variant("it")
    assert scenario.traffic[0].headway_min == 9.0
    assert (scenario.simulation.rail, scenario.simulation.time_step_min) == ("wet", 0.05)
    assert scenario.supply.catenary.r_ohm_per_km == 0.1


def test_variants_are_no_part_of_what_a_scenario_is_told_apart_by():
    assert with_variants(wet={"set": {"simulation.rail": "wet"}}).digest() == short_line().digest()


@pytest.mark.parametrize(
    ("variant", "key", "words"),
    [
        ({"set": {"traffic.westbound.headway_min": 9.0}},
         "variants.it.set.traffic.westbound.headway_min", "name one of eastbound"),
        ({"add": {"line.length_km": [1.0]}}, "variants.it.add.line.length_km.+", "is a value"),
        ({"remove": ["line.stations.Nord"]}, "variants.it.remove", "name one of West, Middle, East"),
        ({"remove": ["traffic.0.departures_min"]}, "variants.it.remove", "name what the scenario has"),
    ],
)  # fmt: skip
def test_a_path_to_nowhere_is_told_with_its_variant(variant, key, words):
    with pytest.raises(tpss.ScenarioError) as caught:
        with_variants(it=variant).variant("it")
    (finding,) = caught.value.findings
    assert finding.key == key
    assert words in finding.remedy


def test_faults_of_a_changed_scenario_name_the_variant_and_one_that_there_is_not_the_others():
    scenario = with_variants(it={"set": {"supply.catenary": "BTX"}})
    with pytest.raises(tpss.ScenarioError, match=r"\(variant it\): supply.catenary = 'BTX'"):
        scenario.variant("it")
    with pytest.raises(tpss.ScenarioError, match=r"no such variant\n.*variants: it"):
        scenario.variant("other")


@pytest.mark.parametrize(
    ("variants", "words"),
    [
        ({"it": {}}, "it changes nothing"),
        ({"all": {"set": {"description": "x"}}}, "stands for all of them"),
        ({"a/b": {"set": {"description": "x"}}}, "variants"),
        ({"it": {"replace": {}}}, "unknown key"),
        (
            {"it": {"set": {"line": {"length_km": math.nan}}}},
            "line.length_km has a number that is not",
        ),
        (
            {"it": {"add": {"traffic": [{"headway_min": math.inf}]}}},
            "traffic has a number that is not",
        ),
    ],
)
def test_a_variant_that_cannot_be_is_a_fault(variants, words):
    with pytest.raises(tpss.ScenarioError, match=words):
        with_variants(**variants)


def test_a_document_is_left_as_it_is():
    document = copy.deepcopy(SHORT_LINE)
    variant = Variant.model_validate({"set": {"supply.catenary": "AT"}})
    changed = apply_variant(document, "AT", variant, "short")
    assert changed["supply"]["catenary"] == "AT"
    assert document == SHORT_LINE
