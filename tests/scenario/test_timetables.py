"""Timetables: CSV files whose trains become entries of the traffic; faults name file and line."""

import copy
from pathlib import Path
from typing import Any

import pytest

import tpss
from tpss import Finding
from tpss.scenario.override import override

from scenarios import SHORT_LINE

HEADER = "name,train,station,arrival,departure,min_dwell_s,kind"

TWO_TRAINS = """\
# From the planner
name,train,station,arrival,departure,min_dwell_s,kind
4101,freight,West,,05:40:00,,start
4101,,Middle,05:52,05:55:30,60,stop
4101,,East,06:08,,,end

4102,,East,,29:31,,
4102,,Middle,,29:43,,pass
4102,,West,,,,
"""


def scenario(
    folder: Path, *texts: str, changes: dict[str, Any] | None = None, train: str | None = "freight"
) -> tpss.Scenario:
    """The short line with timetables only, which starts at half past five."""
    document = copy.deepcopy(SHORT_LINE)
    document["simulation"] |= {"starts_at": "05:30", "duration_min": 60.0}
    document.pop("traffic")
    document["timetables"] = []
    for i, text in enumerate(texts):
        (folder / f"times{i}.csv").write_text(text)
        document["timetables"].append({"file": f"times{i}.csv", "train": train})
    source = folder / "line.toml"
    return tpss.Scenario.from_own_document(override(document, changes or {}, source), source)


def faults(folder: Path, *texts: str, **others: Any) -> tuple[Finding, ...]:
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario(folder, *texts, **others)
    return caught.value.findings


def rows(*lines: str) -> str:
    return "\n".join([HEADER, *lines])


def test_each_train_is_a_service_of_a_single_train_with_its_name(tmp_path):
    """Departure at 05:40, 10 min after the start; the other at 29:31, a day and a minute after it."""
    first, second = scenario(tmp_path, TWO_TRAINS).traffic
    assert first.model_dump(by_alias=True, exclude_defaults=True) == {
        "name": "4101", "train": "freight", "from": "West", "to": "East", "departure_min": 10.0,
        "arrive_after_min": 28.0,
        "stops": ({"station": "Middle", "dwell_min": 1.0, "arrive_after_min": 12.0,
                   "depart_after_min": 15.5},),
    }  # fmt: skip
    assert second.model_dump(by_alias=True, exclude_defaults=True) == {
        "name": "4102", "train": "freight", "from": "East", "to": "West", "departure_min": 1441.0,
        "via": ("Middle",), "passes": ({"station": "Middle", "after_min": 12.0},),
    }  # fmt: skip


def test_columns_stand_in_any_order_minutes_are_times_too_and_semicolons_part_them(tmp_path):
    text = "station; departure;name\nWest;10.5;a\nMiddle;;a\nEast;;a\n"
    (train,) = scenario(tmp_path, text, changes={"simulation.starts_at": None}).traffic
    assert (train.departure_min, train.train, train.passes[0].station) == (
        10.5,
        "freight",
        "Middle",
    )


@pytest.mark.parametrize(
    ("row", "kind"),
    [("a,,Middle,,,,", "pass"), ("a,,Middle,05:50,,,", "pass"), ("a,,Middle,,05:50,,", "stop"),
     ("a,,Middle,,,30,", "stop"), ("a,,Middle,,05:50,,pass", "pass"), ("a,,Middle,,,,stop", "stop")],
)  # fmt: skip
def test_without_a_kind_a_train_stops_where_it_has_a_departure_or_a_dwell(tmp_path, row, kind):
    (train,) = scenario(tmp_path, rows("a,,West,,05:40,,", row, "a,,East,,,,")).traffic
    assert (len(train.stops), len(train.passes)) == ((1, 0) if kind == "stop" else (0, 1))


def test_stops_without_a_least_dwell_have_that_of_their_timetable(tmp_path):
    text = rows("a,,West,,05:40,,", "a,,Middle,,05:50,,", "a,,East,,,,")
    (train,) = scenario(tmp_path, text, changes={"timetables.0.min_dwell_s": 45.0}).traffic
    assert train.stops[0].dwell_min == 0.75


def test_a_track_is_that_on_which_a_train_goes_on_from_its_station(tmp_path):
    """At the origin, a stop and a pass; a spreadsheet may write 2 as 2.0."""
    text = (
        "name,station,departure,kind,track\na,West,05:40,,2.0\na,Middle,05:50,stop,1\na,East,,,\n"
    )
    text += "b,East,05:40,,\nb,Middle,,pass,2\nb,West,,,\n"
    tracks = {"line.tracks": 2, "supply.tracks_tied": "no"}
    first, second = scenario(tmp_path, text, changes=tracks).traffic
    assert (first.track, first.stops[0].track) == (2, 1)
    assert (second.track, second.passes[0].track) == (None, 2)


@pytest.mark.parametrize(
    ("tracks", "place", "problem", "remedy"),
    [
        (("x", "", ""), "line 2, track", "not the number of a track", "a whole number, counted from 1"),
        (("1.5", "", ""), "line 2, track", "not the number of a track", "a whole number"),
        (("0", "", ""), "line 2, track", "not the number of a track", "counted from 1"),
        (("9", "", ""), "line 2, track", "out of range", "less than or equal to 8"),
        (("3", "", ""), "line 2, track", "2 tracks at most", "a track that is there"),
        (("1", "2", ""), "line 3, track", "from Middle to East the line has a single", "leave it out"),
        (("1", "1", ""), "line 3, track", "from Middle to East the line has a single", "leave it out"),
        (("1", "", "1"), "line 4, track", "the last row of a train has none", "leave it empty"),
    ],
)  # fmt: skip
def test_a_track_that_is_none(tmp_path, tracks, place, problem, remedy):
    """The line has two tracks up to Middle, at 10 km, and one behind it."""
    header = "name,station,departure,kind,track"
    calls = ("a,West,05:40,,", "a,Middle,05:50,stop,", "a,East,,,")
    text = "\n".join([header, *(call + track for call, track in zip(calls, tracks, strict=True))])
    counts = [{"from_km": 0.0, "count": 2}, {"from_km": 10.0, "count": 1}]
    changes = {"line.tracks": counts, "supply.tracks_tied": "no"}
    (finding,) = faults(tmp_path, text, changes=changes)
    assert (Path(finding.file).name, finding.key) == ("times0.csv", place)
    assert problem in finding.problem
    assert remedy in finding.remedy


def test_trains_of_timetables_come_behind_the_other_traffic_and_of_its_files_in_their_order(
    tmp_path,
):
    texts = [rows(f"{name},,West,,05:40,,", f"{name},,East,,,,") for name in ("b", "a")]
    both = scenario(tmp_path, *texts, changes={"traffic": SHORT_LINE["traffic"]})
    assert [entry.name for entry in both.traffic] == ["eastbound", "b", "a"]


def test_what_was_read_is_in_the_document_that_is_kept_and_the_file_no_more(tmp_path):
    read = scenario(tmp_path, TWO_TRAINS)
    again = tpss.Scenario.from_document(read.as_document())
    assert again == read
    assert again.digest() == read.digest()
    assert "timetables" not in read.as_document()


def test_another_file_is_a_change_like_any_other(tmp_path):
    (tmp_path / "other.csv").write_text(rows("a,,West,,05:40,,", "a,,East,,,,"))
    changed = scenario(tmp_path, TWO_TRAINS).with_({"timetables.0.file": "other.csv"})
    assert [entry.name for entry in changed.traffic] == ["a"]


WEST, MIDDLE, EAST = "a,,West,,05:40,,", "a,,Middle,05:50,05:51,60,stop", "a,,East,06:10,,,end"

FAULTS = [
    ([WEST.replace("West", "Wst"), EAST], "line 2, station", "did you mean West?"),
    ([WEST, "a,,Midle,,,,", EAST], "line 3, station", "did you mean Middle?"),
    ([WEST, MIDDLE, "a,,,,,,"], "line 4, station", "add it"),
    (["a,frieght,West,,05:40,,", EAST], "line 2, train", "did you mean freight?"),
    ([WEST, "a,other,East,,,,", "b,freight,West,,05:40,,", "b,other,East,,,,"],
     "line 5, train", "one type of train"),
    ([WEST], "line 2", "at least two"),
    ([WEST, EAST, "b,,West,,05:50,,", "b,,East,,,,", EAST], "line 6, name", "keep the rows"),
    ([",,West,,05:40,,", ",,East,,,,"], "line 2, name", "write it in each row"),
    ([WEST, "a,,Middle,05:50,05:49,,", EAST], "line 3, departure", "in the order of travel"),
    ([WEST, "a,,Middle,05:39,05:49,,", EAST], "line 3, arrival", "in the order of travel"),
    ([WEST, MIDDLE, "a,,East,00:10,,,"], "line 4, arrival", "let simulation.starts_at be earlier"),
    (["a,,West,,05:20,,", EAST], "line 2, departure", "let simulation.starts_at be earlier"),
    (["a,,West,,5h40,,", EAST], "line 2, departure", "HH:MM"),
    (["a,,West,,,,", EAST], "line 2, departure", "add it"),
    (["a,,West,05:35,05:40,,", EAST], "line 2, arrival", "leave it empty"),
    ([WEST, "a,,East,06:10,06:11,,"], "line 3, departure", "leave it empty"),
    ([WEST, "a,,Middle,05:50,05:51,1m,", EAST], "line 3, min_dwell_s", "number of seconds"),
    ([WEST, "a,,Middle,05:50,05:51,-1,", EAST], "line 3, min_dwell_s", "number of seconds"),
    ([WEST, "a,,Middle,05:50,,60,pass", EAST], "line 3, min_dwell_s", "leave it empty"),
    ([WEST, "a,,Middle,05:50,05:51,,pass", EAST], "line 3, departure", "write stop as its kind"),
    ([WEST, "a,,Middle,05:50,05:51,,stopp", EAST], "line 3, kind", "did you mean stop?"),
    (["a,,West,,05:40,,stop", EAST], "line 2, kind", "choose from start"),
    ([WEST, "a,,Middle,,,", EAST], "line 3", "one for each column"),
    ([WEST, "a,,East,05:40,,,"], "line 3, arrival", "greater than 0"),
    (["a,,East,,05:40,,", "a,,East,06:00,,,"], "line 3, station", "another station"),
    (["a,,Middle,,05:40,,", "a,,West,05:50,05:51,,", "a,,East,,,,"],
     "line 3, station", "in the order of travel"),
    ([], "line 1", "add rows"),
]  # fmt: skip


@pytest.mark.parametrize(("lines", "place", "remedy"), FAULTS)
def test_a_fault_names_file_and_line_and_what_to_do(tmp_path, lines, place, remedy):
    finding = faults(tmp_path, rows(*lines))[0]
    assert finding.file == str(tmp_path / "times0.csv")
    assert finding.key == place
    assert remedy in finding.remedy


def test_one_faulty_train_is_one_finding_and_the_others_are_looked_at_too(tmp_path):
    text = rows("a,,West,,5h40,,", "a,,East,,,,", "b,,West,,05:40,,", "b,,Est,,,,")
    assert [finding.key for finding in faults(tmp_path, text)] == [
        "line 2, departure",
        "line 5, station",
    ]


def test_the_type_that_all_trains_take_from_their_timetable_is_one_finding(tmp_path):
    text = rows("a,,West,,05:40,,", "a,,East,,,,", "b,,West,,05:40,,", "b,,East,,,,")
    (finding,) = faults(tmp_path, text, train="frieght")
    assert (finding.file, finding.key) == (str(tmp_path / "line.toml"), "timetables.0.train")
    (finding,) = faults(tmp_path, rows("a,,West,,05:40,,", "a,,East,,,,"), train=None)
    assert finding.key == "line 2, train"
    assert "add train to [[timetables]]" in finding.remedy


def test_a_name_may_be_that_of_one_train_only(tmp_path):
    text = rows("eastbound,,West,,05:40,,", "eastbound,,East,,,,")
    (finding,) = faults(tmp_path, text, changes={"traffic": SHORT_LINE["traffic"]})
    assert finding.key == "line 2, name"
    (finding,) = faults(tmp_path, TWO_TRAINS, rows("4101,,West,,05:40,,", "4101,,East,,,,"))
    assert (Path(finding.file).name, finding.key) == ("times1.csv", "line 2, name")


@pytest.mark.parametrize(
    ("header", "value", "remedy"),
    [
        ("name,station,departure,arival", "arival", "did you mean arrival?"),
        ("name,station,departure,name", "name", "leave one out"),
        ("type,station,departure", "type,station,departure", "begin with the line name,station"),
        ("a,b,c", "a,b,c", "begin with the line name,station,departure"),
    ],
)
def test_a_header_that_is_none(tmp_path, header, value, remedy):
    (finding,) = faults(tmp_path, f"{header}\na,b,c\n")
    assert (finding.key, finding.value) == ("line 1", value)
    assert remedy in finding.remedy


def test_trains_may_have_their_names_in_a_column_train_where_there_is_no_other(tmp_path):
    text = "Train;station;arrival;departure\nIC 1;West;;05:40\nIC 1;East;06:10;\n"
    (service,) = scenario(tmp_path, text).traffic
    assert (service.name, service.train) == ("IC 1", "freight")


def test_clock_times_need_a_clock(tmp_path):
    finding = faults(tmp_path, TWO_TRAINS, changes={"simulation.starts_at": None})[0]
    assert finding.key == "line 3, departure"
    assert "add starts_at" in finding.remedy


def test_a_timetable_that_is_not_there_or_of_other_keys(tmp_path):
    (finding,) = faults(tmp_path, TWO_TRAINS, changes={"timetables.0.file": "none.csv"})
    assert (Path(finding.file).name, finding.problem) == ("none.csv", "there is no such file")
    (finding,) = faults(tmp_path, TWO_TRAINS, changes={"timetables.0.trian": "x"})
    assert finding.key == "timetables.0.trian"
    (finding,) = faults(tmp_path, TWO_TRAINS, changes={"timetables.0.file": None})
    assert finding.key == "timetables.0.file"


def test_stations_that_are_passed_say_which_way_a_train_takes_over_several_lines(tmp_path):
    """From A to B it is 10 km on one line, and 20 km over C on two others, which the timetable wants.

    It turns round at C, as it comes from B and goes on to B.
    """
    lines = {
        name: {
            "length_km": length_km,
            "gradients": [{"from_km": 0.0, "permille": 0.0}],
            "speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0}],
            "stations": [
                {"name": first, "position_km": 0.0},
                {"name": last, "position_km": length_km},
            ],
        }
        for name, first, last, length_km in (("direct", "A", "B", 10.0), ("there", "A", "C", 8.0),
                                             ("back", "C", "B", 12.0))
    }  # fmt: skip
    stations = [
        {"name": name, "line": "direct", "position_km": km, "type": "Q48/Q49", "converters": 2}
        for name, km in (("A", 0.0), ("B", 10.0))
    ]
    changes = {"line": None, "lines": lines, "supply.converter_stations": stations}
    header = "name,station,arrival,departure,turn_s,kind\n"
    text = header + "a,A,,05:40,,\na,C,05:50,,,pass\na,B,06:05,,,\n"
    table = tpss.simulate(scenario(tmp_path, text, changes=changes)).stops
    assert table.station.tolist() == ["A", "C", "B"]
    assert table.line.tolist() == ["there", "there", "back"]
    assert 7.0 < table.arrival_min[1] - table.departure_min[0] < 12.0
    turning = header + "a,B,,05:40,,\na,C,,06:00,{},stop\na,B,06:15,,,\n"
    (train,) = scenario(tmp_path, turning.format("300"), changes=changes).traffic
    assert train.stops[0].turn_min == 5.0
    (finding,) = faults(tmp_path, turning.format(""), changes=changes)
    assert (finding.key, finding.remedy) == ("line 3, turn_s", "add the time that it takes")
    (finding,) = faults(tmp_path, header + "a,A,,05:40,,\na,D,,,,\na,B,06:05,,,\n", changes=changes)
    assert (finding.key, finding.problem) == ("line 3, station", "there is no such station")
