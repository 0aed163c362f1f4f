"""The plan file: what it says, and what is wrong with it."""

import tomllib

import jsonschema
import pytest
import tomli_w

import tpss
from tpss.planning.load import load_plan
from tpss.planning.schema import plan_schema

from conftest import EXAMPLES
from small_plans import LINE, PLAN, changed, plan, write_plan


def findings(folder, changes):
    with pytest.raises(tpss.ScenarioError) as caught:
        plan(folder, changes)
    return caught.value.findings


def test_a_plan_says_what_may_be_built_and_what_may_come(tmp_path):
    loaded = plan(tmp_path)
    (area,) = loaded.areas
    assert list(area.measures) == ["Mid", "AT"]
    assert area.measures["AT"].costs == (40.0,)
    assert loaded.file.stages.years == (10, 10)
    assert {name: each.probability for name, each in loaded.futures.items()} == {
        "low": 0.6, "high": 0.4,
    }  # fmt: skip
    assert loaded.file.economics.train_not_run["freight"].source == "assumed"
    assert loaded.file.economics.energy_per_kwh.value == 0.65e-6


def test_without_scenarios_todays_traffic_stays(tmp_path):
    loaded = plan(tmp_path, {"scenarios": None})
    assert [each.probability for each in loaded.futures.values()] == [1.0]


def test_a_measure_like_another_has_its_keys_but_for_its_own(tmp_path):
    far = {"like": "Mid", "title": "Another", "cost": 30.0}
    loaded = plan(tmp_path, {"measures/Far": far})
    measure = loaded.areas[0].measures["Far"]
    assert (measure.title, measure.costs, measure.lifetime_years) == ("Another", (30.0,), 40.0)
    assert measure.additions["supply.converter_stations"]["name"] == "Mid"


def test_areas_have_scenarios_measures_and_traffic_of_their_own(tmp_path):
    (tmp_path / "other.toml").write_text(tomli_w.dumps({**LINE, "name": "other"}), "utf-8")
    own = {"set": {"supply.catenary": "AT"}, "cost": 40.0, "lifetime_years": 40}
    loaded = plan(
        tmp_path,
        {
            "scenario": None,
            "areas": {"north": {"scenario": "line.toml"}, "south": {"scenario": "other.toml"}},
            "measures": {"north": {"AT": own}, "south": {"AT": {"like": "north.AT", "cost": 50.0}}},
            "scenarios": {
                "all": {"probability": 1.0, "south": {"traffic.eastbound.headway_min": [20, 5]}}
            },
        },
    )
    assert [area.name for area in loaded.areas] == ["north", "south"]
    assert [area.measures["AT"].costs for area in loaded.areas] == [(40.0,), (50.0,)]
    assert [area.today.name for area in loaded.areas] == ["short-line", "other"]


BAD = {
    "probabilities": (
        {"scenarios/low/probability": 0.5},
        "scenarios", "add up to 0.9, not to 1", "by +0.1 in all",
    ),
    "price of another year": (
        {"measures/AT/price_year": 2022},
        "measures.AT.price_year", "another year than the plan's, 2024", "convert it",
    ),
    "energy of another year": (
        {"economics/energy_per_kwh": {"value": 1e-6, "price_year": 2015}},
        "economics.energy_per_kwh.price_year", "another year", "prices of 2024",
    ),
    "no price": (
        {"economics/train_not_run": {}},
        "economics.train_not_run.freight", "the price is missing", "add it",
    ),
    "no price of a minute": (
        {"economics/lost_minute": None},
        "economics.lost_minute.freight", "the price is missing", "add it",
    ),
    "no cost": ({"measures/Mid/cost": None}, "measures.Mid.cost", "it is missing", "add it"),
    "a stage without a value": (
        {"scenarios/high/traffic.eastbound.headway_min": [20.0]},
        "scenarios.high.traffic.eastbound.headway_min", "1 values for 2 stages", "add one for 2040",
    ),
    "no life": (
        {"measures/Mid/lifetime_years": 0},
        "measures.Mid.lifetime_years", "out of range", "greater than 0",
    ),
    "a budget without a stage": (
        {"budget": {"per_stage": [10.0]}},
        "budget.per_stage", "1 values for 2 stages", "one for each stage",
    ),
    "a measure beyond all numbers": (
        {"measures/AT/set": {"line.length_km": float("nan")}},
        "measures.AT.set", "line.length_km has a number that is not finite", "a finite number",
    ),
    "an unknown measure": (
        {"measures/AT/excludes": ["Middle"]},
        "measures.AT.excludes", "no such measure", "Mid",
    ),
    "an unknown price": (
        {"scenarios/low/economics.energy_per_mwh": [1.0, 2.0]},
        "scenarios.low.economics.energy_per_mwh", "no such price", "energy_per_kwh",
    ),
    "a price that is none": (
        {"scenarios/low/economics.energy_per_kwh": [1.0, -2.0]},
        "scenarios.low.economics.energy_per_kwh", "not a price", "numbers",
    ),
    "costs without levels": (
        {"measures/AT/cost": [1.0, 2.0]},
        "measures.AT", "2 costs where 1 may be built", "one cost for each",
    ),
    "stages in another order": (
        {"stages/start": [2040, 2030]},
        "stages.start", "does not increase", "ascending",
    ),
    "an end before the beginning": (
        {"stages/end": 2035}, "stages", "the last stage begins in 2040", "after the last start",
    ),
    "a lead longer than all stages": (
        {"measures/Mid/lead_time_years": 12, "measures/AT/lead_time_years": 12},
        "measures.Mid.lead_time_years", "nothing is in service", "shorten the lead time",
    ),
    "leads of different stages": (
        {"measures/Mid/lead_time_years": 5},
        "measures.*.lead_time_years", "different stages: of Mid and AT", "lengthen the shorter",
    ),
    "a measure that comes at no stage": (
        {"measures/Mid/earliest": 2045}, "measures.Mid", "no stage begins", "2030, 2040",
    ),
    "a renewal that comes too late": (
        {"renewals": {"line": {"year": 2060, "cost": 1.0, "lifetime_years": 40}}},
        "renewals.line.year", "from 2030 until 2050", "change it",
    ),
    "an unknown outage": (
        {"require/also_with": ["two out"]}, "require.also_with", "no such outage", "one out",
    ),
    "an outage that ends": (
        {"require/also_with": ["a while"]}, "require.also_with", "a part of a run", "without from_min",
    ),
    "a requirement of which the scenario tells nothing": (
        {"require/rail_short_v": 90.0}, "require.rail_short_v", "the scenario does not tell it",
        "write supply.conductors, or leave the requirement out",
    ),
    "itself alike": (
        {"measures/AT/like": "Mid", "measures/Mid/like": "AT"},
        "measures.AT.like", "in a circle", "all its keys",
    ),
    "an unknown key": ({"measures/AT/sets": {}}, "measures.AT.sets", "unknown key", "set"),
    "no scenario": ({"scenario": "lines.toml"}, "scenario", "1 fault(s)", "name another"),
    "an unknown area": (
        {
            "scenario": None, "areas": {"north": {"scenario": "line.toml"}},
            "measures": {"noth": PLAN["measures"]}, "scenarios": None,
        },
        "measures.noth", "no such area", "north",
    ),
    "two kinds of lines": (
        {"areas": {"north": {"scenario": "line.toml"}}}, "", "either scenario or areas", "name one",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "key", "problem", "remedy"), BAD.values(), ids=BAD)
def test_a_fault_is_named_with_its_remedy(tmp_path, changes, key, problem, remedy):
    found = [each for each in findings(tmp_path, changes) if each.key == key]
    assert found, findings(tmp_path, changes)
    assert found[0].file.endswith("plan.toml")
    assert any(problem in each.problem and remedy in each.remedy for each in found), found


def test_a_scenario_is_no_plan(tmp_path):
    write_plan(tmp_path)
    with pytest.raises(tpss.ScenarioError, match="a scenario, not a plan"):
        load_plan(tmp_path / "line.toml")
    with pytest.raises(tpss.ScenarioError, match="a plan, not a scenario"):
        tpss.load_scenario(tmp_path / "plan.toml")


def test_the_schema_knows_what_a_plan_may_say(tmp_path):
    schema = plan_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    example = tomllib.loads((EXAMPLES / "plan_320km.toml").read_text("utf-8"))
    assert list(validator.iter_errors(example)) == []
    assert list(validator.iter_errors(PLAN)) == []
    assert list(validator.iter_errors(changed({"measures/AT/sets": {}})))
    assert list(validator.iter_errors(changed({"measures/AT/cost": None})))
    assert list(validator.iter_errors(changed({"areas": {"a": {"scenario": "b.toml"}}})))


def test_every_key_of_the_schema_is_described():
    schema = plan_schema()
    for part in (schema, *schema["$defs"].values()):
        assert all(field.get("description") for field in part["properties"].values()), part
