"""Transformer stations at phases of a grid that do not go together: each fault with place and remedy."""

import pytest

from tpss import ScenarioError, load_scenario, prepare
from tpss.model import build_model

from conftest import EXAMPLES
from scenarios import short_line

STATION = {
    "no_load_voltage_kv": 16.0,
    "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0},
    "grid_kv": 132.0,
    "grid_short_circuit_mva": 800.0,
}
WEST = {**STATION, "name": "West", "position_km": 0.0, "phases": "RS", "busbar": "north"}
EAST = {**STATION, "name": "East", "position_km": 20.0, "phases": "ST", "busbar": "north"}
VV = {
    **STATION, "name": "Mid", "position_km": 10.0,
    "connection": "V/V", "phases_before": "RS", "phases_behind": "ST",
}  # fmt: skip
NEUTRAL = [{"from_km": 9.95, "to_km": 10.05}]
KEY = "supply.transformer_stations"


def changes(stations, neutral=NEUTRAL, **more):
    return {
        "supply.transformer_stations": stations,
        "supply.converter_stations": [],
        "supply.neutral_sections": neutral,
        "simulation.motion": None,
        "simulation.braking": None,
        **more,
    }


def findings_of(stations, neutral=NEUTRAL, **more):
    with pytest.raises(ScenarioError) as caught:
        prepare(short_line(changes(stations, neutral, **more)))
    return caught.value.findings


def without(station, *keys):
    return {key: value for key, value in station.items() if key not in keys}


FAULTS = [
    pytest.param([WEST, without(EAST, "phases")], f"{KEY}.1.phases",
                 "missing at the busbar north", 'add phases = "RS"', id="no-phases-at-a-busbar"),
    pytest.param([WEST, without(EAST, "grid_short_circuit_mva")], f"{KEY}.1.grid_short_circuit_mva",
                 "missing at the busbar north", "add it", id="infinite-grid-at-a-busbar"),
    pytest.param([WEST, {**EAST, "grid_short_circuit_mva": 900.0}], f"{KEY}.1.grid_short_circuit_mva",
                 "West says 800.0", "the same grid_short_circuit_mva", id="two-powers-of-a-grid"),
    pytest.param([WEST, {**EAST, "grid_kv": 220.0}], f"{KEY}.1.grid_kv",
                 "West says 132.0", "the same grid_kv", id="two-voltages-of-a-grid"),
    pytest.param([WEST, {**EAST, "grid_r_over_x": 0.1}], f"{KEY}.1.grid_r_over_x",
                 "West says 0.0", "the same grid_r_over_x", id="two-angles-of-a-grid"),
    pytest.param([WEST, {**EAST, "unbalance_limit_percent": 1.0}],
                 f"{KEY}.1.unbalance_limit_percent", "West says 2.0", "another busbar",
                 id="two-limits-of-a-grid"),
    pytest.param([WEST, {**EAST, "phases": "RR"}], f"{KEY}.1.phases",
                 "not one of the choices", "choose from RS", id="unknown-phases"),
    pytest.param([WEST, {**EAST, "transformer": {"rated_mva": 1.0, "short_circuit_percent": 0.0}}],
                 f"{KEY}.1.transformer.short_circuit_percent", "no impedance", "give its short-circuit",
                 id="ideal-transformer-at-a-busbar"),
    pytest.param([without(WEST, "grid_kv"), without(EAST, "busbar")], f"{KEY}.0",
                 "grid_kv is missing", "add grid_kv", id="phases-without-a-grid-voltage"),
    pytest.param([without(VV, "phases_behind")], f"{KEY}.0",
                 "V/V feeds two sections", "give both", id="one-side-of-v-v"),
    pytest.param([{**VV, "phases_behind": "SR"}], f"{KEY}.0",
                 "RS and SR are no V/V connection", '"RS" and "ST"', id="same-pair-twice"),
    pytest.param([{**VV, "connection": "Scott"}], f"{KEY}.0",
                 "RS and ST are no Scott connection", '"ST" and "R"', id="two-pairs-of-scott"),
    pytest.param([{**VV, "phases": "RS"}], f"{KEY}.0",
                 "belong to a station without a connection", "leave phases out", id="phases-and-sides"),
    pytest.param([{**without(WEST, "phases"), "phases_before": "RS"}, EAST], f"{KEY}.0",
                 "belong to a station with a connection", "or give phases", id="sides-of-one"),
    pytest.param([{**VV, "feeds": ["line"]}], f"{KEY}.0",
                 "feeds are those of a station without", "leave feeds out", id="feeds-and-sides"),
]  # fmt: skip


@pytest.mark.parametrize(("stations", "key", "problem", "remedy"), FAULTS)
def test_a_fault_is_told_with_its_place_and_a_remedy(stations, key, problem, remedy):
    findings = findings_of(stations)
    (found,) = [each for each in findings if each.key == key]
    assert problem in found.problem
    assert remedy in found.remedy
    assert len(findings) == 1


def test_stations_of_different_phases_on_one_part_of_the_line_are_a_short_circuit():
    (found,) = findings_of([WEST, EAST], neutral=[])
    assert found.key == f"{KEY}.1.phases"
    assert found.value == "'ST'"
    assert "East feeds the phases ST into contact line that West feeds with RS" in found.problem
    assert "add a neutral section between them" in found.remedy


def test_a_side_of_a_station_and_its_neighbour_have_one_pair_of_phases():
    """The neutral section of the two-sided station parts its sides, not one of them from East."""
    (found,) = findings_of([VV, {**EAST, "phases": "TR", "busbar": "east"}])
    assert found.key == f"{KEY}.1.phases"
    assert "Mid ST" in found.problem


def test_a_station_with_two_sides_stands_at_a_neutral_section():
    (found,) = findings_of([{**VV, "position_km": 12.0}])
    assert found.key == "supply"
    assert "there is no neutral section at 12 km" in found.problem
    assert "add one to neutral_sections" in found.remedy


def test_least_squares_know_no_grid_that_stations_share():
    (found,) = findings_of(
        [WEST, EAST],
        **{"simulation.load_flow": "least-squares", "simulation.time_step_min": 0.5},
    )
    assert found.key == "simulation.load_flow"
    assert "the busbar north" in found.problem
    assert "leave busbar out" in found.remedy


def test_stations_of_one_phase_and_others_that_tell_none_may_share_a_line():
    plain = without(EAST, "phases", "busbar", "grid_kv")
    prepare(short_line(changes([WEST, plain], neutral=[])))
    prepare(short_line(changes([WEST, {**EAST, "phases": "RS"}], neutral=[])))


def test_the_angle_between_sides_may_be_anything():
    """RS and SR are opposite: 32 kV stand across the neutral section; that is told, not refused."""
    prepare(short_line(changes([WEST, {**EAST, "phases": "SR"}])))


def test_rails_that_are_conductors_know_one_angle_only():
    """They go on where the neutral section parts the contact line."""
    east = {
        "name": "East", "position_km": 49.0, "no_load_voltage_kv": 27.5, "secondary": "2x",
        "grid_kv": 220.0, "phases": "ST", "transformer": "ADIF-60MVA", "rail_earthing_ohm": 0.5,
    }  # fmt: skip
    changed = {
        "supply.transformer_stations.+": east,
        "supply.transformer_stations.Airport.grid_kv": 220.0,
        "supply.transformer_stations.Airport.phases": "RS",
        "supply.neutral_sections": [{"from_km": 29.0, "to_km": 29.2}],
    }
    scenario = load_scenario(EXAMPLES / "hs_2x25kv.toml", changed)
    with pytest.raises(ScenarioError) as caught:
        build_model(scenario)
    (found,) = caught.value.findings
    assert found.key == f"{KEY}.1.phases"
    assert "rails, which are conductors here, go on to those of Airport at RS" in found.problem
    assert "leave supply.conductors out" in found.remedy
