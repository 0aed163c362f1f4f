"""Tracks and trains of TTOBench: what becomes of them, and what they say where they are at fault."""

import copy
import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tpss
from tpss.cli.main import main
from tpss.importers.ttobench import read, station_names
from tpss.importers.ttobench_files import files
from tpss.scenario.files import read_toml

from alternatives import fastest_run
from conftest import SHARED

TRACK: dict[str, Any] = {
    "metadata": {"id": "XX_Alpha_Beta", "library version": "TTOBench v1.2"},
    "altitude": {"unit": "m", "value": 12.0},
    "stops": {"unit": "m", "values": [0.0, 6200.5]},
    "speed limits": {
        "units": {"position": "m", "velocity": "km/h"},
        "values": [[0.0, 80], [1500.0, 140], [4000.0, 100]],
    },
    "gradients": {
        "units": {"position": "m", "slope": "permil"},
        "values": [[0.0, 5.0], [2000.3, -12.5], [5000.0, 0.0]],
    },
    "curvatures": {
        "units": {"position": "m", "radius at start": "m", "radius at end": "m"},
        "values": [[0.0, "infinity", 300.0]],
    },
}

TRAIN: dict[str, Any] = {
    "metadata": {"id": "XX_Unit", "library version": "TTOBench v1.2"},
    "num seats": {"unit": "-", "value": 200},
    "mass": {"unit": "kg", "value": 100000.0},
    "rho": {"unit": "%", "value": 8},
    "max traction power": {"unit": "kW", "value": 1800.0},
    "max reg braking power": {"unit": "kW", "value": 1800.0},
    "max traction force": {"unit": "kN", "value": 150.0},
    "max acceleration": {"unit": "m/s^2", "value": 1.0},
    "max deceleration": {"unit": "m/s^2", "value": 0.9},
    "max speed": {"unit": "km/h", "value": 120},
    "rolling resistance r0": {"unit": "kN", "value": 2.0},
    "rolling resistance r1": {"unit": "kN/(km/h)", "value": 0.01},
    "rolling resistance r2": {"unit": "kN/(km/h)^2", "value": 0.001},
    "efficiency traction": {"unit": "%", "value": 88.0},
    "wheel colour": {"unit": "-", "value": 3},
}

REAL = SHARED / "ttobench"
needs_real_files = pytest.mark.skipif(
    not REAL.is_dir(), reason="the files of TTOBench are not beside the repository"
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the made-up files, which is the working folder."""
    write(tmp_path / "track.json", TRACK)
    write(tmp_path / "train.json", TRAIN)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(path: Path, document: Any) -> Path:
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def changed(document: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Copy with values at key paths changed; None takes one out."""
    document = copy.deepcopy(document)
    for path, value in changes.items():
        *above, last = path.split("/")
        at = document
        for key in above:
            at = at[int(key)] if isinstance(at, list) else at[key]
        if value is None:
            del at[last]
        else:
            at[int(last) if isinstance(at, list) else last] = value
    return document


def imported(folder: Path, document: dict[str, Any]) -> Any:
    tracks, trains = read([write(folder / "one.json", document)])
    return [*tracks, *trains][0]


def call(monkeypatch, *arguments: object) -> int | str | None:
    monkeypatch.setattr("sys.argv", ["tpss", *map(str, arguments)])
    with pytest.raises(SystemExit) as exited:
        main()
    return exited.value.code


def test_a_track_becomes_a_line_in_kilometres(folder):
    line = imported(folder, TRACK).document
    assert line["length_km"] == 6.2005
    assert line["stations"] == [
        {"name": "Alpha", "position_km": 0.0},
        {"name": "Beta", "position_km": 6.2005},
    ]
    assert [tuple(row.values()) for row in line["speed_limits"]] == [(0, 80), (1.5, 140), (4, 100)]
    assert [tuple(row.values()) for row in line["gradients"]] == [(0, 5), (2.0003, -12.5), (5, 0)]


def test_a_track_keeps_its_kilometres(folder, monkeypatch):
    """From 438.2 to 444.4005 km: the line begins there, and so does the supply that is assumed."""
    places = {
        "stops/values": [438200.0, 444400.5],
        "speed limits/values": [[438200.0, 80], [439700.0, 140], [442200.0, 100]],
        "gradients": None,
    }
    write(folder / "track.json", changed(TRACK, places))
    assert call(monkeypatch, "import", "ttobench", "track.json", "train.json", "--out", "far") == 0
    scenario = tpss.load_scenario(folder / "far" / "XX_Alpha_Beta-XX_Unit.toml")
    line, supply = scenario.line, scenario.supply
    assert (line.begins_at_km, line.length_km, line.end_km) == (438.2, 6.2005, 444.4005)
    assert [gradient.from_km for gradient in line.gradients] == [438.2]
    assert [station.position_km for station in supply.stations] == [438.2, 444.4005]
    assert tpss.simulate(scenario).status == "finished"


def test_a_train_becomes_a_train(folder):
    """ρ = 8 % of 100 t: 8000 kg; r1 = 10 N/(km/h) = 36 N s/m; r2 = 1 N/(km/h)² = 12.96 N s²/m²."""
    document = imported(folder, TRAIN).document
    assert document["mass_t"] == document["adhesive_mass_t"] == 100.0
    assert document["motor_inertia_kg"] == 8000.0
    assert document["resistance_a_n"] == 2000.0
    assert document["resistance_b_n_s_per_m"] == 36.0
    assert document["resistance_c_n_s2_per_m2"] == 12.96
    assert document["tractive_effort"] == {"max_force_kn": 150.0, "max_power_kw": 1800.0}
    assert (document["max_acceleration_m_s2"], document["max_retardation_m_s2"]) == (1.0, 0.9)
    assert (document["max_speed_kmh"], document["efficiency"]) == (120.0, 0.88)


@pytest.mark.parametrize(
    ("document", "changes"),
    [
        (TRACK, {"stops": {"unit": "km", "values": [0.0, 6.2005]}}),
        (TRACK, {"speed limits/units": {"position": "km", "velocity": "m/s"},
                 "speed limits/values": [[0.0, 80 / 3.6], [1.5, 140 / 3.6], [4.0, 100 / 3.6]]}),
        (TRACK, {"gradients/units/slope": "%",
                 "gradients/values": [[0.0, 0.5], [2000.3, -1.25], [5000.0, 0.0]]}),
        (TRAIN, {"mass": {"unit": "t", "value": 100.0}, "rho": {"unit": "-", "value": 0.08}}),
        (TRAIN, {"rho": {"unit": "-", "value": 1.08}}),
        (TRAIN, {"max traction power": {"unit": "MW", "value": 1.8},
                 "max traction force": {"unit": "N", "value": 150e3},
                 "max speed": {"unit": "m/s", "value": 120 / 3.6},
                 "efficiency traction": {"unit": "-", "value": 0.88}}),
        (TRAIN, {"rolling resistance r0": {"unit": "N", "value": 2000.0},
                 "rolling resistance r1": {"unit": "N/(m/s)", "value": 36.0},
                 "rolling resistance r2": {"unit": "kN/(m/s)^2", "value": 0.01296}}),
    ],
)  # fmt: skip
def test_other_units_give_the_same(folder, document, changes):
    other = imported(folder, changed(document, changes)).document
    assert tpss_rounded(other) == tpss_rounded(imported(folder, document).document)


def tpss_rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: tpss_rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [tpss_rounded(item) for item in value]
    return round(value, 8) if isinstance(value, float) else value


@pytest.mark.parametrize(
    ("name", "count", "expected"),
    [
        ("SE_Vasteras_Kolback", 2, ["Vasteras", "Kolback"]),
        ("CH_Stadelhofen_Altstetten", 4, ["Stadelhofen", "Stop 2", "Stop 3", "Altstetten"]),
        ("00_reference", 2, ["Stop 1", "Stop 2"]),
        ("A_B_C", 3, ["A", "B", "C"]),
        ("CH_Loop_Loop", 2, ["Stop 1", "Stop 2"]),
    ],
)
def test_stations_take_their_names_from_the_id(name, count, expected):
    assert station_names(name, count) == expected


def test_each_file_says_what_was_taken_left_out_and_assumed(folder):
    tracks, trains = read([folder / "track.json", folder / "train.json"])
    texts = files(tracks, trains)
    for words in ("Taken:", "speed limits: 3", "Left out:", "altitude:", "curvatures: curve",
                  "Assumed, edit it:", "names of the stations: Alpha, Beta"):  # fmt: skip
        assert words in texts["XX_Alpha_Beta.toml"]
    for words in ("# Taken:", "#   - rho", "max reg braking power: trains do not feed power back",
                  "wheel colour: not known to this importer", "adhesive_mass_t is the whole mass",
                  "power_factor is 1", "auxiliary_power_kw is 0"):  # fmt: skip
        assert words in texts["XX_Unit.toml"]
    assert texts["XX_Alpha_Beta-XX_Unit.toml"].count("ASSUMED, edit it") == 2


def test_what_a_file_does_not_state_is_assumed_and_said(folder):
    efficiency_map = {"units": {"load": "%"}, "values": [[0, 1]]}
    missing = {"rho": None, "max deceleration": None, "max acceleration": None}
    less = changed(TRAIN, {**missing, "efficiency traction": efficiency_map})
    part = imported(folder, less)
    said = "\n".join(part.assumed)
    assert part.document["motor_inertia_kg"] == 0.0
    assert (part.document["max_retardation_m_s2"], part.document["efficiency"]) == (0.85, 0.8)
    assert "max_acceleration_m_s2" not in part.document
    for words in ("states no rho", "states no max deceleration", "a map of losses"):
        assert words in said
    level = imported(folder, changed(TRACK, {"gradients": None}))
    assert level.document["gradients"] == [{"from_km": 0.0, "permille": 0.0}]
    assert "level track" in level.assumed[0]


def test_an_id_becomes_the_name_of_files_wherever_it_leads(folder):
    part = imported(folder, changed(TRACK, {"metadata/id": "../../etc/passwd x"}))
    assert part.name == "etc_passwd_x"
    assert imported(folder, changed(TRACK, {"metadata": None})).name == "one"


def test_a_pair_runs_end_to_end_and_meets_a_slow_twin(folder, monkeypatch, capsys):
    """Time and energy of the fastest run, integrated over 20 cm of way, within 0.5 %."""
    assert call(monkeypatch, "import", "ttobench", "track.json", "train.json", "--out", "made") == 0
    printed = capsys.readouterr().out
    assert "tpss run made/XX_Alpha_Beta-XX_Unit.toml" in printed
    assert "wheel colour: not known" in printed
    file = folder / "made" / "XX_Alpha_Beta-XX_Unit.toml"
    compare_with_twin(TRACK, TRAIN, file)


def compare_with_twin(track: dict[str, Any], train: dict[str, Any], file: Path) -> None:
    """Fine steps against the twin; limits of speed, force, power and acceleration at every instant."""
    piece_m = 0.2
    x = np.arange(0.0, track["stops"]["values"][-1], piece_m)

    def stair(rows: Any, at: Any) -> Any:
        table = np.array(rows)
        return table[np.searchsorted(table[:, 0], at, side="right") - 1, 1]

    def value(name: str) -> float:
        return float(train[name]["value"])

    fastest = value("max speed") / 3.6
    limit = np.minimum(stair(track["speed limits"]["values"], x) / 3.6, fastest)
    seconds, joule, _ = fastest_run(limit, stair(track["gradients"]["values"], x) / 1e3, piece_m, {
        "mass_kg": value("mass"), "rotating": value("rho") / 100,
        "force_n": 1e3 * value("max traction force"), "power_w": 1e3 * value("max traction power"),
        "a": 1e3 * value("rolling resistance r0"), "b": 3.6e3 * value("rolling resistance r1"),
        "c": 12.96e3 * value("rolling resistance r2"), "acceleration": value("max acceleration"),
        "retardation": value("max deceleration"),
        "efficiency": value("efficiency traction") / 100,
    })  # fmt: skip
    result = tpss.simulate(tpss.load_scenario(file, {"simulation.time_step_min": 0.005}))
    assert (result.status, result.audit["passed"]) == ("finished", True)
    assert result.trips.trip_min[0] * 60.0 == pytest.approx(seconds, rel=5e-3)
    assert result.trips.energy_mwh[0] * 3.6e9 == pytest.approx(joule, rel=5e-3)
    run = result.dataset.isel(train=0)
    at, v = run.position.to_numpy(), run.speed.to_numpy()
    assert (v <= np.minimum(stair(track["speed limits"]["values"], at) / 3.6, fastest) + 1e-9).all()
    a = run.acceleration.to_numpy()[:-1]
    assert a.max() == pytest.approx(value("max acceleration"), rel=1e-9)
    assert a.min() >= -value("max deceleration") - 1e-9
    force = run.tractive_force.to_numpy()[:-1]
    motors = force + np.where(force > 0, a * value("mass") * value("rho") / 100, 0.0)
    assert motors.max() <= 1e3 * value("max traction force") + 1e-6
    power_w = run.motor_power.to_numpy()[:-1].max()
    assert power_w == pytest.approx(1e3 * value("max traction power"), rel=1e-9)


@needs_real_files
@pytest.mark.parametrize("track", ["SE_Vasteras_Kolback", "CH_StGallen_Wil"])
@pytest.mark.parametrize("train", ["CH_Stadler_FLIRT_TPF", "CH_Stadler_KISS_SBB"])
def test_real_tracks_and_trains_meet_the_slow_twin(track, train, tmp_path, monkeypatch):
    paths = [REAL / f"{name}.json" for name in (track, train)]
    assert call(monkeypatch, "import", "ttobench", *paths, "--out", tmp_path) == 0
    documents = [json.loads(path.read_text("utf-8")) for path in paths]
    compare_with_twin(*documents, tmp_path / f"{track}-{train}.toml")


@needs_real_files
def test_the_profile_written_climbs_as_the_file_s_gradients_do():
    """Each gradient holds from its position to the next one's, or to the end of the line."""
    source = json.loads((REAL / "SE_Vasteras_Kolback.json").read_text("utf-8"))
    (track,), _ = read([REAL / "SE_Vasteras_Kolback.json"])
    texts = files([track], [])
    rows = list(csv.reader(texts["SE_Vasteras_Kolback_gradients.csv"].splitlines()[2:]))
    km, permille = np.array(rows, dtype=float).T
    climb_m = np.diff(np.append(km, track.document["length_km"])) @ permille
    given = np.array(source["gradients"]["values"])
    ends = np.append(given[:, 0], source["stops"]["values"][-1])
    assert climb_m == pytest.approx(np.diff(ends) @ given[:, 1] / 1e3, rel=1e-9)


def test_trains_stop_at_the_stops_between(folder, monkeypatch):
    track = changed(TRACK, {"stops/values": [0.0, 3000.0, 6200.5]})
    write(folder / "track.json", track)
    assert call(monkeypatch, "import", "ttobench", "track.json", "train.json", "--out", "m") == 0
    result = tpss.simulate(tpss.load_scenario(folder / "m" / "XX_Alpha_Beta-XX_Unit.toml"))
    run = result.dataset.isel(train=0)
    standing = run.position.to_numpy()[run.train_state.to_numpy() == 4]
    assert set(standing) == {3000.0}
    assert result.stops.dwell_min[1] == pytest.approx(0.5)


def test_parts_may_be_imported_alone_and_used_in_a_scenario_of_ones_own(folder, monkeypatch):
    assert call(monkeypatch, "import", "ttobench", "track.json", "--out", "m") == 0
    assert sorted(p.name for p in (folder / "m").iterdir()) == [
        "XX_Alpha_Beta.toml",
        "XX_Alpha_Beta_gradients.csv",
    ]
    line = read_toml(folder / "m" / "XX_Alpha_Beta.toml")
    assert line["gradients_file"] == "XX_Alpha_Beta_gradients.csv"


def test_existing_files_are_kept_without_force(folder, monkeypatch, capsys):
    def again(*more: str) -> Any:
        return call(monkeypatch, "import", "ttobench", "train.json", "--out", "m", *more)

    assert again() == 0
    (folder / "m" / "XX_Unit.toml").write_text("edited")
    assert again() == 2
    assert "exists already" in capsys.readouterr().err
    assert (folder / "m" / "XX_Unit.toml").read_text() == "edited"
    assert again("--force") == 0
    assert (folder / "m" / "XX_Unit.toml").read_text() != "edited"


FAULTS = [
    pytest.param(TRACK, {"speed limits/units/velocity": "mph"}, "speed limits.units.velocity",
                 "'mph'", "km/h, m/s", id="unknown unit"),
    pytest.param(TRACK, {"stops/unit": None}, "stops.unit", "", "one of m, km", id="no unit"),
    pytest.param(TRACK, {"stops/values/1": "far"}, "stops.values.1", "'far'", "write a number",
                 id="text"),
    pytest.param(TRACK, {"gradients/values/1/1": "infinity"}, "gradients.values.1.1",
                 "'infinity'", "write a number", id="infinity"),
    pytest.param(TRACK, {"gradients/values/1": [3.0]}, "gradients.values.1", "[3.0]",
                 "give these values", id="one value"),
    pytest.param(TRACK, {"gradients/values/2/0": 1000.0}, "gradients.values.2.0", "1000.0 m",
                 "ascending order", id="not ascending"),
    pytest.param(TRACK, {"stops/values": [0.0, 500.0, 400.0]}, "stops.values.2", "400.0 m",
                 "ascending order", id="stops not ascending"),
    pytest.param(TRACK, {"stops/values": [0.0, 0.0]}, "stops.values.1", "0.0 m",
                 "ascending order", id="a stop twice"),
    pytest.param(TRACK, {"stops/values": [0.0, 6e6]}, "stops.values.1", "6000000.0 m",
                 "less than or equal to 2000 km", id="a line around the world"),
    pytest.param(TRACK, {"stops/values": [-5.0, 6000.0]}, "speed limits.values.0.0",
                 "0.0 m", "begin at -0.005", id="a stop before the limits"),
    pytest.param(TRACK, {"stops/values": [6200.5, 0.0], "gradients": None,
                         "speed limits/values": [[6200.5, 80], [1500.0, 140]]}, "stops.values.1",
                 "0.0 m", "minus sign before every position", id="falling kilometres"),
    pytest.param(TRACK, {"stops/values": 6200.5}, "stops.values", "6200.5", "give a list",
                 id="a number for a list"),
    pytest.param(TRACK, {"stops": [0.0, 6200.5]}, "stops", "[0.0, 6200.5]", "with its unit",
                 id="a bare list"),
    pytest.param(TRACK, {"speed limits": None}, "speed limits", "", "give it", id="no limits"),
    pytest.param(TRACK, {"speed limits/values": []}, "speed limits.values", "[]", "give a list",
                 id="empty"),
    pytest.param(TRACK, {"speed limits/units": None}, "speed limits.units.position", "",
                 "one of m, km", id="no units"),
    pytest.param(TRACK, {"speed limits/values/1/1": 900}, "speed limits.values.1.1", "900 km/h",
                 "less than or equal to 500 km/h", id="too fast"),
    pytest.param(TRACK, {"speed limits/units/velocity": "m/s"}, "speed limits.values.1.1",
                 "140 m/s", "less than or equal to 500 km/h", id="km/h called m/s"),
    pytest.param(TRACK, {"speed limits/values/1/1": True}, "speed limits.values.1.1", "True",
                 "write a number", id="a flag"),
    pytest.param(TRACK, {"speed limits/values/1": [3.0, 4.0, 5.0]}, "speed limits.values.1",
                 "[3.0, 4.0, 5.0]", "give these values", id="three values"),
    pytest.param(TRACK, {"speed limits/values/0/0": 10.0}, "speed limits.values.0.0", "10.0 m",
                 "begin at 0", id="begins late"),
    pytest.param(TRACK, {"gradients/values/1/1": 250.0}, "gradients.values.1.1", "250.0 permil",
                 "less than or equal to 100", id="a staircase"),
    pytest.param(TRACK, {"gradients/units/slope": "rad"}, "gradients.units.slope", "'rad'",
                 "permil", id="a slope in radians"),
    pytest.param(TRACK, {"stops/values": [0.0]}, "stops.values", "[0.0] m", "add at least one",
                 id="one stop"),
    pytest.param(TRAIN, {"mass/unit": "lb"}, "mass.unit", "'lb'", "kg, t", id="pounds"),
    pytest.param(TRAIN, {"mass/value": None}, "mass.value", "", "write a number", id="no value"),
    pytest.param(TRAIN, {"mass/value": -1}, "mass.value", "-1 kg", "greater than or equal to 1 t",
                 id="negative"),
    pytest.param(TRAIN, {"mass/value": "100 t"}, "mass.value", "'100 t'", "write a number",
                 id="a text with its unit"),
    pytest.param(TRAIN, {"rho/value": -8}, "rho.value", "-8 %", "greater than or equal to 0",
                 id="negative rotating mass"),
    pytest.param(TRAIN, {"rolling resistance r1/unit": "N"}, "rolling resistance r1.unit", "'N'",
                 "N/(m/s)", id="a force for its slope"),
    pytest.param(TRAIN, {"rolling resistance r0/value": -2.0}, "rolling resistance r0.value",
                 "-2.0 kN", "greater than or equal to 0 N", id="negative resistance"),
    pytest.param(TRAIN, {"max deceleration/value": 9.0}, "max deceleration.value", "9.0 m/s^2",
                 "less than or equal to 5", id="deceleration of a crash"),
    pytest.param(TRAIN, {"max traction force": None}, "max traction force", "", "add it",
                 id="no force"),
    pytest.param(TRAIN, {"max traction power": None}, "max traction power", "", "add it",
                 id="no power"),
    pytest.param(TRAIN, {"max traction power/value": 0}, "max traction power.value", "0 kW",
                 "greater than 0", id="power of nothing"),
    pytest.param(TRAIN, {"max speed": 120}, "max speed", "120", "with its unit", id="bare number"),
    pytest.param(TRAIN, {"max speed/value": 900}, "max speed.value", "900 km/h",
                 "less than or equal to 500 km/h", id="an aircraft"),
    pytest.param(TRAIN, {"efficiency traction/value": 120}, "efficiency traction.value", "120 %",
                 "less than or equal to 1", id="efficiency"),
]  # fmt: skip


@pytest.mark.parametrize(("document", "changes", "key", "value", "remedy"), FAULTS)
def test_a_fault_names_file_key_value_and_remedy(folder, document, changes, key, value, remedy):
    path = write(folder / "bad.json", changed(document, changes))
    with pytest.raises(tpss.ScenarioError) as caught:
        read([path])
    (finding, *_) = [finding for finding in caught.value.findings if finding.key == key]
    assert (finding.file, finding.value) == (str(path), value)
    assert remedy in finding.remedy


@pytest.mark.parametrize(
    ("document", "name"), [(TRACK, "gradients"), (TRACK, "speed limits"), (TRAIN, "max speed")]
)
def test_a_null_in_place_of_a_quantity_is_one_finding(folder, document, name):
    path = write(folder / "bad.json", {**document, name: None})
    with pytest.raises(tpss.ScenarioError) as caught:
        read([path])
    (finding,) = caught.value.findings
    assert (finding.key, finding.problem) == (name, "it is missing")


@pytest.mark.parametrize(
    ("text", "place", "value", "problem"),
    [
        ('{"stops": {\n "unit": }}', "line 2", '"unit": }}', "not JSON"),
        ("", "line 1", "", "not JSON"),
        ("[1]", "", "", "not a JSON object"),
        ("{}", "", "", "neither a track"),
        (None, "", "", "no such"),
    ],
)
def test_files_that_are_something_else_are_reported_all_at_once(
    folder, text, place, value, problem
):
    if text is not None:
        (folder / "other.json").write_text(text)
    bad = write(folder / "bad.json", changed(TRAIN, {"mass/unit": "lb"}))
    with pytest.raises(tpss.ScenarioError) as caught:
        read([folder / "other.json", bad])
    other = caught.value.findings[0]
    assert (other.file, other.key, other.value) == (str(folder / "other.json"), place, value)
    assert problem in other.problem
    assert other.remedy
    assert caught.value.findings[-1].file == str(bad)


def test_two_files_of_one_id_are_refused_and_nothing_is_written(folder, monkeypatch, capsys):
    write(folder / "twin.json", TRAIN)
    assert call(monkeypatch, "import", "ttobench", "train.json", "twin.json", "--out", "m") == 2
    assert "give each its own id" in capsys.readouterr().err
    assert not (folder / "m").exists()


def test_a_folder_that_cannot_be_made_is_reported(folder, monkeypatch, capsys):
    (folder / "m").touch()
    assert call(monkeypatch, "import", "ttobench", "train.json", "--out", "m") == 2
    assert "give another --out" in capsys.readouterr().err


def test_help_shows_an_example(monkeypatch, capsys):
    assert call(monkeypatch, "import", "ttobench", "--help") == 0
    assert "tpss import ttobench" in " ".join(capsys.readouterr().out.split())
