"""What a train takes from the contact line at a voltage: force, active and reactive power.

Within a step a train's force is the smallest of what the driver wants, what adhesion allows and what
the machine gives at the voltage of its pantograph (F.20, F.21).  The first two do not depend on the
voltage: they are its `force_cap_n`.  The third is `machine_force` of what the motors give.

The driver of the original program does not regard adhesion: at `FULL_EFFORT_N` the motors give, and are
billed, all that the machine can; what the rails do not pass on (2.7) is lost to slip.

The equations stand in `tpss.physics`; here is what is evaluated when.  The voltage is tried several
times a step, so what the speed alone decides is kept with the train (`update_speed_terms`), as is what
no voltage moves (`update_cap_terms`), and the machine is not evaluated within a band of voltages in
which it is proven not to limit the force (`certify_free_band`).
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import fused, inlined, kernel
from tpss.numerics.curve import Points, curve_at
from tpss.physics.locomotive import acceleration, active_power, machine_force, motor_power
from tpss.physics.motor import motor_force
from tpss.physics.reactive_power import (
    ReactiveModel,
    filter_reactive_power,
    power_factor,
    reactive_ratio,
)
from tpss.vehicle.billing import billed_speed, motors_current
from tpss.vehicle.bridge import bridge_ratio
from tpss.vehicle.effort.kinds import effort_by_speed, highest_force, update_effort
from tpss.vehicle.line_current import within_line_current
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

Array = npt.NDArray[np.float64]

FULL_EFFORT_N = 1e9
"""Force cap of a driver who takes whatever the machine gives: more than any machine does. [N]"""


@inlined
def motors_force(
    voltage_v: float, kind: TrainType, demand: Demand, scratch: Array
) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    That at the speed of `demand.terms_speed_m_s`, moved along the tangent over the speed: see
    `follow_speed`.
    """
    network = kind.networks.tractive_effort
    force, slope = highest_force(
        voltage_v, demand.terms_speed_m_s, kind.effort, demand.effort, network, scratch
    )
    return _at_mean_speed(force, demand), _grown(slope, demand)


@inlined
def _at_mean_speed(force_n: float, demand: Demand) -> float:
    """What the motors give at the step\'s mean speed, from what they give close by. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.5) and (2.11), as `follow_speed` solves them.
    """
    if demand.effort_growth == 0.0:  # without arithmetic, so without roundings
        return force_n
    return (force_n + demand.effort_shift_n) * (1.0 + demand.effort_growth)


@inlined
def _grown(slope_n_per_v: float, demand: Demand) -> float:
    """The same of a slope over the voltage. [N/V]

    References
    ----------
    [Boullanger2009]_, as `_at_mean_speed`.
    """
    if demand.effort_growth == 0.0:
        return slope_n_per_v
    return slope_n_per_v * (1.0 + demand.effort_growth)


@inlined
def take_speed_as_it_is(demand: Demand) -> None:
    """Let the motors give what they give at `demand.terms_speed_m_s`."""
    demand.effort_shift_n = demand.effort_growth = 0.0


@inlined
def follow_speed(kind: TrainType, demand: Demand, points: Points) -> None:
    r"""Let the motors give what belongs to the mean speed of the step, whatever force that takes.

    The force is known at a speed v* close by.  With r the rotors' share of the inertia, c/M, a force
    F_m of the motors accelerates by (F_m - F_res) / (M (1 + r)), so the mean speed is linear in it, and

    .. math:: F_m = F_m^* + F' \Big(v + \frac{h}{2} \frac{F_m - F_{res}}{M (1 + r)} - v^*\Big)

    is solved for F_m: a shift and a factor.

    References
    ----------
    [Boullanger2009]_, eq. (2.5) and (2.11).
    """
    slope = effort_by_speed(
        demand.voltage_v, demand.terms_speed_m_s, kind.effort, demand.effort, points
    )
    by_force = demand.mean_speed_weight_s / (kind.inertia_kg + kind.rotor_mass_kg)
    off_m_s = demand.speed_m_s - by_force * demand.resistance_n - demand.terms_speed_m_s
    demand.effort_shift_n = slope * off_m_s
    demand.effort_growth = slope * by_force / (1.0 - slope * by_force)


@inlined
def within_free_band(demand: Demand) -> bool:
    """Whether the voltage has stayed within the band in which the machine does not limit the force."""
    return not 0.0 < demand.free_band_v <= abs(demand.voltage_v - demand.free_voltage_v)


@inlined
def update_power_terms(
    speed_m_s: float, kind: TrainType, demand: Demand, points: Points, scratch: Array
) -> None:
    """Evaluate what makes powers of forces, as far as it depends on the speed alone.

    References
    ----------
    [Boullanger2009]_, eq. (2.14), (2.22), (F.25) and (F.26).
    """
    demand.terms_speed_m_s = demand.speed_m_s = speed_m_s
    efficiency = curve_at(speed_m_s, kind.efficiency.first, kind.efficiency.points, points)
    demand.per_efficiency = 1.0 / efficiency
    if kind.reactive_model == ReactiveModel.POWER_FACTOR:
        factor = power_factor(speed_m_s, kind.networks.power_factor, scratch[0])
        demand.reactive_ratio = reactive_ratio(factor)
    elif kind.reactive_model == ReactiveModel.POWER_FACTOR_CURVE:
        curve = kind.power_factor
        factor = curve_at(speed_m_s, curve.first, curve.points, points)
        demand.reactive_ratio = reactive_ratio(factor)
    demand.sine.reach_8 = 0.0


@kernel
def update_speed_terms(
    speed_m_s: float, kind: TrainType, demand: Demand, points: Points, scratch: Array
) -> None:
    """Evaluate what depends on the speed alone, if the speed has changed since that was done last.

    A train that holds its speed limit has the same speed, to the last digit, step after step.  What
    the machine gives is evaluated anew at the voltage of the last step too, if that has left its band.
    """
    demand.free_voltage_v = demand.voltage_v
    if speed_m_s != demand.terms_speed_m_s:
        update_power_terms(speed_m_s, kind, demand, points, scratch)
        network = kind.networks.tractive_effort
        update_effort(speed_m_s, kind.effort, demand.effort, network, points)
    network = kind.networks.tractive_effort
    demand.free_force_n, _ = highest_force(
        demand.voltage_v, speed_m_s, kind.effort, demand.effort, network, scratch
    )


@inlined
def certify_free_band(kind: TrainType, demand: Demand) -> None:
    """Find how far from `free_voltage_v` the machine cannot be what limits the force.

    The slope of the force is bounded (`update_effort`), so a margin in force is a margin in voltage;
    within it the machine need not be evaluated again, and nothing is approximated.  Of a limit of the
    line current nothing is proven.
    """
    ratio = kind.rotor_mass_kg / kind.inertia_kg
    needed = demand.force_cap_n * (1.0 + ratio) - ratio * demand.resistance_n
    free_n = _at_mean_speed(demand.free_force_n, demand)
    margin = free_n - needed
    if demand.effort.steepest_n_per_v > 0.0:
        demand.free_band_v = margin / _grown(demand.effort.steepest_n_per_v, demand)
    else:  # no voltage changes the force
        demand.free_band_v = math.inf if margin >= 0.0 else -1.0
    if kind.line_current.highest_current_a < math.inf:
        demand.free_band_v = -1.0
    demand.machine_force_n = free_n


@inlined
def wheel_force(
    voltage_v: float, kind: TrainType, demand: Demand, scratch: Array
) -> tuple[float, float]:
    """Force that the motors give at the wheel rim at a voltage, and its slope. [N], [N/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (F.20) and (F.21).
    """
    cap = demand.force_cap_n
    if cap <= 0.0:
        return 0.0, 0.0
    if abs(voltage_v - demand.free_voltage_v) < demand.free_band_v:
        return cap, 0.0
    force, slope = motors_force(voltage_v, kind, demand, scratch)
    demand.machine_force_n = force
    if kind.line_current.highest_current_a < math.inf:
        force, slope = within_line_current(voltage_v, force, slope, kind, demand, scratch)
    if force < 0.0:
        force, slope = 0.0, 0.0
    limit = machine_force(force, demand.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    if limit >= cap:
        return cap, 0.0
    if limit <= 0.0:
        return 0.0, 0.0
    return limit, slope / (1.0 + kind.rotor_mass_kg / kind.inertia_kg)


@fused
def motor_state(
    force_n: float, kind: TrainType, demand: Demand
) -> tuple[float, float, float, float]:
    """Motor force, billed speed, motor power, and the power's slope over the force at the wheel rim.

    The power is the mean over the step, if the motors work for a share of it only.

    References
    ----------
    [Boullanger2009]_, eq. (2.5), (2.12), (F.22) and (F.23a).
    """
    a = acceleration(force_n, demand.resistance_n, kind.inertia_kg)
    motor = motor_force(force_n, a, kind.rotor_mass_kg)
    speed, speed_slope = billed_speed(force_n, kind, demand)
    if force_n <= 0.0 or motor <= 0.0:
        return 0.0, speed, 0.0, 0.0
    slip = kind.slip_factor * demand.driven_share
    by_force = (1.0 + kind.rotor_mass_kg / kind.inertia_kg) * speed + motor * speed_slope
    return motor, speed, motor_power(motor, speed, slip), motor_power(1.0, by_force, slip)


@inlined
def update_cap_terms(kind: TrainType, demand: Demand) -> None:
    """Evaluate power and current of a train at its force cap, which no voltage moves, once a step."""
    motor, speed, power, _ = motor_state(demand.force_cap_n, kind, demand)
    demand.cap_power_w = power
    demand.cap_current_a = motors_current(motor, speed, demand.driven_share, kind, demand)


@inlined
def motor_power_demand(
    force_n: float, slope_n_per_v: float, kind: TrainType, demand: Demand
) -> tuple[float, float]:
    """Motor power at a force, and its slope over the line voltage. [W], [W/V]"""
    if force_n == demand.force_cap_n:
        return demand.cap_power_w, 0.0
    _, _, power, power_slope = motor_state(force_n, kind, demand)
    return power, power_slope * slope_n_per_v


@fused
def armature_demand(
    force_n: float, slope_n_per_v: float, kind: TrainType, demand: Demand
) -> tuple[float, float]:
    """Armature current at a force and full line voltage, and its slope. [A], [A/V]"""
    if force_n == demand.force_cap_n:
        return demand.cap_current_a, 0.0
    motor, _, _, _ = motor_state(force_n, kind, demand)
    speed, speed_slope = billed_speed(force_n, kind, demand)
    current = motors_current(motor, speed, demand.driven_share, kind, demand)
    if current <= 0.0:
        return 0.0, 0.0
    # The current follows the force: by the motor force and, above base speed, by the speed too.
    relative = (1.0 + kind.rotor_mass_kg / kind.inertia_kg) / motor
    if demand.speed_m_s >= kind.base_speed_m_s:
        relative += speed_slope / speed
    return current, current * relative * slope_n_per_v


@inlined
def bridge_demand(
    voltage_v: float, force_n: float, slope_n_per_v: float,
    kind: TrainType, demand: Demand, scratch: Array,
) -> tuple[float, float]:  # fmt: skip
    """Reactive power of the motors by the double-bridge model, and its slope. [var], [var/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.19) and (F.24).
    """
    current, current_slope = armature_demand(force_n, slope_n_per_v, kind, demand)
    if current <= 0.0:
        return 0.0, 0.0
    ratio, ratio_slope = bridge_ratio(voltage_v, kind, demand, scratch)
    return ratio * current, ratio_slope * current + ratio * current_slope


@fused
def electrical_demand(
    voltage_v: float, kind: TrainType, demand: Demand, scratch: Array
) -> tuple[float, float, float, float]:
    r"""Active and reactive power that a train draws at a voltage, and their slopes: P, Q, P', Q'.

    .. math:: P_D = P_{motor} / \eta_{loco} + P_{aux}, \quad Q_D = Q_{motor} + Q_{aux} + Q_f

    Force and powers are noted in the train's `Demand` too.

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    kind : TrainType
    demand : Demand
        Written: force and powers.
    scratch : Array, shape `SCRATCH_SHAPE`

    References
    ----------
    [Boullanger2009]_, eq. (2.20)-(2.24), (F.23b) and (F.24)-(F.28).
    """
    force, slope = wheel_force(voltage_v, kind, demand, scratch)
    power, power_slope = motor_power_demand(force, slope, kind, demand)
    active = active_power(power, demand.per_efficiency, kind.auxiliary_power_w)
    if kind.reactive_model == ReactiveModel.DOUBLE_BRIDGE:
        reactive, reactive_slope = bridge_demand(voltage_v, force, slope, kind, demand, scratch)
    else:
        reactive = power * demand.reactive_ratio
        reactive_slope = power_slope * demand.reactive_ratio
    filtered, filtered_slope = filter_reactive_power(voltage_v, kind.filter_susceptance_s)
    reactive += kind.auxiliary_reactive_power_var + filtered
    reactive_slope += filtered_slope
    demand.wheel_force_n = force
    demand.active_power_w, demand.reactive_power_var = active, reactive
    return active, reactive, power_slope * demand.per_efficiency, reactive_slope


@kernel
def motors_power(kind: TrainType, demand: Demand) -> float:
    """Power of the motors at the voltage last tried, mean over the step. [W]

    References
    ----------
    [Boullanger2009]_, as `motor_state`.
    """
    _, _, power, _ = motor_state(demand.wheel_force_n, kind, demand)
    return power
