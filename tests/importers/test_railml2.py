"""Trains of railML 2: the timetable that they become, and XML that is refused."""

import csv
from pathlib import Path

import pytest

import tpss
from tpss.cli.main import main
from tpss.importers.railml import read
from tpss.importers.timetable import Train

FILE = """\
<?xml version="1.0" encoding="UTF-8"?>
<railml xmlns="https://www.railml.org/schemas/2018" version="2.4">
  <infrastructure id="i">
    <tracks><track id="t1"/><track id="t2"/></tracks>
    <operationControlPoints>
      <ocp id="ocp_w" name="West" code="W"/>
      <ocp id="ocp_f" code="Fork"/>
      <ocp id="ocp_m" name="Mine"/>
    </operationControlPoints>
  </infrastructure>
  <rollingstock><formations><formation id="f1" name="Ore train"/></formations></rollingstock>
  <timetable id="tt">
    <operatingPeriods><operatingPeriod id="daily"/></operatingPeriods>
    <trainParts>
      <trainPart id="p1">
        <formationTT formationRef="f1"/>
        <ocpsTT>
          <ocpTT ocpRef="ocp_f" sequence="2" ocpType="pass">
            <times scope="scheduled" arrival="23:50:30"/>
            <times scope="actual" arrival="23:55:00"/>
          </ocpTT>
          <ocpTT ocpRef="ocp_w" sequence="1" ocpType="stop">
            <times scope="scheduled" departure="23:40"/>
          </ocpTT>
          <ocpTT ocpRef="ocp_m" sequence="3">
            <times scope="published" arrival="00:10:00" arrivalDay="1"/>
          </ocpTT>
        </ocpsTT>
      </trainPart>
      <trainPart id="p2">
        <ocpsTT>
          <ocpTT ocpRef="ocp_m" sequence="1" ocpType="stop">
            <times scope="scheduled" departure="00:20:00.0" departureDay="1"/>
            <stopDescription><stopTimes minimalTime="PT5M"/></stopDescription>
            <sectionTT><runTimes minimalTime="PT9M"/></sectionTT>
          </ocpTT>
          <ocpTT ocpRef="ocp_w" sequence="2" ocpType="stop">
            <times scope="scheduled" arrival="00:50:00"/>
          </ocpTT>
        </ocpsTT>
      </trainPart>
      <trainPart id="p3"><ocpsTT/></trainPart>
    </trainParts>
    <trains>
      <train id="tr1" type="operational" trainNumber="4101">
        <trainPartSequence sequence="2"><trainPartRef ref="p2"/></trainPartSequence>
        <trainPartSequence sequence="1">
          <trainPartRef ref="p3" position="2"/><trainPartRef ref="p1" position="1"/>
        </trainPartSequence>
      </train>
      <train id="c1" type="commercial" trainNumber="IC 9">
        <trainPartSequence sequence="1"><trainPartRef ref="p1"/></trainPartSequence>
      </train>
    </trains>
  </timetable>
</railml>
"""


@pytest.fixture
def railml(tmp_path):
    """Reader of the made-up file, with texts changed."""

    def of(*changes: tuple[str, str], text: str = FILE):
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "made.railml"
        path.write_text(text, encoding="utf-8")
        return read(path)

    return of


def told(train: Train) -> list[tuple[object, ...]]:
    return [
        (call.station, call.kind, call.arrival_s, call.departure_s, call.min_dwell_s)
        for call in train.calls
    ]


HOUR, MINUTE = 3600.0, 60.0


def test_parts_of_a_train_follow_each_other_over_midnight(railml):
    """From 23:40 over Fork to the mine, 24:10, and after 5 min at least, at 24:20, back to West."""
    (train,) = railml().trains
    assert (train.name, train.train_type) == ("4101", "Ore_train")
    assert told(train) == [
        ("West", "start", None, 23 * HOUR + 40 * MINUTE, None),
        ("Fork", "pass", 23 * HOUR + 50.5 * MINUTE, None, None),
        ("Mine", "stop", 24 * HOUR + 10 * MINUTE, 24 * HOUR + 20 * MINUTE, 300.0),
        ("West", "end", 24 * HOUR + 50 * MINUTE, None, None),
    ]


def test_a_train_that_passes_its_origin_departs_there(railml):
    """Programs that export a part of a network let trains begin where they pass its border."""
    (train,) = railml(('sequence="1" ocpType="stop"', 'sequence="1" ocpType="pass"')).trains
    assert told(train)[0] == ("West", "start", None, 23 * HOUR + 40 * MINUTE, None)


def test_a_train_begins_where_its_times_do(railml):
    """Without its departure from West it begins when it passes Fork, at 23:50:30."""
    found = railml((' departure="23:40"', ""))
    (train,) = found.trains
    assert told(train)[0] == ("Fork", "start", None, 23 * HOUR + 50.5 * MINUTE, None)
    assert any("where it begins: of 1 of the trains" in each for each in found.left_out)


def test_a_train_without_any_time_is_left_out(railml):
    start, end = FILE.index("<trains>"), FILE.index("</timetable>")
    times = '<times scope="scheduled" departure="00:20:00.0" departureDay="1"/>'
    found = railml((times, ""), ('<times scope="scheduled" arrival="00:50:00"/>', ""),
                   text=FILE[:start] + FILE[end:])  # fmt: skip
    assert [train.name for train in found.trains] == ["p1"]
    assert "trains without any time: 1" in found.left_out


def test_what_is_left_out_is_counted(railml):
    found = railml().left_out
    for words in ("stations of these names: 2", "reserves of running times: 1", "periods: 1",
                  "coupled to others: 1", "times of scope actual: 1"):  # fmt: skip
        assert any(words in each for each in found), words


def test_without_trains_each_part_is_one(railml):
    start, end = FILE.index("<trains>"), FILE.index("</timetable>")
    found = railml(text=FILE[:start] + FILE[end:])
    assert [train.name for train in found.trains] == ["p1", "p2"]


def test_the_command_writes_a_timetable(tmp_path, monkeypatch, capsys):
    (tmp_path / "made.railml").write_text(FILE)
    call = ["tpss", "import", "railml", tmp_path / "made.railml", "--out", tmp_path / "m"]
    monkeypatch.setattr("sys.argv", [str(each) for each in call])
    with pytest.raises(SystemExit) as exited:
        main()
    assert exited.value.code == 0
    assert "their stations: Fork, Mine, West" in capsys.readouterr().out
    lines = (tmp_path / "m" / "timetable.csv").read_text("utf-8").splitlines()
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    assert rows[:3] == [
        ["name", "train", "station", "arrival", "departure", "min_dwell_s", "kind"],
        ["4101", "Ore_train", "West", "", "23:40:00", "", "start"],
        ["4101", "", "Fork", "23:50:30", "", "", "pass"],
    ]


@pytest.mark.parametrize(
    ("old", "new", "key", "problem"),
    [
        ('departure="23:40"', 'departure="late"', "trainPart p1, departure", "not a time"),
        ('arrivalDay="1"', 'arrivalDay="next"', "trainPart p1, arrival", "not its day"),
        ('ocpRef="ocp_f"', 'ocpRef="ocp_x"', "trainPart p1, ocpTT", "no such ocp"),
        ('"PT5M"', '"5 min"', "trainPart p2, minimalTime", "not a duration"),
        ('ref="p2"', 'ref="p9"', "trainPartRef p9", "no such trainPart"),
        ('version="2.4"', 'version="4.0"', "version", "not railML 2 or 3, but railml 4.0"),
        ("</timetable>", "", "line 56", "mismatched tag"),
        ("<trainParts>", "<trainParts>" + "<a>" * 300, "line 14", "more than 200 elements"),
    ],
)
def test_a_fault_names_file_place_and_remedy(railml, old, new, key, problem):
    with pytest.raises(tpss.ScenarioError) as caught:
        railml((old, new))
    finding = caught.value.findings[0]
    assert (Path(finding.file).name, finding.key) == ("made.railml", key)
    assert problem in finding.problem
    assert finding.remedy


def test_a_doctype_is_refused_before_its_entities_grow(railml):
    bomb = '<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>\n<railml'
    with pytest.raises(tpss.ScenarioError) as caught:
        railml(("<railml", bomb))
    assert "DOCTYPE" in caught.value.findings[0].problem


def test_a_file_that_is_not_there_is_told(tmp_path):
    with pytest.raises(tpss.ScenarioError) as caught:
        read(tmp_path / "none.railml")
    assert "cannot be read" in caught.value.findings[0].problem
