r"""Rectifier station of a direct-current line: a current for each voltage, and none the other way.

.. math:: J = I(U), \qquad U = \Re V .

I(U) consists of straight pieces.  n equal groups of rectifiers, of which one gives the current i at the
voltage u along a curve through the points (i_k, u_k), the first one at no current, the last piece going
on.  Above the first point they block, but for a leak: without one, a line on which nobody draws power
would have any voltage above it.  An inverter beside them takes current from a higher voltage on,

.. math:: I(U) = -\min\Big(\frac{U - U_i}{R_i}, \frac{P_i}{U}\Big) \text{ for } U > U_i .

The current falls with the voltage along all pieces but that of the highest power, where it is that of a
constant load, as of a train.

The imaginary half.  The load flow's unknowns are complex, here with imaginary parts that stay 0.  Where
a station blocks, nothing would hold them: all equations hold as well with all voltages turned by one
angle, and the imaginary half of their Jacobian is singular, with the voltages themselves as its null
vector.  So the law acts on the imaginary part too, with a conductance of

.. math:: g_{im} = \max\Big(-\frac{dI}{dU}, \; -\frac{I}{U} + \kappa\Big), \qquad \kappa > 0 .

With it that half, times the voltages, gives no negative current anywhere, and a positive one at every
station: it is an M-matrix, its determinant is positive, and the sign of the whole one is that of the
real system.

References
----------
[Steimel2014]_, on the characteristic of rectifiers.
"""

import math
from typing import Annotated

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, kernel
from tpss.numerics.pairs import Pair
from tpss.record import Record

Floats = npt.NDArray[np.float64]

MOST_POINTS = 6
"""Points of the curve of a group."""

LEAK = 1e-7
"""Conductance with which groups that block conduct nevertheless, of that of their first piece: less than
a watt of a station's megawatts. [1]"""

HOLD = 1e-3
"""κ times the resistance of the station's first piece. [1]"""


class RectifierLaw(Record):
    """Parameters of a rectifier station."""

    points: int = 0
    """Points of the curve, at least two."""
    current_a: Annotated[Floats, (MOST_POINTS,)] = (0.0,) * MOST_POINTS  # type: ignore[assignment]
    """Currents of one group at the points, ascending from 0. [A]"""
    voltage_v: Annotated[Floats, (MOST_POINTS,)] = (0.0,) * MOST_POINTS  # type: ignore[assignment]
    """Voltages at the points, descending. [V]"""
    inverter_from_v: float = math.inf
    """Voltage from which the inverter takes current; infinite: there is none. [V]"""
    inverter_ohm: float = math.nan
    """Rise of its voltage per current. [Ω]"""
    inverter_power_w: float = math.inf
    """Highest power that it takes. [W]"""
    reverse_share: float = 0.0
    """Conductance with which groups that block conduct besides, of that of their first piece: 0, but in
    a search for a solution, which closes them little by little. [1]"""


@inlined
def rectified(voltage_v: float, law: RectifierLaw) -> tuple[float, float]:
    """Current of one group at a voltage, and its slope. [A], [A/V]

    References
    ----------
    [Steimel2014]_, on the characteristic of rectifiers; the formulae at the top of this file.
    """
    volts, amperes = law.voltage_v, law.current_a
    if voltage_v > volts[0]:
        share = LEAK + law.reverse_share
        slope = share * (amperes[1] - amperes[0]) / (volts[1] - volts[0])
        return slope * (voltage_v - volts[0]), slope
    k = 1
    while k < law.points - 1 and voltage_v < volts[at(k)]:
        k += 1
    slope = (amperes[at(k)] - amperes[at(k - 1)]) / (volts[at(k)] - volts[at(k - 1)])
    return amperes[at(k - 1)] + slope * (voltage_v - volts[at(k - 1)]), slope


@inlined
def inverted(voltage_v: float, law: RectifierLaw) -> tuple[float, float]:
    """Current that the inverter takes at a voltage, and its slope. [A], [A/V]

    References
    ----------
    [Steimel2014]_, on inverters of substations; the formulae at the top of this file.
    """
    if voltage_v <= law.inverter_from_v:
        return 0.0, 0.0
    current = (voltage_v - law.inverter_from_v) / law.inverter_ohm
    if current * voltage_v <= law.inverter_power_w:
        return current, 1.0 / law.inverter_ohm
    current = law.inverter_power_w / voltage_v
    return current, -current / voltage_v


@kernel
def rectifier_residual(
    voltage: complex, current: complex, groups: float, law: RectifierLaw
) -> tuple[complex, Pair, Pair]:
    """Current less what the law asks for, as a voltage, and its derivatives over V and J, as pairs.

    Parameters are those of `sources.kinds.residual`; the station's first resistance makes volts of
    amperes.

    References
    ----------
    [Steimel2014]_, as `rectified` and `inverted`.
    """
    first_ohm = (law.voltage_v[0] - law.voltage_v[1]) / (law.current_a[1] * groups)
    voltage_v = voltage.real
    # 1. The current, and its slope over the voltage: -g.
    given, given_slope = rectified(voltage_v, law)
    taken, taken_slope = inverted(voltage_v, law)
    asked = groups * given - taken
    real_s = taken_slope - groups * given_slope
    # 2. What holds the imaginary part.
    imaginary_s = max(real_s, HOLD / first_ohm - asked / max(voltage_v, 1.0))
    value = complex(current.real - asked, current.imag + imaginary_s * voltage.imag)
    by_voltage = (
        complex(0.5 * first_ohm * (real_s + imaginary_s), 0.0),
        complex(0.5 * first_ohm * (real_s - imaginary_s), 0.0),
    )
    return first_ohm * value, by_voltage, (complex(first_ohm, 0.0), 0j)


@inlined
def unloaded_rectifier(law: RectifierLaw) -> tuple[float, float]:
    """Magnitude and angle of a station's voltage without load. [V], [rad]"""
    return law.voltage_v[0], 0.0


@inlined
def set_unloaded_rectifier(magnitude_v: float, law: RectifierLaw) -> None:
    """Give a station another voltage without load; its curve and its inverter move along."""
    shift_v = magnitude_v - law.voltage_v[0]
    for k in range(MOST_POINTS):
        law.voltage_v[at(k)] += shift_v
    law.inverter_from_v += shift_v
