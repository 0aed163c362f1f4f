r"""Converter station with bounds: a highest current of its converters, or no power back into the grid.

Both are steep parts of one law, so that the station has a voltage for each current, a derivative
everywhere, and no mode to guess.  With :math:`i = |J| / n` the current of a converter and
:math:`x = -P / (n S_N)` the power that it takes back, over its rating, the law of
`sources.converter` becomes

.. math:: V = \left(U_g - d(i) + r(x)\right) e^{j (\theta + \alpha(x))} .

Highest current.  Above the limit L the voltage falls, by all of it within `FALL` of the limit:

.. math:: d(i) = \frac{U_0}{0.02 L} (i - L)^+ ,

rounded off over `ROUND` of L to both sides.  So a station at its limit is a source of current whose
voltage is that of the line, and what trains ask for beyond it other stations have to give.

No power back.  A converter whose rectifier cannot turn round takes nothing.  Where trains push power
into its busbar, the angle there runs ahead, up to `AHEAD` within the power `WIDTH` of the rating; other
stations, which take the surplus, hold it there.  If there are none, the surplus has nowhere to go, and
the voltage rises, by U_0 within another `WIDTH`, until trains feed back no more:

.. math:: \alpha(x) = \alpha_0 \, s(x / w), \qquad r(x) = \frac{U_0}{w} (x - 2 w)^+ , \qquad
          s(z) = 3 z^2 - 2 z^3 \text{ for } 0 \le z \le 1 ,

the rise rounded off over half of w.  What the station takes stays below three `WIDTH` of its rating.
"""

import math

from tpss.kernel import inlined
from tpss.numerics.pairs import Pair, magnitude, scaled
from tpss.record import Record
from tpss.sources.converter import (
    ConverterLaw,
    converter_is_plausible,
    converter_voltage,
    terminal_voltage,
)

FALL = 0.02
"""Share of the highest current within which the voltage falls to nothing. [1]"""

ROUND = 0.005
"""Share of the highest current over which the corner is rounded off, to both sides. [1]"""

WIDTH = 2e-4
"""Share of the rating that a station which takes no power back takes nevertheless, for its angle. [1]"""

AHEAD = 0.5
"""How far its angle may run ahead of that without load. [rad]"""


class Bounds(Record):
    """Bounds of a station's converters, whose law is a `ConverterLaw`."""

    highest_current_a: float = math.inf
    """Highest current of a converter; infinite: none. [A]"""
    blocked_from_w: float = math.inf
    """`WIDTH` of the rated power of a converter that takes no power back; infinite: it does. [W]"""


@inlined
def rounded(x: float, half: float) -> tuple[float, float]:
    """The larger of x and 0, rounded off up to half a width away from 0, and its slope.

    .. math:: (x + h)^2 / 4 h \text{ between } -h \text{ and } h
    """
    if x <= -half:
        return 0.0, 0.0
    if x >= half:
        return x, 1.0
    return (x + half) ** 2 / (4.0 * half), (x + half) / (2.0 * half)


@inlined
def fall(current_a: float, law: ConverterLaw, bounds: Bounds) -> tuple[float, float]:
    """Fall of the voltage at the highest current of a converter [V], and its slope [Ω].

    References
    ----------
    The formula at the top of this file; [Steimel2014]_ on static converters, whose current is limited.
    """
    limit_a = bounds.highest_current_a
    if current_a < limit_a * (1.0 - ROUND) or limit_a == math.inf:
        return 0.0, 0.0
    slope_ohm = law.no_load_voltage_v / (FALL * limit_a)
    beyond_a, share = rounded(current_a - limit_a, ROUND * limit_a)
    return slope_ohm * beyond_a, slope_ohm * share


@inlined
def blocked(taken_w: float, law: ConverterLaw, bounds: Bounds) -> tuple[float, float, float, float]:
    """What a power that is pushed into a converter does: angle, its slope, rise of voltage, its slope.

    [rad], [rad/W], [V], [V/W]

    References
    ----------
    The formulae at the top of this file; [Steimel2014]_ on rectifiers that take no power back.
    """
    width_w = bounds.blocked_from_w
    if taken_w <= 0.0 or width_w == math.inf:
        return 0.0, 0.0, 0.0, 0.0
    z = min(1.0, taken_w / width_w)
    angle, slope = AHEAD * z * z * (3.0 - 2.0 * z), 6.0 * AHEAD * z * (1.0 - z) / width_w
    beyond_w, share = rounded(taken_w - 2.0 * width_w, 0.5 * width_w)
    by_w = law.no_load_voltage_v / width_w
    return angle, slope, by_w * beyond_w, by_w * share


@inlined
def bounded_residual(
    voltage: complex, current: complex, converters: float, law: ConverterLaw, bounds: Bounds
) -> tuple[complex, Pair, Pair]:
    """Voltage less what the law asks for, and its derivatives over voltage and current, as pairs.

    Parameters are those of `sources.kinds.residual`.

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4), within the bounds at the top of this file.
    """
    power, size_a = voltage * current.conjugate(), magnitude(current)
    # 1. The law of converters, what the current takes from its voltage, and what is taken back.
    own_v, direction, own_by_q, angle_by_p, angle_by_q = terminal_voltage(
        power.real, power.imag, converters, law
    )
    fall_v, fall_ohm = fall(size_a / converters, law, bounds)
    ahead, ahead_by_w, rise_v, rise_by_w = blocked(-power.real / converters, law, bounds)
    if ahead > 0.0:
        direction = direction * complex(math.cos(ahead), math.sin(ahead))
        angle_by_p -= ahead_by_w / converters
    asked = scaled(direction, own_v - fall_v + rise_v)
    # 2. Its derivatives over the powers, of which half make the pair over voltage and current.
    turned = complex(-asked.imag, asked.real)
    f_p = scaled(turned, 0.5 * angle_by_p) - scaled(direction, 0.5 * rise_by_w / converters)
    f_q = scaled(direction, 0.5 * own_by_q) + scaled(turned, 0.5 * angle_by_q)
    along = complex(-f_q.imag, f_q.real)
    s1, s2 = f_p - along, f_p + along
    by_voltage = (1.0 - s1 * current.conjugate(), -(s2 * current))
    # 3. Those over the size of the current.
    by_size = 0j
    if fall_ohm > 0.0:
        by_size = scaled(direction, fall_ohm / (2.0 * converters * size_a))
    by_current = (
        by_size * current.conjugate() - s2 * voltage.conjugate(),
        by_size * current - s1 * voltage,
    )
    return voltage - asked, by_voltage, by_current


@inlined
def bounded_is_plausible(
    voltage: complex, current: complex, converters: float, law: ConverterLaw, bounds: Bounds
) -> bool:
    """Whether its machines are in step, and its limit of current leaves a positive voltage.

    References
    ----------
    [Boullanger2009]_, eq. (2.1) and (2.3).
    """
    own_v, _ = converter_voltage((voltage * current.conjugate()).imag, converters, law)
    fall_v, _ = fall(magnitude(current) / converters, law, bounds)
    return own_v > fall_v and converter_is_plausible(voltage, current, converters, law)
