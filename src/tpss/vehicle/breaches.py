"""Where what describes a train is extrapolated, clipped, or gives way to a limit of the line current."""

import math
from enum import IntEnum

from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import Points, outside_curve
from tpss.numerics.neural_network import outside
from tpss.physics.locomotive import machine_force
from tpss.physics.motor import motor_voltage
from tpss.physics.reactive_power import ReactiveModel, bridge_outside_training
from tpss.vehicle.demand import motors_power
from tpss.vehicle.effort.kinds import effort_extrapolates
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType


class Breach(IntEnum):
    """What was limited or left its range."""

    EFFORT_EXTRAPOLATED = 0
    EFFORT_CLIPPED = 1
    BRIDGE_EXTRAPOLATED = 2
    BRIDGE_CLIPPED = 3
    POWER_FACTOR_EXTRAPOLATED = 4
    EFFICIENCY_EXTRAPOLATED = 5
    CURRENT_LIMITED = 6


BREACHES = len(Breach)

ROUNDED = 1e-9
"""By how much a machine may exceed its rated power without exceeding it. [1]"""


@inlined
def current_limits(kind: TrainType, demand: Demand) -> bool:
    """Whether a limit of the line current is what keeps a train below its driver and its machine."""
    machine_n = max(0.0, demand.machine_force_n)
    rim_n = machine_force(machine_n, demand.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    return bool(demand.wheel_force_n < min(demand.force_cap_n, max(0.0, rim_n)))


@kernel
def works_beyond_loads(kind: TrainType, demand: Demand) -> bool:
    """Whether motors give more power than a curve over load knows."""
    last = kind.over_load.count - 1
    if last < 0:
        return False
    most_w = kind.over_load.power_w[at(last)] * demand.driven_share
    return motors_power(kind, demand) > most_w * (1.0 + ROUNDED)


@inlined
def find_breaches(
    force_n: float, voltage_v: float, kind: TrainType, demand: Demand, points: Points
) -> int:
    """What of a train that wants force is extrapolated or clipped, a bit each `Breach`.

    Parameters
    ----------
    force_n, voltage_v : float
        Tractive force [N], and voltage at the pantograph [V].
    kind : TrainType
    demand : Demand
        As the voltage has left it.
    points : records of CurvePoint
    """
    speed, voltage, networks = demand.terms_speed_m_s, voltage_v, kind.networks
    breaches = 0
    if effort_extrapolates(speed, voltage, kind.effort, networks.tractive_effort, points):
        breaches |= 1 << Breach.EFFORT_EXTRAPOLATED
    if demand.machine_force_n < 0.0:
        breaches |= 1 << Breach.EFFORT_CLIPPED
    if kind.line_current.highest_current_a < math.inf and current_limits(kind, demand):
        breaches |= 1 << Breach.CURRENT_LIMITED
    if force_n <= 0.0:
        return breaches
    if outside_curve(speed, kind.efficiency, points) or works_beyond_loads(kind, demand):
        breaches |= 1 << Breach.EFFICIENCY_EXTRAPOLATED
    if kind.reactive_model == ReactiveModel.POWER_FACTOR_CURVE:
        if outside_curve(speed, kind.power_factor, points):
            breaches |= 1 << Breach.POWER_FACTOR_EXTRAPOLATED
        return breaches
    if kind.reactive_model != ReactiveModel.DOUBLE_BRIDGE:
        if outside(speed, networks.power_factor, 0):
            breaches |= 1 << Breach.POWER_FACTOR_EXTRAPOLATED
        return breaches
    motor_v = motor_voltage(
        speed, voltage, kind.base_speed_m_s, kind.highest_motor_voltage_v, kind.voltage_model
    )
    if bridge_outside_training(motor_v, voltage * kind.transformer_ratio, networks.bridge_sine):
        breaches |= 1 << Breach.BRIDGE_EXTRAPOLATED
    if demand.bridge_sine < 0.0 or demand.bridge_sine > 1.0:
        breaches |= 1 << Breach.BRIDGE_CLIPPED
    return breaches
