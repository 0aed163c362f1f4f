r"""Six-pulse bridge behind a transformer: its mean voltage over the current, up to the short circuit.

The current is smooth, the diodes are ideal, the transformer is a reactance X in each phase.  With U from
line to line at its valves, and :math:`U_{d0} = 3 \sqrt 2 / \pi \, U` without load,

.. math::

    U_d = \begin{cases}
        U_{d0} - \frac{3 X}{\pi} I & I \le \frac{\sqrt 2 U}{4 X} \\
        \frac{\sqrt 3}{2} U_{d0} \sqrt{1 - \left(\frac{2 X I}{\sqrt 2 U}\right)^2}
            & I \le \frac{\sqrt 6 U}{4 X} \\
        \sqrt 3 U_{d0} - \frac{9 X}{\pi} I & I \le \frac{\sqrt 2 U}{\sqrt 3 X}
    \end{cases}

In the first mode two or three diodes conduct, and a commutation takes less than 60°; in the second
always three; in the third three or four, up to the short circuit.
"""

import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

IDEAL = 3.0 * math.sqrt(2.0) / math.pi
"""Mean voltage of a six-pulse bridge without load over the line-to-line voltage at its valves. [1]"""


def mode_ends(line_to_line_v: float, reactance_ohm: float) -> tuple[float, float, float]:
    """Currents at which the three modes end, the last one that of the short circuit. [A]

    Parameters
    ----------
    line_to_line_v : float
        Voltage at the valves without load. [V]
    reactance_ohm : float
        Reactance of a phase, positive. [Ω]

    References
    ----------
    [Steimel2014]_, on the characteristic of rectifiers; the formulae at the top of this file.
    """
    of_short_circuit = math.sqrt(2.0) * line_to_line_v / reactance_ohm
    return (
        of_short_circuit / 4.0,
        math.sqrt(3.0) / 4.0 * of_short_circuit,
        of_short_circuit / math.sqrt(3.0),
    )


def bridge_voltage(current_a: float, line_to_line_v: float, reactance_ohm: float) -> float:
    """Mean voltage of a bridge at a current. [V]

    Parameters
    ----------
    current_a : float
        From 0 to the current of the short circuit. [A]
    line_to_line_v, reactance_ohm : float
        As of `mode_ends`.

    References
    ----------
    [Steimel2014]_, on the characteristic of rectifiers; the formulae at the top of this file.
    """
    unloaded_v = IDEAL * line_to_line_v
    first_a, second_a, _ = mode_ends(line_to_line_v, reactance_ohm)
    if current_a <= first_a:
        return unloaded_v - 3.0 * reactance_ohm / math.pi * current_a
    if current_a <= second_a:
        share = current_a / (2.0 * first_a)
        return math.sqrt(3.0) / 2.0 * unloaded_v * math.sqrt(1.0 - share * share)
    return math.sqrt(3.0) * unloaded_v - 9.0 * reactance_ohm / math.pi * current_a


def current_at_power(power_w: Floats, current_a: Floats, voltage_v: Floats) -> Floats:
    r"""Current of a group that gives a power along the straight pieces of its characteristic. [A]

    .. math:: P = I (a - R I), \qquad I = \frac{2 P}{a + \sqrt{a^2 - 4 R P}}

    with a the voltage to which a piece leads at no current.  Of two currents it is the lower; a power
    above the highest has that of the highest, and none that is negative has any.

    Parameters
    ----------
    power_w : array
        Power of one group. [W]
    current_a, voltage_v : array
        Points of the characteristic, from no current on. [A], [V]

    References
    ----------
    [Steimel2014]_, on the characteristic of rectifiers.
    """
    at_points = current_a * voltage_v
    rising = np.concatenate([[True], np.logical_and.accumulate(np.diff(at_points) > 0.0)])
    last = min(int(rising.sum()) - 1, len(at_points) - 2)
    power = np.maximum(power_w, 0.0)
    piece = np.minimum(np.searchsorted(at_points[1 : last + 1], power), last)
    ohm = -np.diff(voltage_v) / np.diff(current_a)
    led_v = voltage_v[:-1] + ohm * current_a[:-1]
    root = np.sqrt(np.maximum(led_v[piece] ** 2 - 4.0 * ohm[piece] * power, 0.0))
    highest_a = led_v[piece] / (2.0 * ohm[piece])
    return np.minimum(2.0 * power / (led_v[piece] + root), highest_a)
