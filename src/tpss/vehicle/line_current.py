r"""Current limitation of a train at low voltage: what it leaves for the motors.

.. math::

    I_{lim}(U) = \begin{cases}
        I_{max} & U \ge a U_n \\
        I_{aux} + (I_{max} - I_{aux}) \dfrac{U - U_{min2}}{a U_n - U_{min2}}
            & U_{min2} < U < a U_n \\
        I_{aux},\ \text{without traction} & U \le U_{min2}
    \end{cases}

I_aux is the current of the auxiliaries at U_min2, or, where their power is given, S_aux / U at each
voltage.  The largest force m of the motors is the root of

.. math:: P(m)^2 + Q(m, U)^2 = (U I_{lim}(U))^2

with P and Q of motors and auxiliaries.  Both grow with m, so there is one root; it is found by Newton's
method within bounds, from where the machine would go, and its slope over the voltage by the derivatives
of both sides.

Limits of validity: the filter of a locomotive is left out; it is capacitive, so at traction the
current at the pantograph is lower than the one that is limited.  Auxiliaries are never shed: with
motors off, they draw what they need.
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.ramp import ramp
from tpss.physics.locomotive import active_power
from tpss.physics.reactive_power import ReactiveModel
from tpss.vehicle.at_load import follow_load
from tpss.vehicle.billing import billed_power, motors_current
from tpss.vehicle.bridge import bridge_ratio
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import LineCurrentLimit, TrainType

Array = npt.NDArray[np.float64]

MOST_HALVINGS = 60
"""More than the digits of a number: bisection alone would end within them."""


@inlined
def highest_line_current(voltage_v: float, limit: LineCurrentLimit) -> tuple[float, float]:
    """Current that a train may draw at a voltage at most, and its slope. [A], [A/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    limit : LineCurrentLimit

    References
    ----------
    [EN50388]_, current limitation of trains at low voltage.
    """
    if limit.auxiliary_power_va > 0.0:
        return beside_auxiliary_power(voltage_v, limit)
    return ramp(
        voltage_v, limit.no_traction_voltage_v, limit.full_current_voltage_v,
        limit.auxiliary_current_a, limit.highest_current_a,
    )  # fmt: skip


@kernel
def beside_auxiliary_power(voltage_v: float, limit: LineCurrentLimit) -> tuple[float, float]:
    r"""`highest_line_current` whose lower end is what the auxiliaries' power takes at the voltage.

    [A], [A/V]

    .. math:: I = f I_{max} + (1 - f) \frac{S_{aux}}{U}, \qquad f = \frac{U - U_{min2}}{a U_n - U_{min2}}

    with f from 0 to 1.

    Parameters are those of `highest_line_current`; the voltage is positive.

    References
    ----------
    [EN50388]_, current limitation of trains at low voltage.
    """
    share, share_slope = ramp(
        voltage_v, limit.no_traction_voltage_v, limit.full_current_voltage_v, 0.0, 1.0
    )
    auxiliary_a = limit.auxiliary_power_va / voltage_v
    current = share * limit.highest_current_a + (1.0 - share) * auxiliary_a
    by_share = (limit.highest_current_a - auxiliary_a) * share_slope
    return current, by_share - (1.0 - share) * auxiliary_a / voltage_v


@kernel
def _apparent_power(
    motor_force_n: float, bridge_var_per_a: float, kind: TrainType, demand: Demand
) -> tuple[float, float, float]:
    """Square of the apparent power of motors and auxiliaries [VA²], its slope over the motors' force,
    and over the reactive power that bridges draw for each ampere.

    References
    ----------
    [Boullanger2009]_, eq. (2.19), (2.21) and (2.22).
    """
    power, power_slope, speed, speed_slope = billed_power(motor_force_n, 1.0, kind, demand)
    active = active_power(power, demand.per_efficiency, kind.auxiliary_power_w)
    active_slope = active_power(power_slope, demand.per_efficiency, 0.0)
    if kind.over_load.count > 0:
        active, active_slope = follow_load(active, active_slope, 1.0, kind, demand)
    current_a = 0.0
    if kind.reactive_model == ReactiveModel.DOUBLE_BRIDGE:
        # The current is linear in the force and, above base speed, in the speed.
        current_a = motors_current(motor_force_n, speed, 1.0, kind, demand)
        current_slope = motors_current(1.0, speed, 1.0, kind, demand)
        if demand.speed_m_s >= kind.base_speed_m_s:
            current_slope += motors_current(motor_force_n, speed_slope, 1.0, kind, demand)
        reactive = bridge_var_per_a * current_a
        reactive_slope = bridge_var_per_a * current_slope
    else:
        reactive = power * demand.reactive_ratio
        reactive_slope = power_slope * demand.reactive_ratio
    reactive += kind.auxiliary_reactive_power_var
    slope = 2.0 * (active * active_slope + reactive * reactive_slope)
    return active * active + reactive * reactive, slope, 2.0 * reactive * current_a


@kernel
def within_line_current(
    voltage_v: float,
    force_n: float,
    slope_n_per_v: float,
    kind: TrainType,
    demand: Demand,
    scratch: Array,
) -> tuple[float, float]:
    """Largest force of all motors that keeps to the train's current limit, and its slope. [N], [N/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    force_n, slope_n_per_v : float
        Force that the machine gives, and its slope over the voltage; returned if the current allows it.
    kind, demand, scratch
        As in `electrical_demand`.

    References
    ----------
    [EN50388]_, current limitation of trains at low voltage.
    """
    if force_n <= 0.0:
        return force_n, slope_n_per_v
    if voltage_v <= kind.line_current.no_traction_voltage_v:
        return 0.0, 0.0
    current, current_slope = highest_line_current(voltage_v, kind.line_current)
    allowed = (voltage_v * current) ** 2
    ratio, ratio_slope = 0.0, 0.0
    if kind.reactive_model == ReactiveModel.DOUBLE_BRIDGE:
        ratio, ratio_slope = bridge_ratio(voltage_v, kind, demand, scratch)
    square, slope, by_ratio = _apparent_power(force_n, ratio, kind, demand)
    if square <= allowed:
        return force_n, slope_n_per_v
    if _apparent_power(0.0, ratio, kind, demand)[0] >= allowed:
        return 0.0, 0.0
    low, high, motor = 0.0, force_n, force_n
    for _ in range(MOST_HALVINGS):
        before = motor
        motor -= (square - allowed) / slope if slope > 0.0 else math.inf
        if not low <= motor <= high:
            motor = 0.5 * (low + high)
        square, slope, by_ratio = _apparent_power(motor, ratio, kind, demand)
        if square > allowed:
            high = motor
        else:
            low = motor
        if abs(motor - before) <= 1e-14 * force_n:
            break
    by_voltage = 2.0 * voltage_v * current * (current + voltage_v * current_slope)
    return motor, (by_voltage - by_ratio * ratio_slope) / slope
