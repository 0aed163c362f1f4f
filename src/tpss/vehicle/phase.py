"""What a train gives and takes in a phase of constant acceleration, at the phase's mean speed.

The equations are those of `vehicle.demand`.  There the speed stays and the voltage is tried again and
again; here speed and voltage are new each time, and nothing is kept: first the force is found, then the
powers that belong to it.
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points
from tpss.physics.locomotive import machine_force
from tpss.physics.motor import MotorModel, line_voltage_factor, motor_current
from tpss.physics.reactive_power import filter_reactive_power
from tpss.vehicle.at_load import follow_load
from tpss.vehicle.breaches import find_breaches
from tpss.vehicle.demand import (
    armature_demand,
    electrical_demand,
    take_speed_as_it_is,
    update_cap_terms,
    update_power_terms,
)
from tpss.vehicle.effort.kinds import effort_at, follows_voltage
from tpss.vehicle.line_current import within_line_current
from tpss.vehicle.on_board import within_own_power
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

Array = npt.NDArray[np.float64]


@inlined
def _settle(speed_m_s: float, resistance_n: float, demand: Demand) -> None:
    """Let the demand be that of a phase: all of it at its mean speed."""
    demand.speed_m_s = speed_m_s
    demand.mean_speed_weight_s = 0.0
    demand.driven_share = 1.0
    demand.resistance_n = resistance_n
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
        Running resistance and gradient force; what driver and adhesion allow, positive. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (F.20) and (F.21).
    """
    if voltage_v <= 0.0:
        return 0.0
    _settle(speed_m_s, resistance_n, demand)
    network = kind.networks.tractive_effort
    force = effort_at(voltage_v, speed_m_s, kind.effort, demand.effort, network, points, scratch)
    demand.machine_force_n = force
    if kind.line_current.highest_current_a < math.inf:
        update_power_terms(speed_m_s, kind, demand, points, scratch)
        force, _ = within_line_current(voltage_v, force, 0.0, kind, demand, scratch)
    if demand.store_only_w > 0.0:
        force = within_own_power(force, speed_m_s, kind, demand, points, scratch)
    limit = machine_force(max(0.0, force), resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    return min(cap_n, max(0.0, limit))


@inlined
def voltage_decides(force_n: float, cap_n: float, kind: TrainType, demand: Demand) -> bool:
    """Whether the force of a phase is one that the line voltage decides about."""
    limited = kind.line_current.highest_current_a < math.inf
    return force_n < cap_n and (limited or follows_voltage(kind.effort, demand.effort))


@kernel
def demand_of_phase(
    voltage_v: float, speed_m_s: float, resistance_n: float, force_n: float, cap_n: float,
    kind: TrainType, demand: Demand, points: Points, scratch: Array,
) -> tuple[float, float, float, float, float, int]:  # fmt: skip
    """Active and reactive power, slope of the latter, the motors' power and current, breaches.

    [W], [var], [var/V], [W], [A], and a bit each `Breach`.  The slope is that at a fixed force.

    Parameters
    ----------
    force_n : float
        From `force_of_phase`; the other parameters are those of it. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.14), solved for the motors' power, and (2.18).
    """
    if voltage_v <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0
    _settle(speed_m_s, resistance_n, demand)
    # The force is known: the machine is not asked once more.
    demand.force_cap_n = force_n
    demand.free_voltage_v, demand.free_band_v = voltage_v, math.inf
    update_power_terms(speed_m_s, kind, demand, points, scratch)
    update_cap_terms(kind, demand)
    active, reactive, _, reactive_slope = electrical_demand(voltage_v, kind, demand, scratch)
    motor_w = (active - kind.auxiliary_power_w) / demand.per_efficiency
    if kind.over_load.count > 0:
        active, _ = follow_load(active, 0.0, 1.0, kind, demand)
    current, _ = armature_demand(force_n, 0.0, kind, demand)
    if kind.voltage_model != MotorModel.NEW:
        current /= line_voltage_factor(voltage_v, kind.voltage_model)
    motor_a = motor_current(current, kind.current_model)
    breaches = 0
    if cap_n > 0.0:
        demand.force_cap_n = cap_n
        breaches = find_breaches(force_n, voltage_v, kind, demand, points)
    return active, reactive, reactive_slope, motor_w, motor_a, breaches


@inlined
def demand_standing(voltage_v: float, kind: TrainType) -> tuple[float, float, float]:
    """Active and reactive power of a train that stands, and the latter's slope. [W], [var], [var/V]

    References
    ----------
    [Boullanger2009]_, eq. (2.20) and (2.21).
    """
    if voltage_v <= 0.0:
        return 0.0, 0.0, 0.0
    filtered, slope = filter_reactive_power(voltage_v, kind.filter_susceptance_s)
    return kind.auxiliary_power_w, kind.auxiliary_reactive_power_var + filtered, slope
