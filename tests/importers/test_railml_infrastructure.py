"""Infrastructure of railML 3 and railML 2: the lines that it becomes."""

from pathlib import Path

import pytest

import tpss
from railml_made_up import RAILML_2, RAILML_3, TRAINS_2
from tpss.cli.main import main
from tpss.importers.network import ImportedNetwork, NetworkLine
from tpss.importers.network_files import files
from tpss.importers.railml import read


@pytest.fixture
def network(tmp_path):
    """Reader of a text, with parts of it replaced."""

    def of(text: str, *replaced: tuple[str, str]) -> ImportedNetwork:
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "made.railml").write_text(text, encoding="utf-8")
        found = read(tmp_path / "made.railml")
        assert isinstance(found, ImportedNetwork)
        files(found)
        return found

    return of


def named(network: ImportedNetwork) -> dict[str, NetworkLine]:
    return {line.name: line for line in network.lines}


def call(monkeypatch, *arguments: object) -> int | str | None:
    monkeypatch.setattr("sys.argv", ["tpss", *map(str, arguments)])
    with pytest.raises(SystemExit) as exited:
        main()
    return exited.value.code


LAST_LINE = RAILML_3.count("\n") + 1


# railML 3


def test_net_elements_become_lines_that_keep_their_kilometres(network):
    """ne_a, 6 km from km 10, then ne_b backwards: 4 km by its kilometres, as it has no length.  The
    branch is as long as its track.
    """
    lines = named(network(RAILML_3))
    assert list(lines) == ["Main", "Branch"]
    ends = {name: (line.begins_at_km, line.length_km) for name, line in lines.items()}
    assert ends == {"Main": (10.0, 10.0), "Branch": (0.0, 5.0)}


def test_operational_points_are_where_spots_kilometres_stretches_or_platforms_say(network):
    """West by its spot; Middle at km 13 of the element that stands for both; East in the middle of the
    first 200 m of ne_b, from km 20; the mine in the middle of its platform, 4.8 to 5 km.
    """
    found = network(RAILML_3)
    lines = named(found)
    assert lines["Main"].stations == {"West": 0.0, "Middle": 3.0, "Fork": 6.0, "East": 9.9}
    assert lines["Branch"].stations == {"Fork": 0.0, "Mine": 4.9}
    assert "operational points without a place on the tracks: Lost" in found.left_out
    stations = lines["Main"].document["stations"]
    assert stations[-1] == {"name": "East", "position_km": 19.9}


def test_gradients_turn_with_their_element_and_arcs_have_the_mean_of_their_ends(network):
    """The arc begins with the 5 ‰ before it and changes by -8: 1 ‰ in the mean.  ne_b climbs 2 ‰ towards
    km 16, so from there to km 17 the line falls.
    """
    found = network(RAILML_3)
    expected = [(0, 0), (1, 5), (3, 1), (3.4, -3), (6, -2), (7, 0)]
    assert named(found)["Main"].gradients == expected
    assert "level track on 9 km: the file has no gradients there" in found.assumed


def test_an_arc_with_nothing_beside_it_is_left_out(network):
    found = network(RAILML_3, ('posBegin="3000" posEnd="3400"', 'posBegin="100" posEnd="500"'))
    assert "vertical curves without a gradient beside them: 1" in found.left_out


def test_limits_hold_in_their_directions_for_all_trains(network):
    """80 km/h from km 15 to 16 on ne_a, and on the last km of ne_b against it: to km 17, rising."""
    lines = named(network(RAILML_3))
    assert lines["Main"].limits == [(0, 120), (5, 80), (7, 120)]
    assert lines["Main"].limits_down == [(0, 120)]
    assert (lines["Branch"].limits, lines["Branch"].limits_down) == ([(0, 60)], [])


def test_curves_are_placed_by_shares_of_the_element(network):
    assert named(network(RAILML_3))["Main"].curves == [(3.0, 3.6, 800.0)]


def test_what_railml_3_has_besides_is_counted(network):
    told = network(RAILML_3).left_out
    assert "signalling: 2 signals, 1 balises" in told
    assert "1 platforms" in told
    assert any(each.startswith("electrification sections: 1, 25 kV 50 Hz on 6 km") for each in told)
    assert "neutral sections without a place of their own: 1" in told
    assert "temporary speed sections: 1" in told
    assert "speed sections of single kinds of train: 1" in told


def test_a_short_section_that_separates_phases_is_a_neutral_section(network):
    """The last 200 m of ne_a but 100: km 15.7 to 15.9."""
    whole = '<associatedNetElement netElementRef="ne_a" keepsOrientation="true"/>'
    begin = RAILML_3.index('<electrificationSection id="el">')
    head, tail = RAILML_3[:begin], RAILML_3[begin:]
    part = whole.replace("/>", ' posBegin="5700" posEnd="5900"/>')
    found = network(head + tail.replace(whole, part, 1),
                    ("<phaseSeparationSection/>", '<phaseSeparationSection lowerPantograph="true"/>'),
                    )  # fmt: skip
    assert found.neutral_sections == [("Main", 15.7, 15.9, 15.0)]


def test_each_element_lies_on_a_line_in_its_kilometres(network):
    ranges = [(each.track, each.line, each.from_km, each.to_km, each.begin_m, each.end_m)
              for each in network(RAILML_3).tracks]  # fmt: skip
    assert ranges == [
        ("ne_a", "Main", 10, 16, 0, 6000), ("ne_b", "Main", 16, 20, 4000, 0),
        ("ne_c", "Branch", 0, 5, 0, 5000),
    ]  # fmt: skip


def test_kilometres_that_fall_along_a_line_turn_it(network):
    """ne_b ends at the switch; without ne_a it is the main line, which runs towards km 20."""
    relation = 'id="nr_ab" positionOnA="1" positionOnB="1" navigability="Both"'
    lines = named(network(RAILML_3, (relation, relation.replace("Both", "None"))))
    (line,) = (line for line in lines.values() if "East" in line.stations)
    assert (line.begins_at_km, line.length_km, line.stations["East"]) == (16.0, 4.0, 3.9)


def test_a_jump_of_the_kilometres_is_told(network):
    """ne_b at km 21 to 17: a kilometre is missing behind the switch."""
    found = network(RAILML_3, ('measure="20000"', 'measure="21000"'),
                    ('id="b1" intrinsicCoord="1">\n              <linearCoordinate '
                     'positioningSystemRef="lps" measure="16000"',
                     'id="b1" intrinsicCoord="1">\n              <linearCoordinate '
                     'positioningSystemRef="lps" measure="17000"'))  # fmt: skip
    assert named(found)["Main"].length_km == 10.0
    assert any(
        each.startswith("jumps of the kilometres: 1, of up to 1 km") for each in found.left_out
    )


ANCHORED = (
    'startMeasure="10000" endMeasure="20000"/>',
    """startMeasure="10000" endMeasure="20000">
          <anchor id="k1" measure="10000" measureToNext="2000"/>
          <anchor id="k2" measure="12500" measureToNext="6500"/>
          <anchor id="k3" measure="18800" measureToNext="1200"/>
        </linearPositioningSystem>""",
)
"""Km 12 is km 12.5 at once, and km 19 km 18.8 again."""


def test_a_gap_and_an_overlap_of_a_positioning_system_are_no_way(network):
    """ne_a: 2 km and 3.5 km.  ne_b, from km 20 down to 16: 1.2 km to km 18.8, then from km 19 on 3 km.
    Of 5.5 km the fork is at the end; Middle at km 13 is 2.5 km from the beginning, the limit of km 15
    to 16 4.5 km, and that on ne_b, 3 to 4 km from its beginning, from 0.2 km behind the fork on.
    """
    found = network(RAILML_3, ('id="ne_a" length="6000"', 'id="ne_a"'), ANCHORED)
    main = named(found)["Main"]
    assert (main.begins_at_km, main.length_km) == (10.0, 9.7)
    assert main.stations == pytest.approx({"West": 0.0, "Middle": 2.5, "Fork": 5.5, "East": 9.6})
    assert main.limits == [(0, 120), (4.5, 80), (5.5, 120), (5.7, 80), (6.7, 120)]
    (told,) = (each for each in found.left_out if each.startswith("jumps"))
    assert told.startswith("jumps of the kilometres: 2, of up to 0.5 km")
    assert told.endswith(
        "Main at 12 km (12.5 km in the file), Main at 18.5 km (18.8 km in the file)"
    )


def test_a_mileage_change_of_railml_3_is_a_jump(network):
    """As the first of the anchors, from the spot that ends to the spot that begins."""
    change = """<mileageChanges><mileageChange id="mc" from="mc_a" to="mc_b" type="gap">
          <spotLocation id="mc_b" netElementRef="ne_a"><linearCoordinate positioningSystemRef="lps"
            measure="12500"/></spotLocation>
          <spotLocation id="mc_a" netElementRef="ne_a"><linearCoordinate positioningSystemRef="lps"
            measure="12000"/></spotLocation>
        </mileageChange></mileageChanges>
        <gradientCurves>"""
    found = network(
        RAILML_3, ('id="ne_a" length="6000"', 'id="ne_a"'), ("<gradientCurves>", change)
    )
    assert named(found)["Main"].length_km == 9.5
    assert any(each.endswith("Main at 12 km (12.5 km in the file)") for each in found.left_out)


def test_sections_without_a_length_share_that_of_their_track_as_they_are_drawn(network):
    """10 km of track over ne_a, 6 km, and two elements drawn 3 and 1 long: 3 km and 1 km."""
    drawn = """<associatedPositioningSystem id="{0}">
      <intrinsicCoordinate id="{0}0" intrinsicCoord="0"><geometricCoordinate x="0" y="0"/>
      </intrinsicCoordinate>
      <intrinsicCoordinate id="{0}1" intrinsicCoord="1"><geometricCoordinate x="{1}" y="0"/>
      </intrinsicCoordinate></associatedPositioningSystem>"""
    begin, end = RAILML_3.index('<netElement id="ne_b">'), RAILML_3.index('<netElement id="ne_m">')
    text = (
        RAILML_3[:begin]
        + f'<netElement id="ne_b">{drawn.format("d", 3)}</netElement>'
        + f'<netElement id="ne_c">{drawn.format("e", 1)}</netElement>'
        + RAILML_3[end:]
    )
    track = '<associatedNetElement netElementRef="ne_c" keepsOrientation="true"/>\n          '
    track += '</linearLocation>\n          <length type="physical" value="5000"/>'
    parts = "".join(f'<associatedNetElement netElementRef="ne_{x}"/>' for x in "abc")
    found = network(
        text, (track, f'{parts}</linearLocation><length type="physical" value="10000"/>')
    )
    lines = named(found)
    assert (lines["Main"].length_km, lines["Branch"].length_km) == (9.0, 1.0)
    assert any("lengths of 2 sections: shares of their track's length" in x for x in found.assumed)


def test_without_operational_points_the_ends_of_tracks_are_stations(network):
    begin, end = RAILML_3.index("<operationalPoints>"), RAILML_3.index("<platforms>")
    found = network(RAILML_3[:begin] + RAILML_3[end:])
    assert named(found)["Main"].stations == {"Begin of ne_a": 0, "Fork": 6, "End of ne_b": 10}
    assert any("has no operational points" in each for each in found.assumed)


# railML 2


def test_tracks_of_railml_2_follow_each_other_in_lines_beyond_a_jump_of_kilometres(network):
    """t1, 6 km, cut at the jump and at the switch, then t3 backwards, 4 km; km 12 is km 12.5 at once."""
    found = network(RAILML_2)
    lines = named(found)
    ends = {name: (line.begins_at_km, line.length_km) for name, line in lines.items()}
    assert ends == {"Main": (10.0, 10.0), "Branch_2": (0.0, 3.0)}
    (told,) = (each for each in found.left_out if each.startswith("jumps"))
    assert told.startswith("jumps of the kilometres: 1, of up to 0.5 km")
    assert told.endswith("Main at 12 km (12.5 km in the file)")
    assert [each.track for each in found.tracks] == [
        "t1", "t1 from 2000 m", "t1 from 4000 m", "t3", "t2"
    ]  # fmt: skip


def test_what_ends_at_a_jump_keeps_its_kilometres(network):
    """Without the kilometre of t1's beginning the change itself tells it: km 12 less 2 km."""
    lines = named(network(RAILML_2, ('pos="0" absPos="10000"', 'pos="0"')))
    assert lines["Main"].begins_at_km == 10.0


def test_kilometres_that_jump_untold_are_a_jump_too(network):
    """Without the change, but with a kilometre of the switch: 4 km from km 10 it is km 14.5."""
    change = '<mileageChange id="m" pos="2000" absPosIn="12000" absPos="12500" type="missing"/>'
    found = network(
        RAILML_2, (change, ""), ('name="Fork" pos="4000"', 'name="Fork" pos="4000" absPos="14500"')
    )
    (told,) = (each for each in found.left_out if each.startswith("jumps"))
    assert told.endswith("Main at 14 km (14.5 km in the file)")


def test_operational_points_of_railml_2_are_at_cross_sections_and_macroscopic_nodes(network):
    found = network(RAILML_2)
    lines = named(found)
    assert lines["Main"].stations == {"West": 0.0, "Middle": 1.0, "Fork": 4.0, "East": 9.9}
    assert lines["Branch_2"].stations == {"Fork": 0.0, "Mine": 3.0}
    assert "operational points without a place on the tracks: Lost" in found.left_out


def test_speeds_hold_until_the_next_change_on_the_next_track_too(network):
    """Rising: 100, from 3 km 80, also on t3 until its km 2, where trains towards its beginning may run
    120.  Falling: 90 from t3's beginning on, also on t1.
    """
    found = network(RAILML_2)
    main = named(found)["Main"]
    assert main.limits == [(0, 100), (3, 80), (8, 120)]
    assert main.limits_down == [(0, 90)]
    assert "speed changes of other kinds of train: 1" in found.left_out


def test_the_end_of_a_restriction_leaves_no_limit(network):
    main = named(
        network(RAILML_2, ('pos="3000" dir="up" vMax="80"', 'pos="3000" dir="up" vMax="end"'))
    )
    assert main["Main"].limits == [(0, 100), (3, 500), (8, 120)]


def test_slopes_of_railml_2_turn_with_their_track(network):
    """t3 climbs 1 ‰ from its beginning to its end, which is towards falling kilometres."""
    found = network(RAILML_2)
    assert named(found)["Main"].gradients == [(0, 5), (3, -2), (6, -1)]
    assert "level track on 3 km: the file has no gradients there" in found.assumed


def test_curves_and_electrification_of_railml_2(network):
    found = network(RAILML_2)
    assert named(found)["Main"].curves == [(0.5, 0.9, 700.0)]
    assert found.system == "15kV-16.7Hz"
    assert any(
        "electrifications, 15 kV 16.7 Hz on 6 km of track" in each for each in found.left_out
    )


def test_a_branch_that_comes_in_is_met_from_behind_the_switch(network):
    """It leads on to the piece behind the switch: the line goes on, and the branch meets it."""
    incoming = ('orientation="outgoing" course="left"', 'orientation="incoming" course="left"')
    lines = named(network(RAILML_2, incoming))
    assert lines["Branch_2"].stations == {"Fork": 0.0, "Mine": 3.0}


def test_a_simple_crossing_lets_lines_cross_and_not_meet(network):
    crossing = """<crossing id="x" name="X" pos="4000" type="simpleCrossing">
              <connection id="c4" ref="c2" orientation="outgoing"/>
              <connection id="c6" ref="c5" orientation="incoming"/>
            </crossing>"""
    begin, end = RAILML_2.index('<switch id="sw"'), RAILML_2.index("</switch>") + len("</switch>")
    text = RAILML_2[:begin] + crossing + RAILML_2[end:]
    other = """<track id="t4" name="4"><trackTopology><trackBegin id="t4b" pos="0"/>
      <trackEnd id="t4e" pos="1000"><connection id="c5" ref="c6"/></trackEnd></trackTopology></track>
      <track id="t3" """
    lines = named(network(text.replace('<track id="t3" ', other)))
    assert "X" not in lines["Main"].stations
    (crossed,) = (line for line in lines.values() if "Mine" in line.stations)
    assert crossed.length_km == 4.0


def test_connections_to_nowhere_are_counted(network):
    found = network(RAILML_2, ('<bufferStop id="bs"/>', '<connection id="c9" ref="undefined"/>'))
    assert "connections to what the file does not have: 1" in found.left_out


def test_trains_of_the_same_file_become_its_timetable(network):
    found = network(RAILML_2, ("</railml>", f"{TRAINS_2}</railml>"))
    (train,) = found.trains
    assert [call.station for call in train.calls] == ["West", "Middle", "Mine"]
    assert "trains: 1, with their times" in found.taken
    assert any("do not connect: 1" in each for each in found.left_out)
    assert not any("write the lines" in each for each in found.left_out)
    text = files(found)["scenario.toml"]
    assert '[[timetables]]\nfile = "timetable.csv"' in text


# Files and faults


@pytest.mark.parametrize(
    "text", [RAILML_3, RAILML_2, RAILML_2.replace("</railml>", f"{TRAINS_2}</railml>")]
)
def test_the_files_are_a_scenario_without_faults(text, tmp_path, monkeypatch, capsys):
    (tmp_path / "made.railml").write_text(text, encoding="utf-8")
    there = tmp_path / "m"
    assert call(monkeypatch, "import", "railml", tmp_path / "made.railml", "--out", there) == 0
    assert "Complete it, then check it" in capsys.readouterr().out
    assert call(monkeypatch, "check", there / "scenario.toml") == 0
    assert tpss.load_scenario(there / "scenario.toml").lines["Main"].begins_at_km == 10.0


def test_a_system_of_railml_3_is_that_of_the_scenario(network):
    text = files(network(RAILML_3))["scenario.toml"]
    assert 'system = "25kV-50Hz"' in text
    assert "ASSUMED, edit it: railML 3.2 describes no power supply" in text


@pytest.mark.parametrize(
    ("text", "old", "new", "key", "problem"),
    [
        (RAILML_3, 'version="3.2"', 'version="4.0"', "version", "not railML 2 or 3, but railML 4.0"),
        (RAILML_3, 'encoding="UTF-8"', 'encoding="none"', "line 1", "unknown encoding: none"),
        (RAILML_3, "</railML>", "", f"line {LAST_LINE}", "no element found"),
        (RAILML_3, 'id="ne_a" length="6000"', 'id="ne_a" length="long"', "netElement ne_a, length",
         "not a number"),
        (RAILML_3, '<netElement id="ne_c"/>', '<netElement id="ne_c"/><netElement id="ne_c"/>',
         "netElement ne_c", "another netElement has this id"),
        (RAILML_3, 'type="physical" value="5000"', 'type="physical" value="0"', "netElement ne_c",
         "it has no length"),
        (RAILML_3, '<elementB ref="ne_c"/>', '<elementB ref="ne_x"/>', "netRelation nr_ac",
         "there is no netElement 'ne_x'"),
        (RAILML_3, 'id="nr_ab" positionOnA="1"', 'id="nr_ab"', "netRelation nr_ab, positionOnA",
         "neither 0 nor 1"),
        (RAILML_3, 'curveType="straight" gradient="5"', 'curveType="straight"', "gradientCurve g1",
         "it has no gradient"),
        (RAILML_3, 'id="s120" maxSpeed="120"', 'id="s120"', "speedSection s120", "it has no maxSpeed"),
        (RAILML_3, 'netElementRef="ne_a" intrinsicCoord', 'netElementRef="ne_x" intrinsicCoord',
         "spotLocation op1_s, netElementRef", "there is no such netElement"),
        (RAILML_2, 'id="t2e" pos="3000"', 'id="t2e"', "track t2", "it has no length"),
        (RAILML_2, 'pos="0" slope="5"', 'pos="0"', "gradientChange g1", "it has no slope"),
        (RAILML_2, 'pos="0" slope="5"', 'slope="5"', "gradientChange g1", "it has no pos"),
        (RAILML_2, 'dir="up" vMax="100"', 'dir="up"', "speedChange v1", "it has no vMax"),
        (RAILML_2, 'vMax="100"', 'vMax="fast"', "speedChange v1, vMax", "not a number"),
    ],
)  # fmt: skip
def test_a_fault_names_file_element_and_remedy(network, text, old, new, key, problem):
    with pytest.raises(tpss.ScenarioError) as caught:
        network(text, (old, new))
    finding = next(each for each in caught.value.findings if each.key == key)
    assert Path(finding.file).name == "made.railml"
    assert problem in finding.problem
    assert finding.remedy


def test_all_faults_are_told_at_once(network):
    with pytest.raises(tpss.ScenarioError) as caught:
        network(RAILML_3, ('curveType="straight" gradient="5"', 'curveType="straight"'),
                ('id="s120" maxSpeed="120"', 'id="s120"'))  # fmt: skip
    assert len(caught.value.findings) == 2


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ('<railML version="3.1"><infrastructure id="i"/></railML>', "topology, netElements"),
        ('<railml version="2.3"><infrastructure id="i"/></railml>', "infrastructure, tracks"),
    ],
)
def test_an_empty_infrastructure_is_told(network, text, key):
    with pytest.raises(tpss.ScenarioError) as caught:
        network(text)
    (finding,) = caught.value.findings
    assert finding.key == key
    assert "the infrastructure is empty" in finding.problem
    assert "export the infrastructure" in finding.remedy
