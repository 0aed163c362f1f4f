"""What a train gives and takes in a phase of constant acceleration, at the phase's mean speed.

The equations are those of `vehicle.demand`.  There the speed stays and the voltage is tried again and
again; here speed and voltage are new each time, and nothing is kept.
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points
from tpss.physics.motor import MotorModel, line_voltage_factor, motor_current
from tpss.physics.reactive_power import filter_reactive_power
from tpss.vehicle.breaches import find_breaches
from tpss.vehicle.demand import (
    armature_demand,
    electrical_demand,
    take_speed_as_it_is,
    update_cap_terms,
    update_speed_terms,
    wheel_force,
)
from tpss.vehicle.effort.kinds import update_effort
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

Array = npt.NDArray[np.float64]


@inlined
def _settle(
    speed_m_s: float, resistance_n: float, cap_n: float, kind: TrainType, demand: Demand
) -> None:
    """Let the demand be that of a phase: all of it at its mean speed, nothing known of the machine."""
    demand.speed_m_s = speed_m_s
    demand.mean_speed_weight_s = 0.0
    demand.driven_share = 1.0
    demand.resistance_n = resistance_n
    demand.force_cap_n = cap_n
    demand.free_band_v = -1.0
    take_speed_as_it_is(demand)


@kernel
def force_of_phase(
    voltage_v: float, speed_m_s: float, resistance_n: float, cap_n: float,
    kind: TrainType, demand: Demand, points: Points, scratch: Array,
) -> float:  # fmt: skip
    """Force at the wheel rim that the motors give at a line voltage and a speed. [N]

    Parameters
    ----------
    voltage_v, speed_m_s : float
        Voltage at the pantograph [V], mean speed of the phase [m/s].
    resistance_n, cap_n : float
        Running resistance and gradient force; what driver and adhesion allow. [N]
    """
    _settle(speed_m_s, resistance_n, cap_n, kind, demand)
    if kind.line_current.highest_current_a < math.inf:
        demand.terms_speed_m_s = -1.0
        update_speed_terms(speed_m_s, kind, demand, points, scratch)
    else:
        demand.terms_speed_m_s = speed_m_s
        network = kind.networks.tractive_effort
        update_effort(speed_m_s, kind.effort, demand.effort, network, points)
    force, _ = wheel_force(voltage_v, kind, demand, scratch)
    return force


@kernel
def demand_of_phase(
    voltage_v: float, speed_m_s: float, resistance_n: float, cap_n: float,
    kind: TrainType, demand: Demand, points: Points, scratch: Array,
) -> tuple[float, float, float, float, float, float, int]:  # fmt: skip
    """Active and reactive power, their slopes over the voltage, the motors' power and current.

    [W], [var], [W/V], [var/V], [W], [A]; last, the breaches as bits.  Parameters are those of `force_of_phase`.

    References
    ----------
    [Boullanger2009]_, eq. (2.14), solved for the motors' power, and (2.18).
    """
    _settle(speed_m_s, resistance_n, cap_n, kind, demand)
    demand.terms_speed_m_s = -1.0
    update_speed_terms(speed_m_s, kind, demand, points, scratch)
    update_cap_terms(kind, demand)
    active, reactive, active_slope, reactive_slope = electrical_demand(
        voltage_v, kind, demand, scratch
    )
    motor_w = (active - kind.auxiliary_power_w) / demand.per_efficiency
    current, _ = armature_demand(demand.wheel_force_n, 0.0, kind, demand)
    if kind.voltage_model != MotorModel.NEW:
        current /= line_voltage_factor(voltage_v, kind.voltage_model)
    motor_a = motor_current(current, kind.current_model)
    breaches = 0
    if cap_n > 0.0:
        breaches = find_breaches(demand.wheel_force_n, voltage_v, kind, demand, points)
    return active, reactive, active_slope, reactive_slope, motor_w, motor_a, breaches


@inlined
def demand_standing(voltage_v: float, kind: TrainType) -> tuple[float, float, float]:
    """Active and reactive power of a train that stands, and the latter's slope. [W], [var], [var/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.20), (2.22) and (2.23).
    """
    filtered, slope = filter_reactive_power(voltage_v, kind.filter_susceptance_s)
    return kind.auxiliary_power_w, kind.auxiliary_reactive_power_var + filtered, slope
