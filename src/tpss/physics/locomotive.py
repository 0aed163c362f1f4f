r"""What a train takes from the contact line at a voltage: force, active and reactive power.

Within a step a train's force is the smallest of what the driver wants, what adhesion allows and what
the machine gives at the voltage of its pantograph (F.20, F.21).  The first two do not depend on the
voltage: they are its `force_cap_n`.  The third follows from eq. (2.5) and (2.11), both linear in the
acceleration that belongs to the force,

.. math:: F = F_{max}(U) - c a, \; a = (F - F_{res}) / M
          \;\Rightarrow\; F = \frac{F_{max}(U) + c F_{res} / M}{1 + c / M},

with c = 4 K_J (κ + 1) the inertia of the rotors and M that of the train.

The driver of the original program does not heed adhesion: at `FULL_EFFORT_N` the motors give, and are
billed, all that the machine can; what the rails do not pass on (2.7) is lost to slip.

Trains are records: `TRAIN_TYPE` holds what its owner states, `DEMAND` what stays fixed while a step
is solved.  A record is one pointer to compiled code, however many fields it has.
"""

import math
from typing import Any

import numpy as np

from tpss.kernel import fused, inlined, kernel
from tpss.physics.bridge import bridge_ratio
from tpss.physics.current_limit import within_line_current
from tpss.physics.curve import CURVE, Points, curve_at
from tpss.physics.effort_table import MOST_VOLTAGES
from tpss.physics.machine import highest_force, take_effort
from tpss.physics.motor import armature_current, motor_force
from tpss.physics.neural_network import NETWORK
from tpss.physics.reactive_power import (
    DOUBLE_BRIDGE,
    POWER_FACTOR,
    POWER_FACTOR_CURVE,
    filter_reactive_power,
    power_factor,
    reactive_ratio,
)
from tpss.physics.series import ROOM, SERIES

FULL_EFFORT_N = 1e9
"""Force cap of a driver who takes whatever the machine gives: more than any machine does. [N]"""

MACHINE = np.dtype(
    (
        np.record,
        [
            ("tractive_effort", NETWORK),
            ("bridge_sine", NETWORK),
            ("power_factor", NETWORK),
            ("room", float, ROOM),
        ],
    ),
)
"""The three networks that describe a locomotive's machine, and the room in which they are evaluated."""

TRAIN_TYPE = np.dtype(
    [
        ("mass_kg", float),
        ("adhesive_mass_kg", float),
        ("inertia_kg", float),  # M = m_adh + (m - m_adh)(1 + H), eq. (2.11)
        ("coasting_inertia_kg", float),  # m (1 + H), eq. (2.11), for the original driver
        ("rotor_mass_kg", float),  # c = 4 K_J (κ + 1)
        ("slip_factor", float),  # κ + 1
        ("resistance_a_n", float),
        ("resistance_b_n_s_per_m", float),
        ("resistance_c_n_s2_per_m2", float),
        ("effort_model", np.int64),
        ("highest_current_a", float),  # of one motor, for the network
        ("effort", CURVE),  # the first row of a table; the others follow
        ("effort_rows", np.int64),
        ("effort_voltage_v", float, (MOST_VOLTAGES,)),  # of the rows
        ("highest_force_n", float),  # the limits, of all motors
        ("highest_power_w", float),
        ("limit_speed_m_s", float),  # infinite without a pull-out limit
        ("zero_voltage_v", float),
        ("full_voltage_v", float),
        ("highest_line_current_a", float),  # infinite without a limit; the next three belong to it
        ("auxiliary_current_a", float),
        ("no_traction_voltage_v", float),
        ("full_current_voltage_v", float),
        ("highest_acceleration_m_s2", float),  # infinite without such a limit
        ("highest_retardation_m_s2", float),
        ("highest_speed_m_s", float),
        ("efficiency", CURVE),
        ("power_factor", CURVE),
        ("auxiliary_power_w", float),
        ("auxiliary_reactive_power_var", float),
        ("base_speed_m_s", float),  # NaN, as the next, where the motors' voltage is not known
        ("highest_motor_voltage_v", float),
        ("filter_reactance_ohm", float),  # infinite without a filter
        ("reactive_model", np.int64),
        ("voltage_model", np.int64),
        ("current_model", np.int64),
    ],
    align=True,
)
"""A kind of train, in SI units."""

DEMAND = np.dtype(
    [
        ("force_cap_n", float),  # wanted force or adhesion limit, the smaller; 0 with motors off
        ("adhesion_n", float),  # force that the rails pass on at most
        ("resistance_n", float),
        ("speed_m_s", float),  # at the start of the step
        ("mean_speed_weight_s", float),  # h/2 to bill the step's mean speed, 0 for its start's
        ("driven_share", float),  # share of the step in which the motors give the force, mostly 1
        ("per_efficiency", float),  # 1 / η
        ("reactive_ratio", float),  # Q over P of the motors, by the power factor
        ("taken_speed_m_s", float),  # speed to which all that `take_speed` writes belongs
        ("free_voltage_v", float),  # voltage around which the machine does not limit the force
        ("free_force_n", float),  # what the machine gives there
        ("free_band_v", float),  # how far from it that is proven; negative: nowhere
        ("steepest_n_per_v", float),  # bound of the slope of the machine's force over voltage
        ("cap_power_w", float),  # of the motors at the force cap
        ("cap_current_a", float),
        ("wheel_force_n", float),  # what the motors give at the voltage last tried
        ("active_power_w", float),  # and what the train draws
        ("reactive_power_var", float),
        ("machine_force_n", float),  # of all motors at most, before clipping
        ("bridge_sine", float),  # β, before clipping
        ("sine", SERIES),  # the bridge network over the locomotive's voltage [1], [V]
        ("effort", SERIES),  # the tractive-effort network over the line voltage [N], [V]
        ("row_force_n", float, (MOST_VOLTAGES,)),  # of a table's rows, or by limits the first
        ("row_slope_n_per_v", float, (MOST_VOLTAGES,)),
    ],
    align=True,
)
"""What fixes a train's demand over voltage during one step."""

TrainType = Any
"""A record with the fields of `TRAIN_TYPE`."""

Demand = Any
"""A record with the fields of `DEMAND`, perhaps among others."""

Machine = Any
"""A record of `MACHINE`."""


@inlined
def machine_force(
    motor_force_n: float, resistance_n: float, rotor_mass_kg: float, inertia_kg: float
) -> float:
    """Force at the wheel rim when the motors give `motor_force_n`, acceleration solved for. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.5), (2.11), (F.19) and (F.22).
    """
    ratio = rotor_mass_kg / inertia_kg
    return (motor_force_n + ratio * resistance_n) / (1.0 + ratio)


@fused
def acceleration(force_n: float, resistance_n: float, inertia_kg: float) -> float:
    """Acceleration of a driving train. [m/s²]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    return (force_n - resistance_n) / inertia_kg


@inlined
def speed_is_taken(voltage_v: float, train: Demand) -> bool:
    """Whether `take_speed` has nothing to do: the speed is the same, the voltage within its band."""
    if train.speed_m_s != train.taken_speed_m_s:
        return False
    return not 0.0 < train.free_band_v <= abs(voltage_v - train.free_voltage_v)


@kernel
def take_speed(
    voltage_v: float, kind: TrainType, train: Demand, machine: Machine, points: Points
) -> None:
    """Evaluate what depends on the speed alone, if the speed has changed since that was done last.

    A train that holds its speed limit has the same speed, to the last digit, step after step.  What
    the machine gives is evaluated anew at `voltage_v` too, if that has left the band of the last step.
    """
    if speed_is_taken(voltage_v, train):
        return
    train.free_voltage_v = voltage_v
    if train.speed_m_s == train.taken_speed_m_s:
        train.free_force_n, _ = highest_force(voltage_v, kind, train, machine)
        return
    speed = train.taken_speed_m_s = train.speed_m_s
    efficiency = curve_at(speed, kind.efficiency.first, kind.efficiency.points, points)
    train.per_efficiency = 1.0 / efficiency
    if kind.reactive_model == POWER_FACTOR:
        factor = power_factor(speed, machine.power_factor, machine.room[0])
        train.reactive_ratio = reactive_ratio(factor)
    elif kind.reactive_model == POWER_FACTOR_CURVE:
        factor = curve_at(speed, kind.power_factor.first, kind.power_factor.points, points)
        train.reactive_ratio = reactive_ratio(factor)
    train.sine.reach_8 = 0.0
    take_effort(kind, train, machine, points)
    train.free_force_n, _ = highest_force(voltage_v, kind, train, machine)


@inlined
def prove_free_band(kind: TrainType, train: Demand) -> None:
    """Find how far from `free_voltage_v` the machine cannot be what limits the force.

    The slope of the force is bounded (`take_effort`), so a margin in force is a margin in voltage;
    within it the machine need not be evaluated again, and nothing is approximated.  Of a limit of the
    line current nothing is proven.
    """
    ratio = kind.rotor_mass_kg / kind.inertia_kg
    needed = train.force_cap_n * (1.0 + ratio) - ratio * train.resistance_n
    margin = train.free_force_n - needed
    if train.steepest_n_per_v > 0.0:
        train.free_band_v = margin / train.steepest_n_per_v
    else:  # no voltage changes the force
        train.free_band_v = math.inf if margin >= 0.0 else -1.0
    if kind.highest_line_current_a < math.inf:
        train.free_band_v = -1.0
    train.machine_force_n = train.free_force_n


@fused
def wheel_force(
    voltage_v: float, kind: TrainType, train: Demand, machine: Machine
) -> tuple[float, float]:
    """Force that the motors give at the wheel rim at a voltage, and its slope. [N], [N/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (F.20) and (F.21).
    """
    cap = train.force_cap_n
    if cap <= 0.0:
        return 0.0, 0.0
    if abs(voltage_v - train.free_voltage_v) < train.free_band_v:
        return cap, 0.0
    force, slope = highest_force(voltage_v, kind, train, machine)
    train.machine_force_n = force
    if kind.highest_line_current_a < math.inf:
        force, slope = within_line_current(voltage_v, force, slope, kind, train, machine)
    if force < 0.0:
        force, slope = 0.0, 0.0
    limit = machine_force(force, train.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    if limit >= cap:
        return cap, 0.0
    if limit <= 0.0:
        return 0.0, 0.0
    return limit, slope / (1.0 + kind.rotor_mass_kg / kind.inertia_kg)


@fused
def billed_speed(force_n: float, kind: TrainType, train: Demand) -> tuple[float, float]:
    """Speed with which motor power is billed, and its slope over the force. [m/s], [m/s/N]

    It is that at the start of the step (the thesis) or the step's mean, v + a h/2, with which
    traction work, resistance, climb and kinetic energy balance.  A force beyond adhesion accelerates
    no more than adhesion does.

    Parameters
    ----------
    force_n : float
        What the motors give at the wheel rim. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.7) and (2.11).
    """
    weight = train.mean_speed_weight_s
    a = acceleration(min(force_n, train.adhesion_n), train.resistance_n, kind.inertia_kg)
    slope = weight / kind.inertia_kg if force_n <= train.adhesion_n else 0.0
    return max(0.0, train.speed_m_s + weight * a), slope


@fused
def motor_state(
    force_n: float, kind: TrainType, train: Demand
) -> tuple[float, float, float, float]:
    r"""Motor force, billed speed, motor power, and the power's slope over the force at the wheel rim.

    .. math:: P_{motor} = F_{motor} \, v \, (\kappa + 1)

    The power is the mean over the step, if the motors work for a share of it only.

    References
    ----------
    [Boullanger2009]_, eq. (2.12) and (F.23a).
    """
    a = acceleration(force_n, train.resistance_n, kind.inertia_kg)
    motor = motor_force(force_n, a, kind.rotor_mass_kg)
    speed, speed_slope = billed_speed(force_n, kind, train)
    if force_n <= 0.0 or motor <= 0.0:
        return 0.0, speed, 0.0, 0.0
    slip = kind.slip_factor * train.driven_share
    slope = slip * ((1.0 + kind.rotor_mass_kg / kind.inertia_kg) * speed + motor * speed_slope)
    return motor, speed, motor * speed * slip, slope


@kernel
def train_armature_current(
    motor_force_n: float, speed_m_s: float, kind: TrainType, train: Demand
) -> float:
    """Sum of the four motors' currents at full line voltage, mean of the step. [A]

    See `armature_current`.
    """
    return armature_current(
        motor_force_n,
        kind.slip_factor * train.driven_share,
        speed_m_s,
        kind.base_speed_m_s,
        kind.highest_motor_voltage_v,
        train.speed_m_s < kind.base_speed_m_s,
    )


@inlined
def note_cap(kind: TrainType, train: Demand) -> None:
    """Evaluate power and current of a train at its force cap, which no voltage moves, once a step."""
    motor, speed, power, _ = motor_state(train.force_cap_n, kind, train)
    train.cap_power_w = power
    train.cap_current_a = train_armature_current(motor, speed, kind, train)


@inlined
def motor_power_demand(
    force_n: float, slope_n_per_v: float, kind: TrainType, train: Demand
) -> tuple[float, float]:
    """Motor power at a force, and its slope over the line voltage. [W], [W/V]"""
    if force_n == train.force_cap_n:
        return train.cap_power_w, 0.0
    _, _, power, power_slope = motor_state(force_n, kind, train)
    return power, power_slope * slope_n_per_v


@fused
def armature_demand(
    force_n: float, slope_n_per_v: float, kind: TrainType, train: Demand
) -> tuple[float, float]:
    """Armature current at a force and full line voltage, and its slope. [A], [A/V]"""
    if force_n == train.force_cap_n:
        return train.cap_current_a, 0.0
    motor, _, _, _ = motor_state(force_n, kind, train)
    speed, speed_slope = billed_speed(force_n, kind, train)
    current = train_armature_current(motor, speed, kind, train)
    if current <= 0.0:
        return 0.0, 0.0
    # The current follows the force: by the motor force and, above base speed, by the speed too.
    relative = (1.0 + kind.rotor_mass_kg / kind.inertia_kg) / motor
    if train.speed_m_s >= kind.base_speed_m_s:
        relative += speed_slope / speed
    return current, current * relative * slope_n_per_v


@fused
def bridge_demand(
    voltage_v: float, force_n: float, slope_n_per_v: float,
    kind: TrainType, train: Demand, machine: Machine,
) -> tuple[float, float]:  # fmt: skip
    """Reactive power of the motors by the double-bridge model, and its slope. [var], [var/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.19) and (F.24).
    """
    current, current_slope = armature_demand(force_n, slope_n_per_v, kind, train)
    if current <= 0.0:
        return 0.0, 0.0
    ratio, ratio_slope = bridge_ratio(voltage_v, kind, train, machine)
    return ratio * current, ratio_slope * current + ratio * current_slope


@fused
def electrical_demand(
    voltage_v: float, kind: TrainType, train: Demand, machine: Machine
) -> tuple[float, float, float, float]:
    r"""Active and reactive power that a train draws at a voltage, and their slopes: P, Q, P', Q'.

    .. math:: P_D = P_{motor} / \eta_{loco} + P_{aux}, \quad Q_D = Q_{motor} + Q_{aux} + Q_f

    Force and powers are noted in the train's record too.

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]

    References
    ----------
    [Boullanger2009]_, eq. (2.13), (2.14), (2.20)-(2.24), (F.23b) and (F.24)-(F.28).
    """
    force, slope = wheel_force(voltage_v, kind, train, machine)
    power, power_slope = motor_power_demand(force, slope, kind, train)
    active = power * train.per_efficiency + kind.auxiliary_power_w
    if kind.reactive_model == DOUBLE_BRIDGE:
        reactive, reactive_slope = bridge_demand(voltage_v, force, slope, kind, train, machine)
    else:
        reactive = power * train.reactive_ratio
        reactive_slope = power_slope * train.reactive_ratio
    filtered, filtered_slope = filter_reactive_power(voltage_v, kind.filter_reactance_ohm)
    reactive += kind.auxiliary_reactive_power_var + filtered
    reactive_slope += filtered_slope
    train.wheel_force_n = force
    train.active_power_w, train.reactive_power_var = active, reactive
    return active, reactive, power_slope * train.per_efficiency, reactive_slope
