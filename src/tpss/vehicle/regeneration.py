r"""Regenerative braking: what the motors brake, and what of that the line takes.

Of a braking force F_b at the wheel rim the motors give

.. math:: F_e = \min(F_b, F_{max}, P_{max} / v, F_{rails}) \, \varphi(v),

with φ rising from 0 to 1 between two speeds; friction brakes give the rest.  They offer the line
:math:`F_e v \eta`, with a factor over the load (`vehicle.part_load`).  Auxiliaries are fed first.  The
line takes it whole up to a voltage U₁ and none from a voltage U₂ on; the share in between falls along
a straight line that may be rounded off at both ends, so that its slope has no jumps:

.. math:: g = 1 - \frac{s^2}{2 w (L - w)}, \quad 1 - \frac{s - w/2}{L - w}, \quad
          \frac{(L - s)^2}{2 w (L - w)}

for s = U - U₁ up to w, up to L - w, and up to L = U₂ - U₁.  What it does not take, friction brakes or a
resistor turn into heat: the motion is the same whatever the voltage.

Sign: offered and taken powers are positive; they lower the active power that a train draws.
"""

from tpss.kernel import inlined
from tpss.numerics.curve import Curve
from tpss.numerics.ramp import ramp
from tpss.record import Record
from tpss.vehicle.part_load import LoadCurve

ROUNDED_V = 50.0
"""Length of each rounded end, w, where nothing else is said. [V]"""


class Regeneration(Record):
    """Electric brakes of a type of train."""

    highest_force_n: float = 0.0
    """Highest force of all motors; 0: there are no electric brakes. [N]"""
    highest_power_w: float = 0.0
    """Highest mechanical power. [W]"""
    none_up_to_m_s: float = 0.0
    """Speed up to which they give nothing. [m/s]"""
    whole_from_m_s: float = 0.0
    """Speed from which they give all. [m/s]"""
    reactive_ratio: float = 0.0
    """Reactive power, inductive, over the power that the line takes. [1]"""
    whole_up_to_v: float = 0.0
    """Voltage up to which the line takes all. [V]"""
    none_from_v: float = 0.0
    """Voltage from which it takes none. [V]"""
    efficiency: Curve = Curve.row()
    """Efficiency over speed, from motor shaft to pantograph. [1]"""
    rounded_v: float = ROUNDED_V
    """Length of each rounded end, no more than a quarter of the whole; 0: a straight line. [V]"""
    over_load: LoadCurve = LoadCurve.row()
    """Factor of the efficiency over the power of the electric brakes."""


@inlined
def electric_force(braking_n: float, speed_m_s: float, rails_n: float, own: Regeneration) -> float:
    """Part of a braking force that the motors give. [N]

    Parameters
    ----------
    braking_n : float
        Force of all brakes at the wheel rim, positive. [N]
    speed_m_s : float
        Speed. [m/s]
    rails_n : float
        What wheel and rail transmit at most. [N]
    own : Regeneration

    References
    ----------
    [EN50388]_, where regenerative braking is described; the limits are those of any traction drive.
    """
    share, _ = ramp(speed_m_s, own.none_up_to_m_s, own.whole_from_m_s, 0.0, 1.0)
    if share <= 0.0:
        return 0.0
    force = min(braking_n, own.highest_force_n, rails_n)
    if force * speed_m_s > own.highest_power_w:
        force = own.highest_power_w / speed_m_s
    return force * share


@inlined
def taken_share(voltage_v: float, own: Regeneration) -> tuple[float, float]:
    """Share of what the motors offer that the line takes, g, and its slope. [1], [1/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    own : Regeneration

    References
    ----------
    [EN50163]_, whose highest permanent and highest voltage are the usual ends of the fall.
    """
    above_v, length_v = voltage_v - own.whole_up_to_v, own.none_from_v - own.whole_up_to_v
    if above_v <= 0.0:
        return 1.0, 0.0
    if above_v >= length_v:
        return 0.0, 0.0
    rounded_v = min(own.rounded_v, length_v / 4.0)
    steepest = 1.0 / (length_v - rounded_v)
    if above_v < rounded_v:
        slope = steepest * above_v / rounded_v
        return 1.0 - slope * above_v / 2.0, -slope
    left_v = length_v - above_v
    if left_v < rounded_v:
        slope = steepest * left_v / rounded_v
        return slope * left_v / 2.0, -slope
    return 1.0 - steepest * (above_v - rounded_v / 2.0), -steepest
