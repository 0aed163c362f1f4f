"""Faults of single values: each is reported with its place, its value and a remedy."""

import math
from typing import Any

import pytest

from faults import (
    BY_TIMETABLE,
    EAST,
    ENTRY,
    FILE,
    FREIGHT,
    HV,
    INLINE,
    NOT_RUNNING,
    WEST,
    faults_of,
    finding_at,
    gradients,
    limits,
    shows,
    stations,
    stops,
)  # fmt: skip


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
    unknown(ENTRY, "departures", [0.0], "departures_min"),
    pytest.param(
        {f"{ENTRY}.stops": [{"station": "Middle", "dwell_min": 1.0, "dwell_s": 60.0}]},
        f"{ENTRY}.stops.0.dwell_s", "60.0", "did you mean dwell_min?", id="key-of-a-stop",
    ),
    pytest.param(
        {**NOT_RUNNING, f"{ENTRY}.initial_trains": [{"position_km": 1.0, "speed_kmh": 1.0, "v": 1}]},
        f"{ENTRY}.initial_trains.0.v", "1", "choose from line, position_km, speed_kmh",
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
    pytest.param({"line.stations.0.position_km": -5.0}, "line.stations.0.position_km", "-5",
                 "between 0 and 160 km", id="negative-position"),
    pytest.param({"line.begins_at_km": -20_000.0}, "line.begins_at_km", "-20000.0",
                 "greater than or equal to -10000 km", id="beyond-all-railways"),
    pytest.param({"simulation.time_step_min": 0.0}, "simulation.time_step_min", "0.0",
                 "greater than or equal to 0.001 min", id="no-time-step"),
    pytest.param({"simulation.until": None, "simulation.duration_min": -90.0},
                 "simulation.duration_min", "-90.0", "greater than or equal to 0.001 min",
                 id="negative-duration"),
    pytest.param({"supply.frequency_hz": 0.0}, "supply.frequency_hz", "0.0",
                 "choose a system of direct current", id="direct-current"),
    pytest.param({"supply.frequency_hz": 1000.0}, "supply.frequency_hz", "1000.0",
                 "less than or equal to 60 Hz", id="high-frequency"),
    pytest.param({f"{WEST}.converters": 0}, f"{WEST}.converters", "0",
                 "greater than or equal to 1", id="no-converters"),
    pytest.param({f"{FREIGHT}.efficiency": 1.2}, f"{FREIGHT}.efficiency", "1.2",
                 "less than or equal to 1", id="efficiency-beyond-1"),
    pytest.param({f"{FREIGHT}.mass_t": -1470.0}, f"{FREIGHT}.mass_t", "-1470.0",
                 "greater than or equal to 1 t", id="negative-mass"),
    pytest.param({f"{FREIGHT}.rotating_mass_factor": 1.06}, f"{FREIGHT}.rotating_mass_factor",
                 "1.06", "write rotating_mass_share = 0.06", id="factor-of-the-whole-mass"),
    pytest.param({f"{FREIGHT}.rotating_mass_share": 1.1}, f"{FREIGHT}.rotating_mass_share", "1.1",
                 "write rotating_mass_share = 0.1", id="factor-for-a-share"),
    pytest.param({f"{FREIGHT}.length_m": 0.7}, f"{FREIGHT}.length_m", "0.7", "give the length in m",
                 id="length-in-kilometres"),
    pytest.param({f"{FREIGHT}.adhesion": 30.0}, f"{FREIGHT}.adhesion", "30.0",
                 "less than or equal to 1", id="adhesion-in-percent"),
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
    pytest.param({"name": "a/b"}, "name", "'a/b'", "letters (a to z), digits, dots",
                 id="name-that-is-no-file-name"),
]  # fmt: skip

MISSING = [
    pytest.param({path: None}, path, "", "add it", id=f"no-{path}")
    for path in (
        "format",
        "name",
        "supply",
        "line.length_km",
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


@pytest.mark.parametrize(
    ("changes", "key", "value", "remedy"),
    [*UNKNOWN_KEYS, *WRONG_TYPES, *OUT_OF_RANGE, *MISSING, *UNKNOWN_NAMES],
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


ABSENT = [
    pytest.param({f"{FREIGHT}.regenerative_braking": True}, f"{FREIGHT}.regenerative_braking",
                 "regeneration at this place", "write [trains.NAME.regeneration]", id="regeneration"),
    pytest.param({"line.neutral_sections": [{"from_km": 4.0, "to_km": 4.1}]}, "line.neutral_sections",
                 "neutral sections", "write [[supply.neutral_sections]]", id="neutral sections"),
    pytest.param({"line.speed_limits": [{"from_km": 0.0, "to_km": 5.0, "speed_kmh": 80.0}]},
                 "line.speed_limits.0.to_km", "an end of a speed limit",
                 "holds until the next one begins; where limits overlap, give the lowest",
                 id="end of a limit"),
    pytest.param({INLINE: None, "line.gradients": [{"from_km": 0.0, "permille": 5.0, "to_km": 3.0}]},
                 "line.gradients.0.to_km", "an end of a gradient", "add an entry with 0",
                 id="end of a gradient"),
    pytest.param({f"{ENTRY}.timetable": []}, f"{ENTRY}.timetable", "a timetable at this place",
                 "write [[timetables]]", id="timetable"),
    pytest.param({f"{ENTRY}.direction": "down"}, f"{ENTRY}.direction", "trains run from `from` to `to`",
                 "in the order of travel", id="direction"),
    pytest.param({"line.tunnels": []}, "line.tunnels", "tunnels", "leave it out", id="tunnels"),
    pytest.param({"line.radii_m": []}, "line.radii_m", "curvature and cant", "line.curves takes",
                 id="radii"),
    pytest.param({"line.elevation_m": []}, "line.elevation_m", "altitudes", "give gradients",
                 id="altitudes"),
    pytest.param({"supply.thermal_limits": True}, "supply.thermal_limits", "a thermal limit",
                 "write rating of a catenary", id="thermal limits"),
    pytest.param({"traffic_signals": True}, "traffic_signals", "signals", "leave it out", id="signals"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "key", "words", "remedy"), ABSENT)
def test_what_is_known_to_be_absent_is_said_as_such_without_a_proposal(changes, key, words, remedy):
    finding = finding_at(key, faults_of(changes))
    assert finding.problem.startswith("unknown key; not modelled: ")
    assert words in finding.problem
    assert remedy in finding.remedy
    assert "did you mean" not in finding.remedy


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({f"{FREIGHT}.reach": 1}, f"{FREIGHT}.reach"),
        ({"line.branches": []}, "line.branches"),
        ({"line.lorries": 1}, "line.lorries"),
        ({f"{ENTRY}.to_km": 5.0}, f"{ENTRY}.to_km"),
    ],
)
def test_nothing_far_fetched_is_proposed(changes, key):
    finding = finding_at(key, faults_of(changes))
    assert finding.problem == "unknown key"
    assert finding.remedy.startswith("choose from ")


def test_a_beginning_of_a_key_is_near_enough():
    finding = finding_at("supply.freq", faults_of({"supply.freq": 16.7}))
    assert "did you mean frequency_hz?" in finding.remedy


def test_a_misspelt_key_is_proposed_though_it_resembles_something_absent():
    changes = {"simulation.adhesion_speed_unt": "m/s"}
    finding = finding_at("simulation.adhesion_speed_unt", faults_of(changes))
    assert "did you mean adhesion_speed_unit?" in finding.remedy


def test_what_follows_from_a_key_at_fault_is_no_fault_of_its_own():
    """Without a system there is no frequency that follows from it."""
    (finding,) = faults_of({"supply.system": "15 kV", "supply.frequency_hz": None})
    assert finding.key == "supply.system"
