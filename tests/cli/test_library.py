"""The command ``tpss library``: what ships as data, with units, sources and how to use it."""

import copy
import tomllib
from importlib.resources import files

import pytest

import tpss
from tpss import library
from tpss.cli.library import KINDS, usage
from tpss.conductors.geometry import Geometry

from direct_scenarios import direct_document
from scenarios import SHORT_LINE

ENTRIES = [(kind, name) for kind in library.KINDS for name in library.entries(kind)]
IN_SCENARIOS = [(kind, name) for kind, name in ENTRIES if KINDS[kind].file == "scenario"]


def test_every_file_of_the_library_is_a_kind():
    names = {file.name for file in files(library).iterdir()}
    assert {f"{kind}.toml" for kind in library.KINDS} == {n for n in names if n.endswith(".toml")}
    assert set(KINDS) == set(library.KINDS)


SYSTEM_OF = {"3kV-": "DC-3kV", "PKP-": "DC-3kV", "1.5k": "DC-1.5kV", "750V": "DC-0.75kV"}
"""Systems of the rectifiers, by the beginnings of their names."""


def test_everything_is_listed_with_its_source(tpss_command):
    said = tpss_command("library")
    assert (said.code, said.err) == (0, "")
    for kind, name in ENTRIES:
        assert f"{name}: " in said.out
        source = library.entries(kind)[name]["source"].replace("]_", "]")
        assert source in said.out, source


def test_a_kind_is_listed_with_values_and_units(tpss_command):
    said = tpss_command("library", "catenaries")
    assert said.code == 0
    assert "name Ω/km Ω/km nF/km Ω Ω" in said.out
    assert "AT 0.0335 0.031 13.5 0.189 0.293" in said.out
    assert "Q48/Q49" not in said.out
    assert "tpss library catenaries BT" in said.out


def test_a_kind_may_be_written_with_hyphens(tpss_command):
    assert "132kV 0.051 0.062" in tpss_command("library", "high-voltage-lines").out


@pytest.mark.parametrize(("kind", "name"), ENTRIES)
def test_an_entry_is_shown_whole(tpss_command, kind, name):
    said = tpss_command("library", kind, name)
    assert (said.code, said.err) == (0, "")
    for key, value in library.values(kind, name).items():
        if key == "by_system":
            assert all(each in said.out for each in value)
            continue
        if isinstance(value, dict):  # as it is written in TOML, over several lines of its cell
            numbers = {k: v for k, v in value.items() if not isinstance(v, str | dict | list)}
            assert all(
                inner in said.out and f"{each}" in said.out for inner, each in numbers.items()
            )
            continue
        assert f"{key} {value}" in said.out
    assert "Source: " in said.out


def test_values_come_with_unit_and_meaning_and_defaults_too(tpss_command):
    said = tpss_command("library", "locomotives", "Rc4-freight-1470t")
    assert "mass_t 1470.0 t Mass of the whole train." in said.out
    assert "motor_voltage new Motor voltage over speed alone" in said.out
    assert "filter_reactance_ohm - Ω Reactance of the filter" in said.out
    reactance = tpss_command("library", "converters", "Q48/Q49").out
    assert "generator_reactance_pu 0.53 p.u. q-axis reactance of the generator." in reactance


def of_a_train(system, *_):
    """A scenario of the first system that a train is for, with nothing said of the train."""
    document = direct_document(system) if system.startswith("DC-") else copy.deepcopy(SHORT_LINE)
    document["supply"]["system"] = system
    document["trains"] = {"freight": {}}
    for service in document["traffic"]:
        service["train"] = "freight"
    return document


@pytest.mark.parametrize(("kind", "name"), IN_SCENARIOS)
def test_the_shown_usage_is_that_of_a_scenario(kind, name):
    """The lines are put into a scenario that names something else in that place, or nothing."""
    if kind in ("contact_lines", "rails"):
        document = direct_document("DC-3kV")
        document["supply"]["catenary"] = {"contact_line": "CA-160-3kV", "rails": "60E1"}
    elif kind == "locomotives":
        document = of_a_train(*library.values(kind, name).get("systems", ["15kV-16.7Hz"]))
    elif name.startswith("DC-") or kind == "rectifiers":
        document = direct_document(name if name.startswith("DC-") else SYSTEM_OF[name[:4]])
    else:
        document = copy.deepcopy(SHORT_LINE)
        document["supply"]["high_voltage_line"] = {"type": "132kV", "transformers_km": [10.0]}
    if kind == "station_transformers":
        station = {"name": "Grid", "position_km": 15.0, "no_load_voltage_kv": 16.0}
        document["supply"]["transformer_stations"] = [station]
    used = tomllib.loads(usage(kind, name))
    for table, part in used.items():
        document.setdefault(table, {})
        for key, value in part.items():
            if isinstance(value, list):
                document[table][key][0].update(value[0])
            elif isinstance(value, dict):
                document[table].setdefault(key, {}).update(value)
            else:
                document[table][key] = value
    assert tpss.Scenario.from_document(document).name == document["name"]


@pytest.mark.parametrize("name", library.entries("wires"))
def test_a_wire_is_shown_as_it_stands_in_a_file_of_conductors(tpss_command, name):
    used = tomllib.loads(usage("wires", name))
    place = {"name": "wire", "group": "contact", "x_m": 0.0, "height_m": 6.0}
    document = {"conductors": [{**place, **used["conductors"][0]}]}
    (conductor,) = Geometry.model_validate(document).conductors
    assert conductor.wire.r_ohm_per_km == library.values("wires", name)["r_ohm_per_km"]
    assert "In a file of conductors:" in tpss_command("library", "wires", name).out


def test_a_table_of_one_s_own_is_shown_with_the_entry_s_values(tpss_command):
    said = tpss_command("library", "high_voltage_lines", "132kV")
    assert "type = { r_ohm_per_km = 0.051, x_ohm_per_km = 0.062 }" in said.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["catenary"], "no kind 'catenary' -> did you mean catenaries? choose from catenaries,"),
        (["AT"], "no kind 'AT' -> AT is one of the catenaries: tpss library catenaries AT"),
        (["catenaries", "ATX"], "no 'ATX' in catenaries -> did you mean AT? choose from AT, BT"),
        (["converters", "9"], "no '9' in converters -> choose from Q48/Q49"),
    ],
)
def test_an_unknown_name_is_explained(tpss_command, arguments, words):
    said = tpss_command("library", *arguments)
    assert (said.code, said.out) == (2, "")
    assert f"the library has {words}" in said.err


def test_entries_of_ones_own_are_listed_with_their_file(tpss_command, tmp_path):
    text = '[ours]\nbased_on = "AT"\nr_ohm_per_km = 0.03\nsource = "measured"\n'
    (tmp_path / "catenaries.toml").write_text(text, "utf-8")
    said = tpss_command("library", "catenaries", "--library", ".")
    assert "ours 0.03 0.031 13.5 0.189 0.293" in said.out
    assert "ours: catenaries.toml, based on AT; measured" in said.out
    assert "the others ship with TPSS" in said.out
    entry = tpss_command("library", "catenaries", "ours", "--library", ".").out
    assert 'catenary = "ours"' in entry
    assert "r_ohm_per_km = 0.03" in entry
    assert "no 'ours' in catenaries" in tpss_command("library", "catenaries", "ours").err


def test_an_unknown_key_of_ones_own_is_named(tpss_command, tmp_path):
    text = '[ours]\nbased_on = "AT"\nr_ohm_km = 0.03\n'
    (tmp_path / "catenaries.toml").write_text(text, "utf-8")
    said = tpss_command("library", "catenaries", "--library", tmp_path)
    assert said.code == 2
    assert "catenaries.toml: ours.r_ohm_km unknown key -> did you mean r_ohm_per_km?" in said.err


def test_a_scenario_is_checked_with_a_library(tpss_command, short_file, tmp_path):
    own = tmp_path / "own"
    own.mkdir()
    (own / "catenaries.toml").write_text('[ours]\nbased_on = "AT"\nr_ohm_per_km = 0.03\n', "utf-8")
    arguments = ("check", short_file, "--set", "supply.catenary=ours")
    assert "own: 0.03 + j0.031 Ω/km" in tpss_command(*arguments, "--library", own).out
    assert tpss_command(*arguments).code == 2
