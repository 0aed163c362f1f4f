"""Tables as offices have them: any separator, decimals, encoding and language, and workbooks."""

import copy
import datetime

import openpyxl
import pytest
import tomli_w

from tpss import ScenarioError, load_scenario

from scenarios import SHORT_LINE

PROFILE = [(0.0, 0.0), (0.5, 5.0), (20.0, -2.5)]
"""Positions and gradients of all files below."""


@pytest.fixture
def write(tmp_path):
    """A scenario whose line takes one of its lists from a file."""

    def write(content, name="table.csv", key="gradients", sheet="", **line):
        document = copy.deepcopy(SHORT_LINE)
        document["line"].pop(key)
        document["line"] |= {f"{key}_file": f"{name}{sheet}", **line}
        text = content if isinstance(content, bytes) else content.encode()
        (tmp_path / name).write_bytes(text)
        file = tmp_path / "line.toml"
        file.write_text(tomli_w.dumps(document), "utf-8")
        return file

    return write


def profile(file):
    return [(each.from_km, each.permille) for each in load_scenario(file).line.gradients]


def faults(file):
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    return caught.value.findings


@pytest.mark.parametrize(
    "text",
    [
        "position_km,gradient_permille\n0,0\n0.5,5\n20,-2.5\n",
        "Kilometer;Neigung\n0,0;0,0\n0,5;5,0\n20,0;-2,5\n",
        "km\tlutning ‰\n0,0\t0\n0,5\t5\n20,0\t\u22122,5\n",
        "sep=;\nkm;Neigung [‰]\n0;0\n0,5;5\n20;-2,5\n",
        "Strecke 4711\nStand 2026;;\n\nkm;Neigung;Bemerkung\n0,00;0;\n0,50;5;Brücke\n20,00;-2,5;\n",
        "gradient_permille,remark,POSITION [M]\n0,a,0\n5,b,500\n-2.5,,\"20,000.0\"\n",
        "km,gradient [%]\r\n0,0\r\n0.5,0.5\r\n20,-0.25\r\n",
        "km;Neigung\n0+000;0\n0+500;5\n20+000;-2,5\n",
        "km;Neigung;\n0,0;0;\n0,5;5;\n;;\n20,0;-2,5;\n",
        "Position;Neigung\n[m];[%]\n0;0\n500;0,5\n20000;-0,25\n",
        "Von;Neigung [‰]\n0+000;0\n0+500;5\n20+000;-2,5\n",
        "km;Neigung;Höhe\nkm;‰;m\n0;0;\n0,5;5;7\n20;-2,5;\n",
    ],
    ids=["own", "german", "tabs", "told-separator", "title", "metres", "percent", "posts", "empty",
         "units-below", "posts-without-unit", "altitude-too"],
)  # fmt: skip
def test_the_same_profile_in_other_clothes(write, text):
    assert profile(write(text)) == PROFILE


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings_are_recognised_and_told_unless_they_are_utf_8(write, encoding):
    file = write("km;Längsneigung [‰]\n0,0;0\n0,5;5\n20,0;-2,5\n".encode(encoding))
    assert profile(file) == PROFILE
    told = {
        "utf-16": ("table.csv: read as UTF-16",),
        "cp1252": ("table.csv: read as Windows-1252",),
    }
    assert load_scenario(file).file_notes == told.get(encoding, ())


def test_what_is_assumed_and_passed_over_is_told(write):
    file = write("Stand 2026\nkm;Neigung;Bemerkung\n0;1,234;\n1;2,50;x\n")
    assert load_scenario(file).file_notes == (
        "table.csv: 1 line above the header passed over",
        "table.csv: columns passed over: Bemerkung",
        "table.csv: Neigung gives no unit and is read in ‰",
    )


def test_of_several_columns_the_one_that_is_called_as_in_files_of_tpss_counts(write):
    file = write("km;Neigung;gradient_permille\n0;7;1\n1;8;2\n")
    assert profile(file) == [(0.0, 1.0), (1.0, 2.0)]
    assert load_scenario(file).file_notes == ("table.csv: columns passed over: Neigung",)


def test_gradients_come_before_altitudes_unless_there_are_none(write):
    file = write("km;Neigung;Höhe\n;‰;[m ü. NN]\n0;;7\n1;;8\n")
    assert profile(file) == [(0.0, 1.0), (1.0, 1.0)]
    file = write("km;Höhe;Neigung [‰]\n0;7;1\n1;8;2\n")
    assert profile(file) == [(0.0, 1.0), (1.0, 2.0)]


def test_a_changed_copy_tells_the_same(write):
    scenario = load_scenario(write("km;Neigung\n0;1\n1;2\n"))
    assert scenario.with_({"traffic.0.headway_min": 30.0}).file_notes == scenario.file_notes
    level = {"line.gradients_file": None, "line.gradients": [{"from_km": 0.0, "permille": 0.0}]}
    assert scenario.with_(level).file_notes == ()


def test_gradients_are_derived_from_altitudes_and_that_is_told(write):
    """2.5 m on 0.5 km are 5 ‰; the last gradient goes on."""
    file = write("Kilometer;Höhe [m]\n0,0;100,0\n0,5;102,5\n20,0;98,6\n")
    assert profile(file) == [(0.0, 5.0), (0.5, -0.2), (20.0, -0.2)]
    assert load_scenario(file).file_notes == ("table.csv: gradients derived from altitudes",)


def test_altitudes_may_stand_in_falling_kilometres(write):
    """What they mean is the same; of gradients it would not be clear towards which end they climb."""
    file = write("km;Höhe [m]\n20,0;98,6\n0,5;102,5\n0,0;100,0\n")
    assert profile(file) == [(0.0, 5.0), (0.5, -0.2), (20.0, -0.2)]
    assert "turned round" in load_scenario(file).file_notes[-1]
    (finding,) = faults(write("km;Neigung\n20;1\n0;2\n"))
    assert "does not increase" in finding.problem


def test_altitudes_may_be_smoothed(write):
    """A bump of 1 m at 10 km disappears in means over 20 km, from which one gradient follows."""
    text = "km;Höhe [m]\n0;100\n10;101\n20;104\n"
    file = write(text, gradients_smoothed_over_km=20.0)
    assert profile(file) == [(0.0, 0.2), (20.0, 0.2)]
    assert "averaged over 20 km" in load_scenario(file).file_notes[-1]


@pytest.mark.parametrize(
    ("text", "more", "key", "words"),
    [
        ("km;Neigung\n0;1\n", {"gradients_smoothed_over_km": 1.0}, "", "altitudes are what is smoothed"),
        ("km;Höhe\n0;1\n1;2\n", {"gradients_smoothed_over_km": 0.0},
         "line.gradients_smoothed_over_km", "not a length"),
        ("km;Höhe\n0;1\n", {}, "line 2, Höhe", "a single altitude"),
        ("Position;Höhe\n0;1\n1;2\n", {}, "line 1", "gives no unit of the position"),
        ("km;Höhe\n1,234;1\n2,345;2\n", {}, "column 'km'", "is it 1234 or 1.234?"),
        ("km;Höhe\n1,5;1\n2.5;2\n", {}, "column 'km'", "some numbers have decimal points and some"),
        ("km;Höhe\n1,234;1\n1,5;1\n2.5;2\n", {}, "column 'km'", "some numbers have decimal points"),
        ("km;Höhe\n-1+500;1\n2+500;2\n", {}, "line 2, km", "not a number"),
        ("km;Höhe;km\n1;1;1\n", {}, "line 1", "the column is there twice"),
        ("km,Höhe\n0,5,100,5\n1,5,101,0\n", {}, "line 2", "4 values, expected 2; and 1 more like it"),
        ("km;Höhe\n0;1\n2;2\n1;3\n", {}, "line 4, km", "does not increase"),
        ("\0\1\2", {}, "", "neither text"),
        ("km;Höhe;Höhenlage\n0;1;2\n1;2;3\n", {}, "line 1", "the column Höhe may be the altitude too"),
    ],
)  # fmt: skip
def test_what_is_wrong_names_the_place(write, text, more, key, words):
    (finding,) = faults(write(text, **more))
    assert finding.key == key
    assert words in finding.problem
    assert finding.remedy


def test_smoothing_needs_a_file(tmp_path):
    document = copy.deepcopy(SHORT_LINE)
    document["line"]["gradients_smoothed_over_km"] = 1.0
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(document), "utf-8")
    (finding,) = faults(file)
    assert finding.key == "line.gradients_smoothed_over_km"
    assert "no gradients_file is given" in finding.problem


def limits(file, key="speed_limits"):
    return [(each.from_km, each.speed_kmh) for each in getattr(load_scenario(file).line, key)]


def test_speed_limits_hold_to_the_next_one(write):
    text = "km;V (km/h)\n0,0;60\n4,5;90\n"
    assert limits(write(text, key="speed_limits")) == [(0.0, 60.0), (4.5, 90.0)]


def test_of_speed_limits_with_ends_the_lowest_holds(write):
    """90 all the way, 40 from km 3 to 4, and 70 from km 3.5 to 6."""
    text = "von km;bis km;V (km/h)\n0;20;90\n3,5;6;70\n3;4;40\n"
    file = write(text, key="speed_limits")
    assert limits(file) == [(0.0, 90.0), (3.0, 40.0), (4.0, 70.0), (6.0, 90.0)]
    assert load_scenario(file).file_notes[-1] == "table.csv: where limits overlap the lowest holds"


def test_limits_of_the_other_direction_may_stand_in_a_file_too(tmp_path, write):
    file = write("km;speed\n0;60\n", key="speed_limits", speed_limits_down_file="down.csv")
    (tmp_path / "down.csv").write_text("km;speed\n0;50\n")
    assert limits(file, "speed_limits_down") == [(0.0, 50.0)]


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("from_km,to_km,speed_kmh\n0,5,60\n8,20,80\n", "", "no limit from 5 to 8 km"),
        ("from_km,to_km,speed_kmh\n0,5,60\n8,5,80\n", "line 3, to_km", "ends at 5 km, and begins at 8"),
        ("from_km,to_km,speed_kmh\n0,,60\n", "line 2, to_km", "the cell is empty"),
        ("from_km,speed_kmh\n0,900\n", "line 2, speed_kmh", "out of range"),
        ("from_km,speed_kmh\n1,90\n", "line 2, from_km", "begin"),
    ],
)  # fmt: skip
def test_faults_of_limits(write, text, key, words):
    (finding,) = faults(write(text, key="speed_limits"))
    assert finding.key == key
    assert words in finding.problem


def test_stations_of_a_file(write):
    text = "Bahnhof;km;Gleise\nWest;0,0;\nMiddle;10,0;2\nEast;20,0;1\n"
    stations = load_scenario(write(text, key="stations")).line.stations
    assert [(each.name, each.position_km, each.tracks) for each in stations] == [
        ("West", 0.0, 1),
        ("Middle", 10.0, 2),
        ("East", 20.0, 1),
    ]


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("name,km\nWest,0\nWest,3\nEast,20\n", "line.stations", "occurs twice"),
        ("name,km\nWest,0\n,3\nEast,20\n", "line 3, name", "it is missing"),
        ("name,km\nWest,0\nMiddle,x\nEast,20\n", "line 3, km", "not a number"),
        ("name,km,tracks\nWest,0,1.5\nEast,20,1\n", "line 2, tracks", "not a whole number"),
    ],
)
def test_faults_of_stations(write, text, key, words):
    finding = faults(write(text, key="stations"))[0]
    assert finding.key == key
    assert words in finding.problem


def workbook(tmp_path, **sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    file = tmp_path / "made.xlsx"
    book.save(file)
    return file.read_bytes()


def test_a_workbook_gives_its_first_sheet_or_the_one_that_is_named(tmp_path, write):
    rows = [("Strecke 4711",), (), ("Kilometer", "Höhe [m]", "Bemerkung"), (0, 100.0, None)]
    rows += [(0.5, 102.5, "Brücke"), (20, 98.6, None)]
    content = workbook(tmp_path, Höhen=rows, Other=[("km", "gradient"), (0, 7)])
    expected = [(0.0, 5.0), (0.5, -0.2), (20.0, -0.2)]
    assert profile(write(content, "profile.xlsx")) == expected
    assert profile(write(content, "profile.xlsx", sheet="#Höhen")) == expected
    assert profile(write(content, "profile.xlsx", sheet="#Other")) == [(0.0, 7.0)]
    (finding,) = faults(write(content, "profile.xlsx", sheet="#Othre"))
    assert (finding.key, finding.value) == ("sheet", "Othre")
    assert "did you mean Other?" in finding.remedy


def test_the_name_of_a_sheet_may_have_the_mark_too(tmp_path, write):
    content = workbook(tmp_path, a=[("x",)], **{"No#2": [("km", "Neigung"), (0, 7)]})
    assert profile(write(content, "profile.xlsx", sheet="#No#2")) == [(0.0, 7.0)]


def test_a_number_of_a_workbook_has_its_decimals_whatever_it_looks_like(tmp_path, write):
    """1.234 of a workbook is a number, not 1234."""
    content = workbook(tmp_path, a=[("km", "Neigung"), (0, 1.234), (1.234, 2.345)])
    assert profile(write(content, "profile.xlsx")) == [(0.0, 1.234), (1.234, 2.345)]


def test_what_is_no_workbook_is_told(write):
    (finding,) = faults(write("km;Neigung\n0;1\n", "profile.xlsx"))
    assert "not a workbook that can be read" in finding.problem


def test_a_timetable_in_a_workbook_has_times_of_the_clock(tmp_path):
    rows = [("Zug", "Bahnhof", "Ankunft", "Abfahrt", "Haltezeit [min]")]
    rows += [(4101, "West", None, datetime.time(5, 40), None)]
    rows += [(4101, "Middle", datetime.time(5, 55), datetime.time(5, 57, 30), 1.5)]
    rows += [(4101, "East", datetime.datetime(2026, 3, 2, 6, 10), None, None)]
    document = copy.deepcopy(SHORT_LINE)
    del document["traffic"]
    document["simulation"] |= {"starts_at": "05:30", "duration_min": 60.0}
    (tmp_path / "times.xlsx").write_bytes(workbook(tmp_path, Fahrplan=rows))
    document["timetables"] = [{"file": "times.xlsx#Fahrplan", "train": "freight"}]
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(document), "utf-8")
    (train,) = load_scenario(file).traffic
    assert (train.name, train.departure_min, train.arrive_after_min) == ("4101", 10.0, 30.0)
    assert (train.stops[0].dwell_min, train.stops[0].depart_after_min) == (1.5, 17.5)


def with_train(tmp_path, key, text, **more):
    document = copy.deepcopy(SHORT_LINE)
    document["simulation"] = {"time_step_min": 0.1}
    document["trains"]["freight"] |= {key: {"curve_file": "curve.csv"}, "power_factor": 0.9, **more}
    (tmp_path / "curve.csv").write_text(text, "utf-8")
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(document), "utf-8")
    return file


def test_tractive_effort_of_a_file(tmp_path):
    text = "v (km/h);Zugkraft [kN]\n0;275,5\n70,5;200\n135;90\n"
    train = load_scenario(with_train(tmp_path, "tractive_effort", text)).trains["freight"]
    assert train.tractive_effort.speed_kmh == (0.0, 70.5, 135.0)
    assert train.tractive_effort.force_kn == (275.5, 200.0, 90.0)
    assert train.tractive_effort.curve_file is None


def test_tractive_effort_over_voltage_has_a_row_for_each_in_any_order(tmp_path):
    text = "speed_kmh,voltage_kv,force_kn\n0,15,300\n0,12,240\n100,12,80\n100,15,100\n"
    effort = (
        load_scenario(with_train(tmp_path, "tractive_effort", text))
        .trains["freight"]
        .tractive_effort
    )
    assert effort.voltage_kv == (12.0, 15.0)
    assert effort.force_kn == ((240.0, 80.0), (300.0, 100.0))


def test_braking_of_a_file(tmp_path):
    text = "speed_kmh,retardation_m_s2\n0,0.5\n60,0.4\n"
    train = load_scenario(with_train(tmp_path, "max_retardation_m_s2", text)).trains["freight"]
    assert train.max_retardation_m_s2.from_speed_kmh == (0.0, 60.0)
    assert train.max_retardation_m_s2.retardation_m_s2 == (0.5, 0.4)


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("speed_kmh,force_kn\n0,300\n0,200\n", "line 3, speed_kmh", "does not increase"),
        ("speed_kmh,force_kn\n0,300\n50,-1\n", "line 3, force_kn", "out of range"),
        ("speed_kmh,force_kn\n0,300\n", "column 'speed_kmh'", "too short"),
        ("speed_kmh,voltage_kv,force_kn\n0,15,300\n0,12,240\n50,12,80\n", "line 2, voltage_kv",
         "no force at 50 km/h and 15 kV"),
        ("speed_kmh,voltage_kv,force_kn\n0,15,300\n0,15,240\n50,15,80\n", "line 2, speed_kmh",
         "another row has this speed and voltage"),
        ("speed_kmh,voltage_kv,force_kn\n0,15,300\n50,,240\n", "line 3, voltage_kv", "is empty"),
        ("speed_kmh,power_kw\n0,300\n", "line 1", "no column is the force"),
    ],
)  # fmt: skip
def test_faults_of_a_curve_name_line_and_column(tmp_path, text, key, words):
    finding = faults(with_train(tmp_path, "tractive_effort", text))[0]
    assert (finding.file, finding.key) == (str(tmp_path / "curve.csv"), key)
    assert words in finding.problem


def test_a_curve_is_given_once(tmp_path):
    file = with_train(tmp_path, "tractive_effort", "speed_kmh,force_kn\n0,300\n50,200\n")
    document = file.read_text("utf-8")
    file.write_text(
        document.replace("curve_file =", "speed_kmh = [0.0, 1.0]\ncurve_file ="), "utf-8"
    )
    (finding,) = faults(file)
    assert finding.key == "trains.freight.tractive_effort.curve_file"
    assert "given twice" in finding.problem
