"""Faults of the input: each is reported with its place, its value and a remedy, all at once."""

import math
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tpss import Finding, Scenario, ScenarioError, load_scenario, simulate
from tpss.scenario.files import read_toml

from conftest import EXAMPLES

FILE = EXAMPLES / "thesis_160km.toml"

HV = "supply.high_voltage_line"
WEST = "supply.converter_stations.0"
EAST = "supply.converter_stations.1"
ENTRY = "traffic.0"
FREIGHT = "trains.freight"
LIMITATION = f"{FREIGHT}.current_limitation"

INLINE = "line.gradients_file"
NOT_RUNNING = {f"{ENTRY}.already_running": None}
BY_TIMETABLE = {**NOT_RUNNING, f"{ENTRY}.headway_min": None}


def faults_of(changes: dict[str, Any], file: Path = FILE) -> tuple[Finding, ...]:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file, changes)
    return caught.value.findings


def finding_at(key: str, findings: tuple[Finding, ...]) -> Finding:
    """The finding at a key path; at one place there is at most one fault in these tests."""
    at_key = [finding for finding in findings if finding.key == key]
    assert at_key, f"nothing about {key!r} in {findings}"
    return at_key[0]


def shows(finding: Finding, value: str) -> bool:
    """Whether a finding shows a value; of long ones it shows the beginning."""
    return finding.value == value or (bool(value) and finding.value.startswith(value))


def stations(*rows: tuple[str, float]) -> list[dict[str, Any]]:
    return [{"name": name, "position_km": position} for name, position in rows]


def stops(*names: str) -> list[dict[str, Any]]:
    return [{"station": name, "dwell_min": 1.0} for name in names]


def gradients(*rows: tuple[float, float]) -> dict[str, Any]:
    profile = [{"from_km": start, "permille": rise} for start, rise in rows]
    return {INLINE: None, "line.gradients": profile}


def limits(*rows: tuple[float, float]) -> dict[str, Any]:
    return {"line.speed_limits": [{"from_km": km, "speed_kmh": speed} for km, speed in rows]}


def placed(*rows: tuple[float, float]) -> dict[str, Any]:
    trains = [{"position_km": km, "speed_kmh": speed} for km, speed in rows]
    return {**NOT_RUNNING, f"{ENTRY}.initial_trains": trains}


def unknown(table: str, key: str, value: Any, nearest: str) -> Any:
    """An unknown key, whose remedy names the nearest one that exists."""
    path = f"{table}.{key}" if table else key
    return pytest.param({path: value}, path, repr(value), f"did you mean {nearest}?", id=path)


UNKNOWN_KEYS = [
    unknown("", "suply", 1, "supply"),
    unknown("", "descripton", "x", "description"),
    unknown("simulation", "time_step", 0.5, "time_step_min"),
    unknown("line", "lenght_km", 160.0, "length_km"),
    unknown("line", "length_m", 160_000.0, "length_km"),
    unknown("line.stations.1", "position_m", 80_000.0, "position_km"),
    unknown("line.speed_limits.0", "speed_ms", 27.0, "speed_kmh"),
    unknown("supply", "frequency", 16.7, "frequency_hz"),
    unknown(HV, "transformer_km", 40.0, "transformers_km"),
    unknown(WEST, "converter", 6, "converters"),
    unknown(WEST, "grid_angle_rad", 0.1, "grid_angle_deg"),
    unknown(FREIGHT, "mass_kg", 1_470_000, "mass_t"),
    unknown(FREIGHT, "max_current_a", 1250.0, "max_motor_current_a"),
    unknown(ENTRY, "headway_s", 600.0, "headway_min"),
    unknown(ENTRY, "departure_min", 0.0, "departures_min"),
    pytest.param(
        {f"{ENTRY}.stops": [{"station": "Middle", "dwell_min": 1.0, "dwell_s": 60.0}]},
        f"{ENTRY}.stops.0.dwell_s", "60.0", "did you mean dwell_min?", id="key-of-a-stop",
    ),
    pytest.param(
        {**NOT_RUNNING, f"{ENTRY}.initial_trains": [{"position_km": 1.0, "speed_kmh": 1.0, "v": 1}]},
        f"{ENTRY}.initial_trains.0.v", "1", "choose from position_km, speed_kmh",
        id="key-of-an-initial-train",
    ),
    pytest.param(
        {"supply.catenary": {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2, "capacitance_nf": 9.0}},
        "supply.catenary.capacitance_nf", "9.0", "did you mean capacitance_nf_per_km?",
        id="key-of-a-catenary",
    ),
]  # fmt: skip

WRONG_TYPES = [
    pytest.param({"line.length_km": "160 km"}, "line.length_km", "'160 km'",
                 "write a number in km, without quotes", id="text-with-unit"),
    pytest.param({"supply.frequency_hz": "16.7"}, "supply.frequency_hz", "'16.7'",
                 "write a number in Hz, without quotes", id="number-in-quotes"),
    pytest.param({f"{HV}.transformers_km": ["40 km"]}, f"{HV}.transformers_km.0", "'40 km'",
                 "write a number", id="text-in-a-list-of-numbers"),
    pytest.param({f"{FREIGHT}.mass_t": True}, f"{FREIGHT}.mass_t", "True",
                 "write a number in t", id="flag-for-a-number"),
    pytest.param({f"{WEST}.converters": True}, f"{WEST}.converters", "True",
                 "write a whole number", id="flag-for-a-whole-number"),
    pytest.param({f"{WEST}.converters": 5.5}, f"{WEST}.converters", "5.5",
                 "write a whole number", id="fraction-for-a-whole-number"),
    pytest.param({f"{WEST}.converters": "six"}, f"{WEST}.converters", "'six'",
                 "write a whole number, without quotes", id="text-for-a-whole-number"),
    pytest.param({f"{ENTRY}.already_running": "true"}, f"{ENTRY}.already_running", "'true'",
                 "write true or false, without quotes", id="text-for-a-flag"),
    pytest.param({"name": 160}, "name", "160", "write text in quotes", id="number-for-text"),
    pytest.param({f"{HV}.transformers_km": 40.0}, f"{HV}.transformers_km", "40.0",
                 "write a list in square brackets", id="number-for-a-list"),
    pytest.param({"line": "long"}, "line", "'long'", "write a table", id="text-for-a-table"),
    pytest.param({"trains": ["freight"]}, "trains", "['freight']", "write a table",
                 id="list-for-a-table"),
    pytest.param({"traffic": {"name": "x"}}, "traffic", "{'name': 'x'}",
                 "write a list in square brackets", id="table-for-a-list"),
    pytest.param({"line.stations.1": "Middle"}, "line.stations.1", "'Middle'", "write a table",
                 id="text-for-an-item"),
]  # fmt: skip

OUT_OF_RANGE = [
    pytest.param({"line.length_km": 0.0}, "line.length_km", "0.0", "greater than or equal to 0.01 km",
                 id="no-length"),
    pytest.param({"line.stations.0.position_km": -5.0}, "line.stations.0.position_km", "-5.0",
                 "greater than or equal to 0 km", id="negative-position"),
    pytest.param({"simulation.time_step_min": 0.0}, "simulation.time_step_min", "0.0",
                 "greater than or equal to 0.001 min", id="no-time-step"),
    pytest.param({"simulation.until": None, "simulation.duration_min": -90.0},
                 "simulation.duration_min", "-90.0", "greater than or equal to 0.001 min",
                 id="negative-duration"),
    pytest.param({"supply.frequency_hz": 1000.0}, "supply.frequency_hz", "1000.0",
                 "less than or equal to 60 Hz", id="high-frequency"),
    pytest.param({f"{WEST}.converters": 0}, f"{WEST}.converters", "0",
                 "greater than or equal to 1", id="no-converters"),
    pytest.param({f"{FREIGHT}.efficiency": 1.2}, f"{FREIGHT}.efficiency", "1.2",
                 "less than or equal to 1", id="efficiency-beyond-1"),
    pytest.param({f"{FREIGHT}.mass_t": -1470.0}, f"{FREIGHT}.mass_t", "-1470.0",
                 "greater than or equal to 1 t", id="negative-mass"),
    pytest.param(limits((0.0, 900.0)), "line.speed_limits.0.speed_kmh", "900.0",
                 "less than or equal to 500 km/h", id="speed-of-an-aircraft"),
    pytest.param(gradients((0.0, 300.0)), "line.gradients.0.permille", "300.0",
                 "less than or equal to 100", id="gradient-of-a-staircase"),
    pytest.param({f"{ENTRY}.headway_min": 0.0}, f"{ENTRY}.headway_min", "0.0",
                 "greater than or equal to 0.01 min", id="no-headway"),
    pytest.param({**BY_TIMETABLE, f"{ENTRY}.departures_min": [-5.0, 5.0]},
                 f"{ENTRY}.departures_min.0", "-5.0", "greater than or equal to 0",
                 id="departure-before-the-start"),
    pytest.param({f"{ENTRY}.stops": [{"station": "Middle", "dwell_min": -1.0}]},
                 f"{ENTRY}.stops.0.dwell_min", "-1.0", "greater than or equal to 0 min",
                 id="negative-dwell"),
    pytest.param({f"{HV}.transformers_km": None, f"{HV}.transformers": -1}, f"{HV}.transformers",
                 "-1", "greater than or equal to 0", id="negative-number-of-transformers"),
    pytest.param({"line.length_km": math.nan}, "line.length_km", "nan", "finite number", id="nan"),
    pytest.param({f"{FREIGHT}.mass_t": math.inf}, f"{FREIGHT}.mass_t", "inf", "finite number",
                 id="infinite"),
    pytest.param({f"{HV}.transformers_km": [40.0, math.nan]}, f"{HV}.transformers_km.1", "nan",
                 "finite number", id="nan-in-a-list"),
    pytest.param({"format": 2}, "format", "2", "choose from 1", id="format-of-the-future"),
    pytest.param({"format": True}, "format", "True", "choose from 1", id="format-true"),
    pytest.param({"format": 1.0}, "format", "1.0", "choose from 1", id="format-with-decimals"),
    pytest.param({"simulation.until": "last-train"}, "simulation.until", "'last-train'",
                 "choose from first-departure-arrives", id="unknown-end"),
    pytest.param({f"{WEST}.control": "load"}, f"{WEST}.control", "'load'",
                 "did you mean loading?", id="unknown-control"),
    pytest.param({f"{FREIGHT}.reactive_power": "powerfactor"}, f"{FREIGHT}.reactive_power",
                 "'powerfactor'", "did you mean power-factor?", id="unknown-model-of-reactive-power"),
    pytest.param({"simulation.until": None, "simulation.duration_min": 1e9},
                 "simulation.duration_min", "1000000000.0", "less than or equal to 100000 min",
                 id="run-of-centuries"),
    pytest.param({"simulation.time_step_min": 30.0}, "simulation.time_step_min", "30.0",
                 "less than or equal to 10 min", id="step-of-half-an-hour"),
    pytest.param({"line.length_km": 40_000.0}, "line.length_km", "40000.0",
                 "less than or equal to 2000 km", id="line-around-the-world"),
    pytest.param({f"{ENTRY}.headway_min": 1e6}, f"{ENTRY}.headway_min", "1000000.0",
                 "less than or equal to 100000 min", id="a-train-in-two-years"),
    pytest.param(limits((0.0, 0.1)), "line.speed_limits.0.speed_kmh", "0.1",
                 "greater than or equal to 1 km/h", id="speed-of-a-snail"),
    pytest.param({f"{FREIGHT}.max_retardation_m_s2": 85.0}, f"{FREIGHT}.max_retardation_m_s2",
                 "85.0", "less than or equal to 5 m/s²", id="retardation-of-a-crash"),
    pytest.param({f"{FREIGHT}.max_motor_current_a": 50_000.0}, f"{FREIGHT}.max_motor_current_a",
                 "50000.0", "less than or equal to 5000 A", id="current-of-a-smelter"),
    pytest.param({f"{FREIGHT}.filter_reactance_ohm": 0.45}, f"{FREIGHT}.filter_reactance_ohm",
                 "0.45", "less than or equal to -0.01 Ω", id="inductive-filter"),
    pytest.param({"supply.catenary": {"r_ohm_per_km": 0.0, "x_ohm_per_km": 0.2}},
                 "supply.catenary.r_ohm_per_km", "0.0", "greater than or equal to 0.001 Ω/km",
                 id="superconducting-catenary"),
    pytest.param({f"{WEST}.grid_angle_deg": 90.0}, f"{WEST}.grid_angle_deg", "90.0",
                 "less than or equal to 60 °", id="angle-beyond-the-grid"),
    pytest.param({f"{HV}.transformers_km": None, f"{HV}.transformers": 10**6},
                 f"{HV}.transformers", "1000000", "less than or equal to 100",
                 id="a-million-transformers"),
    pytest.param({f"{HV}.base_kv": 132_000.0}, f"{HV}.base_kv", "132000.0",
                 "less than or equal to 400 kV", id="volts-for-kilovolts"),
    pytest.param({"format": 10**90}, "format", "1" + "0" * 50, "write a smaller number",
                 id="number-of-90-digits"),
    pytest.param({"format": 16**9000}, "format", "a number of thousands of digits",
                 "write a smaller number", id="number-of-thousands-of-digits"),
    pytest.param({f"{ENTRY}.name": "east\nbound"}, f"{ENTRY}.name", "'east\\nbound'",
                 "on one line", id="name-on-two-lines"),
    pytest.param({"line.stations.1.name": "Mid\0dle"}, "line.stations.1.name", "'Mid\\x00dle'",
                 "control characters", id="name-with-a-control-character"),
    pytest.param({"name": "a/b"}, "name", "'a/b'", "letters, digits, dots",
                 id="name-that-is-no-file-name"),
]  # fmt: skip

MISSING = [
    pytest.param({path: None}, path, "", "add it", id=f"no-{path}")
    for path in (
        "format",
        "name",
        "supply",
        "simulation.time_step_min",
        "line.length_km",
        "supply.frequency_hz",
        "supply.catenary",
        f"{WEST}.position_km",
        f"{ENTRY}.from",
        f"{ENTRY}.train",
    )
] + [
    pytest.param({f"{FREIGHT}.model": None}, f"{FREIGHT}.mass_t", "", "name a model that gives it",
                 id="no-model"),
    pytest.param({"trains": {}}, "trains", "{}", "add at least one", id="no-trains"),
    pytest.param({"traffic": []}, "traffic", "[]", "add at least one", id="no-traffic"),
    pytest.param({"line.speed_limits": []}, "line.speed_limits", "[]", "add at least one",
                 id="no-speed-limits"),
    pytest.param(gradients(), "line.gradients", "[]", "add at least one", id="no-gradients"),
    pytest.param({"supply.converter_stations": []}, "supply.converter_stations", "[]",
                 "add at least one", id="no-converter-stations"),
    pytest.param({"line.stations": stations(("West", 0.0))}, "line.stations",
                 "[{'name': 'West', 'position_km': 0.0}]", "add at least one", id="one-station"),
]  # fmt: skip

UNKNOWN_NAMES = [
    pytest.param({"supply.catenary": "BTX"}, "supply.catenary", "'BTX'", "did you mean BT?",
                 id="catenary"),
    pytest.param({f"{EAST}.type": "Q48/Q50"}, f"{EAST}.type", "'Q48/Q50'",
                 "did you mean Q48/Q49?", id="converter-type"),
    pytest.param({f"{HV}.line_transformer": "16 MVA"}, f"{HV}.line_transformer", "'16 MVA'",
                 "did you mean 16MVA?", id="transformer"),
    pytest.param({f"{FREIGHT}.model": "Rc4-freight-1470"}, f"{FREIGHT}.model",
                 "'Rc4-freight-1470'", "did you mean Rc4-freight-1470t?", id="locomotive"),
    pytest.param({f"{HV}.type": "130kV"}, f"{HV}.type", "'130kV'", "did you mean 132kV?",
                 id="high-voltage-line"),
    pytest.param({f"{ENTRY}.train": "fright"}, f"{ENTRY}.train", "'fright'",
                 "did you mean freight?", id="train"),
    pytest.param({f"{ENTRY}.from": "Wst"}, f"{ENTRY}.from", "'Wst'", "did you mean West?",
                 id="station-from"),
    pytest.param({f"{ENTRY}.to": "Eats"}, f"{ENTRY}.to", "'Eats'", "did you mean East?",
                 id="station-to"),
    pytest.param({f"{ENTRY}.stops": stops("Midle")}, f"{ENTRY}.stops.0.station", "'Midle'",
                 "did you mean Middle?", id="station-of-a-stop"),
    pytest.param({f"{ENTRY}.to": "Xyz"}, f"{ENTRY}.to", "'Xyz'", "West, Middle, East",
                 id="nothing-near"),
]  # fmt: skip

ORDER_AND_UNIQUENESS = [
    pytest.param(gradients((0.0, 1.0), (10.0, 2.0), (5.0, 3.0)), "line.gradients", "[{'from_km'",
                 "ascending order", id="gradients-unsorted"),
    pytest.param(gradients((0.0, 1.0), (0.0, 2.0)), "line.gradients", "[{'from_km'",
                 "each place once", id="gradients-twice"),
    pytest.param(limits((0.0, 90.0), (40.0, 70.0), (20.0, 80.0)), "line.speed_limits",
                 "[{'from_km'", "ascending order", id="limits-unsorted"),
    pytest.param(limits((0.0, 90.0), (0.0, 70.0)), "line.speed_limits", "[{'from_km'",
                 "each place once", id="limits-twice"),
    pytest.param(limits((5.0, 90.0)), "line.speed_limits.0.from_km", "5",
                 "begin at 0", id="limits-begin-late"),
    pytest.param({f"{HV}.transformers_km": [80.0, 40.0]}, f"{HV}.transformers_km", "[80.0, 40.0]",
                 "ascending order", id="transformers-unsorted"),
    pytest.param({f"{HV}.transformers_km": [40.0, 40.0]}, f"{HV}.transformers_km", "[40.0, 40.0]",
                 "each place once", id="transformers-twice"),
    pytest.param({**BY_TIMETABLE, f"{ENTRY}.departures_min": [0.0, 20.0, 10.0]},
                 f"{ENTRY}.departures_min", "[0.0, 20.0, 10.0]", "ascending order",
                 id="departures-unsorted"),
    pytest.param({"line.stations.1.name": "West"}, "line.stations", "[{'name': 'West'",
                 "give each one its own", id="station-name-twice"),
    pytest.param({"line.stations.1.position_km": 0.0}, "line.stations", "[{'name': 'West'",
                 "give each one its own", id="station-position-twice"),
    pytest.param({f"{EAST}.name": "West"}, "supply.converter_stations", "[{'name': 'West'",
                 "give each one its own", id="converter-station-name-twice"),
    pytest.param({f"{EAST}.position_km": 0.0}, "supply.converter_stations", "[{'name': 'West'",
                 "give each one its own", id="converter-station-position-twice"),
    pytest.param({"traffic": [{"name": "a", "train": "freight", "from": "West", "to": "East",
                               "headway_min": 10.0}] * 2},
                 "traffic", "[{'name': 'a'", "give each one its own", id="traffic-name-twice"),
]  # fmt: skip

PLACES = [
    pytest.param({"line.stations.2.position_km": 200.0}, "line.stations.2.position_km", "200",
                 "between 0 and 160 km", id="station-beyond-the-line"),
    pytest.param({f"{EAST}.position_km": 161.0}, f"{EAST}.position_km", "161",
                 "between 0 and 160 km", id="converter-station-beyond-the-line"),
    pytest.param({f"{HV}.transformers_km": [40.0, 170.0]}, f"{HV}.transformers_km.1", "170",
                 "between 0 and 160 km", id="transformer-beyond-the-line"),
    pytest.param({f"{HV}.transformers_km": [-1.0, 80.0]}, f"{HV}.transformers_km.0", "-1",
                 "at 0 or beyond", id="transformer-before-the-line"),
    pytest.param({f"{EAST}.position_km": 0.0005}, f"{EAST}.position_km", "0.00050000000000000001",
                 "leave one of them out", id="converter-stations-half-a-metre-apart"),
    pytest.param({f"{HV}.transformers_km": [40.0, 40.0005]}, f"{HV}.transformers_km.1", "40.000",
                 "leave one of them out", id="transformers-half-a-metre-apart"),
    pytest.param({f"{HV}.transformers_km": [159.9995]}, f"{HV}.transformers_km.0", "159.999",
                 "leave one of them out", id="transformer-half-a-metre-before-a-station"),
    pytest.param({f"{EAST}.position_km": 0.002, f"{HV}.transformers_km": None,
                  f"{HV}.transformers": 3}, f"{HV}.transformers", "3", "take fewer",
                 id="more-transformers-than-metres"),
    pytest.param({f"{HV}.transformers_km": [80.0, 160.0]}, f"{HV}.transformers_km.1", "160",
                 "leave it out", id="transformer-at-a-converter-station"),
    pytest.param({"supply.converter_stations": [{"name": "West", "position_km": 0.0,
                                                 "type": "Q48/Q49", "converters": 6}],
                  f"{HV}.transformers_km": None, f"{HV}.transformers": 2},
                 f"{HV}.transformers", "2", "give transformers_km instead",
                 id="transformers-between-one-station"),
    pytest.param({f"{ENTRY}.from": "East", f"{ENTRY}.to": "West"}, f"{ENTRY}.to", "'West'",
                 "towards growing positions", id="to-before-from"),
    pytest.param({f"{ENTRY}.to": "West"}, f"{ENTRY}.to", "'West'", "towards growing positions",
                 id="to-where-it-begins"),
    pytest.param({f"{ENTRY}.stops": stops("East")}, f"{ENTRY}.stops.0.station", "'East'",
                 "ends left out", id="stop-at-the-destination"),
    pytest.param({f"{ENTRY}.to": "Middle", f"{ENTRY}.stops": stops("East")},
                 f"{ENTRY}.stops.0.station", "'East'", "in the order", id="stop-outside-the-way"),
    pytest.param({"line.stations": stations(("West", 0.0), ("A", 40.0), ("B", 80.0), ("East", 160.0)),
                  f"{ENTRY}.stops": stops("B", "A")},
                 f"{ENTRY}.stops.1.station", "'A'", "in the order", id="stops-out-of-order"),
    pytest.param({f"{ENTRY}.stops": stops("Middle", "Middle")}, f"{ENTRY}.stops.1.station",
                 "'Middle'", "in the order", id="stop-twice"),
    pytest.param(placed((160.0, 10.0)), f"{ENTRY}.initial_trains.0.position_km", "160",
                 "on the way of its trains", id="initial-train-at-the-destination"),
    pytest.param(placed((1e308, 10.0)), f"{ENTRY}.initial_trains.0.position_km", "1e+300",
                 "on the way of its trains", id="initial-train-beyond-all-bounds"),
    pytest.param({f"{EAST}.position_km": 1e308}, f"{EAST}.position_km", "1e+300",
                 "between 0 and 160 km", id="converter-station-beyond-all-bounds"),
    pytest.param({**placed((120.0, 10.0)), f"{ENTRY}.to": "Middle"},
                 f"{ENTRY}.initial_trains.0.position_km", "120", "on the way of its trains",
                 id="initial-train-outside-the-way"),
]  # fmt: skip

CONFLICTS = [
    pytest.param({**NOT_RUNNING, f"{ENTRY}.departures_min": [0.0]}, ENTRY, "",
                 "leave one of them out", id="headway-and-departures"),
    pytest.param({f"{ENTRY}.headway_min": None}, ENTRY, "", "add the one that is missing",
                 id="neither-headway-nor-departures"),
    pytest.param({"simulation.duration_min": 90.0}, "simulation", "", "leave one of them out",
                 id="until-and-duration"),
    pytest.param({f"{HV}.transformers": 2}, HV, "", "leave one of them out",
                 id="transformers-twice-placed"),
    pytest.param({f"{HV}.transformers_km": None}, HV, "", "add the one that is missing",
                 id="transformers-not-placed"),
    pytest.param({"supply.catenary": {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.1,
                                      "connection_r_ohm": 1e-9}},
                 "supply.catenary", "", "or 0: no connection impedance",
                 id="connection-of-a-nanoohm"),
    pytest.param({f"{LIMITATION}.knee_factor": 0.9}, f"{LIMITATION}.max_current_a", "", "add it",
                 id="no-line-current"),
    pytest.param({LIMITATION: {"max_current_a": 0}}, f"{LIMITATION}.max_current_a", "0",
                 "greater than 0 A", id="zero-line-current"),
    pytest.param({LIMITATION: {"max_current_a": 400.0, "knee_factor": 95}},
                 f"{LIMITATION}.knee_factor", "95", "less than or equal to 1", id="knee-in-percent"),
    pytest.param({LIMITATION: {"max_current_a": 400.0, "umin2_kv": 14.5}}, LIMITATION, "",
                 "lower umin2_kv", id="no-traction-above-the-knee"),
    pytest.param({LIMITATION: {"max_current_a": 10.0}}, FREIGHT, "", "raise max_current_a",
                 id="auxiliaries-above-the-line-current"),
    pytest.param({LIMITATION: 400.0}, LIMITATION, "400.0", "write a table",
                 id="line-current-alone"),
    pytest.param({f"{FREIGHT}.adhesive_mass_t": 2000.0}, FREIGHT, "", "lower adhesive_mass_t",
                 id="more-adhesive-mass-than-mass"),
    pytest.param({f"{ENTRY}.headway_min": None, f"{ENTRY}.departures_min": [0.0]}, ENTRY, "",
                 "use it with headway_min alone", id="already-running-by-timetable"),
    pytest.param({f"{ENTRY}.initial_trains": [{"position_km": 1.0, "speed_kmh": 1.0}]}, ENTRY, "",
                 "leave already_running out", id="already-running-and-initial-trains"),
    pytest.param({**BY_TIMETABLE, f"{ENTRY}.departures_min": [0.0],
                  f"{ENTRY}.first_departure_min": 5.0}, ENTRY, "",
                 "leave first_departure_min out", id="first-departure-and-timetable"),
    pytest.param({"simulation.driver": "aggressive", "simulation.time_step_min": 1.5},
                 "simulation.time_step_min", "1.5", "take 1 min or less",
                 id="aggressive-driver-in-long-steps"),
    pytest.param({"line.gradients": [{"from_km": 0.0, "permille": 0.0}]}, INLINE,
                 "'gradients_a_160km.csv'", "leave out gradients_file or gradients",
                 id="gradients-twice-given"),
]  # fmt: skip

KEY_PATHS = [
    pytest.param({"traffic.1.headway_min": 12}, "traffic.1.headway_min", "12", "number from 0",
                 id="item-that-is-not-there"),
    pytest.param({"traffic.first.headway_min": 12}, "traffic.first.headway_min", "12",
                 "number from 0", id="item-by-name"),
    pytest.param({"line.length_km.x": 12}, "line.length_km.x", "12", "name tables by their keys",
                 id="into-a-number"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "key", "value", "remedy"),
    [
        *UNKNOWN_KEYS,
        *WRONG_TYPES,
        *OUT_OF_RANGE,
        *MISSING,
        *UNKNOWN_NAMES,
        *ORDER_AND_UNIQUENESS,
        *PLACES,
        *CONFLICTS,
        *KEY_PATHS,
    ],
)
def test_a_fault_is_reported_with_place_value_and_remedy(changes, key, value, remedy):
    finding = finding_at(key, faults_of(changes))
    assert finding.file == str(FILE)
    assert shows(finding, value)
    assert finding.problem
    assert remedy in finding.remedy


def test_a_wrong_unit_also_leaves_the_right_key_missing():
    findings = faults_of({"line.length_km": None, "line.length_m": 160_000.0})
    assert "did you mean length_km?" in finding_at("line.length_m", findings).remedy
    assert finding_at("line.length_km", findings).remedy == "add it"


HEADER = "position_km,gradient_permille\n"


@pytest.fixture
def copied(tmp_path):
    """The scenario with its profile, to be spoilt."""
    shutil.copy(FILE, tmp_path)
    shutil.copy(EXAMPLES / "gradients_a_160km.csv", tmp_path)
    return tmp_path / FILE.name


@pytest.mark.parametrize(
    ("text", "key", "value", "remedy"),
    [
        pytest.param("km,permille\n0,1\n", "line 1", "km,permille",
                     "begin with the line position_km,gradient_permille", id="header"),
        pytest.param("# a\n\nposition_km;gradient_permille\n", "line 3",
                     "position_km;gradient_permille", "begin with the line", id="semicolons"),
        pytest.param(HEADER + "0,1\n5,steep\n", "line 3, gradient_permille", "steep",
                     "decimal point and no unit", id="cell"),
        pytest.param(HEADER + "0 km,1\n", "line 2, position_km", "0 km",
                     "decimal point and no unit", id="unit"),
        pytest.param(HEADER + "0,1\n\n# b\n5\n", "line 5", "5", "separated by a comma",
                     id="one-cell"),
        pytest.param(HEADER + "0,0,1\n", "line 2", "0,0,1", "separated by a comma",
                     id="three-cells"),
        pytest.param(HEADER + "0,1\n5,300\n", "line 3, gradient_permille", "300.0",
                     "less than or equal to 100", id="staircase"),
        pytest.param(HEADER + "# a\n0,nan\n", "line 3, gradient_permille", "nan",
                     "finite number", id="nan"),
        pytest.param(HEADER + "0,1\n1e999,2\n", "line 3, position_km", "inf", "finite number",
                     id="infinite"),
        pytest.param(HEADER + "0,1\n1e9,2\n", "line 3, position_km", "1000000000.0",
                     "less than or equal to 100000", id="position-in-millimetres"),
        pytest.param(HEADER + "0,1\n\n5,2\n3,1\n7,0\n", "line 5, position_km", "3",
                     "ascending order", id="unsorted"),
        pytest.param(HEADER + "0,1\n0,2\n", "line 3, position_km", "0", "each place once",
                     id="twice"),
        pytest.param(HEADER + '"0",1\n', "line 2, position_km", '"0"',
                     "decimal point and no unit", id="quotes"),
        pytest.param(HEADER + "0;1\n", "line 2", "0;1", "separated by a comma",
                     id="semicolon-in-a-row"),
        pytest.param(HEADER + "0,1,\n", "line 2", "0,1,", "separated by a comma",
                     id="comma-at-the-end"),
        pytest.param(HEADER + "0,1 # steep\n", "line 2, gradient_permille", "1 # steep",
                     "decimal point and no unit", id="comment-behind-a-value"),
        pytest.param(HEADER + "0,\n", "line 2, gradient_permille", "",
                     "decimal point and no unit", id="empty-cell"),
        pytest.param("position_km,gradient\n0,1\n", "line 1", "position_km,gradient",
                     "begin with the line", id="other-column"),
        pytest.param("gradient_permille,position_km\n1,0\n", "line 1",
                     "gradient_permille,position_km", "begin with the line", id="columns-swapped"),
        pytest.param("", "line 1", "", "begin with the line", id="empty"),
        pytest.param("# nothing\n", "line 1", "", "begin with the line", id="comments-only"),
        pytest.param("# a\n" + HEADER, "line 2", HEADER.strip(), "add rows", id="header-only"),
    ],
)  # fmt: skip
def test_a_fault_of_a_profile_is_reported_with_its_line(copied, text, key, value, remedy):
    profile = copied.with_name("gradients_a_160km.csv")
    profile.write_text(text, encoding="utf-8")
    (finding,) = faults_of({}, copied)
    assert finding.file == str(profile)
    assert (finding.key, finding.value) == (key, value)
    assert remedy in finding.remedy


def test_every_fault_of_a_profile_is_reported(copied):
    profile = copied.with_name("gradients_a_160km.csv")
    profile.write_text(HEADER + "a,b\n1\n2,3,4\n", encoding="utf-8")
    keys = [finding.key for finding in faults_of({}, copied)]
    assert keys == ["line 2, position_km", "line 2, gradient_permille", "line 3", "line 4"]


def test_a_missing_profile_is_reported_with_those_that_are_there(copied):
    finding = finding_at(INLINE, faults_of({INLINE: "gradients_c.csv"}, copied))
    assert finding.file == str(copied.with_name("gradients_c.csv"))
    assert "gradients_a_160km.csv" in finding.remedy


def test_a_folder_in_place_of_a_profile_is_reported(copied):
    finding = finding_at(INLINE, faults_of({INLINE: "."}, copied))
    assert "check that it is a file" in finding.remedy


def test_a_missing_file_is_reported_with_those_that_are_there(copied):
    (finding,) = faults_of({}, copied.with_name("thesis.toml"))
    assert finding.file == str(copied.with_name("thesis.toml"))
    assert finding.problem == "there is no such file"
    assert "thesis_160km.toml" in finding.remedy


def test_a_missing_folder_is_reported(tmp_path):
    (finding,) = faults_of({}, tmp_path / "nowhere" / "thesis.toml")
    assert f"there is no folder {tmp_path / 'nowhere'}" in finding.remedy


def test_a_folder_in_place_of_a_file_is_reported(tmp_path):
    (finding,) = faults_of({}, tmp_path)
    assert finding.file == str(tmp_path)
    assert "check that it is a file" in finding.remedy


@pytest.mark.parametrize(
    ("content", "place", "value", "problem", "remedy"),
    [
        pytest.param(b"format = 1\nname = \n", "line 2", "name =", "Invalid value",
                     "mend the file", id="no-value"),
        pytest.param(b"name = 'a'\nname = 'b'\n", "line 2", "name = 'b'", "not TOML",
                     "mend the file", id="key-twice"),
        pytest.param(b"[line]\r\nlength_km = 160 km\r\n", "line 2", "length_km = 160 km",
                     "not TOML", "mend the file", id="unit-behind-a-number"),
        pytest.param(b"[line\n", "line 1", "[line", "not TOML", "mend the file", id="bracket"),
        pytest.param(b"x = [1,", "", "", "at end of document", "mend the file", id="cut-off"),
        pytest.param(b"position_km,gradient_permille\n", "line 1",
                     "position_km,gradient_permille", "not TOML", "toml.io", id="csv"),
        pytest.param(b"# a\nname = 'Lule\xe5'\n", "line 2", "byte 0xe5", "not text in UTF-8",
                     "UTF-8", id="latin-1"),
    ],
)  # fmt: skip
def test_a_file_that_is_not_toml_is_reported(tmp_path, content, place, value, problem, remedy):
    file = tmp_path / "line.toml"
    file.write_bytes(content)
    (finding,) = faults_of({}, file)
    assert (finding.file, finding.key, finding.value) == (str(file), place, value)
    assert problem in finding.problem
    assert remedy in finding.remedy


def test_an_empty_file_lacks_every_part(tmp_path):
    file = tmp_path / "line.toml"
    file.touch()
    keys = {finding.key for finding in faults_of({}, file)}
    assert keys == {"format", "name", "simulation", "line", "supply", "trains", "traffic"}


@pytest.mark.parametrize(
    ("changes", "shown", "problem"),
    [
        pytest.param(placed((10.0, 120.0)), "120", "the limit here, 100 km/h", id="limit"),
        pytest.param({**placed((10.0, 90.0)), f"{FREIGHT}.max_speed_kmh": 80.0}, "90",
                     "the limit here, 80 km/h", id="limit-of-the-train"),
        pytest.param(placed((159.9, 90.0)), "90", "stop at 160 km", id="destination"),
        pytest.param({**placed((79.9, 90.0)), f"{ENTRY}.stops": stops("Middle")}, "90",
                     "stop at 80 km", id="stop"),
        pytest.param({**placed((49.9, 90.0)), **limits((0.0, 100.0), (50.0, 30.0))}, "90",
                     "limit at 50 km", id="limit-ahead"),
    ],
)  # fmt: skip
def test_a_train_placed_too_fast_is_reported_before_the_run(changes, shown, problem):
    scenario = load_scenario(FILE, changes)
    with pytest.raises(ScenarioError) as caught:
        simulate(scenario)
    finding = finding_at(f"{ENTRY}.initial_trains.0.speed_kmh", caught.value.findings)
    assert (finding.file, finding.value) == (str(FILE), shown)
    assert problem in finding.problem
    assert "lower the speed" in finding.remedy


def test_every_train_placed_too_fast_is_reported():
    scenario = load_scenario(FILE, placed((10.0, 120.0), (20.0, 60.0), (159.99, 100.0)))
    with pytest.raises(ScenarioError) as caught:
        simulate(scenario)
    keys = [finding.key for finding in caught.value.findings]
    assert keys == [f"{ENTRY}.initial_trains.{i}.speed_kmh" for i in (0, 2)]


def test_faults_of_all_kinds_are_reported_at_once(copied):
    """A field, a key, a name, an order, a conflict, a reference and a profile, each at fault."""
    copied.with_name("gradients_a_160km.csv").write_text(HEADER + "0,x\n", encoding="utf-8")
    changes = {
        "line.length_km": "160 km",
        "simulation.time_step": 0.5,
        "simulation.duration_min": 90.0,
        "supply.catenary": "BTX",
        "supply.frequency_hz": math.nan,
        f"{HV}.transformers_km": [80.0, 160.0],
        f"{EAST}.name": "West",
        f"{FREIGHT}.efficiency": 1.2,
        f"{ENTRY}.train": "fright",
        f"{ENTRY}.headway_min": 0.0,
        f"{ENTRY}.stops": stops("Midle"),
    }
    keys = {finding.key for finding in faults_of(changes, copied)}
    assert keys >= {
        "line 2, gradient_permille",
        "line.length_km",
        "simulation.time_step",
        "supply.catenary",
        "supply.frequency_hz",
        f"{HV}.transformers_km.1",
        "supply.converter_stations",
        f"{FREIGHT}.efficiency",
        f"{ENTRY}.train",
        f"{ENTRY}.headway_min",
        f"{ENTRY}.stops.0.station",
    }


def test_the_message_shows_file_place_value_and_remedy_of_each_fault():
    with pytest.raises(ScenarioError) as caught:
        load_scenario(FILE, {"supply.catenary": "BTX", f"{WEST}.converters": 0})
    lines = str(caught.value).splitlines()
    assert lines[0] == "2 faults in the input:"
    assert f"{FILE}: supply.catenary = 'BTX'" in lines
    assert f"{FILE}: {WEST}.converters = 0" in lines
    assert sum(line.startswith("    -> ") for line in lines) == 2


def test_a_document_names_itself_where_there_is_no_file():
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_document({}, "my study")
    assert {finding.file for finding in caught.value.findings} == {"my study"}


def paths_of(value: Any, path: str = "") -> list[str]:
    """Key paths of all parts of a document, the leaves included."""
    if isinstance(value, dict):
        items = [(key, item) for key, item in value.items()]
    elif isinstance(value, list):
        items = [(str(i), item) for i, item in enumerate(value)]
    else:
        return [path]
    inner = [below for key, item in items for below in paths_of(item, f"{path}.{key}".lstrip("."))]
    return [path, *inner] if path else inner


NUMBERS = [-1, 0, 1e308, -math.inf, math.nan]
JUNK: list[Any] = [None, True, *NUMBERS, "", "x", [], [None], [[]], {}, {"x": {}}]


PATHS = [path for path in paths_of(read_toml(FILE)) if path not in (f"{ENTRY}.from", f"{ENTRY}.to")]


@pytest.mark.parametrize("path", PATHS)
def test_no_value_anywhere_leads_to_anything_but_findings(path):
    for junk in JUNK:
        with suppress(ScenarioError):
            load_scenario(FILE, {path: junk})
