r"""Converter station between the 50 Hz grid and the railway: terminal voltage over its powers.

All converters of a station are alike and share its power equally.  Static converters imitate
rotary ones, so one law serves both.

Sign: P and Q are positive when fed into the railway; angles lag (are negative) under load.
Q_50 is counted positive when delivered to the 50 Hz grid, so that both denominators carry a plus;
the extraction of the thesis has lost the signs, and with Q_50 = 0 nothing depends on it.
"""

import math

from tpss.kernel import inlined
from tpss.numerics.pairs import Pair, magnitude, scaled
from tpss.record import Record


class ConverterLaw(Record):
    """Parameters of a station's converters; reactances of one converter, on the railway's side."""

    no_load_voltage_v: float = math.nan
    """Terminal voltage without reactive power. [V]"""
    droop_v_per_var: float = math.nan
    """Fall of the terminal voltage per reactive power of a converter. [V/var]"""
    generator_reactance_ohm: float = math.nan
    """q-axis reactance of a generator. [Ω]"""
    motor_reactance_ohm: float = math.nan
    """q-axis reactance of a motor. [Ω]"""
    motor_voltage_v: float = math.nan
    """Voltage of the motors. [V]"""
    grid_reactance_ohm: float = math.nan
    """Reactance of the 50 Hz grid. [Ω]"""
    grid_reactive_power_var: float = math.nan
    """Reactive power delivered to the 50 Hz grid. [var]"""
    grid_angle_rad: float = math.nan
    """Angle of the 50 Hz grid, seen at the railway's frequency. [rad]"""


@inlined
def converter_voltage(
    reactive_power_var: float, converters: float, law: ConverterLaw
) -> tuple[float, float]:
    r"""Terminal voltage of a station, and its slope over the reactive power. [V], [V/var]

    .. math:: U_g = 16.5 - \frac{Q_G}{\#conv \cdot 20} \quad [\text{kV}, \text{Mvar}]

    References
    ----------
    [Boullanger2009]_, eq. (2.1) and (F.33).
    """
    voltage = law.no_load_voltage_v - law.droop_v_per_var * reactive_power_var / converters
    return voltage, -law.droop_v_per_var / converters


@inlined
def grid_angle(power_w: float, converters: float, law: ConverterLaw) -> tuple[float, float]:
    r"""Angle behind the 50 Hz side, seen at 16.7 Hz, and its slope in P. [rad], [rad/W]

    .. math::
        \theta_{50} - \tfrac13 \arctan\frac{X_{50} P_G}{U_m^2 + X_{50} Q_{50}}
        - \tfrac13 \arctan\frac{X_q^m P_G / \#conv}{U_m^2 + X_q^m Q_{50} / \#conv}

    The grid carries the power of the whole station, a machine that of one converter.

    References
    ----------
    [Boullanger2009]_, eq. (2.2), (F.39) and the first half of (2.3), (F.40).
    """
    q50_var = law.grid_reactive_power_var
    square = law.motor_voltage_v**2
    grid = law.grid_reactance_ohm / (square + law.grid_reactance_ohm * q50_var)
    x_motor = law.motor_reactance_ohm / converters
    motor = x_motor / (square + x_motor * q50_var)
    by_grid, by_motor = grid * power_w, motor * power_w
    # arctan a + arctan b = arctan (a + b)/(1 - ab), in the quadrant that the signs give.
    lag = math.atan2(by_grid + by_motor, 1.0 - by_grid * by_motor)
    slope = grid / (1.0 + by_grid * by_grid) + motor / (1.0 + by_motor * by_motor)
    return law.grid_angle_rad - lag / 3.0, -slope / 3.0


@inlined
def terminal_voltage(
    power_w: float, reactive_power_var: float, converters: float, law: ConverterLaw
) -> tuple[float, complex, float, float, float]:
    r"""Voltage of a station, its direction, and their slopes: U, e^{jθ}, dU/dQ, dθ/dP, dθ/dQ.

    .. math::
        \theta = \theta_0 + \psi, \quad
        \psi \ni -\arctan\frac{X_q^g P_G / \#conv}{U_g^2 + X_q^g Q_G / \#conv}

    Parameters
    ----------
    power_w, reactive_power_var : float
        Fed into the railway by the whole station. [W], [var]
    converters : float
        Number of converters running, at least 1.
    law : ConverterLaw

    References
    ----------
    [Boullanger2009]_, eq. (2.3), (2.4), (F.40) and (F.41).
    """
    voltage, voltage_slope = converter_voltage(reactive_power_var, converters, law)
    behind, behind_slope = grid_angle(power_w, converters, law)
    x = law.generator_reactance_ohm / converters
    opposite = x * power_w
    adjacent = voltage * voltage + x * reactive_power_var
    per_square = 1.0 / (opposite * opposite + adjacent * adjacent)
    # The direction of the last angle without the angle: the sides of its triangle.
    size = math.sqrt(per_square)
    turn = complex(adjacent * size, -opposite * size)
    direction = complex(math.cos(behind), math.sin(behind)) * turn
    by_power = behind_slope - x * adjacent * per_square
    by_reactive = opposite * (2.0 * voltage * voltage_slope + x) * per_square
    return voltage, direction, voltage_slope, by_power, by_reactive


@inlined
def converter_residual(
    voltage: complex, current: complex, converters: float, law: ConverterLaw, derivatives: bool
) -> tuple[complex, Pair, Pair]:
    """Voltage less what the law asks for, and its derivatives over voltage and current, as pairs.

    With the pair (s₁, s₂) of the law over P + jQ = V J̄, its derivatives are (s₁J̄, s₂J) over the voltage
    and (s₂V̄, s₁V) over the current.  Parameters are those of `sources.kinds.residual`.

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4), (F.33) and (F.39)-(F.41).
    """
    power = voltage * current.conjugate()
    magnitude, direction, by_q, angle_by_p, angle_by_q = terminal_voltage(
        power.real, power.imag, converters, law
    )
    asked = scaled(direction, magnitude)
    if not derivatives:
        return voltage - asked, (0j, 0j), (0j, 0j)
    turned = complex(-asked.imag, asked.real)
    f_p = scaled(turned, 0.5 * angle_by_p)
    f_q = scaled(direction, 0.5 * by_q) + scaled(turned, 0.5 * angle_by_q)
    along = complex(-f_q.imag, f_q.real)
    s1, s2 = f_p - along, f_p + along
    by_voltage = (1.0 - s1 * current.conjugate(), -(s2 * current))
    by_current = (-(s2 * voltage.conjugate()), -(s1 * voltage))
    return voltage - asked, by_voltage, by_current


@inlined
def converter_is_plausible(
    voltage: complex, current: complex, converters: float, law: ConverterLaw
) -> bool:
    r"""Whether the droop leaves the station a positive voltage, and its machines are in step.

    The law continues through zero.  Stations out of phase can meet it with a voltage of turned sign, at
    some hundred times the reactive power of their machines.  A machine whose load angle (2.3) is beyond
    90° would fall out of step; there the side of the triangle along the voltage,
    :math:`U_g^2 + X_q^g Q_G / \#conv`, is negative.

    References
    ----------
    [Boullanger2009]_, eq. (2.1) and (2.3).
    """
    reactive_var = (voltage * current.conjugate()).imag
    own_v, _ = converter_voltage(reactive_var, converters, law)
    along = own_v * own_v + law.generator_reactance_ohm / converters * reactive_var
    return own_v > 0.0 and along > 0.0


@inlined
def converter_reserve(
    voltage: complex, current: complex, converters: float, law: ConverterLaw
) -> float:
    r"""How far machines are from falling out of step: what is left of the triangle of angle (2.3). [1]

    .. math:: \sqrt{(U_g^2 + X Q)^2 + (X P)^2} / U_g^2, \quad X = X_q^g / \#conv

    1 without load.  Where it is 0 there is no angle, and no solution beyond.

    References
    ----------
    [Boullanger2009]_, eq. (2.3).
    """
    power = voltage * current.conjugate()
    own_v, _ = converter_voltage(power.imag, converters, law)
    x = law.generator_reactance_ohm / converters
    return magnitude(complex(own_v * own_v + x * power.imag, x * power.real)) / (own_v * own_v)


@inlined
def unloaded_converter(law: ConverterLaw) -> tuple[float, float]:
    """Magnitude and angle of a station's voltage without load. [V], [rad]"""
    return law.no_load_voltage_v, law.grid_angle_rad


@inlined
def set_unloaded_converter(magnitude_v: float, angle_rad: float, law: ConverterLaw) -> None:
    """Give a station another voltage without load."""
    law.no_load_voltage_v = magnitude_v
    law.grid_angle_rad = angle_rad
