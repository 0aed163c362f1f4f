"""Faults of files of conductors: place, value, problem and remedy."""

import copy
from pathlib import Path

import pytest

import tpss
from tpss.conductors.load import geometry_of
from tpss.scenario.override import override

from conductor_cases import CONDUCTORS

DOCUMENT = {"conductors": CONDUCTORS, "earth_resistivity_ohm_m": 250.0}
WIRE = {"r_ohm_per_km": 0.2, "radius_mm": 6.0}
ALONE = {"name": "a", "group": "contact", "wire": WIRE, "x_m": 0.0, "height_m": 6.0}


def findings(changes, frequency_hz=50.0):
    document = override(copy.deepcopy(DOCUMENT), changes, Path("line.toml"))
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.line_constants(geometry_of(document, Path("line.toml")), frequency_hz)
    return caught.value.findings


@pytest.mark.parametrize(
    ("changes", "key", "value", "problem", "remedy"),
    [
        (
            {"conductors.1.height_m": 5.9},
            "conductors.1.x_m", "0",
            "contact and messenger are at one place",
            "move one of them (conductors.0 or conductors.1)",
        ),
        (
            {"conductors.3.x_m": -0.6},
            "conductors.3.x_m", "-0.6",
            "rail1 and rail2 are 0.1175 m apart, less than both radii, 0.22 m",
            "or correct radius_mm",
        ),
        (
            {"conductors.1.sag_m": 7.3},
            "conductors.1.height_m", "7.25",
            "messenger lies below ground: it has a radius of 0.0063 m, and sags by 7.3 m",
            "height of its middle above ground",
        ),
        (
            {"conductors.2.height_m": 0.1},
            "conductors.2.height_m", "0.1",
            "rail1 lies in the ground: it has a radius of 0.11 m",
            "above ground",
        ),
        ({"conductors.2.height_m": -0.1}, "conductors.2.height_m", "-0.1", "out of range", "than 0 m"),
        (
            {"conductors.0.wire.gmr_mm": 7.0},
            "conductors.0.wire", "",
            "gmr_mm (7) is larger than radius_mm (6.45)",
            "0.7788",
        ),
        (
            {"conductors.0.wire": {**WIRE, "inner_radius_mm": 6.0}},
            "conductors.0.wire", "",
            "inner_radius_mm (6) is no less than radius_mm (6)",
            "or leave it out",
        ),
        (
            {"conductors.0.wire": {**WIRE, "gmr_mm": 4.0, "relative_permeability": 5.0}},
            "conductors.0.wire", "",
            "gmr_mm beside inner_radius_mm or relative_permeability",
            "leave out gmr_mm",
        ),
        (
            {"conductors.0.wire": "CuAg12"},
            "conductors.0.wire", "'CuAg12'",
            "the library has no such entry in wires",
            "did you mean CuAg120?",
        ),
        (
            {"conductors.0.wire": "none.toml"},
            "conductors.0.wire", "",
            "there is no such file",
            "files of this type there",
        ),
        (
            {"wires": {"CuAg120": WIRE}},
            "wires", "",
            "CuAg120 is an entry of the library",
            "another name",
        ),
        (
            {"conductors.0.temperature_c": 40.0},
            "conductors.0", "",
            "temperature_c (40) of a wire without temperature_coefficient_per_k",
            "0.0038 of copper",
        ),
        (
            {"conductors": [{**ALONE, "group": "rails"}]},
            "conductors", "",
            "no conductor is of the group contact",
            'group = "contact"',
        ),
        (
            {"conductors.4.track": 2},
            "conductors.4.track", "2",
            "feeder belongs to a track without a contact line",
            "tracks with one: 1",
        ),
        ({"conductors.0.group": "wire"}, "conductors.0.group", "'wire'", "not one of", "contact"),
        ({"conductors.1.name": "contact"}, "conductors", "", "name contact occurs twice", "its own"),
        ({"conductors.0.heigth_m": 5.0}, "conductors.0.heigth_m", "5.0", "unknown key", "height_m?"),
        ({"conductors": []}, "conductors", "[]", "the list is too short", "add at least one more"),
        ({"method": "pollaczek"}, "method", "'pollaczek'", "not one of the choices", "carson"),
    ],
)  # fmt: skip
def test_a_fault_is_told_with_place_value_and_remedy(changes, key, value, problem, remedy):
    (finding,) = findings(changes)
    assert finding.file.endswith("none.toml" if "such file" in problem else "line.toml")
    assert finding.key == key
    if value:
        assert finding.value == value
    assert problem in finding.problem
    assert remedy in finding.remedy


def test_a_wire_of_one_s_own_with_a_fault_is_not_unknown_where_it_is_used():
    changes = {"wires": {"mine": {**WIRE, "radius_mm": -6.0}}, "conductors.0.wire": "mine"}
    (finding,) = findings(changes)
    assert (finding.key, finding.problem) == ("wires.mine.radius_mm", "out of range")


def test_all_faults_are_told_at_once():
    changes = {"conductors.3.x_m": -0.7175, "conductors.0.sag_m": 6.0, "conductors.4.track": 3}
    assert {each.key for each in findings(changes)} == {
        "conductors.3.x_m", "conductors.0.height_m", "conductors.4.track",
    }  # fmt: skip


def test_a_frequency_is_needed_and_within_its_range():
    (missing,) = findings({}, None)
    assert (missing.file, missing.key) == ("line.toml", "frequency_hz")
    assert "--frequency" in missing.remedy
    for frequency_hz in (-1.0, 1e5, float("nan")):
        (beyond,) = findings({}, frequency_hz)
        assert beyond.problem == "out of range"


def test_first_terms_far_from_where_they_hold_give_no_passive_line():
    """At 10 kHz over 0.001 Ω m their return lies 659 √1e-7 = 0.2 m deep, nearer than any conductor."""
    changes = {"method": "clem", "earth_resistivity_ohm_m": 0.001}
    (finding,) = findings(changes, 1e4)
    assert "no passive line: the smallest eigenvalue of X" in finding.problem
    assert 'method = "carson"' in finding.remedy
    document = override(copy.deepcopy(DOCUMENT), {**changes, "method": "carson"}, Path("line.toml"))
    assert tpss.line_constants(geometry_of(document, Path("line.toml")), 1e4).groups


def test_a_scenario_is_no_file_of_conductors(tmp_path):
    file = tmp_path / "scenario.toml"
    file.write_text("[trains]\n[[traffic]]\n", "utf-8")
    with pytest.raises(tpss.ScenarioError, match="a scenario, not conductors"):
        tpss.load_geometry(file)
