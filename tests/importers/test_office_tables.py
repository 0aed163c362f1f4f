"""`tpss import csv`: what is shown is what a scenario reads, and so is what is written."""

import openpyxl
import pytest
import tomli_w

import tpss
from tpss.cli.main import main

from scenarios import SHORT_LINE

HEIGHTS = "Kilometer;Hoehe;Bemerkung\n0,0;100,0;\n0,5;102,5;Brücke\n20,0;98,6;\n"
LIMITS = "von km\tbis km\tV (km/h)\n0\t20\t90\n3,5\t6\t70\n"
STATIONS = "Driftplats,km\nWest,0\nEast,20\n"
TIMETABLE = "Zug;Bahnhof;Ankunft;Abfahrt\n4101;West;;10,5\n4101;East;;\n"


@pytest.fixture
def call(tmp_path, monkeypatch, capsys):
    """Call `tpss import csv` in a folder with the tables; gives code and words."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    for name, text in (("heights.csv", HEIGHTS), ("limits.csv", LIMITS), ("stations.csv", STATIONS),
                       ("times.csv", TIMETABLE)):  # fmt: skip
        (tmp_path / name).write_text(text, "utf-8")

    def call(*arguments):
        monkeypatch.setattr("sys.argv", ["tpss", "import", "csv", *arguments])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        return ended.value.code, said.out + said.err

    return call


def test_without_a_folder_it_is_shown_and_nothing_is_written(call, tmp_path):
    before = sorted(tmp_path.iterdir())
    code, said = call("heights.csv")
    assert code == 0
    rows = [" ".join(line.split()) for line in said.splitlines()]
    assert "heights.csv: gradients, UTF-8, separated by semicolons" in rows
    assert "Kilometer position km comma 0 20 0, 0.5, 20" in rows
    assert "Hoehe altitude m comma 98.6 102.5 100, 102.5, 98.6" in rows
    assert "Bemerkung passed over" in rows
    assert "derived gradient ‰ -0.2 5 5, -0.2, -0.2" in rows
    assert "Note: heights.csv: gradients derived from altitudes" in rows
    assert sorted(tmp_path.iterdir()) == before


def scenario_with(line):
    document = {key: value for key, value in SHORT_LINE.items() if key != "line"}
    return {**document, "line": line}


def test_a_scenario_reads_what_is_written_as_it_reads_the_tables_themselves(call, tmp_path):
    code, said = call("heights.csv", "limits.csv", "stations.csv", "--out", "ours")
    assert code == 0
    assert 'line = "ours/line.toml"' in said
    named = {
        "length_km": 20.0,
        "gradients_file": "heights.csv",
        "speed_limits_file": "limits.csv",
        "stations_file": "stations.csv",
    }
    (tmp_path / "a.toml").write_text(tomli_w.dumps(scenario_with("ours/line.toml")), "utf-8")
    (tmp_path / "b.toml").write_text(tomli_w.dumps(scenario_with(named)), "utf-8")
    written, own = tpss.load_scenario("a.toml"), tpss.load_scenario("b.toml")
    assert written == own
    assert own.line.gradients[0].permille == 5.0
    assert written.file_notes == ()


def test_part_of_a_line_says_what_is_missing(call, tmp_path):
    assert call("heights.csv", "--out", "ours")[0] == 0
    text = (tmp_path / "ours" / "line.toml").read_text("utf-8")
    assert "# MISSING, add it: speed_limits, or speed_limits_file" in text
    assert "length_km = 20.0" in text


def test_other_tables_say_how_they_are_named(call, tmp_path):
    code, said = call("times.csv", "--out", "ours")
    assert code == 0
    assert '[[timetables]] with file = "ours/timetable.csv"' in said
    text = (tmp_path / "ours" / "timetable.csv").read_text("utf-8")
    assert text.endswith("name,station,arrival,departure\n4101,West,,10.5\n4101,East,,\n")


def test_effort_over_voltage_is_written_in_rows(call, tmp_path):
    text = "v;U [kV];Zugkraft [kN]\n0;12;240,5\n100;12;80\n0;15;300\n100;15;100\n"
    (tmp_path / "effort.csv").write_text(text, "utf-8")
    assert call("effort.csv", "--out", "ours")[0] == 0
    written = (tmp_path / "ours" / "effort.csv").read_text("utf-8")
    rows = "speed_kmh,voltage_kv,force_kn\n0,12,240.5\n100,12,80\n0,15,300\n100,15,100\n"
    assert written.endswith(rows)


def test_a_sheet_of_a_workbook(call, tmp_path):
    book = openpyxl.Workbook()
    sheet = book.create_sheet("Profil")
    for row in (("km", "Höhe [m]"), (0, 10.5), (1, 12.0)):
        sheet.append(row)
    book.save(tmp_path / "made.xlsx")
    code, said = call("made.xlsx#Profil")
    assert code == 0
    assert "made.xlsx#Profil: gradients, workbook of Excel" in said
    code, said = call("made.xlsx")
    assert (code, "no header of a table is found" in said) == (2, True)


def test_what_decides_nothing_is_asked_for(call, tmp_path):
    (tmp_path / "odd.csv").write_text("km;Höhe\n1,234;1\n2,345;2\n", "utf-8")
    code, said = call("odd.csv")
    assert code == 2
    assert "is it 1234 or 1.234?" in said
    assert "tpss import csv odd.csv --decimal comma" in said
    code, said = call("odd.csv", "--decimal", "comma")
    assert code == 0
    assert "1.234, 2.345" in said
    code, said = call("odd.csv", "--decimal", "coma")
    assert (code, "did you mean comma?" in said) == (2, True)


def test_a_table_of_two_kinds_is_asked_for(call, tmp_path):
    (tmp_path / "all.csv").write_text("Bahnhof;km;Höhe\nWest;0;5\nEast;20;25\n", "utf-8")
    code, said = call("all.csv")
    assert code == 2
    assert "it may be one of several tables: gradients, stations" in said
    assert "gradients=all.csv" in said
    code, said = call("gradients=all.csv", "stations=all.csv", "--out", "ours")
    assert code == 0
    assert "Left out" in (tmp_path / "ours" / "stations.csv").read_text("utf-8")


def test_altitudes_may_be_smoothed(call):
    code, said = call("heights.csv", "--smooth-over", "20")
    assert code == 0
    assert "averaged over 20 km" in said


def test_two_tables_of_a_kind_are_refused(call):
    code, said = call("heights.csv", "gradients=heights.csv")
    assert code == 2
    assert "has gradients too" in said


def test_a_line_with_faults_is_not_written(call, tmp_path):
    (tmp_path / "stations.csv").write_text("name,km\nWest,0\nWest,20\n", "utf-8")
    code, said = call("heights.csv", "limits.csv", "stations.csv", "--out", "ours")
    assert code == 2
    assert "occurs twice" in said
    assert not (tmp_path / "ours").exists()


def test_a_part_of_a_line_with_faults_is_refused_when_it_is_shown(call, tmp_path):
    """The rest of the line is taken to be plain; nothing is written, nor shown as if it were sound."""
    (tmp_path / "limits.csv").write_text("km;V\n0;80\n10;-80\n20;90\n")
    code, said = call("limits.csv")
    assert code == 2
    assert "limits.csv: line.speed_limits.1.speed_kmh = -80.0" in said
    (tmp_path / "whole.csv").write_text("km;V\n0;80\n")
    assert call("whole.csv")[0] == 0


def test_existing_files_need_force(call):
    assert call("heights.csv", "--out", "ours")[0] == 0
    code, said = call("heights.csv", "--out", "ours")
    assert (code, "exists already" in said) == (2, True)
    assert call("heights.csv", "--out", "ours", "--force")[0] == 0


def test_headings_are_listed(call):
    code, said = call("--headings")
    assert code == 0
    assert "altitude_m (one of these)" in said
    assert call()[0] == 2
