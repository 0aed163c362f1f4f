"""Forces that oppose a train: rolling and air resistance, and gravity on a gradient.

Sign: a positive force opposes forward motion.  Units: SI; the suffix of a name says which.
"""

from tpss.kernel import inlined, kernel
from tpss.physics.constants import GRAVITY_M_S2
from tpss.record import Record


class DavisCoefficients(Record):
    """Running resistance of a whole train on straight level track, R = a + b v + c v²."""

    a_n: float
    """Constant part, A. [N]"""
    b_n_s_per_m: float
    """Part that grows with the speed, B. [N s/m]"""
    c_n_s2_per_m2: float
    """Part that grows with its square, C. [N s²/m²]"""


@inlined
def running_resistance(speed_m_s: float, davis: DavisCoefficients) -> float:
    r"""Resistance of rolling and air on straight level track. [N]

    .. math:: F_{air,mech} = A + B v + C v^2

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    davis : DavisCoefficients

    References
    ----------
    [Boullanger2009]_, eq. (2.8) and (F.2).
    """
    return davis.a_n + davis.b_n_s_per_m * speed_m_s + davis.c_n_s2_per_m2 * speed_m_s**2


@inlined
def gradient_force(mass_kg: float, gradient: float) -> float:
    r"""Component of the train's weight along the track. [N]

    .. math:: F_{grades} = m g \alpha

    Parameters
    ----------
    mass_kg : float
        Mass of the whole train. [kg]
    gradient : float
        Rise over run, positive uphill; the thesis writes it in per mille. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.9) and (F.3).
    """
    return mass_kg * GRAVITY_M_S2 * gradient


@kernel
def curve_resistance(radius_m: float) -> float:
    r"""Resistance of a curve as a share of the train's weight, as if it were a gradient. [1]

    .. math:: w = \frac{650}{R - 55} ‰ \;\; (R \ge 300 \text{ m}), \quad
              w = \frac{500}{R - 30} ‰ \;\; (R < 300 \text{ m})

    Röckl's formula, for standard gauge; an estimate.

    Parameters
    ----------
    radius_m : float
        Radius of the curve, more than 55. [m]

    References
    ----------
    [Wende2003]_.
    """
    if radius_m >= 300.0:
        return by_radius(radius_m, 650.0, 55.0)
    return by_radius(radius_m, 500.0, 30.0)


@kernel
def by_radius(radius_m: float, permille_m: float, offset_m: float) -> float:
    r"""Resistance of a curve as a share of the train's weight, by a formula of one's own. [1]

    .. math:: w = \frac{k}{R - c} ‰

    Parameters
    ----------
    radius_m : float
        Radius of the curve, R, more than the offset. [m]
    permille_m, offset_m : float
        k, in per mille times metres, and c. [m]

    References
    ----------
    [Wende2003]_, the form of Röckl's formula.
    """
    return permille_m / 1000.0 / (radius_m - offset_m)
