"""Routes of a GTFS feed: the lines, the timetable and the services that they become."""

import csv
import tomllib
import zipfile
from datetime import date
from pathlib import Path
from typing import Any

import pytest

import tpss
from tpss.cli.main import main
from tpss.importers.gtfs import read
from tpss.importers.network import ImportedNetwork
from tpss.importers.network_files import files

DEGREE_KM = 6371.0 * 3.141592653589793 / 180.0
"""Between two places on the equator that are a degree apart: 111.195 km."""


FEED = {
    "routes.txt": """\
route_id,route_short_name,route_long_name,route_type
r1,RE 7,Alpha - Delta,2
r2,B,Bus,3
""",
    "trips.txt": """\
route_id,service_id,trip_id,trip_short_name
r1,week,t1,4101
r1,week,t2,4102
r1,week,t3,
r1,sunday,t4,4101
r2,week,t5,
""",
    # every 0.1 degrees of longitude on the equator: 11.1195 km
    "stops.txt": """\
stop_id,stop_name,stop_lat,stop_lon,parent_station
A,Alpha,0,10.0,
B1,Beta platform 1,0,10.1001,B
B2,Beta platform 2,0,10.0999,B
B,Beta,0,10.1,
C,Gamma,0,10.2,
D,Delta,0,10.3,
E,Epsilon,0.1,10.1,
""",
    "stop_times.txt": """\
trip_id,arrival_time,departure_time,stop_id,stop_sequence,pickup_type,drop_off_type
t1,5:40:00,5:40:00,A,1,,
t1,5:50:00,5:51:30,B1,2,,
t1,6:00:00,6:00:00,C,3,,
t1,6:10:00,6:10:00,D,10,,
t2,25:10:00,25:10:00,D,1,,
t2,25:20:00,25:20:00,B2,2,1,1
t2,25:35:00,25:35:00,A,3,,
t3,7:00:00,7:00:00,A,1,,
t3,,,B1,2,,
t3,7:30:00,7:30:00,E,3,,
t4,9:00:00,9:00:00,A,1,,
t4,9:30:00,9:30:00,D,2,,
t5,9:00:00,9:00:00,A,1,,
""",
    "calendar.txt": """\
service_id,monday,tuesday,wednesday,thursday,friday,saturday,sunday,start_date,end_date
week,1,1,1,1,1,0,0,20250301,20250331
sunday,0,0,0,0,0,0,1,20250301,20250331
""",
    "calendar_dates.txt": "service_id,date,exception_type\nweek,20250303,2\n",
    "transfers.txt": "from_stop_id,to_stop_id\n",
}


def write(folder: Path, changes: dict[str, str | None] | None = None) -> Path:
    """A feed in a folder, with some of its tables in another form; None leaves one out."""
    folder.mkdir(exist_ok=True)
    for name, text in (FEED | (changes or {})).items():
        if text is not None:
            (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def feed(tmp_path):
    """Reader of the made-up feed, on a Wednesday."""

    def of(
        day: date | None = date(2025, 3, 12), route: str = "RE 7", **more: Any
    ) -> ImportedNetwork:
        changes = {f"{name}.txt": text for name, text in more.items()}
        return read(write(tmp_path / "feed", changes), [route], day)

    return of


def rows_of(network: ImportedNetwork, name: str) -> list[tuple[str, ...]]:
    rows = csv.DictReader(files(network)["timetable.csv"].splitlines())
    return [tuple(row.values())[2:] for row in rows if row["name"] == name]


def call(monkeypatch, *arguments: object) -> int | str | None:
    monkeypatch.setattr("sys.argv", ["tpss", *map(str, arguments)])
    with pytest.raises(SystemExit) as exited:
        main()
    return exited.value.code


# Lines


def test_the_trip_with_the_most_stations_is_a_line_and_a_branch_another(feed):
    """Alpha to Delta 3 times 11.1195 km; Epsilon is 11.1195 km north of Beta."""
    main_line, branch = feed().lines
    assert list(main_line.stations) == ["Alpha", "Beta", "Gamma", "Delta"]
    assert main_line.length_km == pytest.approx(0.3 * DEGREE_KM, abs=1e-6)
    assert branch.stations == {"Beta": 0.0, "Epsilon": pytest.approx(0.1 * DEGREE_KM, abs=1e-6)}


def test_a_trip_that_passes_stations_without_a_row_runs_on_the_same_line(feed):
    """That of Sunday, from Alpha to Delta without a stop, is no line beside the longer one."""
    both = FEED["calendar.txt"].replace("sunday,0,0,0", "sunday,0,0,1")
    assert len(feed(calendar=both).lines) == 2


@pytest.mark.parametrize(("unit", "of_a_km"), [("m", 1000.0), ("km", 1.0), ("mi", 0.621371)])
def test_kilometres_along_shapes_are_in_the_unit_that_fits_the_coordinates(feed, unit, of_a_km):
    """12 km along the shape for 11.12 km straight."""
    rows = FEED["stop_times.txt"].splitlines()
    stops = [f"{rows[0]},shape_dist_traveled"] + [
        f"{row},{12.0 * of_a_km * i if i < 4 else ''}" for i, row in enumerate(rows[1:])
    ]
    found = feed(stop_times="\n".join(stops))
    assert list(found.lines[0].stations.values()) == pytest.approx([0, 12, 24, 36], rel=1e-5)
    assert any(
        f"3 distances along the shapes of trips, in {unit} " in each for each in found.assumed
    )


def shaped(last: str) -> dict[str, str]:
    """Trip t1 along a shape that climbs half-way to Beta and comes down again, and ends at a place."""
    lines = FEED["trips.txt"].splitlines()
    named = [f"{lines[0]},shape_id", f"{lines[1]},s", *(f"{line}," for line in lines[2:])]
    points = f"s,0.05,10.05,2\ns,0,10.0,1\ns,0,10.1,30\ns,{last},40\n"
    header = "shape_id,shape_pt_lat,shape_pt_lon,shape_pt_sequence\n"
    return {"trips": "\n".join(named), "shapes": header + points}


def test_stops_without_distances_are_placed_on_the_shape_of_their_trip(feed):
    """Two sides of 0.05 times the root of 2 degrees each: 15.725 km, and 0.0001 degrees to Beta's
    platform; straight on from there.
    """
    found = feed(**shaped("0,10.3"))
    beta_km = 2.0 * 0.05 * 2.0**0.5 * DEGREE_KM
    expected = [
        0.0,
        beta_km + 1e-4 * DEGREE_KM,
        beta_km + 0.1 * DEGREE_KM,
        beta_km + 0.2 * DEGREE_KM,
    ]
    assert list(found.lines[0].stations.values()) == pytest.approx(expected, rel=1e-4)
    assert any("3 distances along the shapes of trips, in km" in each for each in found.assumed)


def test_a_shape_that_does_not_lead_to_all_stops_of_a_trip_tells_nothing(feed):
    """It ends at 10.29 degrees, a kilometre before Delta."""
    assert any("4 distances straight" in each for each in feed(**shaped("0,10.29")).assumed)


def test_that_kilometres_are_straight_is_said(feed):
    assert any("4 distances straight" in each and "too short" in each for each in feed().assumed)


def test_a_speed_limit_is_assumed_by_the_fastest_trip(feed):
    """33.36 km in 25 min, t2, and 30 min, t1: 80 km/h, and twice that, rounded up: 170 km/h."""
    assert feed().lines[0].limits == [(0.0, 170.0)]


def test_a_ring_is_cut_where_it_comes_to_a_station_again(feed):
    """Alpha, Gamma, Epsilon, Alpha: the last hop is a line of its own."""
    times = """\
trip_id,arrival_time,departure_time,stop_id,stop_sequence
t1,5:40:00,5:40:00,A,1
t1,5:50:00,5:51:00,C,2
t1,6:00:00,6:01:00,E,3
t1,6:10:00,6:11:00,A,4
"""
    found = feed(stop_times=times)
    assert [list(line.stations) for line in found.lines] == [
        ["Alpha", "Gamma", "Epsilon"],
        ["Epsilon", "Alpha"],
    ]


def test_stops_of_one_name_far_apart_are_two_stations(feed):
    """Alpha and the stop that is called like it, 33 km away."""
    stops = FEED["stops.txt"].replace("D,Delta", "D,Alpha")
    assert list(feed(stops=stops).lines[0].stations) == ["Alpha", "Beta", "Gamma", "Alpha-2"]


# Timetable


def test_a_trip_becomes_rows_with_its_times(feed):
    """Where arrival and departure are the same, 30 s are assumed."""
    assert rows_of(feed(), "4101") == [
        ("Alpha", "", "05:40:00", "", "start"),
        ("Beta", "05:50:00", "05:51:30", "90", "stop"),
        ("Gamma", "06:00:00", "06:00:00", "30", "stop"),
        ("Delta", "06:10:00", "", "", "end"),
    ]


def test_times_go_on_after_midnight_and_a_stop_for_nobody_is_passed(feed):
    assert rows_of(feed(), "4102") == [
        ("Delta", "", "25:10:00", "", "start"),
        ("Beta", "25:20:00", "", "", "pass"),
        ("Alpha", "25:35:00", "", "", "end"),
    ]


def test_a_trip_without_a_name_has_its_id_and_a_stop_without_times_has_none(feed):
    assert rows_of(feed(), "t3")[1] == ("Beta", "", "", "30", "stop")


def test_only_what_runs_on_the_day_is_imported(feed):
    """On a Sunday one train, on Monday 3 March none: the calendar's dates except it."""
    assert len(feed(date(2025, 3, 9)).trains) == 1
    with pytest.raises(tpss.ScenarioError) as caught:
        feed(date(2025, 3, 3))
    assert "give another --date" in caught.value.findings[0].remedy


def test_without_a_day_it_is_the_first_one_with_the_most_trips(feed):
    """1 March 2025 is a Saturday, and on the Monday nothing runs: Tuesday the 4th."""
    assert "day: 2025-03-04, the first one with the most trips" in feed(None).taken


# Frequencies


def test_frequencies_become_departures(feed):
    """From 06:00, when the simulation begins, every 20 min before 07:00, then every 30 before 08:00."""
    head = "trip_id,start_time,end_time,headway_secs"
    found = feed(frequencies=f"{head}\nt1,6:00:00,7:00:00,1200\nt1,7:00:00,8:00:00,1800\n")
    assert {train.name for train in found.trains} == {"4102", "t3"}
    (service,) = tomllib.loads(files(found)["scenario.toml"])["traffic"]
    assert service["departures_min"] == [0.0, 20.0, 40.0, 60.0, 90.0]
    assert service["stops"] == [
        {"station": "Beta", "dwell_min": 1.5, "arrive_after_min": 10.0, "depart_after_min": 11.5},
        {"station": "Gamma", "dwell_min": 0.5, "arrive_after_min": 20.0, "depart_after_min": 20.0},
    ]
    assert service["arrive_after_min"] == 30.0


def test_a_frequency_until_the_end_of_the_simulation_is_a_headway(feed):
    """Alone, from 06:00 to 20:00 every 2 hours; an hour after the last arrival, at 19:30, is the end."""
    window = "trip_id,start_time,end_time,headway_secs\nt1,6:00:00,20:00:00,7200\n"
    only = "\n".join(FEED["trips.txt"].splitlines()[:2])
    text = files(feed(frequencies=window, trips=only))["scenario.toml"]
    (service,) = tomllib.loads(text)["traffic"]
    assert (service["headway_min"], "first_departure_min" in service) == (120.0, False)
    assert "timetables" not in tomllib.loads(text)


# Files


def test_a_zip_file_gives_the_same_as_a_folder(feed, tmp_path):
    folder = feed()
    with zipfile.ZipFile(tmp_path / "feed.zip", "w") as archive:
        for name, text in FEED.items():
            archive.writestr(f"inner/{name}", text)
    zipped = read(tmp_path / "feed.zip", ["r1"], date(2025, 3, 12))
    assert (zipped.lines, zipped.trains) == (folder.lines, folder.trains)


def test_the_command_says_what_was_taken_left_out_and_assumed(tmp_path, monkeypatch, capsys):
    there = write(tmp_path / "feed")
    given = ("--route", "RE 7", "--date", "2025-03-12", "--out", tmp_path / "m")
    assert call(monkeypatch, "import", "gtfs", there, *given) == 0
    printed = capsys.readouterr().out
    for words in ("day: 2025-03-12", "trips: 3, as trains", "transfers.txt: trains do not wait",
                  "a speed limit of 170 km/h", "tpss check"):  # fmt: skip
        assert words in printed
    assert 'starts_at = "05:40"' in (tmp_path / "m" / "scenario.toml").read_text("utf-8")


def test_the_files_are_a_scenario_without_faults(tmp_path, monkeypatch):
    there = write(tmp_path / "feed")
    given = ("--route", "RE 7", "--date", "2025-03-12", "--out", tmp_path / "m")
    assert call(monkeypatch, "import", "gtfs", there, *given) == 0
    assert call(monkeypatch, "check", tmp_path / "m" / "scenario.toml") == 0


@pytest.mark.parametrize(
    ("table", "old", "new", "place", "problem"),
    [
        ("stop_times.txt", "t1,5:50:00", "t1,5:61:00", "line 3, arrival_time", "not a time"),
        ("stop_times.txt", "A,1,,", "A,first,,", "line 2, stop_sequence", "not a number"),
        ("stops.txt", "0,10.2,", "north,10.2,", "line 6, stop_lat", "not a number"),
        ("stops.txt", "0,10.2,", "95,10.2,", "line 6, stop_lat", "not a coordinate"),
        ("stops.txt", "C,Gamma", "X,Gamma", "stop_id", "a stop that is not there"),
        ("calendar.txt", "20250301,20250331\nsun", "01032025,20250331\nsun", "line 2, start_date",
         "not a date"),
        ("trips.txt", "trip_id,", "trip,", "line 1", "the column trip_id is missing"),
    ],
)  # fmt: skip
def test_a_fault_names_table_line_and_column(feed, table, old, new, place, problem):
    text = FEED[table]
    assert old in text
    with pytest.raises(tpss.ScenarioError) as caught:
        feed(**{table.removesuffix(".txt"): text.replace(old, new, 1)})
    (finding,) = caught.value.findings
    assert (Path(finding.file).name, finding.key) == (table, place)
    assert problem in finding.problem
    assert finding.remedy


def test_a_route_that_is_not_there_is_told_with_those_that_are(feed):
    with pytest.raises(tpss.ScenarioError) as caught:
        feed(route="RE7")
    assert caught.value.findings[0].remedy.startswith("did you mean RE 7? routes: RE 7, B")


def test_a_feed_without_a_table_is_told(feed):
    with pytest.raises(tpss.ScenarioError) as caught:
        feed(stops=None)
    assert Path(caught.value.findings[0].file).name == "stops.txt"


def test_what_is_no_feed_is_told(tmp_path):
    (tmp_path / "feed.zip").write_text("no")
    for path in (tmp_path / "feed.zip", tmp_path / "none.zip"):
        with pytest.raises(tpss.ScenarioError) as caught:
            read(path, ["r1"])
        assert "neither a folder nor a zip file" in caught.value.findings[0].problem
