"""Whole runs fed by transformer stations, alone and beside converters.

Hand-worked station used below: one transformer of 10 MVA, 8 %, 50 kW of load losses at 16 kV, behind
2000 MVA of short-circuit power with R/X = 0.1.

    base:        16²/10 = 25.6 Ω;  R_t = 0.005 · 25.6 = 0.128 Ω;  Z_t = 0.08 · 25.6 = 2.048 Ω
                 X_t = √(2.048² - 0.128²) = 2.043996 Ω
    grid:        2 · 16²/2000 = 0.256 Ω, of which 1/√1.01 is X: 0.254729 Ω, R 0.0254729 Ω
    together:    0.1534729 + 2.298725j Ω
"""

import numpy as np
import pytest

from scenarios import run, short_line
from slow_audit import assert_agree, audit_of

NO_LOAD_V = 16e3
IMPEDANCE_OHM = 0.1534729 + 2.298725j
STATION = {
    "name": "West",
    "position_km": 0.0,
    "no_load_voltage_kv": 16.0,
    "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0, "load_loss_kw": 50.0},
    "grid_short_circuit_mva": 2000.0,
    "grid_r_over_x": 0.1,
}
EAST = {**STATION, "name": "East", "position_km": 20.0, "transformers": 2}
IDEAL = {**STATION, "transformer": {"rated_mva": 10.0, "short_circuit_percent": 0.0}}
del IDEAL["grid_short_circuit_mva"]
CONVERTERS = [{"name": "East", "position_km": 20.0, "type": "Q48/Q49", "converters": 2}]

SUPPLIES = {
    "one": ([STATION], []),
    "two": ([STATION, EAST], []),
    "ideal": ([IDEAL], []),
    "beside converters": ([STATION], CONVERTERS),
}


def fed_by(stations, converters, **more):
    return {
        "supply.transformer_stations": stations,
        "supply.converter_stations": converters,
        "traffic.0.headway_min": 4.0,
        "simulation.duration_min": 20.0,
        **more,
    }


def phasors(dataset, node):
    """Voltages of a node over the intervals. [V]"""
    at = dataset.isel(node=node, time=slice(0, -1))
    return at.node_voltage.to_numpy() * np.exp(1j * at.node_angle.to_numpy())


def powers(dataset, station):
    """Powers of a station over the intervals. [VA]"""
    at = dataset.sel(station=station).isel(time=slice(0, -1))
    return at.station_active_power.to_numpy() + 1j * at.station_reactive_power.to_numpy()


@pytest.mark.parametrize(("stations", "converters"), SUPPLIES.values(), ids=SUPPLIES)
def test_a_run_passes_its_audit_and_that_of_the_slow_twin(stations, converters):
    changes = fed_by(stations, converters)
    result = run(changes)
    expected, limits = audit_of(short_line(changes))
    assert expected.passed
    assert result.audit["converter_residual"] < 1e-9
    found = type(expected)(**{name: result.audit[name] for name in vars(expected)})
    assert_agree(found, expected, limits)


def test_the_voltage_of_a_station_is_that_behind_its_impedance():
    dataset = run(fed_by([STATION], [])).dataset
    voltage, power = phasors(dataset, 0), powers(dataset, "West")
    current = np.conj(power / voltage)
    assert np.abs(current).max() > 100.0
    assert voltage == pytest.approx(NO_LOAD_V - IMPEDANCE_OHM * current, rel=1e-7)
    losses = dataset.station_losses.sel(station="West").to_numpy()[:-1]
    assert losses == pytest.approx(IMPEDANCE_OHM.real * np.abs(current) ** 2, rel=1e-6)


def test_an_ideal_station_keeps_its_voltage_and_loses_nothing():
    dataset = run(fed_by([IDEAL], [])).dataset
    assert phasors(dataset, 0) == pytest.approx(NO_LOAD_V, rel=1e-9)
    assert set(dataset.station_losses.to_numpy()[:-1, 0]) == {0.0}


def test_two_transformers_halve_the_impedance_of_transformers_but_not_of_the_grid():
    dataset = run(fed_by([STATION, EAST], [])).dataset
    east = list(dataset.node.to_numpy()).index("contact line at 20 km")
    voltage, power = phasors(dataset, east), powers(dataset, "East")
    impedance_ohm = IMPEDANCE_OHM - (0.128 + 2.043996j) / 2.0
    current = np.conj(power / voltage)
    assert voltage == pytest.approx(NO_LOAD_V - impedance_ohm * current, rel=1e-7)


def test_a_transformer_station_beside_converters_is_loaded_by_its_angle():
    """Converters lag under load, so the grid's own frequency takes over more of it."""
    alone, beside = (
        run(fed_by(stations, converters)).dataset for stations, converters in (
            ([STATION, EAST], []), ([STATION], CONVERTERS))
    )  # fmt: skip
    shares = [
        powers(found, "West").real.sum() / found.station_active_power.to_numpy()[:-1].sum()
        for found in (alone, beside)
    ]
    assert shares[1] > shares[0]
    assert list(beside.station.to_numpy()) == ["East", "West"]


@pytest.mark.parametrize(("stations", "converters"), SUPPLIES.values(), ids=SUPPLIES)
def test_least_squares_agree_with_the_equations(stations, converters):
    changes = fed_by(stations, converters, **{"simulation.time_step_min": 0.5})
    equations, squares = (
        run({**changes, "simulation.load_flow": kind}).dataset
        for kind in ("equations", "least-squares")
    )
    for name, scale in (("node_voltage", 16e3), ("station_active_power", 10e6)):
        difference = np.abs(squares[name].to_numpy() - equations[name].to_numpy())[:-1]
        assert difference.max() < 1e-6 * scale, name
