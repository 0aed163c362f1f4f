"""The command `tpss line-constants`: tables, and a catenary that a scenario takes."""

import json
import tomllib

import jsonschema
import pytest
import tomli_w

import tpss
from tpss.conductors.schema import geometry_schema

from conductor_cases import CONDUCTORS
from conftest import EXAMPLES
from scenarios import SHORT_LINE

GEOMETRIES = sorted(EXAMPLES.glob("geometry_*.toml"))
DOUBLE_TRACK = EXAMPLES / "geometry_double_track.toml"


@pytest.fixture
def single_track(tmp_path):
    file = tmp_path / "track.toml"
    document = {"earth_resistivity_ohm_m": 250.0, "conductors": CONDUCTORS}
    file.write_text(tomli_w.dumps(document), "utf-8")
    return file


def test_matrices_and_equivalents_are_printed_with_units(tpss_command, single_track):
    """The values of the case, to four decimals."""
    said = tpss_command("line-constants", single_track, "--frequency", "50")
    assert (said.code, said.err) == (0, "")
    assert "track.toml, 50 Hz, earth of 250 Ω m, Carson's full series" in said.out
    assert "messenger contact 0.00 7.25 0.1938" in said.out
    assert "R of the groups contact feeder rails group Ω/km Ω/km Ω/km" in said.out
    assert "contact 0.1365 0.0514 0.0461" in said.out
    assert "contact 0.6148 0.3698 0.3584" in said.out
    assert "B of the groups contact feeder rails group µS/km" in said.out
    assert "rails at the voltage of the earth 0.1228 0.3514" in said.out
    assert "all return in the rails 0.1445 0.3829" in said.out
    assert "autotransformers, along the line (zL) 0.0510 0.1523" in said.out
    assert "Taken for a catenary: autotransformers, along the line (zL)" in said.out


def test_direct_current_has_resistances_only(tpss_command, single_track):
    said = tpss_command("line-constants", single_track, "--frequency", "0")
    assert said.code == 0
    assert "track.toml, direct current" in said.out
    assert "all return in the rails 0.1285 0.0000" in said.out
    assert "X of the groups" not in said.out


def test_tracks_stand_in_tables_with_their_numbers(tpss_command):
    said = tpss_command("line-constants", DOUBLE_TRACK)
    assert "contact 1 rails 1 contact 2 rails 2" in said.out
    assert "rails at the voltage of the earth 0.1417 0.1401 0.0083 0.0438" in said.out


def test_tracks_that_differ_are_told(tpss_command, tmp_path):
    text = DOUBLE_TRACK.read_text("utf-8").replace("wear_percent = 10.0", "wear_percent = 0.0", 1)
    (tmp_path / "worn.toml").write_text(text, "utf-8")
    said = tpss_command("line-constants", "worn.toml")
    assert "Tracks differ by up to" in said.out


def test_a_catenary_is_written_that_a_scenario_takes(tpss_command, tmp_path):
    said = tpss_command("line-constants", DOUBLE_TRACK, "--out", "wires.toml")
    assert said.code == 0
    assert 'Wrote wires.toml. In a scenario: supply.catenary = "wires.toml"' in said.out
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(SHORT_LINE), "utf-8")
    supply = tpss.load_scenario(file, {"supply.catenary": "wires.toml"}).supply
    assert supply.catenary.r_ohm_per_km == pytest.approx(0.141713)
    assert supply.catenary.mutual_x_ohm_per_km == pytest.approx(0.0438318)
    source = tomllib.loads((tmp_path / "wires.toml").read_text("utf-8"))["source"]
    assert "geometry_double_track.toml at 16.7 Hz, carson" in source


@pytest.mark.parametrize("changes", [{}, {"supply.catenary": str(DOUBLE_TRACK)}])
def test_conductors_in_place_of_a_scenario_or_a_catenary_are_told_what_to_do(tmp_path, changes):
    scenario = tmp_path / "line.toml"
    scenario.write_text(tomli_w.dumps(SHORT_LINE), "utf-8")
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.load_scenario(scenario if changes else DOUBLE_TRACK, changes)
    words = "make a catenary of them: tpss line-constants FILE --out catenary.toml"
    assert any(words in each.remedy for each in caught.value.findings)


def test_a_file_is_replaced_only_with_force(tpss_command, tmp_path):
    (tmp_path / "wires.toml").write_text("mine", "utf-8")
    call = ("line-constants", DOUBLE_TRACK, "--out", "wires.toml")
    said = tpss_command(*call)
    assert said.code == 2
    assert "--force to replace it" in said.err
    assert (tmp_path / "wires.toml").read_text("utf-8") == "mine"
    assert tpss_command(*call, "--force").code == 0


def test_a_line_that_no_catenary_can_have_is_not_written(tpss_command, tmp_path):
    wire = {"r_ohm_per_km": 50.0, "radius_mm": 1.0}
    thin = {"name": "a", "group": "contact", "wire": wire, "x_m": 0.0, "height_m": 6.0}
    (tmp_path / "thin.toml").write_text(tomli_w.dumps({"conductors": [thin]}), "utf-8")
    said = tpss_command("line-constants", "thin.toml", "--frequency", "50", "--out", "wires.toml")
    assert said.code == 2
    assert "supply.catenary.r_ohm_per_km" in said.err
    assert not (tmp_path / "wires.toml").exists()


def test_faults_name_file_key_and_remedy(tpss_command, single_track):
    text = single_track.read_text("utf-8").replace("gmr_mm = 5.02", "gmr_mm = 50.2")
    single_track.write_text(text, "utf-8")
    said = tpss_command("line-constants", single_track, "--frequency", "50")
    assert said.code == 2
    assert f"{single_track}: conductors.0.wire" in said.err
    assert "gmr_mm (50.2) is larger than radius_mm (6.45)" in said.err


def test_without_a_frequency_nothing_is_computed(tpss_command, single_track):
    said = tpss_command("line-constants", single_track)
    assert (said.code, said.out) == (2, "")
    assert f"{single_track}: frequency_hz" in said.err


@pytest.mark.parametrize("file", GEOMETRIES, ids=lambda file: file.stem)
def test_every_example_has_line_constants_and_is_accepted_by_the_schema(tpss_command, file):
    said = tpss_command("line-constants", file)
    assert (said.code, said.err) == (0, "")
    jsonschema.Draft202012Validator(geometry_schema()).validate(
        tomllib.loads(file.read_text("utf-8"))
    )


def test_the_schema_is_printed_and_describes_every_key(tpss_command):
    schema = json.loads(tpss_command("schema", "--geometry").out)
    assert schema == geometry_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    parts = [schema, *schema["$defs"].values()]
    fields = {key: field for part in parts for key, field in part["properties"].items()}
    assert all("description" in field for field in fields.values())
    assert fields["radius_mm"]["description"] == "Outer radius. [mm]"
    assert tpss_command("schema", "--geometry", "--plan").code == 2
