r"""Converter station by a law of somebody's own: voltage and angle over the powers of one converter.

With :math:`p + j q = V \bar{J} / n` of each of n running converters, the law gives magnitude u and angle
φ with their slopes, and the station's voltage is

.. math:: V = s\, u(p, q)\, e^{j (\varphi(p, q) + \psi)} ,

with s = 1 and the angle ψ of the 50 Hz grid.  With the pair (s₁, s₂) of this over P + jQ its derivatives
are those of `sources.converter`.
"""

import cmath

from tpss.kernel import kernel
from tpss.numerics.called import Called, find_six_numbers
from tpss.numerics.pairs import Pair
from tpss.record import Record


class OwnStationLaw(Record):
    """Parameters of a station by a law of somebody's own."""

    voltage: Called = Called.row()
    """Voltage and angle of a converter over its powers, with their slopes."""
    scale: float = 1.0
    """s, by which the voltage is multiplied. [1]"""
    turn_rad: float = 0.0
    """ψ, which is added to the angle. [rad]"""


@kernel
def own_residual(
    voltage: complex, current: complex, converters: float, law: OwnStationLaw
) -> tuple[complex, Pair, Pair]:
    """Voltage less what the law asks for, and its derivatives over voltage and current, as pairs.

    Parameters are those of `sources.kinds.residual`.
    """
    power = voltage * current.conjugate()
    magnitude_v, angle, by_p, by_q, angle_by_p, angle_by_q = find_six_numbers(
        law.voltage, (power.real / converters, power.imag / converters)
    )
    direction = cmath.exp(complex(0.0, angle + law.turn_rad))
    per = law.scale / converters
    asked = law.scale * magnitude_v * direction
    f_p = per * complex(by_p, magnitude_v * angle_by_p) * direction
    f_q = per * complex(by_q, magnitude_v * angle_by_q) * direction
    s1, s2 = 0.5 * (f_p - 1j * f_q), 0.5 * (f_p + 1j * f_q)
    by_voltage = (1.0 - s1 * current.conjugate(), -(s2 * current))
    by_current = (-(s2 * voltage.conjugate()), -(s1 * voltage))
    return voltage - asked, by_voltage, by_current


@kernel
def own_is_plausible(
    voltage: complex, current: complex, converters: float, law: OwnStationLaw
) -> bool:
    """Whether the law gives the station a positive voltage."""
    power = voltage * current.conjugate()
    given = (power.real / converters, power.imag / converters)
    return find_six_numbers(law.voltage, given)[0] > 0.0


@kernel
def unloaded_own(law: OwnStationLaw) -> tuple[float, float]:
    """Magnitude and angle of a station's voltage without load. [V], [rad]"""
    found = find_six_numbers(law.voltage, (0.0, 0.0))
    return law.scale * found[0], found[1] + law.turn_rad


@kernel
def set_unloaded_own(magnitude_v: float, angle_rad: float, law: OwnStationLaw) -> None:
    """Give a station another voltage without load."""
    found = find_six_numbers(law.voltage, (0.0, 0.0))
    law.scale = magnitude_v / found[0]
    law.turn_rad = angle_rad - found[1]
