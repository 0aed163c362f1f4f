"""A 25 kV, 50 Hz line fed from one end: a case that two other programs have solved.

A station of 27.5 kV behind a grid of 1500 MVA (j1.008333333 Ω) and a transformer of 30 MVA, 10 %, 100 kW
(0.08402777778 + j2.519432481 Ω) feeds 40 km of line, 0.169 + j0.432 Ω/km and 12 nF/km, open at its end.
Train 1 at km 14 draws 6.0 MW and 0.6 Mvar, train 2 at km 31 draws 4.5 MW and 1.5 Mvar.  A dense nodal
Newton method and a fixed point on the tableau of all branches agree on what stands here to 1e-9 V.
"""

import math

import numpy as np
import pytest

from tpss.model.contact_line import LineLayout
from tpss.model.supply import build_supply
from tpss.powerflow.solve import solve
from tpss.scenario.supply import Supply

from networks import constant_loads, place

STATION = {
    "name": "A",
    "position_km": 0.0,
    "no_load_voltage_kv": 27.5,
    "grid_short_circuit_mva": 1500.0,
    "transformer": {"rated_mva": 30.0, "short_circuit_percent": 10.0, "load_loss_kw": 100.0},
}
LINE = {"r_ohm_per_km": 0.169, "x_ohm_per_km": 0.432, "capacitance_nf_per_km": 12.0}
POWERS = [6.0e6 + 0.6e6j, 4.5e6 + 1.5e6j]


def solved(capacitance_nf_per_km, powers, **changes):
    supply = Supply(
        system="25kV-50Hz",
        catenary={**LINE, "capacitance_nf_per_km": capacitance_nf_per_km},
        transformer_stations=[{**STATION, **changes}],
    )
    network, _ = build_supply(
        supply, (LineLayout("line", 0, 0.0, 40.0, (), ((0.0, 40.0, 1),), True),)
    )
    case = place(network, constant_loads([14e3, 31e3][: len(powers)], powers))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    return case


def polar(kilovolt, degree):
    return kilovolt * 1e3 * np.exp(1j * math.radians(degree))


def test_the_impedances_are_those_of_the_case():
    law = solved(12.0, POWERS).network.sources[0].grid
    assert law.grid_impedance_ohm == pytest.approx(1.008333333j, rel=1e-9)
    assert law.transformer_impedance_ohm == pytest.approx(0.08402777778 + 2.519432481j, rel=1e-9)


@pytest.mark.parametrize(
    ("capacitance_nf_per_km", "station", "first"),
    [(12.0, 26948.30832 - 1406.192856j, 25104.82302 - 3488.863512j),
     (0.0, 26934.21748 - 1406.338818j, 25070.48493 - 3482.298908j)],
)  # fmt: skip
def test_voltages_are_those_of_the_other_programs(capacitance_nf_per_km, station, first):
    """Ten digits are given, 1e-5 V."""
    case = solved(capacitance_nf_per_km, POWERS)
    assert case.flow.nodes[0].voltage_v == pytest.approx(station, abs=1e-5)
    assert case.train_voltage[0] == pytest.approx(first, abs=1e-5)


def test_the_station_feeds_what_the_other_programs_say():
    (fed,) = solved(12.0, POWERS).fed
    assert fed == pytest.approx(11042463.13 + 3390787.842j, abs=0.01)


def test_without_load_the_line_s_capacitance_raises_its_voltage():
    """27514.64655 V at the station, fed 29.16950735 W - j114235.7727 var."""
    case = solved(12.0, [])
    assert abs(case.flow.nodes[0].voltage_v) == pytest.approx(27514.64655, abs=1e-5)
    # One section is one π without trains; the case parts the line at its places.
    assert case.fed[0].imag == pytest.approx(-114235.7727, rel=1e-4)


def test_an_ideal_station_keeps_its_voltage_whatever_it_feeds():
    ideal = {"rated_mva": 30.0, "short_circuit_percent": 0.0}
    case = solved(12.0, POWERS, transformer=ideal, grid_short_circuit_mva=None)
    assert case.flow.nodes[0].voltage_v == pytest.approx(27_500.0, abs=1e-9)


def test_two_transformers_halve_the_impedance_of_one():
    """The drop from no load follows: E - V = (Z_grid + Z_t / 2) J."""
    case = solved(0.0, POWERS, transformers=2)
    node, law = case.flow.nodes[0], case.network.sources[0].grid
    drop = (law.grid_impedance_ohm + law.transformer_impedance_ohm / 2.0) * node.leaving_current_a
    assert 27_500.0 - node.voltage_v == pytest.approx(drop, rel=1e-9)


@pytest.mark.parametrize(
    ("capacitance_nf_per_km", "station", "trains"),
    [(12.0, 27402.63283 - 327.5464736j, [27023.70734 - 830.9485363j, 27400.44198 + 103.3659456j]),
     (0.0, 27387.94458 - 327.279259j, [26988.13864 - 822.7363666j, 27351.69413 + 118.5990109j])],
)  # fmt: skip
def test_a_train_that_brakes_feeds_the_other_one(capacitance_nf_per_km, station, trains):
    """Train 2 gives 3.5 MW; the same two programs."""
    case = solved(capacitance_nf_per_km, [POWERS[0], -3.5e6 + 0j])
    assert case.flow.nodes[0].voltage_v == pytest.approx(station, abs=1e-5)
    assert list(case.train_voltage) == [pytest.approx(each, abs=1e-5) for each in trains]


def test_a_single_train_has_the_upper_root_of_its_equation():
    """U² = (b + sqrt(b² - 4 |Z|² |S|²)) / 2, b = E² - 2 (R P + X Q): 7 MW and 1 Mvar at km 20.

    Z = 3.464027778 + j12.16776581 ohm; 25913.32551 V.
    """
    supply = Supply(
        system="25kV-50Hz",
        catenary={**LINE, "capacitance_nf_per_km": 0.0},
        transformer_stations=[STATION],
    )
    line = LineLayout("line", 0, 0.0, 40.0, (), ((0.0, 40.0, 1),), True)
    network, _ = build_supply(supply, (line,))
    case = place(network, constant_loads([20e3], [7e6 + 1e6j]))
    assert solve(False, case.network, case.flow, case.loads)[0] == 1.0
    assert abs(case.train_voltage[0]) == pytest.approx(25913.32551, abs=1e-5)
