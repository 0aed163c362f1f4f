"""Hand-worked train used below: an Rc4 before 1470 t, on level track at 60 km/h, R = 33 717 N.

At the machine's limit F_max = 169 170 N the rotors, 10 750 kg, take their share:

    c/M = 10 750/1 470 000 = 0.00731293
    F = (169 170 + 0.00731293 · 33 717)/1.00731293 = 168 186.6 N
    a = (168 186.6 - 33 717)/1 470 000 = 0.0914759 m/s²;  F + 10 750 a = 169 170 N again

When the driver wants 100 kN:

    a = (100 000 - 33 717)/1 470 000 = 0.0450905 m/s²
    F_motor = 100 000 + 10 750 · 0.0450905 = 100 484.7 N
    P_motor = 100 484.7 · 16.6667 = 1 674 745 W
    P_D = 1 674 745/0.8 + 151 500 = 2 244 932 W
    Q_D = 1 674 745 · 0.960636 + 113 625 = 1 722 446 var               (λ = 0.721158)

and over a step of 60 s, with the step's mean speed 16.6667 + 30 · 0.0450905 = 18.0194 m/s:

    P_motor = 100 484.7 · 18.0194 = 1 810 672 W;  P_D = 2 414 841 W

At full effort on rails that pass on 147 kN, all of F_max = 169 170 N is billed:

    P_motor = 169 170.2 · 16.6667 = 2 819 503 W
    a = (147 000 - 33 717)/1 470 000 = 0.0770633 m/s²;  mean speed 16.6667 + 30 a = 18.9786 m/s
    P_motor = 169 170.2 · 18.9786 = 3 210 607 W
"""

import math

import numpy as np
import pytest

from tpss.driving.driver import prepare
from tpss.kernel import plain
from tpss.model import build_model
from tpss.model.curves import CurveBook
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.physics.adhesion import Rail, adhesion_limit
from tpss.physics.motor import MotorModel
from tpss.physics.reactive_power import ReactiveModel
from tpss.run.services import ScheduledTrain, train_records
from tpss.step.model import driving_data
from tpss.vehicle.billing import billed_speed, motors_current
from tpss.vehicle.bridge import train_bridge_sine
from tpss.vehicle.demand import (
    FULL_EFFORT_N,
    bridge_demand,
    certify_free_band,
    electrical_demand,
    motor_state,
    update_cap_terms,
    update_speed_terms,
    wheel_force,
)
from tpss.vehicle.effort.kinds import EffortKind
from tpss.vehicle.effort.network import VOLTAGE
from tpss.vehicle.train_type import TrainType
from vehicles import NETWORKS, demand_at

from alternatives import central_difference
from scenarios import short_line

SCRATCH = np.zeros(SCRATCH_SHAPE)
CURVES = CurveBook()
EFFICIENCY = CURVES.add_constant(0.8)
POINTS = CURVES.points()
RESISTANCE_N = 33_717.0
NO_LIMIT_N = 1e6
RATIO = 487 / 15e3
FILTER_S = RATIO**2 / -0.45
"""Susceptance at the pantograph of a filter of -0.45 Ω behind the transformer."""

FREIGHT = {
    "mass_kg": 1.47e6,
    "adhesive_mass_kg": 79e3,
    "inertia_kg": 1.47e6,
    "rotor_mass_kg": 10_750.0,
    "slip_factor": 1.0,
    "efficiency": EFFICIENCY,
    "auxiliary_power_w": 151_500.0,
    "auxiliary_reactive_power_var": 113_625.0,
    "base_speed_m_s": 78 / 3.6,
    "highest_motor_voltage_v": 770.0,
    "transformer_ratio": RATIO,
    "reactive_model": ReactiveModel.POWER_FACTOR,
    "voltage_model": MotorModel.NEW,
    "networks": NETWORKS,
}
MODELS = [ReactiveModel.POWER_FACTOR, ReactiveModel.DOUBLE_BRIDGE]
VOLTAGE_MODELS = [MotorModel.NEW, MotorModel.FORMER]


def freight(highest_current_a=1250.0, **changes):
    kind = TrainType.blank(1)[0]
    for name, value in {**FREIGHT, **changes}.items():
        kind[name] = value
    kind.effort.kind, kind.effort.highest_current_a = EffortKind.NETWORK, highest_current_a
    kind.line_current.highest_current_a = math.inf
    return kind


def demand(cap_n, speed_kmh=60.0, mean_over_s=0.0, resistance_n=RESISTANCE_N, kind=None, share=1.0):
    """A train in a step; the machine's limit is evaluated at every voltage."""
    kind = kind or freight()
    train = demand_at(
        speed_kmh, kind, POINTS,
        force_cap_n=cap_n, resistance_n=resistance_n, adhesion_n=NO_LIMIT_N,
        mean_speed_weight_s=mean_over_s / 2.0, driven_share=share,
    )  # fmt: skip
    update_cap_terms(kind, train)
    return train


def test_machine_limits_a_driver_who_wants_more(as_run):
    """F_max at 60 km/h, 15 kV and 1250 A is 169 170.16 N."""
    force, slope = as_run(wheel_force)(15e3, freight(), demand(NO_LIMIT_N), SCRATCH)
    assert force == pytest.approx(168_186.8, abs=0.1)
    assert slope != 0.0


def test_driver_who_wants_less_has_it_at_any_voltage(as_run):
    for voltage_v in (12e3, 15e3, 16.5e3):
        assert as_run(wheel_force)(voltage_v, freight(), demand(1e5), SCRATCH) == (1e5, 0.0)


def test_wet_rail_takes_73_kilonewton_of_the_machine_s_168(as_run):
    cap_n = adhesion_limit(79e3, 60 / 3.6, Rail.WET)
    force, _ = as_run(wheel_force)(15e3, freight(), demand(cap_n), SCRATCH)
    assert force == pytest.approx(72_752, abs=1.0)


def test_coasting_or_braking_train_has_no_tractive_force(as_run):
    assert as_run(wheel_force)(15e3, freight(), demand(0.0), SCRATCH) == (0.0, 0.0)


@pytest.mark.parametrize(("resistance_n", "force_n"), [(-1e5, 0.0), (0.0, 0.0), (1e5, 725.98)])
def test_network_below_zero_counts_as_zero(as_run, resistance_n, force_n):
    """At 250 km/h, 16.5 kV and 2080 A the network is at -8 N.

    Rotors that slow down with the train give 10 750/1 480 750 · 100 kN = 725.98 N by eq. (2.5).
    """
    kind = freight(highest_current_a=2080.0)
    train = demand(NO_LIMIT_N, speed_kmh=250.0, resistance_n=resistance_n, kind=kind)
    force, slope = as_run(wheel_force)(16.5e3, kind, train, SCRATCH)
    assert force == pytest.approx(force_n, abs=0.01)
    assert slope == 0.0


def test_power_at_the_start_of_the_step(as_run):
    motor, speed, power, _ = as_run(motor_state)(1e5, freight(), demand(1e5))
    assert motor == pytest.approx(100_484.7, abs=0.1)
    assert speed == pytest.approx(60 / 3.6)
    assert power == pytest.approx(1_674_745, abs=1.0)


def test_power_at_the_mean_speed_of_the_step(as_run):
    train = demand(1e5, mean_over_s=60.0)
    _, speed, power, _ = as_run(motor_state)(1e5, freight(), train)
    assert speed == pytest.approx(18.0194, abs=1e-4)
    assert power == pytest.approx(1_810_672, abs=1.0)


def test_slip_turns_the_rotors_faster_and_costs_power(as_run):
    """κ = 0.02: F_motor = 100 000 + 10 965 · 0.0450905 = 100 494.4 N, P = F_motor · 17 m/s."""
    kind = freight(slip_factor=1.02, rotor_mass_kg=1.02 * 10_750.0)
    motor, _, power, _ = as_run(motor_state)(1e5, kind, demand(1e5))
    assert motor == pytest.approx(100_494.4, abs=0.1)
    assert power == pytest.approx(100_494.42 * 17.0, abs=1.0)


@pytest.mark.parametrize("force_n", [0.0, 100.0, 1000.0])
def test_motor_takes_no_negative_power_on_a_slope_that_slows_the_train(as_run, force_n):
    """On 20 ‰ the rotors alone would give 10 750 · 0.22 = 2300 N back."""
    train = demand(force_n, mean_over_s=60.0, resistance_n=322e3)
    motor, speed, power, slope = as_run(motor_state)(force_n, freight(), train)
    assert (motor, power, slope) == (0.0, 0.0, 0.0)
    assert speed == pytest.approx(60 / 3.6 + 30.0 * (force_n - 322e3) / 1.47e6)


def test_train_that_gathers_speed_downhill_without_traction_takes_no_power(as_run):
    train = demand(0.0, resistance_n=-1e5)
    assert as_run(motor_state)(0.0, freight(), train) == (0.0, 60 / 3.6, 0.0, 0.0)


def test_billed_speed_is_never_negative(as_run):
    """From 1 km/h at -0.22 m/s², half a minute on."""
    train = demand(100.0, speed_kmh=1.0, mean_over_s=60.0, resistance_n=322e3)
    assert as_run(motor_state)(100.0, freight(), train) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("mean_over_s", [0.0, 60.0])
@pytest.mark.parametrize("slip", [0.0, 0.02])
def test_slope_of_the_power_is_that_over_the_force(as_run, mean_over_s, slip):
    kind = freight(slip_factor=1.0 + slip, rotor_mass_kg=(1.0 + slip) * 10_750.0)
    train = demand(1e5, mean_over_s=mean_over_s)
    slope = as_run(motor_state)(1e5, kind, train)[3]
    power = central_difference(lambda f: as_run(motor_state)(f, kind, train)[2], 1e5, 10.0)
    assert slope == pytest.approx(power, rel=1e-8)


def test_efficiency_and_auxiliaries_come_on_top_of_the_motors(as_run):
    active, reactive, _, _ = as_run(electrical_demand)(15e3, freight(), demand(1e5), SCRATCH)
    assert active == pytest.approx(2_244_932, abs=1.0)
    assert reactive == pytest.approx(1_722_446, abs=1.0)


def test_mean_speed_is_billed_to_the_line(as_run):
    train = demand(1e5, mean_over_s=60.0)
    active, *_ = as_run(electrical_demand)(15e3, freight(), train, SCRATCH)
    assert active == pytest.approx(2_414_841, abs=1.0)


@pytest.mark.parametrize("reactive_model", MODELS)
def test_train_without_traction_draws_its_auxiliaries(as_run, reactive_model):
    kind = freight(reactive_model=reactive_model)
    drawn = as_run(electrical_demand)(15e3, kind, demand(0.0), SCRATCH)
    assert drawn == (151_500.0, 113_625.0, 0.0, 0.0)


def test_filter_gives_600_kilovar_back_at_16_kilovolt(as_run):
    kind = freight(filter_susceptance_s=FILTER_S)
    _, reactive, _, _ = as_run(electrical_demand)(16e3, kind, demand(0.0), SCRATCH)
    assert reactive == pytest.approx(113_625 - 599_657, abs=1.0)


def test_bridges_draw_reactive_power_by_their_firing_angle(as_run):
    """Above base speed U_di = 770 V; at 15 kV β = 0.859368 by the network.

    100 kN at 100 km/h with R = 100 kN: 4 I_D = 100 000 · 27.7778/770 = 3607.50 A
    Q = 487 · 3607.50 · √2/π · 0.859368 = 679 650 var
    """
    kind = freight(reactive_model=ReactiveModel.DOUBLE_BRIDGE)
    train = demand(1e5, speed_kmh=100.0, resistance_n=1e5)
    reactive, _ = as_run(bridge_demand)(15e3, 1e5, 0.0, kind, train, SCRATCH)
    assert as_run(motors_current)(1e5, 100 / 3.6, 1.0, kind, train) == pytest.approx(
        3607.50, abs=0.01
    )
    assert as_run(train_bridge_sine)(15e3, kind, train, SCRATCH)[0] == pytest.approx(
        0.859368, abs=1e-6
    )
    assert reactive == pytest.approx(679_650, abs=20.0)


def test_former_motor_voltage_draws_more_current_below_14_kilovolt(as_run):
    """The same power at 13/14 of the motor voltage takes 14/13 of the current, by another β."""
    bridge = ReactiveModel.DOUBLE_BRIDGE
    new, former = (freight(reactive_model=bridge, voltage_model=m) for m in VOLTAGE_MODELS)
    ratio = 14 / 13
    for kind in (new, former):
        sine, _ = as_run(train_bridge_sine)(13e3, kind, demand(1e5), SCRATCH)
        ratio = ratio / sine if kind is new else ratio * sine
    reactive = [
        as_run(bridge_demand)(13e3, 1e5, 0.0, kind, demand(1e5), SCRATCH)[0]
        for kind in (new, former)
    ]
    assert reactive[1] / reactive[0] == pytest.approx(ratio)


@pytest.mark.parametrize(("shift", "clipped"), [(-2.0, 0.0), (2.0, 1.0)])
def test_sine_of_a_network_that_errs_is_clipped_to_0_and_1(as_run, shift, clipped):
    erring = freight()
    erring.networks.bridge_sine.output_bias += shift
    sine, slope = as_run(train_bridge_sine)(15e3, erring, demand(1e5), SCRATCH)
    assert (sine, slope) == (clipped, 0.0)


@pytest.mark.parametrize("filter_s", [0.0, FILTER_S], ids=["no filter", "filter"])
@pytest.mark.parametrize("cap_n", [6e4, NO_LIMIT_N], ids=["wanted", "limit"])
@pytest.mark.parametrize("mean_over_s", [0.0, 60.0], ids=["start", "mean"])
@pytest.mark.parametrize("speed_kmh", [60.0, 100.0])
@pytest.mark.parametrize("voltage_v", [13.2e3, 15.2e3])
@pytest.mark.parametrize("voltage_model", VOLTAGE_MODELS, ids=["new", "former"])
@pytest.mark.parametrize("reactive_model", MODELS, ids=["factor", "bridge"])
def test_slopes_of_the_demand_are_those_over_voltage(
    as_run, reactive_model, voltage_model, voltage_v, speed_kmh, mean_over_s, cap_n, filter_s
):
    kind = freight(
        reactive_model=reactive_model,
        voltage_model=voltage_model,
        filter_susceptance_s=filter_s,
        slip_factor=1.02,
    )
    train = demand(cap_n, speed_kmh, mean_over_s)

    def drawn(at_v):
        return as_run(electrical_demand)(at_v, kind, train, SCRATCH)

    _, _, active_slope, reactive_slope = drawn(voltage_v)
    active = central_difference(lambda v: drawn(v)[0], voltage_v, 0.1)
    reactive = central_difference(lambda v: drawn(v)[1], voltage_v, 0.1)
    assert active_slope == pytest.approx(active, rel=1e-6, abs=1e-6)
    assert reactive_slope == pytest.approx(reactive, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("cap_n", [6e4, NO_LIMIT_N], ids=["wanted", "limit"])
@pytest.mark.parametrize("reactive_model", MODELS, ids=["factor", "bridge"])
def test_motors_that_work_for_a_third_of_the_step_draw_a_third(as_run, reactive_model, cap_n):
    """Of power, of reactive power by power factor or current, and of their slopes over voltage."""
    kind = freight(reactive_model=reactive_model)
    whole, third = (
        np.array(as_run(electrical_demand)(14.2e3, kind, demand(cap_n, share=share), SCRATCH))
        for share in (1.0, 1.0 / 3.0)
    )
    idle = np.array([151_500.0, 113_625.0, 0.0, 0.0])
    assert third - idle == pytest.approx((whole - idle) / 3.0, rel=1e-9)


@pytest.mark.parametrize(("mean_over_s", "power_w"), [(0.0, 2_819_503), (60.0, 3_210_607)])
def test_full_effort_is_billed_whatever_the_rails_pass_on(as_run, mean_over_s, power_w):
    kind, train = freight(), demand(FULL_EFFORT_N, mean_over_s=mean_over_s)
    train.adhesion_n = 147e3
    active, *_ = as_run(electrical_demand)(15e3, kind, train, SCRATCH)
    assert (active - 151_500.0) * 0.8 == pytest.approx(power_w, abs=2.0)


def test_speed_billed_follows_the_force_until_the_wheels_slip(as_run):
    train = demand(FULL_EFFORT_N, mean_over_s=60.0)
    train.adhesion_n = 147e3
    assert as_run(billed_speed)(1e5, freight(), train)[1] == pytest.approx(30.0 / 1.47e6)
    speed, slope = as_run(billed_speed)(168e3, freight(), train)
    assert speed == pytest.approx(18.9786, abs=1e-4)
    assert slope == 0.0


@pytest.mark.parametrize("adhesion_n", [100e3, NO_LIMIT_N], ids=["slip", "grip"])
@pytest.mark.parametrize("mean_over_s", [0.0, 60.0], ids=["start", "mean"])
@pytest.mark.parametrize("speed_kmh", [60.0, 100.0])
@pytest.mark.parametrize("reactive_model", MODELS, ids=["factor", "bridge"])
def test_slopes_at_full_effort_are_those_over_voltage(
    as_run, reactive_model, speed_kmh, mean_over_s, adhesion_n
):
    kind = freight(reactive_model=reactive_model, slip_factor=1.02)
    train = demand(FULL_EFFORT_N, speed_kmh, mean_over_s)
    train.adhesion_n = adhesion_n

    def drawn(at_v):
        return as_run(electrical_demand)(at_v, kind, train, SCRATCH)

    _, _, active_slope, reactive_slope = drawn(14.2e3)
    active = central_difference(lambda v: drawn(v)[0], 14.2e3, 0.1)
    reactive = central_difference(lambda v: drawn(v)[1], 14.2e3, 0.1)
    assert active_slope == pytest.approx(active, rel=1e-6, abs=1e-6)
    assert reactive_slope == pytest.approx(reactive, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("speed_kmh", [0.0, 40.0, 90.0, 130.0])
def test_slope_of_the_wheel_force_is_that_over_voltage(as_run, speed_kmh):
    train = demand(NO_LIMIT_N, speed_kmh)
    _, slope = as_run(wheel_force)(14.3e3, freight(), train, SCRATCH)
    expected = central_difference(
        lambda v: as_run(wheel_force)(v, freight(), train, SCRATCH)[0], 14.3e3, 1.0
    )
    assert slope == pytest.approx(expected, rel=1e-6)


def random_trains(count):
    """Kinds and trains at 15 kV, some near the machine's limit, some far from it."""
    random = np.random.default_rng(2)
    for _ in range(count):
        kind = freight(highest_current_a=random.uniform(300.0, 2080.0))
        cap_n, resistance_n = random.uniform(1e3, 2e5), random.uniform(-1e5, 2e5)
        yield kind, demand(cap_n, random.uniform(0.0, 140.0), 60.0, resistance_n, kind)


def test_band_is_the_margin_of_force_over_the_steepest_slope(as_run):
    """For 100 kN at the rim the motors need 100 484.7 N of the 169 170.2 N that they can give."""
    train = demand(1e5)
    as_run(certify_free_band)(freight(), train)
    margin_n = train.free_band_v * NETWORKS.tractive_effort.steepest[VOLTAGE]
    assert margin_n == pytest.approx(169_170.2 - 100_484.7, abs=0.1)
    assert train.free_voltage_v == 15e3


def test_inside_the_proven_band_the_force_is_what_the_driver_wants(as_run):
    """The machine alone, evaluated anew with the band taken away, says the same."""
    proven = 0
    for kind, train in random_trains(300):
        as_run(certify_free_band)(kind, train)
        band_v, train.free_band_v = train.free_band_v, -1.0
        if band_v > 0.0:
            proven += 1
            for at_v in 15e3 + band_v * np.linspace(-0.999, 0.999, 5):
                assert as_run(wheel_force)(at_v, kind, train, SCRATCH) == (train.force_cap_n, 0.0)
    assert proven > 50


def test_force_does_not_depend_on_the_voltages_tried_before(as_run):
    """The band stays where it was proven, whatever is evaluated outside it.

    Series made around other voltages differ by roundings, some 2e-16 of the network's terms (1e6 N).
    """
    for kind, train in random_trains(100):
        as_run(certify_free_band)(kind, train)
        fresh = train.copy()
        for at_v in (11e3, 16.5e3, 13e3, 13.01e3, 15.2e3):
            force, _ = as_run(wheel_force)(at_v, kind, train, SCRATCH)
            alone, _ = as_run(wheel_force)(at_v, kind, fresh.copy(), SCRATCH)
            assert force == pytest.approx(alone, rel=1e-12, abs=1e-8)


def test_band_is_used_within_and_not_beyond(as_run):
    """A band of 100 V is set by hand where the machine gives far less than is wanted."""
    train = demand(NO_LIMIT_N)
    train.free_voltage_v, train.free_band_v = 15e3, 100.0
    assert as_run(wheel_force)(15_099.0, freight(), train, SCRATCH) == (NO_LIMIT_N, 0.0)
    assert as_run(wheel_force)(15_101.0, freight(), train, SCRATCH)[0] < 2e5


def test_nothing_is_proven_at_the_limit(as_run):
    train = demand(NO_LIMIT_N)
    as_run(certify_free_band)(freight(), train)
    assert train.free_band_v < 0.0


def test_what_depends_on_the_speed_is_taken_anew_when_the_speed_changes(as_run):
    """λ = 0.721158 at 60 km/h, 0.809358 at 100 km/h; F_max = 169 170 N, 127 030 N at 15 kV."""
    train = demand(1e5)
    for speed_kmh, factor, force_n in ((60.0, 0.721158, 169_170), (100.0, 0.809358, 127_030)):
        as_run(update_speed_terms)(speed_kmh / 3.6, freight(), train, POINTS, SCRATCH)
        assert train.speed_m_s == speed_kmh / 3.6
        assert train.reactive_ratio == pytest.approx(math.sqrt(factor**-2 - 1.0), rel=1e-5)
        assert train.free_force_n == pytest.approx(force_n, abs=1.0)


def test_the_same_speed_is_not_evaluated_twice(as_run):
    """What the speed decides stays; the machine is asked again, as its band may have been left."""
    train = demand(1e5)
    train.reactive_ratio = train.free_force_n = 7.0
    as_run(update_speed_terms)(60 / 3.6, freight(), train, POINTS, SCRATCH)
    assert train.reactive_ratio == 7.0
    assert train.free_force_n == pytest.approx(169_170, abs=1.0)


@pytest.mark.parametrize(
    ("band_v", "voltage_v", "force_n"),
    [
        (100.0, 15_099.0, 7.0),  # within its band
        (100.0, 15_101.0, None),
        (-1.0, 15_101.0, 7.0),  # nothing was proven: every voltage is tried anyway
    ],
)
def test_a_step_at_the_same_speed_asks_the_machine_anew_beyond_its_band_only(
    as_run, band_v, voltage_v, force_n
):
    model, _ = build_model(short_line())
    train = train_records([ScheduledTrain("", "", 0, 0, False, 0, speed_m_s=60 / 3.6)], 15e3)[0]
    data = plain(driving_data)(model)
    as_run(prepare)(train, data, model.points, SCRATCH)
    assert train.demand.free_force_n == pytest.approx(169_170, abs=1.0)
    train.demand.free_force_n, train.demand.free_band_v = 7.0, band_v
    train.demand.voltage_v = voltage_v
    as_run(prepare)(train, data, model.points, SCRATCH)
    if force_n is None:
        assert train.demand.free_force_n == pytest.approx(169_170, abs=1e3)
        assert train.demand.free_voltage_v == voltage_v
    else:
        assert train.demand.free_force_n == force_n
        assert train.demand.free_voltage_v == 15e3


def test_demand_notes_what_it_found_before_clipping(as_run):
    """Powers; and at standstill the network's β = -0.00045, which counts as an excess."""
    kind = freight(reactive_model=ReactiveModel.DOUBLE_BRIDGE)
    train = demand(NO_LIMIT_N, speed_kmh=0.0)
    active, reactive, _, _ = as_run(electrical_demand)(15e3, kind, train, SCRATCH)
    assert (train.active_power_w, train.reactive_power_var) == (active, reactive)
    assert train.machine_force_n == pytest.approx(175_057.06, abs=0.01)
    assert train.bridge_sine == pytest.approx(-0.00045134, abs=1e-8)
