"""Values that do not go together: each fault is reported with its place, its value and a remedy."""

import math
from contextlib import suppress
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
    LIMITATION,
    NOT_RUNNING,
    WEST,
    faults_of,
    finding_at,
    gradients,
    limits,
    placed,
    shows,
    stations,
    stops,
)  # fmt: skip
from tpss import Scenario, ScenarioError, load_scenario, simulate
from tpss.scenario.files import read_toml

ORDER_AND_UNIQUENESS = [
    pytest.param(gradients((0.0, 1.0), (10.0, 2.0), (5.0, 3.0)), "line.gradients", "[{'from_km'",
                 "ascending order", id="gradients-unsorted"),
    pytest.param(gradients((0.0, 1.0), (0.0, 2.0)), "line.gradients", "[{'from_km'",
                 "each value once", id="gradients-twice"),
    pytest.param(limits((0.0, 90.0), (40.0, 70.0), (20.0, 80.0)), "line.speed_limits",
                 "[{'from_km'", "ascending order", id="limits-unsorted"),
    pytest.param(limits((0.0, 90.0), (0.0, 70.0)), "line.speed_limits", "[{'from_km'",
                 "each value once", id="limits-twice"),
    pytest.param(limits((5.0, 90.0)), "line.speed_limits.0.from_km", "5",
                 "begin at 0", id="limits-begin-late"),
    pytest.param({f"{HV}.transformers_km": [80.0, 40.0]}, f"{HV}.transformers_km", "[80.0, 40.0]",
                 "ascending order", id="transformers-unsorted"),
    pytest.param({f"{HV}.transformers_km": [40.0, 40.0]}, f"{HV}.transformers_km", "[40.0, 40.0]",
                 "each value once", id="transformers-twice"),
    pytest.param({**BY_TIMETABLE, f"{ENTRY}.departures_min": [0.0, 20.0, 10.0]},
                 f"{ENTRY}.departures_min", "[0.0, 20.0, 10.0]", "ascending order",
                 id="departures-unsorted"),
    pytest.param({"line.stations.1.name": "West"}, "line.stations", "[{'name': 'West'",
                 "give each one its own", id="station-name-twice"),
    pytest.param({"line.stations.1.position_km": 0.0}, "line.stations", "[{'name': 'West'",
                 "give each one its own", id="station-position-twice"),
    pytest.param({"line.stations.1.position_km": 1e-9}, "line.stations", "[{'name': 'West'",
                 "move one of them", id="stations-within-a-millimetre"),
    pytest.param({f"{EAST}.name": "West"}, "supply.converter_stations", "[{'name': 'West'",
                 "give each one its own", id="converter-station-name-twice"),
    pytest.param({f"{EAST}.position_km": 0.0}, "supply.converter_stations", "[{'name': 'West'",
                 "give each one its own", id="converter-station-position-twice"),
    pytest.param({"traffic": [{"name": "a", "train": "freight", "from": "West", "to": "East",
                               "headway_min": 10.0}] * 2},
                 "traffic", "[{'name': 'a'", "give each one its own", id="traffic-name-twice"),
]  # fmt: skip

CURVE = {"from_km": 10.0, "to_km": 12.0, "radius_m": 400.0}

PLACES = [
    pytest.param({"line.curves": [{**CURVE, "to_km": 170.0}]}, "line.curves.0.to_km", "170",
                 "between 0 and 160 km", id="curve-beyond-the-line"),
    pytest.param({"line.curves": [{**CURVE, "to_km": 9.0}]}, "line.curves.0", "",
                 "the lower position as from_km", id="curve-that-ends-before-it-begins"),
    pytest.param({"line.curves": [CURVE, {**CURVE, "from_km": 11.0, "to_km": 13.0}]}, "line.curves",
                 "[{'from_km'", "give each place one radius", id="curves-that-overlap"),
    pytest.param({"line.stations.2.position_km": 200.0}, "line.stations.2.position_km", "200",
                 "between 0 and 160 km", id="station-beyond-the-line"),
    pytest.param({f"{EAST}.position_km": 161.0}, f"{EAST}.position_km", "161",
                 "between 0 and 160 km", id="converter-station-beyond-the-line"),
    pytest.param({f"{HV}.transformers_km": [40.0, 170.0]}, f"{HV}.transformers_km.1", "170",
                 "between 0 and 160 km", id="transformer-beyond-the-line"),
    pytest.param({f"{HV}.transformers_km": [-1.0, 80.0]}, f"{HV}.transformers_km.0", "-1",
                 "between 0 and 160 km", id="transformer-before-the-line"),
    pytest.param({f"{EAST}.position_km": 0.0005}, f"{EAST}.position_km", "0.00050000000000000001",
                 "leave one of them out", id="converter-stations-half-a-metre-apart"),
    pytest.param({f"{EAST}.grid_reactive_power_mvar": -75.0, f"{EAST}.converters": 3},
                 EAST, "", "run more converters", id="motors-without-voltage"),
    pytest.param({f"{HV}.transformers_km": [40.0, 40.0005]}, f"{HV}.transformers_km.1", "40.000",
                 "leave one of them out", id="transformers-half-a-metre-apart"),
    pytest.param({f"{HV}.transformers_km": [159.9995]}, f"{HV}.transformers_km.0", "159.999",
                 "leave one of them out", id="transformer-half-a-metre-before-a-station"),
    pytest.param({f"{EAST}.position_km": 0.002, f"{HV}.transformers_km": None,
                  f"{HV}.transformers": 3}, f"{HV}.transformers", "3", "use fewer",
                 id="more-transformers-than-metres"),
    pytest.param({f"{HV}.transformers_km": [80.0, 160.0]}, f"{HV}.transformers_km.1", "160",
                 "leave it out", id="transformer-at-a-converter-station"),
    pytest.param({"supply.converter_stations": [{"name": "West", "position_km": 0.0,
                                                 "type": "Q48/Q49", "converters": 6}],
                  f"{HV}.transformers_km": None, f"{HV}.transformers": 2},
                 f"{HV}.transformers", "2", "give transformers_km instead",
                 id="transformers-between-one-station"),
    pytest.param({f"{ENTRY}.to": "West"}, f"{ENTRY}.to", "'West'", "name another station",
                 id="to-where-it-begins"),
    pytest.param({f"{ENTRY}.stops": stops("East")}, f"{ENTRY}.stops.0.station", "'East'",
                 "without the first and last", id="stop-at-the-destination"),
    pytest.param({f"{ENTRY}.to": "Middle", f"{ENTRY}.stops": stops("East")},
                 f"{ENTRY}.stops.0.station", "'East'", "in the order", id="stop-outside-the-way"),
    pytest.param({"line.stations": stations(("West", 0.0), ("A", 40.0), ("B", 80.0), ("East", 160.0)),
                  f"{ENTRY}.stops": stops("B", "A")},
                 f"{ENTRY}.stops.1.station", "'A'", "in the order", id="stops-out-of-order"),
    pytest.param({f"{ENTRY}.stops": stops("Middle", "Middle")}, f"{ENTRY}.stops.1.station",
                 "'Middle'", "in the order", id="stop-twice"),
    pytest.param(placed((160.0, 10.0)), f"{ENTRY}.initial_trains.0.position_km", "160",
                 "on the route of its trains", id="initial-train-at-the-destination"),
    pytest.param(placed((1e308, 10.0)), f"{ENTRY}.initial_trains.0.position_km", "1e+300",
                 "on the route of its trains", id="initial-train-beyond-all-bounds"),
    pytest.param({f"{EAST}.position_km": 1e308}, f"{EAST}.position_km", "1e+300",
                 "between 0 and 160 km", id="converter-station-beyond-all-bounds"),
    pytest.param({**placed((120.0, 10.0)), f"{ENTRY}.to": "Middle"},
                 f"{ENTRY}.initial_trains.0.position_km", "120", "on the route of its trains",
                 id="initial-train-outside-the-way"),
]  # fmt: skip

CONFLICTS = [
    pytest.param({**NOT_RUNNING, f"{ENTRY}.departures_min": [0.0]}, ENTRY, "",
                 "leave all but one of them out", id="headway-and-departures"),
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
    pytest.param({f"{FREIGHT}.tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 2000.0,
                                                 "limit_speed_kmh": 18.0},
                  f"{FREIGHT}.power_factor": 1.0}, f"{FREIGHT}.tractive_effort", "",
                 "raise it to 36 km/h at least", id="pull-out-below-the-knee"),
    pytest.param({f"{FREIGHT}.rotating_mass_share": 0.06, f"{FREIGHT}.rotating_mass_factor": 0.04},
                 FREIGHT, "", "leave out rotating_mass_factor", id="rotating-mass-twice"),
    pytest.param({f"{FREIGHT}.rotating_mass_share": 0.06, f"{FREIGHT}.motor_inertia_kg": 9000.0},
                 FREIGHT, "", "leave out motor_inertia_kg", id="motors-in-the-share-and-beside-it"),
    pytest.param({f"{FREIGHT}.adhesive_mass_t": 1470.0, f"{FREIGHT}.rotating_mass_factor": 0.1},
                 FREIGHT, "", "write rotating_mass_share = 0.1", id="rotating-mass-of-nothing-hauled"),
    pytest.param({f"{FREIGHT}.adhesive_mass_t": 1470.0, f"{FREIGHT}.rotating_mass_factor": 1.0},
                 FREIGHT, "", "write rotating_mass_share = 0.5", id="rotating-mass-beyond-any-share"),
    pytest.param({f"{ENTRY}.headway_min": None, f"{ENTRY}.departures_min": [0.0]}, ENTRY, "",
                 "use it with headway_min alone", id="already-running-by-timetable"),
    pytest.param({f"{ENTRY}.initial_trains": [{"position_km": 1.0, "speed_kmh": 1.0}]}, ENTRY, "",
                 "leave already_running out", id="already-running-and-initial-trains"),
    pytest.param({**BY_TIMETABLE, f"{ENTRY}.departures_min": [0.0],
                  f"{ENTRY}.first_departure_min": 5.0}, ENTRY, "",
                 "leave first_departure_min out", id="first-departure-and-timetable"),
    pytest.param({"simulation.driver": "aggressive", "simulation.time_step_min": 1.5},
                 "simulation.time_step_min", "1.5", "use 1 min or less",
                 id="aggressive-driver-in-long-steps"),
    pytest.param({"simulation.load_flow": "least-squares", "simulation.time_step_min": None},
                 "simulation.time_step_min", "", "add it", id="least-squares-without-a-step"),
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
    [*ORDER_AND_UNIQUENESS, *PLACES, *CONFLICTS, *KEY_PATHS],
)
def test_a_conflict_is_reported_with_place_value_and_remedy(changes, key, value, remedy):
    finding = finding_at(key, faults_of(changes))
    assert finding.file == str(FILE)
    assert shows(finding, value)
    assert finding.problem
    assert remedy in finding.remedy


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
