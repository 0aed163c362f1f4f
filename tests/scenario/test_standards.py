"""By what a result is judged: limits of the library, any of them changed, a peak window, zones."""

import pytest

import tpss
from tpss import ScenarioError, library
from tpss.scenario.standards import VoltageLimits

from direct_scenarios import direct_scenario
from scenarios import short_line

LIMITS = "standards.voltage_limits"


def test_a_scenario_that_says_nothing_is_judged_by_the_limits_of_15_kv():
    standards = short_line().standards
    limits = standards.voltage_limits
    found = (limits.umin2_kv, limits.umin1_kv, limits.un_kv, limits.umax1_kv, limits.umax2_kv)
    assert found == (11.0, 12.0, 15.0, 17.25, 18.0)
    assert (limits.longest_low_min, limits.longest_high_min) == (2.0, 5.0)
    assert (limits.mean_useful_kv, limits.mean_useful_fast_kv) == (13.5, 14.2)
    assert (standards.peak_from_min, standards.peak_to_min, standards.zones) == (0.0, None, ())


def test_any_figure_may_be_changed_alone():
    limits = short_line({f"{LIMITS}.umin1_kv": 12.5}).standards.voltage_limits
    assert (limits.umin1_kv, limits.umin2_kv) == (12.5, 11.0)


ELEVEN_KV = {
    f"{LIMITS}.{key}": value
    for key, value in {
        "un_kv": 11.0, "umin2_kv": 8.0, "umin1_kv": 9.0, "umax1_kv": 17.0, "umax2_kv": 18.0,
    }.items()
}  # fmt: skip
"""Limits of one's own, of a nominal voltage of 11 kV."""


@pytest.mark.parametrize(
    ("given", "useful", "fast"),
    [
        ({}, None, None),
        ({"mean_useful_kv": 10.0}, 10.0, None),
        ({"mean_useful_fast_kv": 10.5}, None, 10.5),
        ({"un_kv": 15.0}, 13.5, 14.2),
    ],
)
def test_the_useful_voltage_of_the_library_is_not_that_of_another_nominal_voltage(
    given, useful, fast
):
    changes = {**ELEVEN_KV, **{f"{LIMITS}.{key}": value for key, value in given.items()}}
    scenario = short_line(changes)
    limits = scenario.standards.voltage_limits
    assert (limits.mean_useful_kv, limits.mean_useful_fast_kv) == (useful, fast)
    again = type(scenario).from_document(scenario.as_document())
    assert again.standards.voltage_limits == limits


def test_a_line_of_another_nominal_voltage_is_not_held_against_13_5_kv():
    result = tpss.simulate(short_line({**ELEVEN_KV, "simulation.duration_min": 5.0}))
    assert result.standards.least_useful_voltage_kv is None
    assert set(result.standards.useful_voltage_trains.verdict) == {""}
    assert set(result.standards.useful_voltage_zones.verdict) == {""}


@pytest.mark.parametrize("system", library.entries("systems"))
def test_the_result_is_judged_by_the_limits_of_the_supply_s_system(system):
    """The stations of the short line feed 16.5 kV, which both alternating systems' bands hold."""
    line = direct_scenario(system) if system.startswith("DC") else short_line()
    assert line.with_({"supply.system": system}).standards.voltage_limits.system == system
    named = line.with_({"supply.system": system, f"{LIMITS}.system": system})
    assert named.standards.voltage_limits == VoltageLimits(system=system)


@pytest.mark.parametrize("system", sorted({*library.entries("voltage_limits")} - {"15kV-16.7Hz"}))
def test_limits_of_another_system_are_a_fault(system):
    with pytest.raises(ScenarioError) as caught:
        short_line({f"{LIMITS}.system": system})
    (finding,) = caught.value.findings
    assert finding.key == f"{LIMITS}.system"
    assert "the limits of another system than that of the supply, 15kV-16.7Hz" in finding.problem


def test_a_current_limitation_of_another_system_is_a_fault():
    limitation = {"max_current_a": 300.0, "un_kv": 15.0}
    with pytest.raises(ScenarioError) as caught:
        short_line({"supply.system": "25kV-50Hz", "trains.freight.current_limitation": limitation})
    (finding,) = caught.value.findings
    assert finding.key == "trains.freight.current_limitation.un_kv"
    assert "leave un_kv, umin2_kv and knee_factor out" in finding.remedy


@pytest.mark.parametrize("system", library.entries("voltage_limits"))
def test_every_entry_says_where_it_is_from(system):
    source = library.entries("voltage_limits")[system]["source"]
    assert "[EN50163]_" in source
    assert "check your edition" in source


def test_the_document_holds_the_limits_so_that_the_run_can_be_judged_again():
    document = short_line({f"{LIMITS}.umin1_kv": 12.5}).as_document()
    assert document["standards"]["voltage_limits"]["umin1_kv"] == 12.5
    assert document["standards"]["voltage_limits"]["umax2_kv"] == 18.0
    assert type(short_line()).from_document(document).as_document() == document


@pytest.mark.parametrize(
    ("changes", "key", "problem", "remedy"),
    [
        ({f"{LIMITS}.umin1_kv": 10.0}, LIMITS,
         "umin2_kv (11.0 kV) is more than umin1_kv (10.0 kV)", "keep to the order"),
        ({f"{LIMITS}.umin1": 12.0}, f"{LIMITS}.umin1", "unknown key", "did you mean umin1_kv?"),
        ({f"{LIMITS}.system": "25kV"}, f"{LIMITS}.system", "the library has no such entry",
         "did you mean 25kV-50Hz?"),
        ({f"{LIMITS}.umin1_kv": "12 kV"}, f"{LIMITS}.umin1_kv", "not a number",
         "write a number in kV"),
        ({f"{LIMITS}.longest_low_min": -1.0}, f"{LIMITS}.longest_low_min", "out of range",
         "greater than or equal to 0 min"),
        ({"standards.peak_from_min": 30.0, "standards.peak_to_min": 30.0}, "standards",
         "peak_to_min (30.0) does not lie beyond peak_from_min (30.0)", "raise peak_to_min"),
        ({"standards.zones": [{"name": "a", "from_km": 5.0, "to_km": 5.0}]}, "standards.zones.0",
         "to_km (5.0) does not lie beyond from_km (5.0)", "raise to_km"),
        ({"standards.zones": [{"name": "a", "from_km": 5.0, "to_km": 25.0}]},
         "standards.zones.0.to_km", "outside the line, which runs from 0 to 20 km",
         "between 0 and 20 km"),
        ({"standards.zones": [{"name": "a", "from_km": 0.0, "to_km": 5.0}] * 2},
         "standards.zones", "name a occurs twice", "give each one its own"),
        ({"standards": {"zone": []}}, "standards.zone", "unknown key", "did you mean zones?"),
    ],
)  # fmt: skip
def test_a_fault_is_told_with_its_place_and_a_remedy(changes, key, problem, remedy):
    with pytest.raises(ScenarioError) as caught:
        short_line(changes)
    (finding,) = caught.value.findings
    assert finding.key == key
    assert problem in finding.problem
    assert remedy in finding.remedy
