"""Rectifier stations with trains that draw and that feed back, against other programs' ten digits."""

import math

import numpy as np
import pytest

from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.powerflow.solve import solve
from tpss.vehicle.demand import certify_free_band, update_cap_terms
from vehicles import demand_at

from direct_lines import Braking, Drawing, curve, diode, direct_line
from direct_scenarios import UNIT, direct_scenario

WEST, EAST = (0.0, diode(1650.0, 0.06)), (14.0, diode(1640.0, 0.09))
LINE = [Braking(2.0, 2.4e6, 1750.0, 1800.0, 100e3), Drawing(6.0, 900e3), Drawing(11.5, 1800e3)]


def solved(case):
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    assert np.abs(case.train_voltage.imag).max() < 1e-9
    stations = case.flow.nodes[case.network.sources.node]
    return stations.voltage_v.real, stations.leaving_current_a.real, case.train_voltage.real


def test_a_station_blocks_and_braking_power_is_refused_in_part():
    """1500 V, two diode stations of 1650 V behind 0.06 ohm and 1640 V behind 0.09 ohm, 0.055 ohm/km.

    The train that brakes at km 2 lifts its surroundings above the western station's 1650 V, and offers
    2.4 MW, of which the line takes 74 % at 1762.94 V.  By shooting with a scan of all roots.
    """
    station_v, station_a, train_v = solved(direct_line(1500.0, 0.055, [WEST, EAST], LINE))
    assert station_v == pytest.approx([1762.938966, 1561.114834], abs=1e-3)
    assert station_a == pytest.approx([0.0, 876.5018472], abs=1e-3)
    assert train_v == pytest.approx([1762.938966, 1553.422629, 1440.59583], abs=1e-3)


@pytest.mark.parametrize(
    ("limit_w", "station_v", "station_a", "train_v"),
    [
        (math.inf, [1716.178549, 1559.461215], [-323.5709725, 894.8753842],
         [1751.771356, 1544.784545, 1436.41585]),
        (400e3, [1729.501976, 1559.931102], [-231.2804527, 889.6544233],
         [1754.942826, 1547.238463, 1437.603619]),
    ],
    ids=["as much as comes", "at its highest power"],
)  # fmt: skip
def test_an_inverter_takes_what_trains_do_not(limit_w, station_v, station_a, train_v):
    """As above; the western station takes current from 1700 V on, behind 0.05 ohm, or up to 400 kW."""
    law = diode(1650.0, 0.06, inverter_from_v=1700.0, inverter_ohm=0.05, inverter_power_w=limit_w)
    found = solved(direct_line(1500.0, 0.055, [(0.0, law), EAST], LINE))
    for each, expected in zip(found, (station_v, station_a, train_v), strict=True):
        assert each == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize(
    ("power_w", "expected_v"), [(1e6, 3173.975065), (4e6, 2709.481005), (6.5e6, 2000.0)]
)
def test_one_train_behind_one_station_is_the_upper_root_of_its_equation(power_w, expected_v):
    """U = (E + sqrt(E² - 4 R P)) / 2 with E = 3300 V and R = 0.1 + 5 x 0.06 ohm; P_max = 6.806 MW."""
    case = direct_line(3000.0, 0.06, [(0.0, diode(3300.0, 0.1))], [Drawing(5.0, power_w)])
    _, _, train_v = solved(case)
    assert train_v[0] == pytest.approx(expected_v, abs=1e-3)


HEAVY = [
    # km, power with auxiliaries, highest current, auxiliaries: [km], [W], [A], [W]
    (9.0, 3.2e6, 1500.0, 100e3),
    (24.0, 4.0e6, 2000.0, 150e3),
]


def heavy_line(limited: bool):
    """3 kV from one end, a rectifier of three regions, two trains with or without a limit."""
    station = (0.0, curve([0.0, 30.0, 1818.0, 5454.0], [3600.0, 3510.0, 3300.0, 2850.0]))
    case = direct_line(3000.0, 0.0723, [station], [Drawing(km, watts) for km, watts, _, _ in HEAVY])
    speed_m_s = 20.0
    for k, (_, watts, highest_a, auxiliary_w) in enumerate(HEAVY if limited else ()):
        train = {
            **{key: value for key, value in UNIT.items() if key != "regeneration"},
            "tractive_effort": {"max_force_kn": 1000.0, "max_power_kw": 10_000.0},
            "efficiency": 1.0,
            "auxiliary_power_kw": auxiliary_w / 1e3,
            "current_limitation": {"max_current_a": highest_a, "knee_factor": 0.9, "un_kv": 3.0,
                                   "umin2_kv": 2.0, "auxiliaries": "power"},
        }  # fmt: skip
        made = direct_scenario("DC-3kV", **{"trains.unit": train})
        kinds, points = build_train_types([Running(made.trains["unit"])])
        kind = kinds[0]
        cap_n = (watts - auxiliary_w) / speed_m_s
        demand = demand_at(3.6 * speed_m_s, kind, points, force_cap_n=cap_n, adhesion_n=1e9)
        certify_free_band(kind, demand)
        update_cap_terms(kind, demand)
        case.loads.types[k], case.loads.trains[k].demand = kind, demand
    return case


def test_trains_below_the_knee_of_their_limit_keep_to_what_it_leaves():
    """Both are below 0.9 x 3 kV and draw f I_max + (1 - f) P_aux / U, f = (U - 2 kV) / 0.7 kV.

    The rectifier is in the second of its regions.  All 64 combinations of regions: one is consistent.
    """
    station_v, station_a, train_v = solved(heavy_line(limited=True))
    assert station_v == pytest.approx([3353.797109], abs=1e-3)
    assert station_a == pytest.approx([1359.956043], abs=1e-3)
    assert train_v == pytest.approx([2468.873712, 2098.134205], abs=1e-3)


def test_without_the_limit_the_same_line_carries_a_third_of_them():
    """34.16 % of both powers, by halving."""
    case = heavy_line(limited=False)
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == pytest.approx(0.341567, abs=1e-3)


def test_beyond_the_nose_the_share_that_can_be_carried_is_told():
    """E²/4R = 6.80625 MW of 10 MW."""
    case = direct_line(3000.0, 0.06, [(0.0, diode(3300.0, 0.1))], [Drawing(5.0, 10e6)])
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == pytest.approx(0.680625, abs=1e-3)


def test_where_all_stations_block_the_braking_trains_hold_the_voltage():
    """Two trains of 3 and 0.5 MW feed one of 0.7 MW: no station conducts, 77 % are refused."""
    trains = [
        Braking(2.0, 3e6, 1750.0, 1800.0, 100e3),
        Drawing(5.0, 700e3),
        Braking(9.0, 500e3, 1750.0, 1800.0, 50e3),
    ]
    station_v, station_a, train_v = solved(direct_line(1500.0, 0.055, [WEST, EAST], trains))
    assert station_v == pytest.approx([1790.134326, 1772.59656], abs=1e-3)
    assert station_a == pytest.approx([0.0, 0.0], abs=1e-3)
    assert train_v == pytest.approx([1790.134326, 1744.791267, 1772.59656], abs=1e-3)


def test_a_line_on_which_hardly_anybody_draws_has_the_voltage_without_load():
    """The stations' 750 V are the base voltage too, at which rectifiers neither conduct nor block."""
    case = direct_line(750.0, 0.02, [(0.0, diode(750.0, 0.015))], [Drawing(1.0, 1e-3)])
    station_v, _, train_v = solved(case)
    assert station_v == pytest.approx([750.0], abs=1e-6)
    assert train_v == pytest.approx([750.0], abs=1e-6)


def test_a_characteristic_of_several_pieces_holds_in_each_of_them():
    """3600 V falling to 3510 V by 30 A, 3300 V at 1818 A, 2850 V at 5454 A, and on.

    A train at the station takes P = U I at 20, 1000, 3000 and 6000 A: U by interpolation.
    """
    amperes, volts = [0.0, 30.0, 1818.0, 5454.0], [3600.0, 3510.0, 3300.0, 2850.0]
    slope = (volts[3] - volts[2]) / (amperes[3] - amperes[2])
    for current_a in (20.0, 1000.0, 3000.0, 6000.0):
        voltage_v = float(np.interp(current_a, amperes, volts))
        if current_a > amperes[3]:
            voltage_v = volts[3] + slope * (current_a - amperes[3])
        train = Drawing(0.001, current_a * (voltage_v - 1e-6 * current_a))
        case = direct_line(3000.0, 0.001, [(0.0, curve(amperes, volts))], [train])
        station_v, station_a, _ = solved(case)
        assert station_a[0] == pytest.approx(current_a, rel=1e-8)
        assert station_v[0] == pytest.approx(voltage_v, rel=1e-8)


def test_of_two_stable_solutions_that_of_the_last_step_is_followed():
    """1500 V, one station of 1660 V behind 0.1 ohm at km 2.5; 2.5 MW braked, 1.38 and 0.466 MW drawn.

    With the station feeding 18.8 A the braking train has 1657 V and all its power is taken; with the
    station blocked it has 1756 V, and 97 %.  Both are stable.  From the state of a little more or less
    braking power each is reached, and kept.
    """
    station = [(2.5, diode(1660.0, 0.1))]

    def trains(offered_w):
        return [
            Braking(3.8, offered_w, 1755.0, 1800.0, 100e3),
            Drawing(10.3, 1.38e6),
            Drawing(14.6, 466e3),
        ]

    case = direct_line(1500.0, 0.04, station, trains(2.5e6))
    demand = case.loads.trains[0].demand
    for first_w, expected_v in ((2.2e6, 1658.12231), (3.0e6, 1756.440332)):
        for offered_w in np.linspace(first_w, 2.5e6, 16):
            demand.offered_power_w = offered_w
            share, _ = solve(offered_w != first_w, case.network, case.flow, case.loads)
            assert share == 1.0
        assert case.flow.nodes[0].voltage_v.real == pytest.approx(expected_v, abs=1e-3)


UNLOADED_V, STATION_OHM, CABLES_OHM = 3571.254869, 0.07372108531, 0.05138194444
LOOP_OHM_PER_KM = 0.0613 + 0.011 * 0.46 / (0.011 + 0.46)
"""Contact line, and the rails beside the earth."""

ONE_SIDED_V = [
    3446.15,
    3302.07,
    3157.98,
    3013.89,
    2869.81,
    2725.72,
    2581.63,
    2437.55,
    2293.46,
    2149.38,
    2005.29,
]
TWO_SIDED_V = [
    3455.41,
    3344.92,
    3258.98,
    3197.59,
    3160.76,
    3148.49,
    3160.76,
    3197.59,
    3258.98,
    3344.92,
    3455.41,
]
FIRST_A = [926.02, 840.82, 755.61, 670.41, 585.2, 500.0, 414.8, 329.59, 244.39, 159.18, 73.98]
FIRST_BUSBAR_V = [3502.99, 3509.27, 3515.55, 3521.83, 3528.11, 3534.39, 3540.68, 3546.96, 3553.24,
                  3559.52, 3565.8]  # fmt: skip


def of_the_thesis(km, voltage_v, *places_km):
    """Stations behind their cables at some places, and a train that draws 1000 A at a voltage."""
    law = diode(UNLOADED_V, STATION_OHM + CABLES_OHM)
    stations = [(each, law) for each in places_km]
    beside_km = {each: abs(each - 1e-3) for each in places_km}  # a metre from a station
    train = Drawing(beside_km.get(km, km), 1000.0 * voltage_v)
    return solved(direct_line(3000.0, LOOP_OHM_PER_KM, stations, [train]))


@pytest.mark.parametrize(("km", "voltage_v"), list(zip(range(0, 21, 2), ONE_SIDED_V, strict=True)))
def test_a_published_line_fed_from_one_end(km, voltage_v):
    """[Yoo2024], Table 5: 3 kV, contact line C120-2C, rails S60, a train of 1000 A every 2 km.

    The train here draws the power that it has there.  At 20 km little is left of what the line can
    carry: a rounding of the table by 0.005 V moves the voltage by R I / (2 U - U0) = 3.6 times as much.
    """
    _, station_a, (found_v,) = of_the_thesis(km, voltage_v, 0.0)
    ohm = STATION_OHM + CABLES_OHM + LOOP_OHM_PER_KM * km
    moves = 1.0 + 1000.0 * ohm / (2.0 * voltage_v - UNLOADED_V)
    assert found_v == pytest.approx(voltage_v, abs=0.005 * moves + 0.08 * (km == 0))
    assert UNLOADED_V - STATION_OHM * station_a[0] == pytest.approx(3497.53, abs=0.01)


@pytest.mark.parametrize("k", range(11))
def test_a_published_line_fed_from_both_ends(k):
    """[Yoo2024], Table 6: voltage of the train, current and busbar voltage of the first station."""
    _, station_a, (found_v,) = of_the_thesis(2.0 * k, TWO_SIDED_V[k], 0.0, 20.0)
    at_an_end = k in (0, 10)  # of which the train stands a metre away
    assert found_v == pytest.approx(TWO_SIDED_V[k], abs=0.1 if at_an_end else 0.01)
    assert station_a[0] == pytest.approx(FIRST_A[k], abs=0.05 if at_an_end else 0.01)
    busbar_v = UNLOADED_V - STATION_OHM * station_a[0]
    assert busbar_v == pytest.approx(FIRST_BUSBAR_V[k], abs=0.01)
