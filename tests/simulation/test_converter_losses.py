"""What converter stations lose: laws by hand, balances of runs, and what they take from the 50 Hz grid.

Hand-worked converter used below: 10 MVA, 300 kW idle, b = 1.5 %, c = 4.5 %, 2.0 % while it takes back.

    two of them that feed P = 9 MW, Q = 12 Mvar: S = 15 MVA, each 7.5 MVA, l = 0.75
    idle 2 · 300 = 600 kW; b S = 225 kW; c S² / (n S_N) = 0.045 · 225 / 20 = 0.50625 MW
    P₅₀ = 9 + 0.6 + 0.225 + 0.50625 = 10.33125 MW
"""

import copy
import math
from typing import Any

import numpy as np
import pytest
import tomli_w

import tpss
from lines import line, network, scenario_of, service
from tpss import Finding, ScenarioError, library
from tpss.many import key_figures
from tpss.results.converter_losses import PARTS, in_words, station_powers
from tpss.results.grid_side import StationSide, Units, law_of, powers_of
from tpss.scenario.supply import ConverterLosses

from scenarios import SHORT_LINE, short_line

HAND = {"idle_kw": 300.0, "linear_percent": 1.5, "quadratic_percent": 4.5,
        "feedback_quadratic_percent": 2.0}  # fmt: skip
CURVE = [
    {"load_percent": 0.0, "loss_kw": 300.0},
    {"load_percent": 50.0, "loss_kw": 400.0},
    {"load_percent": 100.0, "loss_kw": 900.0},
]
ROTARY = "Q48/Q49 with losses (estimate)"


def side(auxiliaries_w: float | None = None, burns: bool = False, **losses: Any) -> StationSide:
    law = law_of(ConverterLosses(**losses), 10e6)
    return StationSide("West", (Units(law),), None, auxiliaries_w, burns)


def powers(p_mw: float, q_mvar: float, running: float, of: StationSide) -> Any:
    each = np.array([p_mw * 1e6]), np.array([q_mvar * 1e6]), np.array([running])
    return powers_of(*each, of)


def test_two_converters_that_feed_9_mw_take_10_33_mw() -> None:
    found = powers(9.0, 12.0, 2.0, side(**HAND))
    assert found.idle[0] == pytest.approx(600e3)
    assert found.by_load[0] == pytest.approx(225e3 + 506.25e3)
    assert found.from_grid[0] == pytest.approx(10.33125e6)
    assert found.to_grid[0] == 0.0


def test_what_is_taken_back_is_delivered_less_the_losses() -> None:
    """P = -9 MW: c is 2 %, 0.02 · 225 / 20 = 0.225 MW: 9 - 0.6 - 0.225 - 0.225 = 7.95 MW to the grid."""
    found = powers(-9.0, 12.0, 2.0, side(**HAND))
    assert found.to_grid[0] == pytest.approx(7.95e6)
    assert found.from_grid[0] == 0.0


def test_a_little_that_is_taken_back_does_not_cover_the_losses() -> None:
    """P = -0.4 MW against 600 kW idle, 6 kW by load and 0.16 kW: 206.16 kW come from the grid."""
    found = powers(-0.4, 0.0, 2.0, side(**HAND))
    assert found.from_grid[0] == pytest.approx(200e3 + 6e3 + 0.02 * 0.16e12 / 20e6)
    assert found.to_grid[0] == 0.0


def test_a_resistor_burns_what_would_be_delivered() -> None:
    """The losses are covered by the railway first; the grid gets nothing."""
    found = powers(-9.0, 12.0, 2.0, side(burns=True, **HAND))
    assert (found.from_grid[0], found.to_grid[0]) == (0.0, 0.0)
    assert found.burnt[0] == pytest.approx(7.95e6)


def test_a_curve_is_straight_between_its_points_and_goes_on() -> None:
    """Two converters at 7.5 MVA each: 650 kW each; at 12 MVA: 900 + 0.2 · 1000 = 1100 kW."""
    within, beyond = (powers(p, 0.0, 2.0, side(curve=CURVE)) for p in (15.0, 24.0))
    assert within.losses[0] == pytest.approx(2 * 650e3)
    assert within.idle[0] == pytest.approx(600e3)
    assert beyond.losses[0] == pytest.approx(2 * 1100e3)


def test_a_station_out_of_service_takes_nothing() -> None:
    found = powers(0.0, 0.0, 0.0, side(auxiliaries_w=30e3, **HAND))
    assert all(each[0] == 0.0 for each in found)


def with_losses(changes: dict[str, Any] | None = None, **losses: Any) -> tpss.Scenario:
    """The short line with losses of all converters, its stations switched by loading."""
    kind = {**library.values("converters", "Q48/Q49"), "losses": losses or HAND}
    stations = {
        "supply.converter_stations.*.type": kind,
        "supply.converter_stations.*.control": "loading",
        "supply.converter_stations.*.converters": 3,
        "supply.converter_stations.0.station_kw": 30.0,
    }
    return short_line({**stations, **(changes or {})})


def test_balance_of_every_step_and_of_the_run() -> None:
    """P₅₀ = P + losses, with the losses formed once more, station by station and step by step."""
    result = tpss.simulate(with_losses())
    data, found = result.dataset, station_powers(result.dataset, result.scenario)
    for s, station in enumerate(result.scenario.supply.stations):
        own = found[station.name]
        for k in range(data.sizes["time"] - 1):
            p, q = (float(data[f"station_{name}_power"][k, s]) for name in ("active", "reactive"))
            n, size = float(data.active_converters[k, s]), math.hypot(p, q)
            lost = n * 300e3 + 0.015 * size + 0.045 * size**2 / (n * 10e6)
            lost += 30e3 if s == 0 else 0.0
            assert own.from_grid[k] - own.to_grid[k] == pytest.approx(p + lost, rel=1e-12)
    table = result.converter_losses
    energies = table.from_grid_mwh - table.to_grid_mwh - table.burnt_mwh - table.losses_mwh
    np.testing.assert_allclose(energies, result.stations.energy_mwh, rtol=1e-12)
    np.testing.assert_allclose(table[list(PARTS)].sum(axis=1), table.losses_mwh, rtol=1e-12)
    assert (table.auxiliaries_mwh > 0.0).tolist() == [True] + [False] * (len(table) - 1)


def test_the_railway_does_not_notice_losses() -> None:
    plain = {"supply.converter_stations.*.type": "Q48/Q49",
             "supply.converter_stations.0.station_kw": None}  # fmt: skip
    with_, without = tpss.simulate(with_losses()), tpss.simulate(with_losses(plain))
    assert with_.dataset.drop_attrs().identical(without.dataset.drop_attrs())
    assert {*with_.summary} - {*without.summary} == {"converter_losses"}
    assert without.converter_losses.empty
    assert math.isnan(key_figures(without.scenario).converter_losses_mwh)
    assert math.isnan(key_figures(without.scenario).drawn_from_grid_mwh)


def test_key_figures_are_those_of_the_table() -> None:
    scenario = with_losses()
    found, table = key_figures(scenario), tpss.simulate(scenario).converter_losses
    assert found.converter_losses_mwh == pytest.approx(table.losses_mwh.sum(), rel=1e-12)
    assert found.drawn_from_grid_mwh == pytest.approx(table.from_grid_mwh.sum(), rel=1e-12)
    assert found.fed_back_to_grid_mwh == pytest.approx(table.to_grid_mwh.sum(), abs=1e-12)


@pytest.mark.parametrize("feedback", ["grid", "resistor"])
def test_energy_that_trains_feed_back_reaches_the_grid_less_the_losses(feedback: str) -> None:
    """A train that holds its speed down a grade of 15 ‰ feeds back."""
    slope = line(40.0, {"A": 0.0, "B": 40.0}, gradients=[{"from_km": 0.0, "permille": -15.0}])
    made = network({"main": slope}, [service("down", "A", "B")])
    brakes = {"max_force_kn": 150.0, "max_power_kw": 3000.0, "efficiency": 0.8}
    made["trains"]["freight"] = {**made["trains"]["freight"], "regeneration": brakes}
    kind = {**library.values("converters", "Q48/Q49"), "losses": {"idle_kw": 20.0}}
    made["supply"]["converter_stations"][0] |= {"type": kind, "feedback": feedback}
    scenario = scenario_of(made)
    result = tpss.simulate(scenario)
    (row,) = result.converter_losses.to_dict("records")
    delivered = row["to_grid_mwh"] if feedback == "grid" else row["burnt_mwh"]
    assert delivered > 0.0
    assert row["to_grid_mwh" if feedback == "resistor" else "burnt_mwh"] == 0.0
    fed = result.stations.energy_mwh.item()
    assert row["from_grid_mwh"] - delivered == pytest.approx(fed + row["losses_mwh"], rel=1e-12)
    assert key_figures(scenario).fed_back_to_grid_mwh == pytest.approx(row["to_grid_mwh"])


def test_starts_and_peaks_are_those_of_the_recording() -> None:
    result = tpss.simulate(with_losses())
    running = result.dataset.active_converters.to_numpy()[:-1]
    for s, row in result.converter_losses.iterrows():
        rises = [int(b - a) for a, b in zip(running[:-1, s], running[1:, s], strict=True) if b > a]
        assert row.starts == sum(rises)
        peak = station_powers(result.dataset, result.scenario)[row.station].from_grid.max()
        assert row.peak_from_grid_mw == pytest.approx(peak / 1e6)
        assert row.peak_1_min_mw <= row.peak_from_grid_mw
        assert math.isnan(row.peak_1_h_mw) == (result.summary["duration_min"] < 60.0)


def test_an_estimate_is_called_one() -> None:
    result = tpss.simulate(with_losses({"supply.converter_stations.*.type": ROTARY}))
    assert result.summary["converter_losses"]["origins"] == ["estimate"]
    assert in_words(result.summary["converter_losses"]).endswith("losses by estimate")
    assert set(result.converter_losses.origin) == {"estimate"}


def test_entries_of_the_library_with_losses_are_marked() -> None:
    for name, entry in library.entries("converters").items():
        if "losses" in entry:
            assert entry["losses"]["origin"] == "estimate"
            assert "(estimate)" in name


def test_a_rotary_set_at_half_load_has_the_efficiency_of_its_estimate() -> None:
    """At 5 MVA and power factor 1: 0.3 + 0.075 + 0.1125 = 0.4875 MW; 5 / 5.4875 = 91.1 %."""
    found = powers(5.0, 0.0, 1.0, side(**library.values("converters", ROTARY)["losses"]))
    assert 5e6 / found.from_grid[0] == pytest.approx(0.911, abs=5e-4)


def own_type(**more: Any) -> dict[str, Any]:
    """The short line with an own type of converter by name."""
    made = copy.deepcopy(SHORT_LINE)
    kind = {**library.values("converters", "Q48/Q49"), **more}
    made["supply"]["converter_types"] = {"own": kind}
    for station in made["supply"]["converter_stations"]:
        station["type"] = "own"
    return made


def test_an_own_type_is_what_the_same_table_is() -> None:
    scenario = tpss.Scenario.from_document(own_type(losses=HAND))
    for station in scenario.supply.converter_stations:
        assert station.type.losses == ConverterLosses(**HAND)
    again = tpss.Scenario.from_document(scenario.as_document())
    assert again == scenario
    assert hash(again.supply) == hash(scenario.supply)
    assert len(tpss.simulate(scenario).converter_losses) == len(scenario.supply.stations)


def faults_of(made: dict[str, Any], source: Any = "scenario") -> tuple[Finding, ...]:
    with pytest.raises(ScenarioError) as caught:
        tpss.Scenario.from_document(made, source)
    return caught.value.findings


TYPE = "supply.converter_types.own"


def falling(*kw: float) -> list[dict[str, float]]:
    return [{"load_percent": 50.0 * k, "loss_kw": each} for k, each in enumerate(kw)]


@pytest.mark.parametrize(
    ("more", "key", "problem"),
    [
        ({"losses": {}}, f"{TYPE}.losses", "without load are missing"),
        ({"losses": {**HAND, "curve": CURVE}}, f"{TYPE}.losses", "given twice, by a curve and by"),
        ({"losses": {**HAND, "idle_kw": -1.0}}, f"{TYPE}.losses.idle_kw", "out of range"),
        ({"losses": {"curve": falling(92, 95, 91)}}, f"{TYPE}.losses", "loss_kw falls from 95 to 91"),
        ({"losses": {"curve": CURVE[1:]}}, f"{TYPE}.losses", "begins at a load of 50 %"),
        ({"losses": {"curve": CURVE[:1]}}, f"{TYPE}.losses.curve", "too short"),
        ({"losses": {"curve": CURVE[::-1]}}, f"{TYPE}.losses.curve", "does not increase"),
        ({"losses": {**HAND, "origin": "guess"}}, f"{TYPE}.losses.origin", "not one of the choices"),
        ({"rating_mva": None}, f"{TYPE}.rating_mva", "not a number"),
    ],
)  # fmt: skip
def test_losses_that_cannot_be_are_named(more: dict[str, Any], key: str, problem: str) -> None:
    (finding,) = faults_of(own_type(**more))
    assert finding.key == key
    assert problem in finding.problem
    assert finding.remedy


def test_an_own_type_may_not_have_a_name_of_the_library() -> None:
    made = own_type()
    made["supply"]["converter_types"]["Q48/Q49"] = made["supply"]["converter_types"]["own"]
    (finding,) = faults_of(made)
    assert "is an entry of the library" in finding.problem


def test_a_curve_in_a_file_is_what_the_same_list_is(tmp_path: Any) -> None:
    text = "# acceptance test\nload_percent,loss_kw\n0,300\n50,400\n100,900\n"
    (tmp_path / "losses.csv").write_text(text, "utf-8")
    made = own_type(losses={"curve_file": "losses.csv", "origin": "measurement"})
    scenario = tpss.Scenario.from_document(made, tmp_path / "line.toml")
    expected = own_type(losses={"curve": CURVE, "origin": "measurement"})
    assert scenario == tpss.Scenario.from_document(expected)


def test_a_type_in_a_file_finds_its_curve_beside_itself(tmp_path: Any) -> None:
    folder = tmp_path / "types"
    folder.mkdir()
    (folder / "losses.csv").write_text("load_percent,loss_kw\n0,300\n100,900\n", "utf-8")
    kind = {**library.values("converters", "Q48/Q49"), "losses": {"curve_file": "losses.csv"}}
    (folder / "own.toml").write_text(tomli_w.dumps(kind), "utf-8")
    made = own_type()
    made["supply"]["converter_types"]["own"] = "types/own.toml"
    scenario = tpss.Scenario.from_document(made, tmp_path / "line.toml")
    losses = scenario.supply.converter_stations[0].type.losses
    assert losses is not None
    assert losses.curve is not None
    assert losses.curve[1].loss_kw == 900.0


@pytest.mark.parametrize(
    ("text", "key", "problem"),
    [
        ("load,efficiency\n0,1\n", "line 1", "not the expected header"),
        ("load_percent,loss_kw\n0,300\n50,x\n", "line 3, loss_kw", "not a number"),
        ("load_percent,loss_kw\n0,300\n0,400\n", "line 3, load_percent", "does not increase"),
        ("load_percent,loss_kw\n0,-3\n90,400\n", "line 2, loss_kw", "out of range"),
    ],
)
def test_faults_of_a_curve_name_file_and_line(
    tmp_path: Any, text: str, key: str, problem: str
) -> None:
    (tmp_path / "losses.csv").write_text(text, "utf-8")
    made = own_type(losses={"curve_file": "losses.csv"})
    (finding,) = faults_of(made, tmp_path / "line.toml")
    assert finding.file.endswith("losses.csv")
    assert finding.key == key
    assert problem in finding.problem


def test_a_curve_that_is_not_there_is_named_with_its_key(tmp_path: Any) -> None:
    made = own_type(losses={"curve_file": "losses.csv"})
    (finding,) = faults_of(made, tmp_path / "line.toml")
    assert finding.key == f"{TYPE}.losses.curve_file"
    assert finding.problem == "there is no such file"
