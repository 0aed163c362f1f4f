"""The command ``tpss schema``: a JSON Schema that knows the scenario format."""

import copy
import json
import tomllib

import jsonschema
import pytest

import tpss
from tpss import library
from tpss.scenario.override import override
from tpss.scenario.schema import scenario_schema

from conftest import EXAMPLE_SCENARIOS, EXAMPLES, SHARED
from scenarios import SHORT_LINE

SCHEMA = scenario_schema()
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
FILES = sorted([*EXAMPLE_SCENARIOS, *(SHARED / "scenarios").glob("*.toml")])


def faults(changes):
    """What the schema finds in the short line with some values changed."""
    document = override(copy.deepcopy(SHORT_LINE), changes, "short-line")
    return [fault.json_path for fault in VALIDATOR.iter_errors(document)]


def test_it_is_a_schema_of_its_draft():
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    VALIDATOR.check_schema(SCHEMA)


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}-{file.stem}")
def test_every_example_is_accepted_as_written(file):
    VALIDATOR.validate(tomllib.loads(file.read_text("utf-8")))


def test_a_saved_scenario_is_accepted():
    VALIDATOR.validate(tpss.load_scenario(EXAMPLES / "thesis_160km.toml").as_document())


def test_the_template_is_accepted(tpss_command, tmp_path):
    tpss_command("new", ".")
    VALIDATOR.validate(tomllib.loads((tmp_path / "scenario.toml").read_text("utf-8")))


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({"lenght": 1}, "$"),
        ({"line.lenght_km": 1}, "$.line"),
        ({"trains.freight.mass": 1}, "$.trains.freight"),
        ({"trains.freight.model": None}, "$.trains.freight"),
        ({"trains.freight.model": "Rc5"}, "$.trains.freight.model"),
        ({"supply.catenary": "BTX"}, "$.supply.catenary"),
        ({"supply.catenary": {"r_ohm_per_km": 0.2}}, "$.supply.catenary"),
        ({"simulation.time_step_min": 0}, "$.simulation.time_step_min"),
        ({"simulation.rail": "icy"}, "$.simulation.rail"),
        ({"simulation.until": "first-departure-arrives", "simulation.duration_min": 1},
         "$.simulation"),
        ({"line.gradients": None}, "$.line"),
        ({"line.gradients_file": "a.csv"}, "$.line"),
        ({"traffic.0.departures_min": [0.0]}, "$.traffic[0]"),
        ({"supply.high_voltage_line": {"type": "132kV"}}, "$.supply.high_voltage_line"),
    ],
)  # fmt: skip
def test_a_fault_is_found_at_its_place(changes, place):
    assert faults(changes) == [place]


@pytest.mark.parametrize(
    "changes",
    [
        {"line.gradients": None, "line.gradients_file": "a.csv"},
        {"simulation.time_step_min": None},
        {"simulation": None},
        {"supply.catenary": {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2}},
        {"supply.high_voltage_line": {"type": "132kV", "transformers": 2}},
        {"traffic.0.headway_min": None, "traffic.0.departures_min": [0.0, 5.0]},
        {"trains.freight.mass_t": 1000},
        {"trains.freight.model": "mine.toml"},
        {"supply.catenary": "mine.toml"},
        {"line": "mine.toml"},
    ],
)
def test_what_a_scenario_may_say_is_accepted(changes):
    assert faults(changes) == []


def test_every_key_is_described_with_its_unit():
    parts = [SCHEMA, *SCHEMA["$defs"].values()]
    described = {key: field for part in parts for key, field in part["properties"].items()}
    undescribed = [k for k, field in described.items() if not {"description", "$ref"} & set(field)]
    assert undescribed == []
    assert described["mass_t"]["description"] == "Mass of the whole train. [t]"
    assert described["permille"]["description"].endswith("[‰]")


def test_names_of_the_library_are_offered():
    catenary = SCHEMA["$defs"]["Supply"]["properties"]["catenary"]
    assert catenary["anyOf"][0]["enum"] == ["AT", "BT"]
    model = SCHEMA["$defs"]["Train"]["properties"]["model"]
    assert model["anyOf"][0]["enum"] == sorted(library.entries("locomotives"))


def test_it_is_printed(tpss_command, capsys):
    assert json.loads(tpss_command("schema").out) == SCHEMA


def test_it_is_written_into_a_file_and_replaced_there(tpss_command, tmp_path):
    for _ in range(2):
        said = tpss_command("schema", "--out", "s.json")
        assert (said.code, said.err) == (0, "")
        assert "#:schema s.json" in said.out
        assert json.loads((tmp_path / "s.json").read_text("utf-8")) == SCHEMA
    assert [path.name for path in tmp_path.iterdir()] == ["s.json"]


def test_another_file_is_not_replaced(tpss_command, short_file):
    before = short_file.read_bytes()
    said = tpss_command("schema", "--out", short_file)
    assert said.code == 2
    assert "exists and is not a schema of TPSS; name another file" in said.err
    assert short_file.read_bytes() == before


def test_a_file_that_cannot_be_written_is_explained(tpss_command):
    said = tpss_command("schema", "--out", "nowhere/s.json")
    assert said.code == 2
    assert "nowhere/s.json cannot be written: No such file or directory" in said.err
