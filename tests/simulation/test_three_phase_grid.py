"""Whole runs of lines whose transformer stations stand at different phases of a three-phase grid.

Stations used below: 10 MVA, 8 %, 50 kW of load losses and 6 kW without load at 16 kV, behind 800 MVA of
short-circuit power at 132 kV with R/X = 0.1, at either end of 20 km of line with a neutral section in
its middle.
"""

import numpy as np
import pytest

import tpss
from tpss.model.outages import layout_of
from tpss.physics.three_phase import angle_of, winding_of
from tpss.results.notes import notes
from tpss.results.three_phase import busbars, station_currents_a

from conftest import EXAMPLES
from scenarios import run, short_line
from slow_audit import assert_agree, audit_of

STATION = {
    "no_load_voltage_kv": 16.0,
    "transformer": {
        "rated_mva": 10.0,
        "short_circuit_percent": 8.0,
        "load_loss_kw": 50.0,
        "no_load_loss_kw": 6.0,
    },
    "grid_kv": 132.0,
    "grid_short_circuit_mva": 800.0,
    "grid_r_over_x": 0.1,
}
WEST = {**STATION, "name": "West", "position_km": 0.0, "phases": "RS", "busbar": "north"}
EAST = {**STATION, "name": "East", "position_km": 20.0, "phases": "ST", "busbar": "north"}
TWO_SIDED = {**STATION, "name": "Mid", "position_km": 10.0, "grid_kv": 132.0}
VV = {**TWO_SIDED, "connection": "V/V", "phases_before": "RS", "phases_behind": "TR"}
SCOTT = {**TWO_SIDED, "connection": "Scott", "phases_before": "ST", "phases_behind": "R"}
THIRD = {**VV, "name": "Far", "position_km": 10.0, "busbar": "north"}

SUPPLIES = {
    "own grids": [{**WEST, "busbar": "west"}, {**EAST, "busbar": "east"}],
    "one busbar": [WEST, EAST],
    "V/V": [VV],
    "Scott": [SCOTT],
    "four windings": [WEST, {**EAST, "phases": "TR"}, THIRD],
}


def fed_by(stations, **more):
    return {
        "supply.transformer_stations": stations,
        "supply.converter_stations": [],
        "supply.neutral_sections": [{"from_km": 9.95, "to_km": 10.05}],
        "traffic.0.headway_min": 4.0,
        "simulation.duration_min": 20.0,
        "simulation.motion": None,
        "simulation.braking": None,
        **more,
    }


@pytest.mark.parametrize("stations", SUPPLIES.values(), ids=SUPPLIES)
def test_a_run_passes_its_audit_and_that_of_the_slow_twin(stations):
    changes = fed_by(stations)
    result = run(changes)
    expected, limits = audit_of(short_line(changes))
    assert expected.passed
    assert result.audit["converter_residual"] < 1e-9
    found = type(expected)(**{name: result.audit[name] for name in vars(expected)})
    assert_agree(found, expected, limits)


@pytest.mark.parametrize("stations", SUPPLIES.values(), ids=SUPPLIES)
def test_energy_of_the_grid_s_voltages_is_that_fed_and_lost(stations):
    """Without load every station has 16 kV: Re(E J̄) is what it feeds and loses, in each step."""
    result = run(fed_by(stations))
    current_a = station_currents_a(result.dataset, result.scenario)
    given_w = 16e3 * current_a.real
    steps = result.dataset.isel(time=slice(0, -1))
    spent_w = (steps.station_active_power + steps.station_losses).to_numpy()
    assert np.abs(current_a).max() > 100.0
    assert spent_w == pytest.approx(given_w, rel=1e-7, abs=1.0)


def test_losses_of_a_common_grid_are_those_in_its_three_phases():
    """R/X = 0.1 of 132²/800 Ω: R = 2.1672 Ω a phase, and 0.128 Ω in each transformer."""
    result = run(fed_by(SUPPLIES["one busbar"]))
    (busbar,) = busbars(result.dataset, result.scenario)
    r_ohm = 132.0**2 / 800.0 * 0.1 / np.sqrt(1.01)
    in_grid_w = r_ohm * (np.abs(busbar.phase_currents_a) ** 2).sum(axis=1)
    current_a = station_currents_a(result.dataset, result.scenario)
    in_transformers_w = 0.128 * (np.abs(current_a) ** 2).sum(axis=1)
    lost_w = result.dataset.station_losses.to_numpy()[:-1].sum(axis=1)
    assert lost_w == pytest.approx(in_grid_w + in_transformers_w, rel=1e-6, abs=1.0)


def test_transformers_lose_without_load_all_the_time():
    """6 kW each for 20 min: 2 kWh; what comes from the grid is what is fed, and both losses."""
    result = run(fed_by(SUPPLIES["one busbar"]))
    lost, fed = result.transformer_losses, result.stations
    assert lost.no_load_mwh.to_numpy() == pytest.approx(0.002, rel=1e-9)
    net = lost.from_grid_mwh - lost.to_grid_mwh - lost.burnt_mwh
    spent = fed.energy_mwh + lost.load_mwh + lost.no_load_mwh
    assert net.to_numpy() == pytest.approx(spent.to_numpy(), rel=1e-9)
    step_s = result.dataset.attrs["time_step_s"]
    recorded = result.dataset.station_losses.to_numpy()[:-1].sum(axis=0) * step_s / 3.6e9
    assert (lost.load_mwh + lost.grid_mwh).to_numpy() == pytest.approx(recorded, rel=1e-6)


def test_unbalance_is_told_and_judged():
    """Of one transformer between two phases, u₂ ≈ S/S_k · E/U, and a limit below its mean is violated.

    E/U is up to 1.07: what the load has of reactive power lowers the voltage by so much.
    """
    stations = SUPPLIES["own grids"]
    result = run(fed_by(stations))
    table = result.standards.unbalance.set_index("busbar")
    assert list(table.index) == ["west", "east"]
    power = result.dataset.isel(time=slice(0, -1))
    apparent = np.hypot(power.station_active_power, power.station_reactive_power).to_numpy()
    assert table.peak_percent.to_numpy() == pytest.approx(apparent.max(axis=0) / 8e6, rel=0.08)
    assert (table.verdict == "kept").all()
    assert len(result.standards.violations) == 0
    least = table.mean_10_min_percent.min()
    judged = run(fed_by([{**each, "unbalance_limit_percent": 0.9 * least} for each in stations]))
    assert (judged.standards.unbalance.verdict == "exceeded").all()
    assert set(judged.standards.violations.subject) == {"busbar west", "busbar east"}


def test_the_mean_of_a_run_shorter_than_its_window_is_that_of_the_run():
    result = run(fed_by(SUPPLIES["one busbar"], **{"simulation.duration_min": 5.0}))
    (busbar,) = busbars(result.dataset, result.scenario)
    found = result.standards.unbalance.mean_10_min_percent[0]
    assert found == pytest.approx(100.0 * busbar.unbalance.mean(), rel=1e-9)


def test_voltage_across_the_neutral_section():
    """120° apart 16 kV √3 = 27.7 kV without load; a little less where trains draw power."""
    result = run(fed_by(SUPPLIES["one busbar"]))
    (row,) = result.standards.neutral_sections.itertuples()
    assert (row.phases_before, row.phases_behind, round(row.angle_deg)) == ("RS", "ST", 120)
    assert 0.9 * 27.713 < row.mean_kv < row.highest_kv < 27.9
    scott = run(fed_by(SUPPLIES["Scott"])).standards.neutral_sections
    assert scott.angle_deg[0] == pytest.approx(90.0)


def test_opposite_phases_are_noted():
    """RS and SR are 180° apart: 32 kV without load."""
    result = run(fed_by([WEST, {**EAST, "phases": "SR"}]))
    (note,) = [each for each in notes(result) if "neutral section" in each]
    assert "at 9.95-10.05 km (RS and SR) are 180° apart: up to 3" in note
    assert not any("neutral section" in each for each in notes(run(fed_by(SUPPLIES["one busbar"]))))


@pytest.mark.parametrize("secondary", [None, "2x"])
def test_stations_of_one_busbar_also_feed_conductors(secondary):
    """Between a source of one winding and the line lies a resistance then, which its law leaves out."""
    station = {
        "no_load_voltage_kv": 27.5,
        "transformer": {"rated_mva": 60.0, "short_circuit_percent": 10.0, "load_loss_kw": 160.0},
        "grid_kv": 220.0,
        "grid_short_circuit_mva": 3000.0,
        "rail_earthing_ohm": 0.5,
        "phases": "RS",
        "busbar": "north",
    }
    places = {"Airport": 0.0, "City": 50.0}
    scenario = tpss.load_scenario(EXAMPLES / "hs_2x25kv.toml").with_(
        {
            "supply.transformer_stations": [
                {"name": name, "position_km": km, **station} for name, km in places.items()
            ],
            "supply.transformer_stations.0.secondary": secondary,
            "simulation.duration_min": 10.0,
        }
    )
    result = tpss.simulate(scenario)
    assert result.audit["passed"]
    assert result.audit["converter_residual"] < 1e-9


def test_without_phases_nothing_is_told():
    bare = {key: value for key, value in WEST.items() if key not in ("phases", "busbar", "grid_kv")}
    plain = {**STATION, "name": "East", "position_km": 20.0}
    result = run(fed_by([bare, plain]))
    assert result.standards.unbalance.empty
    assert result.standards.neutral_sections.empty


def test_an_outage_of_a_station_leaves_the_others_their_grid():
    """East is out for 5 min: its current is none then, and West's alone flows in R and S."""
    outage = {"name": "east", "stations": ["East"], "from_min": 8.0, "to_min": 13.0}
    result = run(
        fed_by(SUPPLIES["one busbar"], **{"outages": [outage], "simulation.outage": "east"})
    )
    assert result.audit["passed"]
    (busbar,) = busbars(result.dataset, result.scenario)
    minutes = result.dataset.time.to_numpy()[:-1] / 60.0
    out = (minutes >= 8.0) & (minutes < 13.0 - 1e-9)
    current_a = station_currents_a(result.dataset, result.scenario)
    assert (current_a[out, 1] == 0.0).all()
    assert np.abs(current_a[~out, 1]).max() > 1.0
    assert (busbar.phase_currents_a[out, 2] == 0.0).all()


def test_a_side_of_a_two_sided_station_is_out_by_its_own_name():
    outage = {"name": "side", "stations": ["Mid TR"]}
    result = run(fed_by(SUPPLIES["V/V"], **{"outages": [outage], "simulation.outage": "side"}))
    assert list(result.dataset.station.to_numpy()) == ["Mid RS", "Mid TR"]
    assert float(np.abs(result.dataset.station_active_power[:-1, 1]).max()) == 0.0
    assert float(result.dataset.station_active_power[:-1, 0].max()) > 1e5


def test_a_bigger_grid_and_another_connection_as_a_variant():
    """A grid of four times the power has about a quarter of the unbalance."""
    weak = short_line(fed_by(SUPPLIES["own grids"]))
    strong = weak.with_({"supply.transformer_stations.0.grid_short_circuit_mva": 3200.0})
    before, after = (
        tpss.simulate(each).standards.unbalance.peak_percent[0] for each in (weak, strong)
    )
    assert after == pytest.approx(before / 4.0, rel=0.05)


def test_phase_currents_are_the_windings_currents():
    """At 132 kV they are 16/132 of the stations': S carries the difference of both."""
    result = run(fed_by(SUPPLIES["one busbar"]))
    (busbar,) = busbars(result.dataset, result.scenario)
    plan = layout_of(result.scenario, None).plan
    assert len(plan.sources) == 2
    west, east = station_currents_a(result.dataset, result.scenario).T * 16.0 / 132.0
    west, east = west * np.exp(1j * angle_of("RS")), east * np.exp(1j * angle_of("ST"))
    assert busbar.phase_currents_a == pytest.approx(
        np.stack([west, east - west, -east], axis=1), abs=1e-9
    )
    assert winding_of("ST").tolist() == [0.0, 1.0, -1.0]
