"""Electric side of the traction motors: power, voltage and current.

"New" is the thesis's model, "former" the one of the program before it.
"""

from enum import IntEnum

from tpss.kernel import inlined, kernel

MOTORS_OF_LOCOMOTIVE = 4.0
"""Motors whose currents the armature current adds up: those of a locomotive. [1]"""


class MotorModel(IntEnum):
    """Model of motor voltage or motor current."""

    NEW = 0
    FORMER = 1


FORMER_VOLTAGE_KNEE_V = 14_000.0
"""Line voltage below which the former model lowers the motor voltage. [V]"""


@kernel
def motor_force(wheel_force_n: float, acceleration_m_s2: float, rotor_mass_kg: float) -> float:
    r"""Force that the motors give for a force at the wheel rim, never negative. [N]

    .. math:: F_{motor} = F_{wheels} + 4 K_J a (\kappa + 1)

    Parameters
    ----------
    wheel_force_n : float
        Tractive force at the wheel rim, positive. [N]
    acceleration_m_s2 : float
        Acceleration of the train. [m/s²]
    rotor_mass_kg : float
        Inertia of the rotors, 4 K_J (κ + 1), as a mass at the wheel rim. [kg]

    References
    ----------
    [Boullanger2009]_, eq. (2.5) and (F.22).
    """
    return max(0.0, wheel_force_n + rotor_mass_kg * acceleration_m_s2)


@kernel
def motor_voltage(
    speed_m_s: float, line_voltage_v: float, base_speed_m_s: float, highest_v: float, model: int
) -> float:
    r"""Voltage of one motor, U_di. [V]

    .. math::
        U_{di} = E_{max} \min(1, v / v_{base})
        \quad\text{(former: } \times \min(1, U / 14\,\text{kV})\text{)}

    Parameters
    ----------
    speed_m_s : float
        Speed at the start of the step. [m/s]
    line_voltage_v : float
        Voltage at the pantograph, used by the former model only. [V]
    base_speed_m_s : float
        Speed from which the motor voltage is at its highest. [m/s]
    highest_v : float
        Highest motor voltage, E_max. [V]
    model : int
        Of `MotorModel`.

    References
    ----------
    [Boullanger2009]_, eq. (2.15), (F.6) and, former, (2.16).
    """
    voltage_v = highest_v * min(1.0, speed_m_s / base_speed_m_s)
    return voltage_v * line_voltage_factor(line_voltage_v, model)


@kernel
def line_voltage_factor(line_voltage_v: float, model: int) -> float:
    """Factor min(1, U / 14 kV) of the former motor voltage; 1 in the new model. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.16).
    """
    if model == MotorModel.FORMER:
        return min(1.0, line_voltage_v / FORMER_VOLTAGE_KNEE_V)
    return 1.0


@kernel
def armature_current(
    motor_force_n: float,
    slip_factor: float,
    speed_m_s: float,
    base_speed_m_s: float,
    highest_v: float,
    below_base_speed: bool,
) -> float:
    r"""Sum of the four motors' currents, 4 I_D, at full line voltage. [A]

    .. math:: 4 I_D = \frac{F_{motor} (\kappa + 1)}{E_{max}}
              \begin{cases} v_{base} & v < v_{base} \\ v & \text{otherwise} \end{cases}

    This is P_motor / U_di with eq. (2.15) inserted, which avoids 0/0 at standstill.

    Parameters
    ----------
    motor_force_n : float
        Force of all motors. [N]
    slip_factor : float
        κ + 1. [1]
    speed_m_s : float
        Speed to which the power belongs. [m/s]
    below_base_speed : bool
        Whether the speed at the start of the step is below the base speed.

    References
    ----------
    [Boullanger2009]_, eq. (2.17) and (F.34).
    """
    speed = base_speed_m_s if below_base_speed else speed_m_s
    return motor_force_n * slip_factor * speed / highest_v


@inlined
def motor_current(armature_current_a: float, model: int) -> float:
    """Motor current I_D as the model defines it: of one motor, or formerly of all four. [A]

    References
    ----------
    [Boullanger2009]_, eq. (2.17) and, former, (2.18).
    """
    return (
        armature_current_a
        if model == MotorModel.FORMER
        else armature_current_a / MOTORS_OF_LOCOMOTIVE
    )
