"""Speed and power with which a step's motor force is billed, and their slopes over the force.

The equations are those of `physics.locomotive`; the slopes serve Newton's method.
"""

import math

from tpss.kernel import fused, inlined, kernel
from tpss.physics.locomotive import acceleration, machine_force, motor_power
from tpss.physics.motor import armature_current
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType


@fused
def billed_speed(force_n: float, kind: TrainType, demand: Demand) -> tuple[float, float]:
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
    weight = demand.mean_speed_weight_s
    a = acceleration(min(force_n, demand.adhesion_n), demand.resistance_n, kind.inertia_kg)
    slope = weight / kind.inertia_kg if force_n <= demand.adhesion_n else 0.0
    return max(0.0, demand.speed_m_s + weight * a), slope


@inlined
def billed_power(
    motor_force_n: float, driven_share: float, kind: TrainType, demand: Demand
) -> tuple[float, float, float, float]:
    """Motor power, its slope, the billed speed, and its slope, over the motors' force.

    [W], [W/N], [m/s], [m/s/N]

    Parameters
    ----------
    motor_force_n : float
        Force of all motors. [N]
    driven_share : float
        Share of the step over which the power is a mean: 1 for the power while the motors work. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.5), (2.7), (2.11) and (2.12).
    """
    rotor_kg, inertia_kg = kind.rotor_mass_kg, kind.inertia_kg
    force = machine_force(motor_force_n, demand.resistance_n, rotor_kg, inertia_kg)
    speed, by_force = billed_speed(force, kind, demand)
    speed_slope = by_force / (1.0 + rotor_kg / inertia_kg)
    slip = kind.slip_factor * driven_share
    power_slope = motor_power(1.0, speed + motor_force_n * speed_slope, slip)
    return motor_power(motor_force_n, speed, slip), power_slope, speed, speed_slope


@kernel
def motors_current(
    motor_force_n: float, speed_m_s: float, driven_share: float, kind: TrainType, demand: Demand
) -> float:
    """Sum of the four motors' currents at full line voltage, at a billed speed. [A]

    See `armature_current`.
    """
    return armature_current(
        motor_force_n,
        kind.slip_factor * driven_share,
        speed_m_s,
        kind.base_speed_m_s,
        kind.highest_motor_voltage_v,
        demand.speed_m_s < kind.base_speed_m_s,
    )


@kernel
def force_of_current(
    current_a: float, speed_m_s: float, resistance_n: float, weight_s: float, kind: TrainType
) -> float:
    r"""Force at the wheel rim at which the motors' currents have a sum, at full line voltage. [N]

    Below base speed the current is proportional to the motors' force.  Above it, it is their power over
    their highest voltage, at the billed speed, which follows the force: with
    :math:`B = 4 I_D E_{max} / (\kappa + 1)` and w the weight of the mean speed,

    .. math:: F_{motor} v_b = B, \quad v_b = v + w \frac{F_{motor} - F_{res}}{M + c} ,

    which is quadratic in :math:`v_b`, with one root that is positive.

    Parameters
    ----------
    current_a : float
        Sum of the four motors' currents. [A]
    speed_m_s, resistance_n : float
        Speed at the start of the step [m/s]; running resistance and gradient force [N].
    weight_s : float
        w, as `Demand.mean_speed_weight_s`. [s]

    References
    ----------
    [Boullanger2009]_, eq. (2.5), (2.11), (2.17) and (F.34), solved for the force.
    """
    power_w = current_a * kind.highest_motor_voltage_v / kind.slip_factor
    if power_w <= 0.0:
        return 0.0
    billed_m_s = kind.base_speed_m_s
    if speed_m_s >= billed_m_s:
        per_force = weight_s / (kind.inertia_kg + kind.rotor_mass_kg)
        coasting_m_s = speed_m_s - per_force * resistance_n
        root = math.sqrt(coasting_m_s * coasting_m_s + 4.0 * per_force * power_w)
        billed_m_s = (coasting_m_s + root) / 2.0
    force_n = power_w / billed_m_s
    return max(0.0, machine_force(force_n, resistance_n, kind.rotor_mass_kg, kind.inertia_kg))
