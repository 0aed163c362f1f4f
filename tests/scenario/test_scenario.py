"""What a scenario is: defaults, library values, changed copies, and its document."""

import copy
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from tpss import Scenario, ScenarioError, load_scenario, simulate
from tpss.scenario.files import read_toml
from tpss.scenario.override import parse_assignment
from tpss.scenario.supply.transformers import transformer_positions_km

from conftest import EXAMPLE_SCENARIOS, EXAMPLES
from scenarios import SHORT_LINE, short_line

FILE = EXAMPLES / "thesis_160km.toml"


def value_at(scenario: Scenario, path: str) -> Any:
    """Value of a scenario at a key path."""
    part: Any = scenario
    for key in path.split("."):
        if isinstance(part, tuple):
            part = part[int(key)]
        else:
            part = part[key] if isinstance(part, dict) else getattr(part, key)
    return part


@pytest.mark.parametrize("file", EXAMPLE_SCENARIOS, ids=lambda file: file.stem)
def test_every_example_loads(file):
    assert load_scenario(file).format == 1


def test_a_path_may_be_text():
    assert load_scenario(str(FILE)) == load_scenario(FILE)


@pytest.mark.parametrize(
    ("path", "default"),
    [
        ("description", ""),
        ("simulation.duration_min", None),
        ("simulation.power_sampling", "mean"),
        ("simulation.gradient_sampling", "mean"),
        ("simulation.adhesion_speed_unit", "m/s"),
        ("simulation.rail", "dry"),
        ("simulation.load_flow", "equations"),
        ("simulation.driver", "regulated"),
        ("supply.high_voltage_line", None),
        ("supply.converter_stations.0.control", "all-on"),
        ("supply.catenary.capacitance_nf_per_km", 0.0),
        ("supply.catenary.connection_r_ohm", 0.0),
        ("supply.catenary.connection_x_ohm", 0.0),
        ("trains.freight.max_motor_current_a", 1250.0),
        ("trains.freight.max_retardation_m_s2", 0.85),
        ("trains.freight.max_speed_kmh", 135.0),
        ("trains.freight.efficiency", 0.8),
        ("trains.freight.auxiliary_power_kw", 151.5),
        ("trains.freight.auxiliary_power_factor", 0.8),
        ("trains.freight.reactive_power", "power-factor"),
        ("trains.freight.motor_voltage", "new"),
        ("trains.freight.motor_current", "new"),
        ("trains.freight.filter_reactance_ohm", None),
        ("traffic.0.first_departure_min", 0.0),
        ("traffic.0.already_running", False),
        ("traffic.0.initial_trains", ()),
        ("traffic.0.stops", ()),
    ],
)
def test_what_is_left_out_has_its_default(path, default):
    assert value_at(short_line(), path) == default


def test_a_high_voltage_line_has_132_kv_and_the_library_s_transformers():
    line = {"supply.high_voltage_line": {"type": "132kV", "transformers_km": [10.0]}}
    high_voltage = short_line(line).supply.high_voltage_line
    assert high_voltage.base_kv == 132.0
    assert high_voltage.line_transformer.x_ohm == 0.85
    assert high_voltage.station_transformer.x_ohm == 0.54


def test_changes_of_a_scenario_leave_what_they_were_given_as_it_is():
    """A second path leads into the list that the first one has set."""
    level = [{"from_km": 0.0, "permille": 5.0}]
    changes = {"line.gradients": level, "line.gradients.0.permille": 30.0}
    changed = short_line(changes)
    assert changed.line.gradients[0].permille == 30.0
    assert level == [{"from_km": 0.0, "permille": 5.0}]


def test_a_train_starts_from_its_model_and_overrides_what_it_gives():
    scenario = short_line({"trains.freight.mass_t": 900.0, "trains.freight.slip": 0.02})
    train = scenario.trains["freight"]
    assert (train.mass_t, train.slip) == (900.0, 0.02)
    assert train.adhesive_mass_t == short_line().trains["freight"].adhesive_mass_t == 79.0


def test_a_catenary_is_a_library_name_or_a_table_of_one_s_own():
    table = {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.20}
    assert short_line({"supply.catenary": table}) == short_line({"supply.catenary": "BT"})


@pytest.mark.parametrize(("system", "frequency_hz"), [("15kV-16.7Hz", 16.7), ("25kV-50Hz", 50.0)])
def test_the_frequency_is_that_of_the_system_unless_it_is_given(system, frequency_hz):
    of_the_system = short_line({"supply.system": system, "supply.frequency_hz": None})
    assert of_the_system.supply.frequency_hz == frequency_hz
    own = short_line({"supply.system": system, "supply.frequency_hz": 25.0})
    assert own.supply.frequency_hz == 25.0
    assert short_line({"supply.frequency_hz": None}).supply.frequency_hz == 16.7


def test_a_converter_type_is_a_library_name_or_a_table_of_one_s_own():
    table = short_line().as_document()["supply"]["converter_stations"][0]["type"]
    own = short_line({"supply.converter_stations.0.type": {**table, "rating_mva": 15.0}})
    assert own.supply.converter_stations[0].type.rating_mva == 15.0
    assert own.supply.converter_stations[1].type.rating_mva == 10.0


def with_stations_and_transformers(positions_km: list[float], line: dict[str, Any]) -> Scenario:
    """The short line on 160 km, with a high-voltage line."""
    stations = [
        {"name": f"station {km:g}", "position_km": km, "type": "Q48/Q49", "converters": 2}
        for km in positions_km
    ]
    changes = {
        "line.length_km": 160.0,
        "supply.converter_stations": stations,
        "supply.high_voltage_line": {"type": "132kV", **line},
    }
    return short_line(changes)


@pytest.mark.parametrize(
    ("stations_km", "count", "expected_km"),
    [
        ([0.0, 160.0], 0, []),
        ([0.0, 160.0], 1, [80.0]),
        ([0.0, 160.0], 3, [40.0, 80.0, 120.0]),
        ([160.0, 0.0], 3, [40.0, 80.0, 120.0]),
        ([10.0, 100.0], 2, [40.0, 70.0]),
        ([0.0, 60.0, 160.0], 1, [30.0, 110.0]),
        ([0.0, 60.0, 160.0], 3, [15.0, 30.0, 45.0, 85.0, 110.0, 135.0]),
    ],
)
def test_a_number_of_transformers_is_spaced_equally_between_stations(
    stations_km, count, expected_km
):
    """N transformers divide the way between two stations into N + 1 equal parts."""
    scenario = with_stations_and_transformers(stations_km, {"transformers": count})
    assert transformer_positions_km(scenario.supply) == pytest.approx(expected_km)


def test_transformers_stand_where_they_are_placed():
    scenario = with_stations_and_transformers([0.0, 160.0], {"transformers_km": [1.0, 99.0]})
    assert transformer_positions_km(scenario.supply) == [1.0, 99.0]


def test_without_a_high_voltage_line_there_are_no_transformers():
    assert transformer_positions_km(short_line().supply) == []


PROFILE = """# metres above the sea are lost; their differences are not
position_km,gradient_permille

0.0 , 1.5
  # the river
2.5,-3
10,0.0
"""


def test_gradients_of_a_file_equal_those_of_a_list(tmp_path):
    (tmp_path / "profile.csv").write_text(PROFILE, encoding="utf-8")
    document = copy.deepcopy(SHORT_LINE)
    del document["line"]["gradients"]
    document["line"]["gradients_file"] = "profile.csv"
    rows = [(0.0, 1.5), (2.5, -3.0), (10.0, 0.0)]
    inline = {"line.gradients": [{"from_km": km, "permille": rise} for km, rise in rows]}
    from_file = Scenario.from_document(document, tmp_path / "line.toml")
    assert from_file == short_line(inline)


def test_a_profile_is_looked_for_beside_the_scenario_wherever_one_stands(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    gradients = load_scenario(FILE).line.gradients
    assert len(gradients) == 320
    assert (gradients[1].from_km, gradients[1].permille) == (0.5, 0.0462)


def test_with_gives_a_changed_copy_and_leaves_the_original():
    before = load_scenario(FILE)
    after = before.with_({"traffic.0.headway_min": 12.0, "supply.catenary": "AT"})
    assert (after.traffic[0].headway_min, after.supply.catenary.r_ohm_per_km) == (12.0, 0.0335)
    assert (before.traffic[0].headway_min, before.supply.catenary.r_ohm_per_km) == (10.0, 0.21)
    assert before == load_scenario(FILE)


def test_changes_add_up():
    scenario = short_line().with_({"line.length_km": 30.0}).with_({"name": "longer"})
    assert (scenario.name, scenario.line.length_km) == ("longer", 30.0)


def test_changes_while_loading_equal_changes_afterwards():
    changes = {"traffic.0.headway_min": 12.0}
    assert load_scenario(FILE, changes) == load_scenario(FILE).with_(changes)


def test_none_takes_a_key_out():
    scenario = load_scenario(FILE).with_({"supply.high_voltage_line": None})
    assert scenario.supply.high_voltage_line is None


def test_a_change_may_add_a_table():
    fast = {"model": "Rc4-freight-1470t", "mass_t": 300.0}
    scenario = short_line({"trains.fast": fast, "traffic.0.train": "fast"})
    assert scenario.trains["fast"].mass_t == 300.0


def test_a_changed_copy_is_validated_too():
    with pytest.raises(ScenarioError, match=r"supply\.catenary = 'BTX'"):
        short_line().with_({"supply.catenary": "BTX"})
    with pytest.raises(ScenarioError, match="runs from 0 to 15 km"):
        short_line().with_({"line.length_km": 15.0})


@pytest.mark.parametrize("path", ["traffic.1.headway_min", "traffic.-1.headway_min", "name.x"])
def test_a_path_to_nowhere_is_refused(path):
    with pytest.raises(ScenarioError, match="no such place") as caught:
        short_line().with_({path: 12.0})
    assert [finding.key for finding in caught.value.findings] == [path]


def test_every_path_to_nowhere_is_reported():
    with pytest.raises(ScenarioError) as caught:
        short_line().with_({"name.x": 1, "line.length_km": 30.0, "traffic.7.name": "y"})
    assert [finding.key for finding in caught.value.findings] == ["name.x", "traffic.7.name"]


@pytest.mark.parametrize(
    "path",
    [
        "name",
        "simulation.time_step_min",
        "line.length_km",
        "line.stations.0.position_km",
        "supply.catenary.r_ohm_per_km",
        "trains.freight.mass_t",
        "traffic.0.headway_min",
    ],
)
def test_no_part_of_a_scenario_can_be_changed(path):
    scenario = short_line()
    above, _, key = path.rpartition(".")
    part = value_at(scenario, above) if above else scenario
    with pytest.raises(ValidationError, match="frozen"):
        setattr(part, key, value_at(scenario, path))


@pytest.mark.parametrize("file", EXAMPLE_SCENARIOS, ids=lambda file: file.stem)
def test_the_document_of_a_scenario_gives_an_equal_scenario(file):
    scenario = load_scenario(file)
    again = Scenario.from_document(scenario.as_document())
    assert again == scenario
    assert again.as_document() == scenario.as_document()


def test_the_document_is_whole():
    """It names no file and no library entry that may change: the run can be repeated from it."""
    document = load_scenario(FILE).as_document()
    assert "gradients_file" not in document["line"]
    assert len(document["line"]["gradients"]) == 320
    assert document["supply"]["catenary"]["r_ohm_per_km"] == 0.21
    assert document["trains"]["freight"]["resistance_a_n"] == 15400.0
    assert document["traffic"][0]["from"] == "West"


@pytest.mark.parametrize(
    "changes",
    [
        {"name": "other"},
        {"line.length_km": 21.0},
        {"traffic.0.headway_min": 61.0},
        {"supply.catenary": "AT"},
    ],
)
def test_scenarios_that_differ_are_not_equal(changes):
    assert short_line(changes) != short_line()


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [
        ("simulation.time_step_min=0.1", "simulation.time_step_min", 0.1),
        ("traffic.0.headway_min=12", "traffic.0.headway_min", 12),
        ("traffic.0.already_running=true", "traffic.0.already_running", True),
        ("supply.catenary=AT", "supply.catenary", "AT"),
        ("supply.catenary='AT'", "supply.catenary", "AT"),
        ('supply.catenary="AT"', "supply.catenary", "AT"),
        ("supply.converter_stations.0.type=Q48/Q49", "supply.converter_stations.0.type", "Q48/Q49"),
        ("traffic.0.departures_min=[0, 7.5]", "traffic.0.departures_min", [0, 7.5]),
        ("description=v = s/t", "description", "v = s/t"),
        ("description=", "description", None),
        ('description=""', "description", ""),
        (" name = study ", "name", "study"),
        (
            "line.gradients=[{from_km = 0.0, permille = 3.0}]",
            "line.gradients",
            [{"from_km": 0.0, "permille": 3.0}],
        ),
    ],
)
def test_an_assignment_is_read_as_toml_or_else_as_text(text, path, value):
    assert parse_assignment(text) == (path, value)


def test_an_assignment_keeps_whole_numbers_whole():
    assert isinstance(parse_assignment("supply.converter_stations.0.converters=4")[1], int)


@pytest.mark.parametrize("text", ["simulation.time_step_min", "=0.1", " =0.1", ""])
def test_an_assignment_without_key_or_value_is_refused(text):
    with pytest.raises(ScenarioError, match="not of the form KEY=VALUE"):
        parse_assignment(text)


def test_a_scenario_keeps_to_itself():
    """Values that a caller hands in stay the caller's; a scenario does not change with them."""
    document = read_toml(FILE)
    untouched = copy.deepcopy(document)
    Scenario.from_document(document, FILE).with_({"line.length_km": 170.0})
    assert document == untouched


def test_the_source_of_a_scenario_is_named_in_faults_of_its_copies():
    with pytest.raises(ScenarioError) as caught:
        load_scenario(FILE).with_({"supply.catenary": "BTX"})
    assert [Path(finding.file) for finding in caught.value.findings] == [FILE]


def relative(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Scenario:
    """An example whose file is named from the working folder."""
    (tmp_path / "of mine").mkdir()
    text = FILE.read_text("utf-8").replace("gradients_a_160km.csv", "gradients.csv")
    (tmp_path / "of mine" / "line.toml").write_text(text, encoding="utf-8")
    gradients = (EXAMPLES / "gradients_a_160km.csv").read_text("utf-8")
    (tmp_path / "of mine" / "gradients.csv").write_text(gradients, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return load_scenario("of mine/line.toml")


def files_of(caught: pytest.ExceptionInfo[ScenarioError]) -> set[str]:
    return {finding.file for finding in caught.value.findings}


def test_faults_of_changes_name_the_file_as_it_was_given(tmp_path, monkeypatch):
    scenario = relative(tmp_path, monkeypatch)
    with pytest.raises(ScenarioError) as caught:
        scenario.with_({"simulation.time_step_min": -1.0})
    assert files_of(caught) == {str(Path("of mine/line.toml"))}
    with pytest.raises(ScenarioError) as caught:
        scenario.variant("none")
    assert files_of(caught) == {str(Path("of mine/line.toml"))}
    (tmp_path / "of mine" / "gradients.csv").write_text("position_km,permille\n0,steep\n")
    with pytest.raises(ScenarioError) as caught:
        scenario.with_({"simulation.time_step_min": 1.0})
    assert files_of(caught) == {str(Path("of mine/gradients.csv"))}


def test_faults_that_the_model_finds_name_the_file_as_it_was_given(tmp_path, monkeypatch):
    """A station that trips has to say which overloads it bears."""
    scenario = relative(tmp_path, monkeypatch).with_({"protection.trip": True})
    monkeypatch.chdir("/")
    with pytest.raises(ScenarioError, match="nothing trips") as caught:
        simulate(scenario)
    assert files_of(caught) == {str(Path("of mine/line.toml"))}
