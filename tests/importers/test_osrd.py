"""Infrastructure and trains of OSRD: the lines and the timetable that they become."""

import copy
import csv
import json
from pathlib import Path
from typing import Any

import pytest

import tpss
from tpss.cli.main import main
from tpss.importers.feeding import feeding_places
from tpss.importers.network import ImportedNetwork, NetworkLine
from tpss.importers.network_files import files
from tpss.importers.osrd import read
from tpss.importers.timetable import seconds_of

from osrd_made_up import INFRA, TRAINS, circle, on, parallel, point, ports, track


def write(path: Path, document: Any) -> Path:
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


@pytest.fixture
def network(tmp_path):
    """Reader of documents as files."""

    def of(infra: Any, trains: Any = None) -> ImportedNetwork:
        there = write(tmp_path / "trains.json", trains) if trains is not None else None
        return read(write(tmp_path / "made.json", infra), there)

    return of


def named(network: ImportedNetwork) -> dict[str, NetworkLine]:
    return {line.name: line for line in network.lines}


def call(monkeypatch, *arguments: object) -> int | str | None:
    monkeypatch.setattr("sys.argv", ["tpss", *map(str, arguments)])
    with pytest.raises(SystemExit) as exited:
        main()
    return exited.value.code


# Lines


def test_tracks_of_one_name_become_a_line_though_the_switch_lists_another_way_first(network):
    """M1 of 6 km, then M2 backwards, 4 km: B2 of the switch, as B1 leads to the branch."""
    lines = named(network(INFRA))
    assert list(lines) == ["Main_V1", "Branch_V1"]
    assert (lines["Main_V1"].length_km, lines["Branch_V1"].length_km) == (10.0, 5.0)
    assert lines["Main_V1"].stations == {"West": 0.0, "Fork": 6.0, "East": 10.0}


def test_lines_meet_at_the_switch_which_has_one_name_on_both(network):
    """The mine has two parts on its track, 4.8 and 5 km from the switch: the first is its station."""
    found = network(INFRA)
    assert named(found)["Branch_V1"].stations == {"Fork": 0.0, "Mine": 4.8}
    assert "further parts of operational points on one line: 1" in found.left_out


def test_slopes_turn_with_a_track_that_runs_the_other_way(network):
    """M2 climbs 2 ‰ from its beginning, km 10, to km 9: towards rising km it falls there."""
    assert named(network(INFRA))["Main_V1"].gradients == [(0, 0), (1, 5), (3, 0), (9, -2)]


def test_curves_have_the_radius_without_its_side_and_too_sharp_ones_are_left_out(network):
    found = network(INFRA)
    assert named(found)["Main_V1"].curves == [(2.0, 2.5, 800.0)]
    assert "curves below 100 m or beyond 100 km: 1" in found.left_out


def test_limits_hold_in_their_directions_the_lowest_of_several(network):
    """40 m/s = 144 km/h; 72 km/h towards rising km on the last km of M1, and from its beginning to its
    end on the last km of M2, which is towards falling km, from 7 to 6.  None holds on the branch.
    """
    lines = named(network(INFRA))
    assert lines["Main_V1"].limits == [(0, 144), (5, 72), (6, 144)]
    assert lines["Main_V1"].limits_down == [(0, 144), (6, 72), (7, 144)]
    assert (lines["Branch_V1"].limits, lines["Branch_V1"].limits_down) == ([(0, 500)], [])


def test_what_is_left_out_is_counted(network):
    told = network(INFRA).left_out
    assert "signalling: 2 signals, 1 routes, 3 detectors" in told
    assert any(each.startswith("announcements of neutral sections: 1") for each in told)
    assert "speed sections of single routes: 1" in told
    assert "speed sections of single kinds of train: 1" in told
    assert any("25000V on 6 km of track" in each for each in told)


def test_neutral_sections_are_those_of_both_directions_and_end_before_lines_meet(network):
    """On M1 those of 5.9 to 6 km and of 5.7 to 5.95 km overlap: one, which ends 2 m before the switch at
    km 6.  That on M2, at 2 to 2.1 km from its end at km 10, lies at km 7.9 to 8.
    """
    found = network(INFRA)
    assert found.neutral_sections == [
        ("Main_V1", 5.7, 5.998, 15.0), ("Main_V1", 7.9, 8.0, 0.0),
    ]  # fmt: skip
    assert any(each.startswith("neutral sections: 2") for each in found.taken)
    assert any(each.startswith("15 s until power is back") for each in found.assumed)


def test_each_side_of_a_neutral_section_has_a_feeding_station(network):
    """West to km 5.7, the fork with the branch, and East beyond km 8."""
    places = feeding_places(network(INFRA))
    assert sorted(place.at for place in places) == ["East", "Fork", "West"]


def test_a_stretch_between_neutral_sections_without_a_station_is_fed_in_its_middle(network):
    """Between km 1 and km 2 of the main line there is no station."""
    infra = copy.deepcopy(INFRA)
    infra["neutral_sections"] = [
        {"id": str(km), "track_ranges": [on("M1", 1e3 * km - 50.0, 1e3 * km)]} for km in (1, 2)
    ]
    found = network(infra)
    assert ("Main_V1 1.475 km", "", "Main_V1", 1.475) in feeding_places(found)
    text = files(found)["scenario.toml"]
    assert 'line = "Main_V1"\nposition_km = 1.475\n' in text


def test_a_neutral_section_at_a_place_where_lines_meet_is_told(network):
    """4 m before the switch only 2 m would be left of it."""
    infra = copy.deepcopy(INFRA)
    infra["neutral_sections"] = [{"id": "n", "track_ranges": [on("M1", 5996.0, 6000.0)]}]
    found = network(infra)
    assert not found.neutral_sections
    assert "neutral sections where lines meet or end: 1" in found.left_out


def test_no_station_is_far_from_a_feeding_station(network):
    """70 km and 40 km of the main line: one at the fork, and at its ends, 70 and 40 km away."""
    infra = copy.deepcopy(INFRA)
    infra |= {"neutral_sections": [], "speed_sections": [], "operational_points": []}
    infra["track_sections"] = [
        each | {"length": {"M1": 70e3, "M2": 40e3}.get(each["id"], each["length"]), "slopes": [],
                "curves": []} for each in infra["track_sections"]
    ]  # fmt: skip
    assert [place.at for place in feeding_places(network(infra))] == [
        "Fork", "Begin of M1", "End of M2",
    ]  # fmt: skip


def test_each_track_lies_on_a_line_once(network):
    """M2 runs from km 10 down to km 6: its position is 4000 m at km 6, 0 at km 10."""
    found = network(INFRA)
    ranges = [(each.track, each.line, each.from_km, each.to_km) for each in found.tracks]
    assert ranges == [
        ("M1", "Main_V1", 0, 6), ("M2", "Main_V1", 6, 10), ("B1", "Branch_V1", 0, 5),
    ]  # fmt: skip
    assert (found.tracks[1].begin_m, found.tracks[1].end_m) == (4000.0, 0.0)


def test_without_names_the_longest_chains_become_lines(network):
    """left, upper, right in a row: the first way of each switch; lower is a line of its own."""
    found = network(parallel())
    assert [line.length_km for line in found.lines] == [6.0, 1.0]


def test_parallel_tracks_of_one_length_have_a_station_each_by_which_a_service_chooses(network):
    """Between S1 and S2 both are 1 km long: 2 km from the beginning, the middle is at 2.5 km."""
    first, second = network(parallel()).lines
    middles = [name for line in (first, second) for name in line.stations if "Middle" in name]
    assert first.stations[middles[0]] == 2.5
    assert second.stations[middles[1]] == 0.5
    assert len(middles) == 2


def test_a_circle_is_cut_where_it_comes_to_its_beginning_again(network):
    """4 km around, no station on it: one half-way, and two lines between both, which are as long."""
    found = network(circle())
    assert [line.length_km for line in found.lines] == [2.0, 2.0]
    one, other = (list(line.stations) for line in found.lines)
    assert (one[0], one[-1]) == (other[-1], other[0]) == ("Begin of one", "Loop at Begin of one")


def test_ends_of_a_track_that_is_too_short_for_a_line_are_one_station(network):
    """A crossover of 9 m between the switches A and B."""
    infra = copy.deepcopy(INFRA)
    infra["track_sections"] = [
        track("U1", 3000.0, "U"), track("U2", 3000.0, "U"), track("X", 9.0, "X"),
        track("N1", 3000.0, "N"), track("N2", 3000.0, "N"),
    ]  # fmt: skip
    points = {"switch_type": "point_switch"}
    infra["switches"] = [
        {"id": "A", **points, "ports": ports(A="U1.END", B1="U2.BEGIN", B2="X.BEGIN")},
        {"id": "B", **points, "ports": ports(A="N2.BEGIN", B1="N1.END", B2="X.END")},
    ]
    infra |= {"operational_points": [], "speed_sections": [], "electrifications": []}
    lines = named(network(infra))
    assert set(lines) == {"U_V1", "N_V1"}
    assert lines["U_V1"].stations == {"Begin of U1": 0.0, "A": 3.0, "End of U2": 6.0}
    assert lines["N_V1"].stations == {"Begin of N1": 0.0, "A": 3.0, "End of N2": 6.0}


def test_a_crossing_lets_lines_cross_and_not_meet(network):
    infra = copy.deepcopy(INFRA)
    infra["track_sections"] = [
        track("U1", 3000.0, "U"), track("U2", 3000.0, "U"),
        track("N1", 2000.0, "N"), track("N2", 2000.0, "N"),
    ]  # fmt: skip
    crossed = ports(A1="U1.END", B1="U2.BEGIN", A2="N1.END", B2="N2.BEGIN")
    infra["switches"] = [{"id": "X", "switch_type": "crossing", "ports": crossed}]
    infra |= {"operational_points": [], "speed_sections": [], "electrifications": []}
    found = network(infra)
    assert [list(line.stations.values()) for line in found.lines] == [[0, 6], [0, 4]]
    assert len(feeding_places(found)) == 2


def test_two_operational_points_of_one_name_are_told_apart(network):
    infra = copy.deepcopy(INFRA)
    infra["operational_points"][1] = point("West", 2, ("M2", 0.0))
    assert list(named(network(infra))["Main_V1"].stations) == ["West", "Fork", "West-2"]


# Trains


def rows_of(network: ImportedNetwork) -> list[dict[str, str]]:
    return list(csv.DictReader(files(network)["timetable.csv"].splitlines()))


def test_trains_become_rows_of_a_timetable(network):
    """West at 05:40:00, past 3 km 2.5 min later; the mine, on the branch, at 05:50."""
    rows = [tuple(row.values()) for row in rows_of(network(INFRA, TRAINS)) if row["name"] == "4101"]
    assert rows == [
        ("4101", "Fast_freight", "West", "", "05:40:00", "", "start"),
        ("4101", "", "M1 at 3.000 km", "05:42:30", "", "", "pass"),
        ("4101", "", "Mine", "05:50:00", "", "", "end"),
    ]


def test_times_go_on_beyond_midnight(network):
    """A day later, 00:05, and 5 minutes at the origin; 12 min after 00:05 a stop of 90 s."""
    rows = [tuple(row.values()) for row in rows_of(network(INFRA, TRAINS)) if row["name"] == "4102"]
    assert rows == [
        ("4102", "train", "East", "", "24:10:00", "", "start"),
        ("4102", "", "M1 at 3.000 km", "24:17:00", "24:18:30", "90", "stop"),
        ("4102", "", "West", "", "", "", "end"),
    ]


def test_places_of_trains_become_stations(network):
    assert named(network(INFRA, TRAINS))["Main_V1"].stations["M1 at 3.000 km"] == 3.0


def test_what_of_trains_is_left_out_is_counted(network):
    told = network(INFRA, TRAINS).left_out
    assert any(each.startswith("margins") and each.endswith("of 1 of the trains") for each in told)
    assert "trains with places that the infrastructure does not have: 1" in told


def test_trains_over_parallel_tracks_take_the_longer_line(network):
    trains = [{
        "train_name": "t", "start_time": "2024-05-01T06:00:00Z",
        "path": [{"id": "a", "track": "left", "offset": 0},
                 {"id": "b", "track": "right", "offset": 3_000_000}],
    }]  # fmt: skip
    stations = [row["station"] for row in rows_of(network(parallel(), trains))]
    assert stations == ["left at 0.000 km", "Middle of line, from S1", "right at 3.000 km"]


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("PT5M", 300.0), ("P0D", 0.0), ("PT120S", 120.0), ("P1DT1H0.5S", 90_000.5)],
)
def test_durations(text, seconds):
    assert seconds_of(text) == seconds


# Files


def test_the_files_are_a_scenario_without_faults(tmp_path, monkeypatch, capsys):
    infra = write(tmp_path / "made.json", INFRA)
    assert call(monkeypatch, "import", "osrd", infra, "--out", tmp_path / "m") == 0
    printed = capsys.readouterr().out
    assert "signalling: 2 signals, 1 routes, 3 detectors" in printed
    assert call(monkeypatch, "check", tmp_path / "m" / "scenario.toml") == 0
    scenario = tpss.load_scenario(tmp_path / "m" / "scenario.toml")
    assert scenario.supply.system == "25kV-50Hz"
    assert {station.at for station in scenario.supply.stations} == {"West", "Fork", "East"}
    text = (tmp_path / "m" / "scenario.toml").read_text("utf-8")
    assert text.count("ASSUMED, edit it") == 4  # duration, supply, train and service
    assert (tmp_path / "m" / "tracks.csv").read_text().splitlines()[2] == "Main_V1,6,10,M2,4000,0"


@pytest.mark.parametrize("infra", [parallel(), circle()])
def test_a_service_over_parallel_tracks_names_its_way(infra, tmp_path, monkeypatch):
    there = write(tmp_path / "made.json", infra)
    assert call(monkeypatch, "import", "osrd", there, "--out", tmp_path / "m") == 0
    assert call(monkeypatch, "check", tmp_path / "m" / "scenario.toml") == 0


def test_a_scenario_with_trains_names_the_timetable_and_its_clock(network):
    """From 05:40, rounded down to 5 min, until an hour after 24:18:30: 18 h 38.5 min and 60 min."""
    text = files(network(INFRA, TRAINS))["scenario.toml"]
    assert 'starts_at = "05:40"\nduration_min = 1179.0 ' in text
    assert '[[timetables]]\nfile = "timetable.csv"' in text
    assert "[trains.Fast_freight]" in text
    assert "[trains.train]" in text
    assert "[[traffic]]" not in text


def test_a_scenario_with_trains_has_no_faults(tmp_path, monkeypatch):
    there = [write(tmp_path / "i.json", INFRA), write(tmp_path / "t.json", TRAINS)]
    assert call(monkeypatch, "import", "osrd", *there, "--out", tmp_path / "m") == 0
    assert call(monkeypatch, "check", tmp_path / "m" / "scenario.toml") == 0


def changed(document: Any, changes: dict[str, Any]) -> Any:
    """Copy with values at key paths changed; None takes one out."""
    document = copy.deepcopy(document)
    for path, value in changes.items():
        *above, last = (int(key) if key.isdigit() else key for key in path.split("."))
        at = document
        for key in above:
            at = at[key]
        if value is None:
            del at[last]
        else:
            at[last] = value
    return document


@pytest.mark.parametrize(
    ("changes", "key", "value", "problem"),
    [
        ({"version": "2.2.1"}, "version", "'2.2.1'", "not an infrastructure of railjson 3"),
        ({"version": None}, "version", "", "not an infrastructure of railjson 3"),
        ({"track_sections": []}, "track_sections", "[]", "at least 1 item"),
        ({"track_sections.0.length": -5.0}, "track_sections.0.length", "-5.0", "greater than 0"),
        ({"track_sections.0.id": None}, "track_sections.0.id", "", "it is missing"),
        ({"track_sections.1.id": "M1"}, "track_sections.1.id", "'M1'", "has this id"),
        ({"switches.0.ports.A.track": "M9"}, "switches.0.ports.A.track", "'M9'", "no such track"),
        ({"switches.0.switch_type": "magic"}, "switches.0.switch_type", "'magic'", "no such type"),
        ({"switches.0.ports.B1": None}, "switches.0.ports", "'B1'", "no such port"),
        ({"operational_points.0.parts.0.track": "M9"}, "operational_points.0.parts.0.track", "'M9'",
         "no such track"),
        ({"speed_sections.0.track_ranges.0.track": "M9"},
         "speed_sections.0.track_ranges.0.track", "'M9'", "no such track"),
        ({"track_sections.0.slopes.0.gradient": 200.0}, "track_sections.0.slopes.0.gradient",
         "200.0", "less than or equal to 100"),
    ],
)  # fmt: skip
def test_a_fault_names_file_place_value_and_remedy(network, changes, key, value, problem):
    with pytest.raises(tpss.ScenarioError) as caught:
        network(changed(INFRA, changes))
    finding = caught.value.findings[0]
    assert (Path(finding.file).name, finding.key, finding.value) == ("made.json", key, value)
    assert problem in finding.problem
    assert finding.remedy


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"0.path": []}, "0.path"),
        ({"0.start_time": "tomorrow"}, "0.start_time"),
        ({"0.schedule.0.arrival": "2 minutes"}, "0.schedule.0.arrival"),
        ({"0.train_name": ""}, "0.train_name"),
    ],
)
def test_a_fault_of_a_train_does_too(network, changes, key):
    with pytest.raises(tpss.ScenarioError) as caught:
        network(INFRA, changed(TRAINS, changes))
    assert (Path(caught.value.findings[0].file).name, caught.value.findings[0].key) == (
        "trains.json", key,
    )  # fmt: skip
