"""Hand-worked drive used below: 2000 kW, of which it turns into motion

    load        5 %   10 %   25 %   50 %   100 %
    power       100    200    500   1000   2000 kW
    efficiency  0.60  0.78   0.85   0.88   0.88

At the points, 100 kW take 100/0.60 = 166.667 kW, 2000 kW take 2272.727 kW; brakes of 200 kW offer
156 kW.  Below 5 % it stays at 0.60: 50 kW take 83.333 kW.

Between 5 and 10 % the slope is 0 at 5 %, and at 10 % the weighted harmonic mean of the secants,
0.18/100 = 0.0018 and 0.07/300 = 0.000233333 a kW, with weights 2 · 300 + 100 = 700 and 300 + 2 · 100 =
500:

    m = 1200/(700/0.0018 + 500/0.000233333) = 1200/(388 888.9 + 2 142 857.1) = 0.000473981 a kW
    at 150 kW: (0.60 + 0.78)/2 - 100/8 · m = 0.69 - 0.0059248 = 0.6840752
    slope there: 1.5 · 0.0018 - m/4 = 0.0027 - 0.0001185 = 0.0025815 a kW
    taken: 150/0.6840752 = 219.2741 kW;  slope (1 - 150 · 0.0025815/0.6840752)/0.6840752 = 0.634350
"""

import math

import numpy as np
import pytest

from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.scenario import over_load
from tpss.vehicle import part_load
from tpss.vehicle.at_load import follow_load
from tpss.vehicle.demand import (
    certify_free_band,
    electrical_demand,
    motor_state,
    update_cap_terms,
)
from tpss.vehicle.feed_back import offer
from tpss.vehicle.part_load import (
    LoadCurve,
    factor_at,
    falls_with_power,
    given_share,
    lay_out_loads,
    power_for,
    range_over_load,
    taken_at_load,
)
from vehicles import SCRATCH, demand_at, kind_of

from alternatives import central_difference
from scenarios import short_line

LOAD = [5.0, 10.0, 25.0, 50.0, 100.0]
FACTOR = [0.60, 0.78, 0.85, 0.88, 0.88]
KW = 1e3
CURVE = LoadCurve.array([lay_out_loads([20.0 * KW * load for load in LOAD], FACTOR)])[0]
NONE = LoadCurve.array([LoadCurve.row()])[0]


@pytest.mark.parametrize(
    ("power_kw", "taken_kw"),
    [(0.0, 0.0), (50.0, 83.3333), (100.0, 166.6667), (150.0, 219.2741), (200.0, 256.4103),
     (2000.0, 2272.7273), (2500.0, 2840.9091)],
)  # fmt: skip
def test_motors_take_more_for_each_kilowatt_at_a_low_load(as_run, power_kw, taken_kw):
    taken_w, _ = as_run(taken_at_load)(power_kw * KW, 1.0, CURVE)
    assert taken_w == pytest.approx(taken_kw * KW, rel=1e-6)


def test_slope_is_that_worked_out_by_hand(as_run):
    assert as_run(taken_at_load)(150.0 * KW, 1.0, CURVE)[1] == pytest.approx(0.634350, abs=2e-6)


@pytest.mark.parametrize(
    "power_kw", [20.0, 99.0, 100.0, 151.0, 200.0, 333.0, 1000.0, 1999.0, 2500.0]
)
@pytest.mark.parametrize("share", [1.0, 0.3])
def test_slope_is_the_derivative_at_points_and_between(as_run, power_kw, share):
    """Also at a point, where the slope has no jump; within 0.1 W it changes by less than 1e-5."""
    taken = as_run(taken_at_load)
    power_w = share * power_kw * KW
    slope = central_difference(lambda p: taken(p, share, CURVE)[0], power_w, 0.1)
    assert taken(power_w, share, CURVE)[1] == pytest.approx(slope, rel=2e-5)


def test_motors_of_half_a_step_take_half_of_what_their_power_takes(as_run):
    whole, _ = as_run(taken_at_load)(150.0 * KW, 1.0, CURVE)
    half, _ = as_run(taken_at_load)(75.0 * KW, 0.5, CURVE)
    assert half == pytest.approx(whole / 2.0, rel=1e-15)


def test_motors_that_rest_take_nothing_in_no_part_of_a_step(as_run):
    assert as_run(taken_at_load)(0.0, 0.0, CURVE) == (0.0, 1.0 / 0.6)


def test_what_is_taken_and_what_is_offered_rise_with_the_power(as_run):
    powers_w = np.linspace(0.0, 2200.0 * KW, 4001)
    taken = [as_run(taken_at_load)(power_w, 1.0, CURVE)[0] for power_w in powers_w]
    given = [power_w * as_run(given_share)(power_w, CURVE) for power_w in powers_w]
    assert (np.diff(taken) > 0.0).all()
    assert (np.diff(given) > 0.0).all()


def test_brakes_of_a_tenth_of_the_power_offer_0_78_of_it(as_run):
    assert as_run(given_share)(200.0 * KW, CURVE) == pytest.approx(0.78)
    assert as_run(given_share)(200.0 * KW, NONE) == 1.0


@pytest.mark.parametrize("power_kw", [1.0, 77.0, 150.0, 200.0, 1234.0, 3000.0])
def test_power_for_what_is_taken_is_the_way_back(as_run, power_kw):
    taken_w, _ = as_run(taken_at_load)(power_kw * KW, 1.0, CURVE)
    assert as_run(power_for)(taken_w, CURVE) == pytest.approx(power_kw * KW, rel=1e-13)


def test_without_a_curve_the_load_changes_nothing(as_run):
    assert as_run(range_over_load)(NONE) == (1.0, 1.0)
    assert as_run(power_for)(5.0, NONE) == 5.0
    assert as_run(power_for)(-5.0, CURVE) == -5.0  # less than the auxiliaries is left


def test_factors_lie_between_those_of_the_points(as_run):
    assert as_run(range_over_load)(CURVE) == (0.60, 0.88)
    found = [as_run(factor_at)(power_w, CURVE)[0] for power_w in np.linspace(0.0, 2.2e6, 2001)]
    assert min(found) == 0.60
    assert max(found) == 0.88


@pytest.mark.parametrize(
    ("factor", "taken", "offered"),
    [
        ([0.60, 0.78, 0.85, 0.88, 0.88], None, None),
        ([0.30, 0.78, 0.85, 0.88, 0.88], 0, None),  # 5 % took 16.7, 10 % takes 12.8
        ([0.60, 0.62, 0.20, 0.20, 0.20], None, 1),  # 10 % offered 6.2, 25 % offers 5
        ([0.50, 0.50, 0.50, 0.45, 0.95], 3, None),
    ],
)
def test_power_that_falls_as_the_load_rises_is_found(factor, taken, offered):
    """In the last case 50 and 100 % take 111 and 105 %."""
    assert falls_with_power(LOAD, factor, 1.0) == taken
    assert falls_with_power(LOAD, factor, -1.0) == offered


def test_power_that_falls_between_two_points_only_is_found():
    """From 0.5 at 40 % to 0.9 at 80 %: 80 and 88.9 % are taken at the points.

    In the middle, at 60 %, the factor is 0.7 and its slope 1.5 · 0.4/0.4 = 1.5: 0.7 - 0.6 · 1.5 < 0.
    """
    assert falls_with_power([0.4, 0.8, 1.0], [0.5, 0.9, 0.9], 1.0) == 0


@pytest.mark.parametrize("seed", range(20))
def test_what_is_found_to_rise_rises_in_small_steps(seed):
    """Random curves, against a thousand differences."""
    rng = np.random.default_rng(seed)
    load = np.cumsum(rng.uniform(0.05, 0.4, 5))
    factor = rng.uniform(0.3, 1.0, 5)
    curve = LoadCurve.array([lay_out_loads(load.tolist(), factor.tolist())])[0]
    powers = np.linspace(load[0], load[-1], 4001)
    taken = np.array([taken_at_load(power, 1.0, curve)[0] for power in powers])
    offered = np.array([power * given_share(power, curve) for power in powers])
    for values, sign in ((taken, 1.0), (offered, -1.0)):
        assert (falls_with_power(load.tolist(), factor.tolist(), sign) is None) == bool(
            (np.diff(values) > 0.0).all()
        )


OVER_LOAD = {"load_percent": LOAD, "value": FACTOR}
LIMITS = {
    "max_force_kn": 300.0,
    "max_power_kw": 8000.0,
    "full_voltage_kv": 15.0,
    "zero_voltage_kv": 11.0,
}
MACHINES = {
    "voltage": {"tractive_effort": LIMITS, "power_factor": 0.9},
    "table": {"tractive_effort": {"speed_kmh": [0, 60, 200], "voltage_kv": [11, 16.5],
                                  "force_kn": [[300, 250, 100], [320, 280, 120]]},
              "power_factor": 0.9},
    "current": {"tractive_effort": {"max_force_kn": 300.0, "max_power_kw": 8000.0},
                "power_factor": 0.9, "current_limitation": {"max_current_a": 400.0}},
    "bridge": {"max_motor_current_a": 2080.0, "reactive_power": "double-bridge",
               "current_limitation": {"max_current_a": 500.0}},
}  # fmt: skip


def train(machine, share=1.0, **changes):
    kind, points = kind_of(
        **MACHINES[machine], efficiency=0.9,
        efficiency_over_load={**OVER_LOAD, "rated_power_kw": 12_000.0}, **changes,
    )  # fmt: skip
    found = demand_at(
        70.0, kind, points, force_cap_n=1e6, resistance_n=30e3, adhesion_n=1e6,
        mean_speed_weight_s=5.0, driven_share=share,
    )  # fmt: skip
    certify_free_band(kind, found)
    update_cap_terms(kind, found)
    return kind, found


def drawn(as_run, voltage_v, kind, found):
    """Active power at a voltage, and its slope, as the load flow asks for them. [W], [W/V]"""
    p, _, p_slope, _ = as_run(electrical_demand)(voltage_v, kind, found, SCRATCH)
    return as_run(follow_load)(p, p_slope, found.driven_share, kind, found)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("voltage_v", [11.6e3, 12.5e3, 13.7e3])
def test_slope_of_the_power_over_the_voltage_is_its_derivative(as_run, machine, voltage_v):
    """Which Newton's method of the load flow builds on."""
    kind, found = train(machine)
    _, slope = drawn(as_run, voltage_v, kind, found)
    expected = central_difference(lambda v: drawn(as_run, v, kind, found)[0], voltage_v, 0.1)
    assert slope != 0.0
    assert slope == pytest.approx(expected, rel=1e-6)


def test_limited_train_draws_the_current_that_it_may(as_run):
    """Of 400 A, 0.118 A/V below 14.25 kV: at 12.5 kV 192.7 A or 2.41 MVA, motors at a part load."""
    kind, found = train("current")
    active, _ = drawn(as_run, 12.5e3, kind, found)
    reactive = found.reactive_power_var
    limit = kind.line_current
    share = (12.5e3 - 11e3) / (14.25e3 - 11e3)
    allowed_a = limit.auxiliary_current_a + share * (400.0 - limit.auxiliary_current_a)
    assert math.hypot(active, reactive) == pytest.approx(12.5e3 * allowed_a, rel=1e-9)


def test_factor_multiplies_the_efficiency_over_speed(as_run):
    """P = P_motor / (0.9 λ) + P_aux."""
    kind, found = train("voltage")
    active, _ = drawn(as_run, 12.5e3, kind, found)
    _, _, motor_w, _ = motor_state(found.wheel_force_n, kind, found)
    factor, _ = factor_at(motor_w, kind.over_load)
    assert factor < 0.88
    assert active == pytest.approx(motor_w / (0.9 * factor) + kind.auxiliary_power_w, rel=1e-14)


def test_brakes_have_the_curve_of_traction_or_one_of_their_own(as_run):
    """At 20 m/s 60 kN brake with 1200 kW: 10 % of 12 MW, so 0.78; of 1500 kW 80 %, amid 0.7 and 0.9."""
    brakes = {"max_force_kn": 60.0, "max_power_kw": 1500.0}
    own = {"load_percent": [60.0, 100.0], "value": [0.7, 0.9]}
    for regeneration, factor in ((brakes, 0.78), ({**brakes, "efficiency_over_load": own}, 0.8)):
        changes = {
            "simulation": {"time_step_min": 0.05},
            "trains.freight.efficiency": 0.9,
            "trains.freight.efficiency_over_load": {**OVER_LOAD, "rated_power_kw": 12_000.0},
            "trains.freight.regeneration": regeneration,
        }
        kinds, points = build_train_types([Running(short_line(changes).trains["freight"])])
        found = demand_at(72.0, kinds[0], points, adhesion_n=1e6)
        as_run(offer)(100e3, 20.0, kinds[0], found, points)
        assert found.offered_power_w == pytest.approx(1200e3 * 0.9 * factor, rel=1e-12)


def test_a_curve_of_a_scenario_has_as_many_points_as_a_record_has_places():
    assert over_load.MOST_LOADS == part_load.MOST_LOADS
