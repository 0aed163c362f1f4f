"""What a train is under the system of the supply: data by system, models of the library, limits."""

import copy
from typing import Any

import pytest

import tpss
from tpss import library
from tpss.scenario.of_the_system import under_its_system

from direct_scenarios import UNIT, direct_document
from scenarios import SHORT_LINE

FREIGHT = "freight-1600t multi-system (estimate)"


def scenario(system: str, train: dict[str, Any]) -> tpss.Scenario:
    """A short line of a system with a train."""
    document = direct_document(system) if system.startswith("DC-") else copy.deepcopy(SHORT_LINE)
    document["supply"]["system"] = system
    document["trains"] = {"unit": train}
    for service in document["traffic"]:
        service["train"] = "unit"
    return tpss.Scenario.from_document(document)


BOTH = {
    **{key: value for key, value in UNIT.items() if key != "regeneration"},
    "power_factor": 1.0,
    "by_system": {
        "DC-3kV": {"efficiency": 0.9,
                   "tractive_effort": {"max_force_kn": 180.0, "max_power_kw": 1_500.0}},
        "DC-1.5kV": {"tractive_effort": {"max_force_kn": 150.0, "max_power_kw": 900.0}},
    },
}  # fmt: skip


@pytest.mark.parametrize(
    ("system", "power_kw", "efficiency"),
    [("DC-3kV", 1_500.0, 0.9), ("DC-1.5kV", 900.0, 0.85), ("DC-0.75kV", 2_000.0, 0.85),
     ("25kV-50Hz", 2_000.0, 0.85)],
)  # fmt: skip
def test_the_data_of_the_supply_s_system_take_the_place_of_the_others(
    system: str, power_kw: float, efficiency: float
) -> None:
    made = scenario(system, BOTH)
    train = made.trains["unit"]
    assert train.tractive_effort.max_power_kw == power_kw  # type: ignore[union-attr]
    assert train.efficiency == efficiency
    assert "by_system" not in made.as_document()["trains"]["unit"]
    assert tpss.Scenario.from_document(made.as_document()) == made


def test_a_scenario_of_another_system_has_the_other_data() -> None:
    given = {**BOTH, "by_system": {"25kV-50Hz": {"mass_t": 170.0}}}
    one = scenario("15kV-16.7Hz", given)
    other = one.with_({"supply.system": "25kV-50Hz"})
    assert (one.trains["unit"].mass_t, other.trains["unit"].mass_t) == (150.0, 170.0)


def test_a_model_of_several_systems_gives_its_power_under_each() -> None:
    for system, power_kw in (("15kV-16.7Hz", 6_400.0), ("DC-3kV", 6_000.0), ("DC-1.5kV", 4_000.0)):
        train = scenario(system, {"model": FREIGHT}).trains["unit"]
        assert train.tractive_effort.max_power_kw == power_kw  # type: ignore[union-attr]
        assert (train.current_limitation is None) == (not system.startswith("DC"))


def test_what_a_scenario_says_goes_before_its_model_s_data_by_system() -> None:
    mine = {"model": FREIGHT, "efficiency": 0.8}
    assert scenario("DC-3kV", mine).trains["unit"].efficiency == 0.8
    own = {**mine, "by_system": {"DC-3kV": {"efficiency": 0.7}}}
    assert scenario("DC-3kV", own).trains["unit"].efficiency == 0.7


@pytest.mark.parametrize("name", library.entries("locomotives"))
def test_models_of_the_library_run_on_a_line_of_each_of_their_systems(name: str) -> None:
    values = library.values("locomotives", name)
    for system in values.get("systems", ["15kV-16.7Hz"]):
        train = scenario(system, {"model": name}).trains["unit"]
        assert train.mass_t == values["mass_t"]
        limit = train.current_limitation
        assert limit is None or limit.un_kv == library.values("systems", system)["nominal_kv"]


@pytest.mark.parametrize(
    ("system", "knee", "umin2_kv"),
    [("DC-3kV", 0.9, 2.0), ("DC-1.5kV", 0.9, 1.0), ("DC-0.75kV", 0.8, 0.5), ("DC-0.6kV", 0.8, 0.4),
     ("25kV-50Hz", 0.9, 17.5), ("15kV-16.7Hz", 0.95, 11.0)],
)  # fmt: skip
def test_a_current_limitation_is_that_of_the_system_unless_it_says_otherwise(
    system: str, knee: float, umin2_kv: float
) -> None:
    given = {**BOTH, "by_system": {}, "current_limitation": {"max_current_a": 1_000.0}}
    limit = scenario(system, given).trains["unit"].current_limitation
    assert limit is not None
    nominal_kv = library.values("systems", system)["nominal_kv"]
    assert (limit.un_kv, limit.knee_factor, limit.umin2_kv) == (nominal_kv, knee, umin2_kv)


def test_what_a_limitation_with_a_nominal_voltage_leaves_out_is_as_before() -> None:
    own = {"max_current_a": 500.0, "un_kv": 25.0, "umin2_kv": 17.5}
    given = {**BOTH, "by_system": {}, "current_limitation": own}
    limit = scenario("25kV-50Hz", given).trains["unit"].current_limitation
    assert limit is not None
    assert limit.knee_factor == 0.95


FAULTS = {
    "a model of another system": (
        "DC-1.5kV", {"model": "metro-278t"}, "trains.unit.model",
        "a train for DC-0.75kV, and the system of the supply is DC-1.5kV",
    ),
    "systems of one's own": (
        "DC-3kV", {**BOTH, "systems": ["DC-1.5kV"]}, "trains.unit.systems", "a train for DC-1.5kV",
    ),
    "an unknown system": (
        "DC-3kV", {**BOTH, "by_system": {"DC-3KV": {}}}, "trains.unit.by_system.DC-3KV",
        "no such system",
    ),
    "an unknown key": (
        "DC-3kV", {**BOTH, "by_system": {"DC-1.5kV": {"power_kw": 3.0}}},
        "trains.unit.by_system.DC-1.5kV.power_kw", "no key of a train there",
    ),
    "no table": (
        "DC-3kV", {**BOTH, "by_system": {"DC-1.5kV": 3.0}}, "trains.unit.by_system.DC-1.5kV", "no table",
    ),
    "no tables": ("DC-3kV", {**BOTH, "by_system": 3.0}, "trains.unit.by_system", "dict"),
    "a value out of range": (
        "DC-3kV", {**BOTH, "by_system": {"DC-3kV": {"mass_t": -1.0}}}, "trains.unit.mass_t", "range",
    ),
    "no systems at all": ("DC-3kV", {**BOTH, "systems": []}, "trains.unit.systems", ""),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_once_with_its_place(name: str) -> None:
    system, train, key, problem = FAULTS[name]
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario(system, train)
    (finding,) = caught.value.findings
    assert finding.key == key
    if name != "no tables":
        assert problem in finding.problem


def test_documents_without_a_known_system_are_left_as_they_are() -> None:
    document = {"supply": {"system": "steam"}, "trains": {"unit": BOTH}}
    assert under_its_system(document) is document
