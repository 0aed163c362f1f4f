r"""Tractive effort by limits: a constant force, then a constant power, then the pull-out limit.

.. math:: F = \min\Big(F_{max}, \frac{P_{max}}{v} \min\Big(1, \frac{v_{lim}}{v}\Big)\Big) \, r(U)

Below a full voltage force and power fall in proportion, to nothing at a lower voltage:
:math:`r = (U - U_{zero}) / (U_{full} - U_{zero})`, between 0 and 1.

Limits of validity: where a train moves in steps of one acceleration from the force at their start, the
power passes its limit within a step by the share by which the speed grows.
"""

import math

from tpss.kernel import inlined
from tpss.numerics.ramp import ramp
from tpss.record import Record


class EffortLimits(Record):
    """Limits of the force and the power of all motors."""

    highest_force_n: float = 0.0
    """Highest force. [N]"""
    highest_power_w: float = 0.0
    """Highest mechanical power. [W]"""
    limit_speed_m_s: float = math.inf
    """Speed beyond which the force falls with its square; infinite without a pull-out limit. [m/s]"""
    zero_voltage_v: float = 0.0
    """Line voltage of no force. [V]"""
    full_voltage_v: float = 0.0
    """Line voltage of full force; both 0: no dependence. [V]"""


@inlined
def limited_force(speed_m_s: float, limits: EffortLimits) -> float:
    """Largest force of all motors at full voltage. [N]

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    limits : EffortLimits

    References
    ----------
    [Steimel2014]_, the ranges of constant force, constant power and pull-out of a traction drive.
    """
    if speed_m_s <= 0.0:
        return limits.highest_force_n
    share = min(1.0, limits.limit_speed_m_s / speed_m_s)
    return min(limits.highest_force_n, limits.highest_power_w / speed_m_s * share)


@inlined
def limited_by_speed(speed_m_s: float, force_n: float, limits: EffortLimits) -> float:
    """Slope over the speed of the largest force at full voltage. [N s/m]

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    force_n : float
        `limited_force` there. [N]
    limits : EffortLimits

    References
    ----------
    [Steimel2014]_, the derivative of `limited_force`.
    """
    if force_n >= limits.highest_force_n:
        return 0.0
    power = 2.0 if speed_m_s > limits.limit_speed_m_s else 1.0
    return -power * force_n / speed_m_s


@inlined
def steepest_slope(force_n: float, limits: EffortLimits) -> float:
    """Steepest slope over the line voltage of a force that is `force_n` at full voltage. [N/V]

    References
    ----------
    [EN50388]_, as `voltage_share`.
    """
    fall_v = limits.full_voltage_v - limits.zero_voltage_v
    return force_n / fall_v if fall_v > 0.0 else 0.0


@inlined
def voltage_share(voltage_v: float, limits: EffortLimits) -> tuple[float, float]:
    """Share of force and power that the line voltage allows, and its slope. [1], [1/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    limits : EffortLimits

    References
    ----------
    [EN50388]_, which limits the current of a train at low voltage in this manner.
    """
    return ramp(voltage_v, limits.zero_voltage_v, limits.full_voltage_v, 0.0, 1.0)
