"""Public examples of other programs, fetched as they may not be handed on: scenarios without faults.

What is expected of each was counted in the files themselves, or is what their authors say of them.
"""

from pathlib import Path

import pytest

import tpss
from tpss.cli.main import main
from tpss.importers import gtfs, osrd, railml
from tpss.importers.network import ImportedNetwork
from tpss.importers.network_files import files
from tpss.importers.railml2 import ImportedTrains

from public_files import PublicFile

OSRD = ("OpenRailAssociation/osrd", "66c30bb34e55f46c0d62bde258d2275797dedbac")
INFRAS = {
    "circle_infra": "eecba5a3d9a0fc59dd7ffab78cec7efdc57ba7a93bd05db419e8789fbc66c92a",
    "example_script": "6d3e47b60a08ff84059c6a05c6e3ca0019765a058900a7b8a8225cf0e012cd8a",
    "nested_switches": "878cbfbc008e87d6549fa5196967cfedb2e300a25a7b4385871d69bb9d1cbd7e",
    "one_line": "303851889f381cf3dc2523d20d807b3ce39104ec42725dbd211be85580e9cb67",
    "overlapping_routes": "9ea6d1f2538270b853c645dab1750e64a5d6c6cde1d3029cd5d7276372d4d66b",
    "small_infra": "abf3ca7d70f8bc681a5401902e079ffcbec0f958f51ce0cebc0f4051928e0126",
    "three_trains": "93e7523808e5efcf9d0f9b4834f8a17fce53b3b05210d1b410bf42de3ad1643c",
    "tiny_infra": "06cb360b1cfd64435973015c51fab49340165a2c7388583766e5f64b789a57c6",
}
OSRD_TRAINS = PublicFile(
    *OSRD,
    "front/tests/assets/trainSchedule/train_schedules.json",
    "0f0b2f08c4f27258734896adff6b4e5f511ed21e593b42b2807a74482c1c5994",
)

SAMPLES = ("rigosk/railml", "e1e719677e022e16daf505bc7ee47408f59af035")
OPENTRACK_TRAINS = PublicFile(
    *SAMPLES,
    "samples/OpenTrack_to_railML.V_2.2.timetable.railml",
    "8a3665feb22ea6883c8c5807a84b131c19590a2f736ccc32cdac46c800ed4945",
)
SIMPLE_EXAMPLE = PublicFile(
    *SAMPLES,
    "samples/railML_SimpleExample_v11_railML3-1_04.railml",
    "14a581484c511c18626ce02ff94679db88a03867bcdc4ff6ee6b20acbce9f280",
)
FINNISH_LINE = PublicFile(
    "finnishtransportagency/infra2railml",
    "d80998246d97cad75be088f542fbf6e95507bb8b",
    "Track-007_28-47.railml.xml",
    "7ad34b6f6c7a4e3233a52d32202b284573b929a1c809066bb6252c6dccd1a125",
)
JUNCTIONS_3 = PublicFile(
    "GICSAFePhD/RailML",
    "3f0818a85bbaa597f7e7391075cbf0c554b29fc0",
    "Example_0.railml",
    "b479e1d4dc926a08755689e79e3d5d670656fbf80fa12b470bdfb30d9e395df1",
)
STATION_2 = PublicFile(
    "keepsky/Railml_editor",
    "6854a0fe21f9a5479078b58d24a33c98911a2698",
    "kr.railml",
    "7ce630e807d0b224f8c1f1550d887bb155d242627301099e45d4ed64d3662929",
)

SAMPLE_FEED = PublicFile(
    "google/transitfeed",
    "104b5a5b339c62a94c1579d7209a41c7c0833e35",
    "tests/data/good_feed.zip",
    "d95f74f4106964abca1087607db324e90965754afe5044b709ea0d971bb5fd0a",
)
CALTRAIN = {
    "calendar.txt": "6a3efa78b1227c1ac27f7c7c7bae7a1046b88ffe4194212b250e5e6e7ca726e0",
    "calendar_dates.txt": "296b4aafd8bbf10c37fcd32c7953ae310cdb4402bb05772a48867274d02d7f6b",
    "routes.txt": "2366f9993b77d737e260ec1bb00ffda27e1063ca30a32c77104af657827ea95b",
    "shapes.txt": "488c599cf3038da41923885ff5fb48a64d02af8cba8afb796af421e9d62b3e4b",
    "stop_times.txt": "df3f2b8a39a04ebd6276e0fe2a05d5c04b0b189adb0b2177cb0deec968a75b20",
    "stops.txt": "b421a4e8260d9816bd4133d905d57e37a783b75371d6893fdbf54b92c92adb00",
    "trips.txt": "ef2210b17258afcb4b138bcd82392d53a68870133a5115ea64ae7a3845c6d45d",
}


def infra(name: str, folder: Path) -> Path:
    """An infrastructure of OSRD, in a folder of its name."""
    path = f"tests/data/infras/{name}/infra.json"
    return PublicFile(*OSRD, path, INFRAS[name]).copied_to(folder / name)


def caltrain(folder: Path) -> Path:
    """A feed of the trains between San Francisco and Gilroy."""
    commit = ("remix/partridge", "7b3d2c70281ef4f5437c3e48d786569c1702ebd8")
    for name, sha256 in CALTRAIN.items():
        path = f"tests/fixtures/caltrain-2017-07-24/{name}"
        PublicFile(*commit, path, sha256).copied_to(folder / "caltrain")
    return folder / "caltrain"


def length_km(network: ImportedNetwork) -> float:
    return round(sum(line.length_km for line in network.lines), 3)


def load(network: ImportedNetwork, folder: Path) -> tpss.Scenario:
    """The scenario that is written of a network."""
    for name, text in files(network).items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return tpss.load_scenario(folder / "scenario.toml")


@pytest.mark.parametrize("name", INFRAS)
def test_infrastructures_of_osrd(name, tmp_path):
    found = osrd.read(infra(name, tmp_path))
    assert load(found, tmp_path / "made").lines


def test_small_infra_of_osrd_with_its_trains(tmp_path):
    """31 track sections, 8 stations, 20 trains; 93.253 km of its tracks have 25 kV.  Its neutral
    sections: 500 m of TG4 and 10 m of TA6, both from a switch on; the last 40 m of TA0 one way and 140 m
    before its last 10 m the other way; 100 m of TA6.
    """
    found = osrd.read(infra("small_infra", tmp_path), OSRD_TRAINS.copied_to(tmp_path))
    assert (length_km(found), found.system, len(found.trains)) == (120.253, "25kV-50Hz", 20)
    scenario = load(found, tmp_path / "made")
    assert {(each.line, each.from_km, each.to_km) for each in scenario.supply.neutral_sections} == {
        ("West_parking_V1", 1.85, 1.998),
        ("West_to_East_road_V1", 0.002, 0.01),
        ("West_to_East_road_V1", 8.5, 8.6),
        ("North_East_parking_V1", 0.002, 0.5),
    }


def test_what_is_imported_runs(tmp_path, monkeypatch):
    """All the 20 trains of OSRD run their ways, with the supply that is assumed."""
    monkeypatch.setattr("sys.argv", [
        "tpss", "import", "osrd", str(infra("small_infra", tmp_path)),
        str(OSRD_TRAINS.copied_to(tmp_path)), "--out", str(tmp_path / "made"),
    ])  # fmt: skip
    with pytest.raises(SystemExit) as exited:
        main()
    assert exited.value.code == 0
    changes = {"simulation.time_step_min": 0.5}
    result = tpss.simulate(tpss.load_scenario(tmp_path / "made" / "scenario.toml", changes))
    assert result.trips["arrival_min"].notna().all()


def test_trains_that_opentrack_exported(tmp_path):
    """50 trains around Zürich; 28 of them begin where they pass the border of the network."""
    found = railml.read(OPENTRACK_TRAINS.copied_to(tmp_path))
    assert isinstance(found, ImportedTrains)
    assert len(found.trains) == 50
    first = next(train for train in found.trains if train.name == "18321").calls[0]
    assert (first.station, first.departure_s) == ("SCHL", 6 * 3600 + 52 * 60 + 48)
    assert all(train.calls[0].departure_s is not None for train in found.trains)


def test_the_simple_example_of_railml_3(tmp_path):
    """Line 6869 from Arnau to Cstadt, 5 km, with two tracks at both and a track beside at the end."""
    found = railml.read(SIMPLE_EXAMPLE.copied_to(tmp_path))
    assert isinstance(found, ImportedNetwork)
    main_line = found.lines[0]
    assert main_line.length_km == 5.0
    assert {"Bf Arnau", "Bf Cstadt"} <= set(main_line.stations)
    assert load(found, tmp_path / "made").lines


def test_a_finnish_line_in_its_kilometres(tmp_path):
    """Line 7 has a track for each kilometre from 28 to 47, but none for km 39; km 32 has 1003 m."""
    found = railml.read(FINNISH_LINE.copied_to(tmp_path))
    assert isinstance(found, ImportedNetwork)
    ends = [(line.begins_at_km, line.length_km) for line in found.lines]
    assert ends == [(28.0, 11.003), (39.003, 8.002)]
    assert load(found, tmp_path / "made").lines


@pytest.mark.parametrize(
    ("file", "sections"), [(JUNCTIONS_3, 17), (STATION_2, 54)], ids=["railML 3", "railML 2"]
)
def test_drawn_track_plans(file, sections, tmp_path):
    """Plans of stations from two editors: all their track sections are on lines."""
    found = railml.read(file.copied_to(tmp_path))
    assert isinstance(found, ImportedNetwork)
    assert found.taken[0].startswith(f"track sections: {sections},")
    assert load(found, tmp_path / "made").lines


def test_the_sample_feed_of_gtfs(tmp_path):
    found = gtfs.read(SAMPLE_FEED.copied_to(tmp_path), ["AB"])
    assert [train.name for train in found.trains] == ["AB1", "AB2"]
    assert load(found, tmp_path / "made").lines


def test_trains_between_san_francisco_and_gilroy(tmp_path):
    """28 local trains a day and 29 stations, on 124 km (77.2 miles) of railway."""
    found = gtfs.read(caltrain(tmp_path), ["Local"])
    assert (len(found.trains), [len(line.stations) for line in found.lines]) == (28, [29])
    assert length_km(found) == pytest.approx(124.2, rel=0.01)
    assert load(found, tmp_path / "made").lines
