r"""Current limitation of a train at low voltage: what it leaves for the motors.

.. math::

    I_{lim}(U) = \begin{cases}
        I_{max} & U \ge a U_n \\
        I_{aux} + (I_{max} - I_{aux}) \dfrac{U - U_{min2}}{a U_n - U_{min2}}
            & U_{min2} < U < a U_n \\
        I_{aux},\ \text{without traction} & U \le U_{min2}
    \end{cases}

I_aux is the current of the auxiliaries at U_min2.  The largest force m of the motors is the root of

.. math:: P(m)^2 + Q(m, U)^2 = (U I_{lim}(U))^2

with P and Q of motors and auxiliaries.  Both grow with m, so there is one root; it is found by Newton's
method within bounds, from where the machine would go, and its slope over the voltage by the derivatives
of both sides.

Limits of validity: the filter of a locomotive is left out; it is capacitive, so at traction the
current at the pantograph is lower than the one that is limited.  Auxiliaries are never shed: with
motors off, they draw what they need.
"""

import math
from typing import Any

from tpss.kernel import inlined, kernel
from tpss.physics.bridge import bridge_ratio
from tpss.physics.reactive_power import DOUBLE_BRIDGE

MOST_HALVINGS = 60
"""More than the digits of a number: bisection alone would end within them."""


@inlined
def highest_line_current(voltage_v: float, kind: Any) -> tuple[float, float]:
    """Current that a train may draw at a voltage at most, and its slope. [A], [A/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    kind : record of `TRAIN_TYPE`

    References
    ----------
    [EN50388]_, current limitation of trains at low voltage.
    """
    low_v, full_v = kind.no_traction_voltage_v, kind.full_current_voltage_v
    if voltage_v >= full_v:
        return kind.highest_line_current_a, 0.0
    if voltage_v <= low_v:
        return kind.auxiliary_current_a, 0.0
    slope = (kind.highest_line_current_a - kind.auxiliary_current_a) / (full_v - low_v)
    return kind.auxiliary_current_a + slope * (voltage_v - low_v), slope


@inlined
def motor_power(motor_force_n: float, kind: Any, train: Any) -> tuple[float, float, float, float]:
    """Motor power, its slope, the billed speed, and its slope, over the motors' force.

    [W], [W/N], [m/s], [m/s/N]

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (2.11) and (2.12).
    """
    weight, resistance_n = train.mean_speed_weight_s, train.resistance_n
    inertia_kg = kind.inertia_kg + kind.rotor_mass_kg
    a, a_slope = (motor_force_n - resistance_n) / inertia_kg, 1.0 / inertia_kg
    grip = (train.adhesion_n - resistance_n) / kind.inertia_kg
    if a > grip:
        a, a_slope = grip, 0.0
    speed, speed_slope = train.speed_m_s + weight * a, weight * a_slope
    if speed <= 0.0:
        speed, speed_slope = 0.0, 0.0
    slip = kind.slip_factor
    power_slope = slip * (speed + motor_force_n * speed_slope)
    return slip * motor_force_n * speed, power_slope, speed, speed_slope


@kernel
def _apparent_power(
    motor_force_n: float, bridge_var_per_a: float, kind: Any, train: Any
) -> tuple[float, float, float]:
    """Square of the apparent power of motors and auxiliaries [VA²], its slope over the motors' force,
    and over the reactive power that bridges draw for each ampere.

    References
    ----------
    [Boullanger2009]_, eq. (2.13), (2.17), (2.19), (2.21) and (2.22).
    """
    power, power_slope, speed, speed_slope = motor_power(motor_force_n, kind, train)
    active = power * train.per_efficiency + kind.auxiliary_power_w
    active_slope = power_slope * train.per_efficiency
    current_a = 0.0
    if kind.reactive_model == DOUBLE_BRIDGE:
        if train.speed_m_s < kind.base_speed_m_s:
            speed, speed_slope = kind.base_speed_m_s, 0.0
        per_force = kind.slip_factor / kind.highest_motor_voltage_v
        current_a = per_force * motor_force_n * speed
        reactive = bridge_var_per_a * current_a
        reactive_slope = bridge_var_per_a * per_force * (speed + motor_force_n * speed_slope)
    else:
        reactive = power * train.reactive_ratio
        reactive_slope = power_slope * train.reactive_ratio
    reactive += kind.auxiliary_reactive_power_var
    slope = 2.0 * (active * active_slope + reactive * reactive_slope)
    return active * active + reactive * reactive, slope, 2.0 * reactive * current_a


@kernel
def within_line_current(
    voltage_v: float, force_n: float, slope_n_per_v: float, kind: Any, train: Any, machine: Any
) -> tuple[float, float]:
    """Largest force of all motors that keeps to the train's current limit, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    force_n, slope_n_per_v : float
        Force that the machine gives, and its slope over the voltage; returned if the current allows it.
    kind, train, machine : records
        As in `tpss.physics.locomotive`.

    References
    ----------
    [EN50388]_, current limitation of trains at low voltage.
    """
    if force_n <= 0.0:
        return force_n, slope_n_per_v
    if voltage_v <= kind.no_traction_voltage_v:
        return 0.0, 0.0
    current, current_slope = highest_line_current(voltage_v, kind)
    allowed = (voltage_v * current) ** 2
    ratio, ratio_slope = 0.0, 0.0
    if kind.reactive_model == DOUBLE_BRIDGE:
        ratio, ratio_slope = bridge_ratio(voltage_v, kind, train, machine)
    square, slope, by_ratio = _apparent_power(force_n, ratio, kind, train)
    if square <= allowed:
        return force_n, slope_n_per_v
    if _apparent_power(0.0, ratio, kind, train)[0] >= allowed:
        return 0.0, 0.0
    low, high, motor = 0.0, force_n, force_n
    for _ in range(MOST_HALVINGS):
        before = motor
        motor -= (square - allowed) / slope if slope > 0.0 else math.inf
        if not low <= motor <= high:
            motor = 0.5 * (low + high)
        square, slope, by_ratio = _apparent_power(motor, ratio, kind, train)
        if square > allowed:
            high = motor
        else:
            low = motor
        if abs(motor - before) <= 1e-14 * force_n:
            break
    by_voltage = 2.0 * voltage_v * current * (current + voltage_v * current_slope)
    return motor, (by_voltage - by_ratio * ratio_slope) / slope
