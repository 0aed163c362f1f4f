"""Trains, lines and equipment in files beside a scenario: what they give, and their faults."""

import copy
import shutil
from pathlib import Path
from typing import Any, get_args

import pytest
import tomli_w
from pydantic import BaseModel

from tpss import Finding, Scenario, ScenarioError, library, load_result, load_scenario, simulate
from tpss.conductors.geometry import Geometry
from tpss.scenario.fields import FromLibrary
from tpss.scenario.inline import PLACES

from scenarios import SHORT_LINE

OWN_TRAIN: dict[str, Any] = {
    "source": "made up",
    "tractive_effort": {"max_force_kn": 200, "max_power_kw": 2600},
    "mass_t": 122.0,
    "adhesive_mass_t": 122.0,
    "resistance_a_n": 2378.0,
    "resistance_b_n_s_per_m": 61.0,
    "resistance_c_n_s2_per_m2": 12.0,
    "max_speed_kmh": 160,
    "max_retardation_m_s2": 1.1,
    "efficiency": {"speed_kmh": [0, 50, 160], "value": [0.7, 0.9, 0.88]},
    "power_factor": 0.99,
    "auxiliary_power_kw": 80,
}

EQUIPMENT = {
    "supply.catenary": ("catenaries", "BT"),
    "supply.converter_stations.1.type": ("converters", "Q48/Q49"),
    "supply.high_voltage_line.type": ("high_voltage_lines", "132kV"),
    "supply.high_voltage_line.line_transformer": ("transformers", "16MVA"),
    "supply.high_voltage_line.station_transformer": ("transformers", "25MVA"),
}


def write(folder: Path, name: str, table: dict[str, Any]) -> None:
    (folder / name).write_text(tomli_w.dumps(table), encoding="utf-8")


@pytest.fixture
def scenario_file(tmp_path):
    """The short line with a high-voltage line and a train in a file."""
    document = copy.deepcopy(SHORT_LINE)
    document["supply"]["high_voltage_line"] = {"type": "132kV", "transformers": 1}
    document["trains"] = {"freight": {"model": "own.toml"}}
    write(tmp_path, "line.toml", document)
    write(tmp_path, "own.toml", OWN_TRAIN)
    return tmp_path / "line.toml"


def faults_of(file: Path, changes: dict[str, Any] | None = None) -> dict[tuple[str, str], Finding]:
    """Findings by the name of their file and their key."""
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file, changes)
    return {(Path(f.file).name, f.key): f for f in caught.value.findings}


def test_a_train_takes_from_its_file_what_the_scenario_does_not_give(scenario_file):
    scenario = load_scenario(scenario_file, {"trains.freight.mass_t": 140.0})
    train = scenario.trains["freight"]
    assert (train.mass_t, train.adhesive_mass_t, train.model) == (140.0, 122.0, None)
    assert train.tractive_effort.max_power_kw == 2600.0


def test_a_train_without_model_gives_all_itself(scenario_file):
    own = {key: value for key, value in OWN_TRAIN.items() if key != "source"}
    assert load_scenario(scenario_file, {"trains.freight": own}) == load_scenario(scenario_file)


def test_a_train_of_a_library_model_may_have_another_machine(scenario_file):
    train = {"model": "Rc4-freight-1470t", "tractive_effort": OWN_TRAIN["tractive_effort"]}
    scenario = load_scenario(scenario_file, {"trains.freight": {**train, "power_factor": 1.0}})
    assert scenario.trains["freight"].mass_t == 1470.0
    assert scenario.trains["freight"].tractive_effort.max_force_kn == 200.0


@pytest.mark.parametrize(("path", "entry"), EQUIPMENT.items(), ids=EQUIPMENT)
def test_equipment_in_a_file_is_what_the_same_table_is(scenario_file, path, entry):
    kind, name = entry
    write(scenario_file.parent, "equipment.toml", library.entries(kind)[name])
    from_file = load_scenario(scenario_file, {path: "equipment.toml"})
    assert from_file == load_scenario(scenario_file, {path: library.values(kind, name)})


def test_a_line_in_a_file_finds_its_profile_beside_itself(scenario_file):
    folder = scenario_file.parent / "lines"
    folder.mkdir()
    line = {key: value for key, value in SHORT_LINE["line"].items() if key != "gradients"}
    write(folder, "west.toml", {**line, "gradients_file": "west.csv"})
    (folder / "west.csv").write_text("position_km,gradient_permille\n0,4\n", "utf-8")
    scenario = load_scenario(scenario_file, {"line": "lines/west.toml"})
    assert scenario.line.gradients[0].permille == 4.0
    assert scenario.line.length_km == 20.0


def test_a_saved_result_holds_what_its_files_held(scenario_file, tmp_path):
    """The scenario of a result folder runs again when the files are gone, to the same result."""
    write(scenario_file.parent, "wires.toml", {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.21})
    changes = {"supply.catenary": "wires.toml", "simulation.duration_min": 2.0}
    result = simulate(load_scenario(scenario_file, changes))
    result.save(tmp_path / "result")
    for name in ("own.toml", "wires.toml", "line.toml"):
        (tmp_path / name).unlink()
    again = simulate(load_scenario(tmp_path / "result" / "scenario.toml"))
    assert again.scenario == result.scenario == load_result(tmp_path / "result").scenario
    assert again.dataset.identical(result.dataset.assign_attrs(again.dataset.attrs))


def test_files_are_looked_for_beside_the_scenario_wherever_one_stands(
    scenario_file, monkeypatch, tmp_path
):
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    scenario = load_scenario(scenario_file)
    assert scenario.with_({"name": "other"}).trains == scenario.trains


def test_every_place_that_takes_a_library_name_takes_a_file():
    """A field that looks names up in the library stands among the places of files."""

    conductors = {"catenary": ("contact_line", "rails")}  # of what may stand in a file itself

    def places(part: type[BaseModel], above: tuple[str, ...]) -> list[tuple[str, ...]]:
        found = []
        for name, field in part.model_fields.items():
            if any(isinstance(item, FromLibrary) for item in field.metadata):
                found.append((*above, name))
                found += [(*above, name, inner) for inner in conductors.get(name, ())]
                continue
            waiting = [(field.annotation, (*above, name))]
            while waiting:
                annotation, at = waiting.pop()
                marks = getattr(annotation, "__metadata__", ())
                if any(isinstance(item, FromLibrary) for item in marks):
                    found.append(at)
                    found += [(*at, inner) for inner in conductors.get(at[-1], ())]
                    continue
                if isinstance(annotation, type) and issubclass(annotation, BaseModel):
                    found += places(annotation, at)
                    continue
                star = getattr(annotation, "__origin__", None) in (tuple, dict)
                inner = (*at, "*") if star else at
                waiting += [(arg, inner) for arg in get_args(annotation)]
        return found

    assert {*places(Scenario, ()), *places(Geometry, ())} == set(PLACES) - {
        ("line",),
        ("lines", "*"),
        ("trains", "*", "model"),
    }


# Changes of the train's file, and the key, value and remedy of the finding there.
FAULTS = [
    pytest.param({"mass_t": -3}, "mass_t", "-3", "greater than or equal to 1 t", id="range"),
    pytest.param({"max_powr_kw": 3}, "max_powr_kw", "3", "choose from", id="unknown key"),
    pytest.param({"mass_t": None}, "mass_t", "", "add it", id="missing"),
    pytest.param({"mass_t": "122 t"}, "mass_t", "'122 t'", "a number in t", id="text"),
    pytest.param({"model": "Rc4-freight-1470t"}, "model", "'Rc4-freight-1470t'",
                 "write the values of that model", id="model of a model"),
    pytest.param({"efficiency": 1.2}, "efficiency", "1.2", "less than or equal to 1",
                 id="efficiency"),
    pytest.param({"efficiency": {"speed_kmh": [0, 50], "value": [0.5, 1.5]}},
                 "efficiency.value.1", "1.5", "less than or equal to 1", id="efficiency of a curve"),
    pytest.param({"efficiency": {"speed_kmh": [0, 50], "value": [0.5]}},
                 "efficiency.value", "[0.5]", "as many values as speed_kmh", id="curve too short"),
    pytest.param({"efficiency": {"speed_kmh": [50, 0], "value": [0.5, 0.6]}},
                 "efficiency.speed_kmh", "[50, 0]", "ascending order", id="curve unsorted"),
    pytest.param({"efficiency": {"speed_kmh": [0], "value": [0.5]}},
                 "efficiency.speed_kmh", "[0]", "add at least one", id="curve of one point"),
    pytest.param({"efficiency_over_load": {"load_percent": [10, 90], "value": [0.5, 0.8]}},
                 "efficiency_over_load.load_percent", "[10, 90]", "add the value at 100 %",
                 id="curve over load that ends early"),
    pytest.param({"efficiency_over_load": {"load_percent": [10, 100], "value": [0.5]}},
                 "efficiency_over_load.value", "[0.5]", "as many values as load_percent",
                 id="curve over load too short"),
    pytest.param({"efficiency_over_load": {"load_percent": [5, 10, 100], "value": [0.3, 0.8, 0.9]}},
                 "efficiency_over_load.value", "[0.3, 0.8, 0.9]",
                 "bring these two values closer together", id="curve over load too steep"),
    pytest.param({"efficiency_over_load": {"load_percent": [5, 10, 100], "value": [0.9, 0.9, 0.1]}},
                 "efficiency_over_load.value", "[0.9, 0.9, 0.1]",
                 "bring these two values closer together", id="curve over load falls too steeply"),
    pytest.param({"tractive_effort": "Rc4", "max_motor_current_a": 1250.0,
                  "efficiency_over_load": {"load_percent": [5, 100], "value": [0.6, 1.0]}},
                 "efficiency_over_load", "", "add rated_power_kw",
                 id="curve over load of a machine without rated power"),
    pytest.param({"efficiency": {"speed": [0, 1], "value": [0.5, 0.6]}},
                 "efficiency.speed", "[0, 1]", "did you mean speed_kmh?", id="key of a curve"),
    pytest.param({"power_factor": None}, "power_factor", "", "add power_factor",
                 id="no power factor"),
    pytest.param({"reactive_power": "double-bridge"}, "base_speed_kmh", "",
                 'choose reactive_power = "power-factor"', id="bridge without base speed"),
    pytest.param({"reactive_power": "double-bridge"}, "max_motor_voltage_v", "",
                 'choose reactive_power = "power-factor"', id="bridge without motor voltage"),
    pytest.param({"tractive_effort": "Rc4"}, "max_motor_current_a", "", "add it, such as 1250",
                 id="network without current"),
    pytest.param({"tractive_effort": "Rc5"}, "tractive_effort", "'Rc5'", 'write "Rc4", or a table',
                 id="unknown machine"),
    pytest.param({"tractive_effort": 200.0}, "tractive_effort", "200.0", 'write "Rc4", or a table',
                 id="effort as a number"),
    pytest.param({"tractive_effort": None}, "tractive_effort", "", "add it", id="no effort"),
    pytest.param({"max_acceleration_m_s2": 0.0}, "max_acceleration_m_s2", "0.0",
                 "greater than or equal to 0.01 m/s²", id="acceleration"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "key", "value", "remedy"), FAULTS)
def test_a_fault_of_a_file_names_the_file_key_value_and_remedy(
    scenario_file, changes, key, value, remedy
):
    table = {k: v for k, v in {**OWN_TRAIN, **changes}.items() if v is not None}
    write(scenario_file.parent, "own.toml", table)
    finding = faults_of(scenario_file)["own.toml", key]
    assert finding.value == value
    assert remedy in finding.remedy


SPEEDS = [0, 50, 100]

# A table of tractive effort, and the key below it, value and remedy of its finding.
TABLES = [
    pytest.param({"speed_kmh": SPEEDS, "force_kn": [1, 2]}, "force_kn", "[1, 2]",
                 "as many values as speed_kmh", id="row too short"),
    pytest.param({"speed_kmh": [0, 50, 40], "force_kn": [3, 2, 1]}, "speed_kmh", "[0, 50, 40]",
                 "ascending order", id="speeds unsorted"),
    pytest.param({"speed_kmh": [0, 0], "force_kn": [3, 2]}, "speed_kmh", "[0, 0]",
                 "each value once", id="speed twice"),
    pytest.param({"speed_kmh": [-5, 0], "force_kn": [3, 2]}, "speed_kmh.0", "-5",
                 "greater than or equal to 0 km/h", id="negative speed"),
    pytest.param({"speed_kmh": SPEEDS, "force_kn": [3, -2, 1]}, "force_kn.1", "-2",
                 "greater than or equal to 0 kN", id="negative force"),
    pytest.param({"speed_kmh": SPEEDS, "force_kn": [3, "two", 1]}, "force_kn.1", "'two'",
                 "a number in kN", id="text among forces"),
    pytest.param({"speed_kmh": SPEEDS}, "force_kn", "", "add it", id="no forces"),
    pytest.param({"force_kn": [3, 2]}, "speed_kmh", "", "add it", id="no speeds"),
    pytest.param({"speed_kmh": SPEEDS, "voltage_kv": [12, 15], "force_kn": [3, 2, 1]}, "force_kn",
                 "[3, 2, 1]", "as many values as voltage_kv", id="row for a table"),
    pytest.param({"speed_kmh": SPEEDS, "voltage_kv": [12, 14, 15], "force_kn": [3, 2, 1]},
                 "force_kn", "[3, 2, 1]", "nest the lists", id="row for a square table"),
    pytest.param({"speed_kmh": SPEEDS, "voltage_kv": [15, 12], "force_kn": [[3, 2, 1]] * 2},
                 "voltage_kv", "[15, 12]", "ascending order", id="voltages unsorted"),
    pytest.param({"speed_kmh": SPEEDS, "voltage_kv": [12, 15], "force_kn": [[3, 2, 1], [3, 2]]},
                 "force_kn", "[[3, 2, 1], [3, 2]]", "as many values as speed_kmh", id="ragged"),
    pytest.param({"speed_kmh": SPEEDS, "voltage_kv": [12, 15],
                  "force_kn": [[3, 2, 1], [3, 2, -1]]},
                 "force_kn.1.2", "-1", "greater than or equal to 0 kN", id="negative in a row"),
    pytest.param({"speed_kmh": SPEEDS, "force_kn": [[3, 2, 1]] * 3}, "force_kn",
                 "[[3, 2, 1], [3, 2, 1], [3, 2, 1]]", "add voltage_kv or motor_current_a",
                 id="rows without an axis"),
    pytest.param({"speed_kmh": SPEEDS, "motor_current_a": [500, 1000],
                  "force_kn": [[3, 2, 1]] * 3},
                 "force_kn", "[[3, 2, 1], [3, 2, 1], [3, 2, 1]]",
                 "as many values as motor_current_a", id="a row too many"),
    pytest.param({"speed_kmh": [0, 50], "voltage_kv": list(range(1, 18)),
                  "force_kn": [[3, 2]] * 17}, "voltage_kv",
                 str(list(range(1, 18))), "leave at most 16", id="17 voltages"),
    pytest.param({"max_force_kn": 200}, "max_power_kw", "", "add it", id="no power"),
    pytest.param({"max_force_kn": 200, "max_power_kw": 0}, "max_power_kw", "0",
                 "greater than 0 kW", id="zero power"),
    pytest.param({"max_force_kn": 200, "max_power_kw": 2600, "max_speed_kmh": 160},
                 "max_speed_kmh", "160", "did you mean limit_speed_kmh?", id="unknown limit"),
    pytest.param({"max_force_kn": 200, "max_power_kw": 2600, "full_voltage_kv": 14}, "", "",
                 "give both", id="one voltage"),
    pytest.param({"max_force_kn": 200, "max_power_kw": 2600, "full_voltage_kv": 10,
                  "zero_voltage_kv": 14}, "", "", "lower zero_voltage_kv", id="voltages swapped"),
]  # fmt: skip


@pytest.mark.parametrize(("table", "key", "value", "remedy"), TABLES)
@pytest.mark.parametrize("in_a_file", [False, True], ids=["scenario", "file"])
def test_a_fault_of_a_tractive_effort_names_its_place(
    scenario_file, table, key, value, remedy, in_a_file
):
    place = f"tractive_effort.{key}".rstrip(".")
    if in_a_file:
        write(scenario_file.parent, "own.toml", {**OWN_TRAIN, "tractive_effort": table})
        finding = faults_of(scenario_file)["own.toml", place]
    else:
        found = faults_of(scenario_file, {"trains.freight.tractive_effort": table})
        finding = found["line.toml", f"trains.freight.{place}"]
    assert finding.value == value
    assert remedy in finding.remedy


# A place that takes a library name, the table in its file, and key, value and remedy of the finding.
WIRES = {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2}
LIBRARY_FILES = [
    pytest.param("supply.catenary", {**WIRES, "r_ohm_per_km": "0.2"}, "r_ohm_per_km", "'0.2'",
                 "a number in Ω/km", id="text for a resistance"),
    pytest.param("supply.catenary", {**WIRES, "r_ohm_per_km": 200.0}, "r_ohm_per_km", "200.0",
                 "less than or equal to", id="milliohms"),
    pytest.param("supply.catenary", {**WIRES, "capacitance_nf": 9.0}, "capacitance_nf", "9.0",
                 "did you mean capacitance_nf_per_km?", id="capacitance of nothing"),
    pytest.param("supply.catenary", {"r_ohm_per_km": 0.2}, "x_ohm_per_km", "", "add it",
                 id="no reactance"),
    *[
        pytest.param(path, {key: change}, key, value, remedy, id=f"{path.split('.')[-1]} {key}")
        for path, key, change, value, remedy in [
            ("supply.converter_stations.1.type", "rated_mva", 10, "10", "choose from"),
            ("supply.converter_stations.1.type", "motor_reactance_pu", "0.5", "'0.5'", "a number"),
            ("supply.high_voltage_line.type", "r_ohm_per_km", -0.05, "-0.05", "greater than"),
            ("supply.high_voltage_line.type", "x_ohm_km", 0.4, "0.4", "did you mean x_ohm_per_km?"),
            ("supply.high_voltage_line.line_transformer", "r_ohm", True, "True", "a number in Ω"),
            ("supply.high_voltage_line.station_transformer", "x_ohm", -1.0, "-1.0", "greater than"),
        ]
    ],
]  # fmt: skip


@pytest.mark.parametrize(("path", "table", "key", "value", "remedy"), LIBRARY_FILES)
def test_a_fault_of_equipment_in_a_file_names_the_file_key_value_and_remedy(
    scenario_file, path, table, key, value, remedy
):
    """Beside the values of the library's own entry, where there is one."""
    if path in EQUIPMENT and path != "supply.catenary":
        kind, name = EQUIPMENT[path]
        table = {**library.values(kind, name), **table}
    write(scenario_file.parent, "equipment.toml", table)
    finding = faults_of(scenario_file, {path: "equipment.toml"})["equipment.toml", key]
    assert finding.value == value
    assert remedy in finding.remedy


def test_a_current_limit_outside_the_table_is_reported(scenario_file):
    table = {"speed_kmh": SPEEDS, "motor_current_a": [500, 1000], "force_kn": [[3, 2, 1]] * 2}
    changes = {
        "trains.freight.tractive_effort": table,
        "trains.freight.max_motor_current_a": 1250.0,
    }
    finding = faults_of(scenario_file, changes)["line.toml", "trains.freight.max_motor_current_a"]
    assert finding.value == "1250.0"
    assert "choose between 500 and 1000 A" in finding.remedy


def test_base_speed_and_motor_voltage_belong_together(scenario_file):
    finding = faults_of(scenario_file, {"trains.freight.base_speed_kmh": 80.0})
    assert "give both" in finding["line.toml", "trains.freight"].remedy


def test_a_key_that_the_scenario_overrides_is_not_a_fault_of_the_file(scenario_file):
    write(scenario_file.parent, "own.toml", {**OWN_TRAIN, "mass_t": -3})
    assert load_scenario(scenario_file, {"trains.freight.mass_t": 130.0})
    found = faults_of(scenario_file, {"trains.freight.mass_t": -4})
    assert set(found) == {("line.toml", "trains.freight.mass_t")}


@pytest.mark.parametrize("path", ["line", "trains.freight.model", *EQUIPMENT])
def test_a_missing_file_is_reported_with_those_that_are_there(scenario_file, path):
    found = faults_of(scenario_file, {path: "nowhere.toml", "simulation.time_step_min": -1.0})
    assert set(found) == {("nowhere.toml", path), ("line.toml", "simulation.time_step_min")}
    assert "own.toml" in found["nowhere.toml", path].remedy


@pytest.mark.parametrize("path", ["line", "trains.freight.model", "supply.catenary"])
def test_a_file_that_is_not_toml_is_reported(scenario_file, path):
    (scenario_file.parent / "bad.toml").write_text("r_ohm_per_km = \n")
    found = faults_of(scenario_file, {path: "bad.toml"})
    assert [name for name, _ in found] == ["bad.toml"]


def test_what_the_scenario_says_itself_is_judged_even_if_the_file_cannot_be_read(scenario_file):
    changes = {"trains.freight.model": "nowhere.toml", "trains.freight.efficiency": 1.2}
    assert ("line.toml", "trains.freight.efficiency") in faults_of(scenario_file, changes)


def test_faults_of_a_line_or_of_equipment_stand_in_their_files(scenario_file):
    line = copy.deepcopy(SHORT_LINE["line"])
    line["speed_limits"][0]["speed_kmh"] = 1600
    line["stations"][2]["position_km"] = 30.0
    write(scenario_file.parent, "own_line.toml", line)
    write(scenario_file.parent, "wires.toml", {"r_ohm_per_km": -0.2, "x_ohm_km": 0.2})
    found = faults_of(scenario_file, {"line": "own_line.toml", "supply.catenary": "wires.toml"})
    assert set(found) == {
        ("own_line.toml", "speed_limits.0.speed_kmh"),
        ("own_line.toml", "stations.2.position_km"),
        ("wires.toml", "r_ohm_per_km"),
        ("wires.toml", "x_ohm_km"),
        ("wires.toml", "x_ohm_per_km"),
    }


def test_an_unknown_library_name_hints_at_a_file_of_ones_own(scenario_file):
    for path in ("supply.catenary", "trains.freight.model"):
        finding = faults_of(scenario_file, {path: "mine"})["line.toml", path]
        assert "a file of your own that ends in .toml" in finding.remedy


def test_a_folder_may_be_moved_with_its_files(scenario_file, tmp_path):
    scenario = load_scenario(scenario_file)
    shutil.copytree(tmp_path, tmp_path / "copy")
    assert load_scenario(tmp_path / "copy" / "line.toml") == scenario
