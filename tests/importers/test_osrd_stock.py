"""Rolling stock of OSRD: effort curves of the lines' voltage, and networks of direct current."""

import copy
import json
from pathlib import Path
from typing import Any

import pytest

import tpss
from tpss.cli.main import main
from tpss.importers import osrd
from tpss.importers.network_files import files
from tpss.importers.supplies import SUPPLIES, mixed_systems

from osrd_made_up import INFRA, TRAINS, on

STOCK: dict[str, Any] = {
    "railjson_version": "3.3",
    "name": "Fast freight",
    "mass": 400_000.0,
    "length": 200.0,
    "max_speed": 40.0,
    "const_gamma": 0.5,
    "comfort_acceleration": 0.4,
    "inertia_coefficient": 1.05,
    "rolling_resistance": {"type": "davis", "A": 0.008, "B": 0.0002, "C": 0.00001},
    "effort_curves": {
        "default_mode": "25000V",
        "modes": {
            "25000V": {"is_electric": True, "curves": [], "default_curve": {
                "speeds": [0.0, 20.0, 40.0], "max_efforts": [250e3, 250e3, 125e3]}},
            "1500V": {"is_electric": True, "curves": [], "default_curve": {
                "speeds": [0.0, 20.0, 40.0], "max_efforts": [200e3, 150e3, 75e3]}},
            "thermal": {"is_electric": False, "curves": [], "default_curve": {
                "speeds": [0.0, 40.0], "max_efforts": [100e3, 50e3]}},
        },
    },
}  # fmt: skip


def of_voltage(*voltages: str) -> dict[str, Any]:
    """The made-up infrastructure with electrifications of its two main tracks."""
    infra = copy.deepcopy(INFRA)
    places = [on("M1", 0.0, 6000.0), on("M2", 0.0, 4000.0)]
    infra["electrifications"] = [
        {"id": voltage, "voltage": voltage, "track_ranges": [place]}
        for voltage, place in zip(voltages, places, strict=False)
    ]
    return infra


def write(path: Path, document: Any) -> Path:
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def imported(folder: Path, infra: dict[str, Any], **stock: Any) -> tpss.Scenario:
    """The scenario that the command writes."""
    found = osrd.read(
        write(folder / "infra.json", infra), write(folder / "trains.json", TRAINS),
        [write(folder / "stock.json", {**STOCK, **stock})],
    )  # fmt: skip
    for name, text in files(found).items():
        target = folder / "made" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return tpss.load_scenario(folder / "made" / "scenario.toml")


@pytest.mark.parametrize(
    ("voltage", "system", "force_kn"),
    [("25000V", "25kV-50Hz", (250.0, 250.0, 125.0)), ("1500V", "DC-1.5kV", (200.0, 150.0, 75.0))],
)
def test_a_train_has_the_curve_of_the_lines_voltage(tmp_path, voltage, system, force_kn):
    """0.008 N/kg of 400 t are 3200 N; B and C likewise; 144 km/h; a twentieth more inertia."""
    scenario = imported(tmp_path, of_voltage(voltage))
    train = scenario.trains["Fast_freight"]
    assert scenario.supply.system == system
    assert train.tractive_effort.force_kn == force_kn
    assert train.tractive_effort.speed_kmh == (0.0, 72.0, 144.0)
    assert (train.mass_t, train.length_m, train.max_speed_kmh) == (400.0, 200.0, 144.0)
    assert train.rotating_mass_share == pytest.approx(0.05)
    davis = (train.resistance_a_n, train.resistance_b_n_s_per_m, train.resistance_c_n_s2_per_m2)
    assert davis == pytest.approx((3200.0, 80.0, 4.0))
    assert (train.max_acceleration_m_s2, train.max_retardation_m_s2) == (0.4, 0.5)
    other = scenario.with_({"supply.system": system})
    assert other.trains["Fast_freight"] == train


def test_it_runs_on_a_line_of_direct_current(tmp_path):
    curve = {"speeds": [0.0, 10.0, 40.0], "max_efforts": [60e3, 60e3, 15e3]}
    weak = {"modes": {"1500V": {"is_electric": True, "default_curve": curve}}}
    infra = {**of_voltage("1500V", "1500V"), "neutral_sections": []}
    result = tpss.simulate(imported(tmp_path, infra, mass=100e3, effort_curves=weak))
    assert result.audit["passed"]
    assert result.summary["status"] == "finished"


def test_a_resistance_of_the_whole_train_is_taken_as_it_is(tmp_path):
    whole = {"type": "davis", "A": 3200.0, "B": 80.0, "C": 4.0}
    train = imported(tmp_path, INFRA, rolling_resistance=whole).trains["Fast_freight"]
    assert train.resistance_a_n == 3200.0
    assert train.resistance_b_n_s_per_m == 80.0


def test_a_train_of_other_voltages_is_left_out_and_told(tmp_path):
    found = osrd.read(
        write(tmp_path / "infra.json", of_voltage("3000V")), None,
        [write(tmp_path / "stock.json", STOCK)],
    )  # fmt: skip
    assert found.system == "DC-3kV"
    assert not found.stock
    assert any(
        "a train for 25000V, 1500V, thermal, not for DC-3kV" in each for each in found.left_out
    )


@pytest.mark.parametrize("separated", [True, False])
def test_systems_that_meet_are_told(tmp_path, separated):
    """6 km of 25 kV and 4 km of 1.5 kV."""
    infra = of_voltage("25000V", "1500V")
    if not separated:
        infra["neutral_sections"] = []
    found = osrd.read(write(tmp_path / "infra.json", infra))
    (told,) = [each for each in found.left_out if "other systems" in each]
    assert found.system == "25kV-50Hz"
    assert "DC-1.5kV" in told
    assert ("no neutral section separates them" in told) == (not separated)


def test_one_system_is_nothing_to_be_told():
    assert mixed_systems(["", "DC-3kV", "DC-3kV"], separated=False) == []
    assert mixed_systems([], separated=False) == []


@pytest.mark.parametrize("voltage", ["750V", "1500V", "3000V", "25000V", "15000V"])
def test_the_assumed_supply_of_each_system_makes_a_scenario(tmp_path, voltage):
    infra = of_voltage(voltage, voltage)
    found = osrd.read(write(tmp_path / "infra.json", infra))
    assert found.system in SUPPLIES
    for name, text in files(found).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    scenario = tpss.load_scenario(tmp_path / "scenario.toml")
    assert scenario.supply.system == found.system


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mass": -1.0}, "mass"),
        ({"effort_curves": {"modes": {}}}, "effort_curves.modes"),
        ({"effort_curves": {"modes": {"25000V": {"is_electric": True, "default_curve": {
            "speeds": [0.0, 1.0], "max_efforts": [1.0]}}}}}, "2 speeds and 1 efforts"),
        ({"rolling_resistance": {"A": "much", "B": 0.0, "C": 0.0}}, "rolling_resistance.A"),
    ],
)  # fmt: skip
def test_a_fault_names_the_file_and_the_place(tmp_path, changes, said):
    stock = write(tmp_path / "stock.json", {**STOCK, **changes})
    with pytest.raises(tpss.ScenarioError) as caught:
        osrd.read(write(tmp_path / "infra.json", INFRA), None, [stock])
    assert said in str(caught.value)
    assert "stock.json" in str(caught.value)


def test_the_command_takes_files_of_rolling_stock(tmp_path, monkeypatch, capsys):
    arguments = [
        "tpss", "import", "osrd", write(tmp_path / "infra.json", INFRA),
        write(tmp_path / "trains.json", TRAINS), "--out", tmp_path / "made",
        "--rolling-stock", write(tmp_path / "stock.json", STOCK),
    ]  # fmt: skip
    monkeypatch.setattr("sys.argv", [str(each) for each in arguments])
    with pytest.raises(SystemExit) as exited:
        main()
    assert not exited.value.code
    assert (
        "Fast freight of stock.json: effort curves for 25kV-50Hz, DC-1.5kV"
        in capsys.readouterr().out
    )
    assert (tmp_path / "made" / "trains" / "Fast_freight.toml").exists()
