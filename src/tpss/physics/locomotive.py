r"""Forces, motor power and electrical power of a train, as equations.

The motors' force and the force at the wheel rim differ by what accelerates the rotors: by eq. (2.5) and
(2.11), both linear in the acceleration that belongs to the force,

.. math:: F = F_{motor} - c a, \; a = (F - F_{res}) / M
          \;\Rightarrow\; F = \frac{F_{motor} + c F_{res} / M}{1 + c / M},

with c = 4 K_J (κ + 1) the inertia of the rotors and M that of the train.
"""

from tpss.kernel import fused


@fused
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


@fused
def motor_power(motor_force_n: float, speed_m_s: float, slip_factor: float) -> float:
    r"""Mechanical power of the motors. [W]

    .. math:: P_{motor} = F_{motor} \, v \, (\kappa + 1)

    Parameters
    ----------
    motor_force_n : float
        Force of all motors. [N]
    speed_m_s : float
        Speed to which the power belongs. [m/s]
    slip_factor : float
        κ + 1, times the share of the step for which the motors work. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.12) and (F.23a).
    """
    return motor_force_n * speed_m_s * slip_factor


@fused
def active_power(motor_power_w: float, per_efficiency: float, auxiliary_power_w: float) -> float:
    r"""Active power that a train draws. [W]

    .. math:: P_D = P_{motor} / \eta_{loco} + P_{aux}

    Parameters
    ----------
    motor_power_w : float
        Mechanical power of the motors. [W]
    per_efficiency : float
        1 / η, from pantograph to motor shaft. [1]
    auxiliary_power_w : float
        Active power of the auxiliaries. [W]

    References
    ----------
    [Boullanger2009]_, eq. (2.13), (2.14) and (F.25).
    """
    return motor_power_w * per_efficiency + auxiliary_power_w
