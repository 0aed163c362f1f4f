r"""Tractive effort by limits: a constant force, then a constant power, then the pull-out limit.

.. math:: F = \min\Big(F_{max}, \frac{P_{max}}{v} \min\Big(1, \frac{v_{lim}}{v}\Big)\Big) \, r(U)

Below a full voltage force and power fall in proportion, to nothing at a lower voltage:
:math:`r = (U - U_{zero}) / (U_{full} - U_{zero})`, between 0 and 1.

Limits of validity: the speed is that at the start of a step, so within a step that accelerates the
power passes its limit by the share by which the speed grows.
"""

from tpss.kernel import inlined


@inlined
def limited_force(
    speed_m_s: float, highest_force_n: float, highest_power_w: float, limit_speed_m_s: float
) -> float:
    """Largest force of all motors at full voltage. [N]

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    highest_force_n, highest_power_w : float
        Limits of the motors' force [N] and mechanical power [W].
    limit_speed_m_s : float
        Speed beyond which the force falls with the square of the speed; infinite: nowhere. [m/s]

    References
    ----------
    [Steimel2014]_, the ranges of constant force, constant power and pull-out of a traction drive.
    """
    if speed_m_s <= 0.0:
        return highest_force_n
    share = min(1.0, limit_speed_m_s / speed_m_s)
    return min(highest_force_n, highest_power_w / speed_m_s * share)


@inlined
def voltage_share(
    voltage_v: float, zero_voltage_v: float, full_voltage_v: float
) -> tuple[float, float]:
    """Share of force and power that the line voltage allows, and its slope. [1], [1/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    zero_voltage_v, full_voltage_v : float
        Voltages of no force and of full force; both 0: no dependence. [V]

    References
    ----------
    [EN50388]_, which limits the current of a train at low voltage in this manner.
    """
    if voltage_v >= full_voltage_v:
        return 1.0, 0.0
    if voltage_v <= zero_voltage_v:
        return 0.0, 0.0
    slope = 1.0 / (full_voltage_v - zero_voltage_v)
    return (voltage_v - zero_voltage_v) * slope, slope
