"""One law bills a motor force: the demand at the wheel rim and the limit of the line current share it.

The demand begins with a force at the wheel rim (`motor_state`), the limit with one of the motors
(`billed_power`); at forces that belong together both must bill the same power and current.
"""

import numpy as np
import pytest

from tpss.physics.locomotive import active_power, machine_force
from tpss.physics.reactive_power import ReactiveModel
from tpss.vehicle.billing import billed_power, motors_current
from tpss.vehicle.bridge import bridge_ratio
from tpss.vehicle.demand import armature_demand, electrical_demand, motor_state, update_cap_terms
from tpss.vehicle.line_current import _apparent_power
from vehicles import SCRATCH, demand_at, kind_of

from alternatives import central_difference

FORCES_N = [5e3, 60e3, 110e3, 160e3]
KINDS = {"factor": {}, "bridge": {"reactive_power": "double-bridge"},
         "slip": {"slip": 0.03, "reactive_power": "double-bridge"}}  # fmt: skip
VOLTAGE_V = 14.2e3


@pytest.fixture(params=KINDS.values(), ids=KINDS.keys())
def kind_and_points(request):
    return kind_of(max_motor_current_a=2080.0, **request.param)


def train_at(speed_kmh, kind, points, **terms):
    common = {"resistance_n": 40e3, "mean_speed_weight_s": 30.0, "adhesion_n": 1e6}
    return demand_at(speed_kmh, kind, points, **{**common, **terms})


@pytest.mark.parametrize("speed_kmh", [0.0, 5.0, 50.0, 95.0])
@pytest.mark.parametrize("weight_s", [0.0, 30.0], ids=["start", "mean"])
@pytest.mark.parametrize("adhesion_n", [80e3, 1e6], ids=["slip", "grip"])
@pytest.mark.parametrize("share", [1.0, 0.4])
@pytest.mark.parametrize("motor_n", FORCES_N)
def test_a_force_of_the_motors_is_billed_as_the_force_at_the_rim_that_belongs_to_it(
    as_run, kind_and_points, speed_kmh, weight_s, adhesion_n, share, motor_n
):
    kind, points = kind_and_points
    terms = {"mean_speed_weight_s": weight_s, "adhesion_n": adhesion_n, "driven_share": share}
    train = train_at(speed_kmh, kind, points, **terms)
    at_rim_n = machine_force(motor_n, train.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    motor, speed, power, slope = as_run(motor_state)(at_rim_n, kind, train)
    found, found_slope, found_speed, _ = as_run(billed_power)(motor_n, share, kind, train)
    assert motor == pytest.approx(motor_n, rel=1e-12)
    assert (found, found_speed) == pytest.approx((power, speed), rel=1e-12)
    rim_by_motor = 1.0 / (1.0 + kind.rotor_mass_kg / kind.inertia_kg)
    assert found_slope == pytest.approx(slope * rim_by_motor, rel=1e-12)
    current, _ = as_run(armature_demand)(at_rim_n, 0.0, kind, train)
    billed_a = as_run(motors_current)(motor_n, found_speed, share, kind, train)
    assert billed_a == pytest.approx(current, rel=1e-12)


@pytest.mark.parametrize("speed_kmh", [5.0, 50.0, 95.0])
@pytest.mark.parametrize("motor_n", FORCES_N)
def test_the_limited_power_is_the_power_that_the_train_draws_at_that_force(
    as_run, kind_and_points, speed_kmh, motor_n
):
    """The filter, which the limit leaves out, is taken away."""
    kind, points = kind_and_points
    kind.filter_susceptance_s = 0.0
    train = train_at(speed_kmh, kind, points)
    train.force_cap_n = machine_force(
        motor_n, train.resistance_n, kind.rotor_mass_kg, kind.inertia_kg
    )
    train.free_voltage_v, train.free_band_v = VOLTAGE_V, 100.0  # the cap counts, not the machine
    as_run(update_cap_terms)(kind, train)
    active, reactive, _, _ = as_run(electrical_demand)(VOLTAGE_V, kind, train, SCRATCH)
    ratio = 0.0
    if kind.reactive_model == ReactiveModel.DOUBLE_BRIDGE:
        ratio, _ = as_run(bridge_ratio)(VOLTAGE_V, kind, train, SCRATCH)
    square, slope, _ = as_run(_apparent_power)(motor_n, ratio, kind, train)
    assert square == pytest.approx(active**2 + reactive**2, rel=1e-11)
    around = central_difference(
        lambda f: as_run(_apparent_power)(f, ratio, kind, train)[0], motor_n, 10.0
    )
    assert slope == pytest.approx(around, rel=1e-6)


def test_the_slope_of_the_billed_power_is_that_over_the_force(as_run):
    kind, points = kind_of()
    train = train_at(70.0, kind, points)
    _, slope, _, speed_slope = as_run(billed_power)(90e3, 1.0, kind, train)
    power, speed = (
        central_difference(lambda f, k=k: as_run(billed_power)(f, 1.0, kind, train)[k], 90e3, 10.0)
        for k in (0, 2)
    )
    assert (slope, speed_slope) == pytest.approx((power, speed), rel=1e-8)


def test_what_the_line_carries_is_motor_power_over_efficiency_and_auxiliaries(as_run):
    kind, points = kind_of()
    train = train_at(70.0, kind, points)
    _, _, power, _ = as_run(motor_state)(90e3, kind, train)
    train.force_cap_n = 90e3
    train.free_voltage_v, train.free_band_v = VOLTAGE_V, 100.0
    update_cap_terms(kind, train)
    active, *_ = as_run(electrical_demand)(VOLTAGE_V, kind, train, SCRATCH)
    expected = active_power(power, train.per_efficiency, kind.auxiliary_power_w)
    assert active == pytest.approx(expected, rel=1e-15)
    assert np.isfinite(active)
