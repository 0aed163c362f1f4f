"""Adhesion between wheel and rail: the tractive effort that the rails can take."""

from enum import IntEnum

from tpss.kernel import inlined
from tpss.physics.constants import GRAVITY_M_S2


class Rail(IntEnum):
    """State of the rails."""

    DRY = 0
    WET = 1


@inlined
def adhesion_limit(adhesive_mass_kg: float, speed: float, rail: int) -> float:
    r"""Largest tractive force that wheel and rail transmit. [N]

    .. math::
        F_{tract,adh} = m_{adh} g \left(0.161 + \frac{7.5}{44 + 3.6 v}\right) \text{ (dry)}, \quad
        F_{tract,adh} = m_{adh} g \frac{3.78}{23.6 + v} \text{ (wet)}

    Parameters
    ----------
    adhesive_mass_kg : float
        Mass on driven axles. [kg]
    speed : float
        Speed, not negative.  In m/s the dry law is Curtius and Kniffler's; the thesis prints km/h,
        which converts twice (see Notes).
    rail : int
        Of `Rail`.

    Notes
    -----
    With v in m/s the dry law is 7.5 / (V + 44) + 0.161 with V in km/h, as it is widely published.
    The thesis states v in km/h in both formulas, and its old results suggest that the original
    program did the same; the caller chooses the unit.  The wet law matches 13.6 / (85 + V) with V in
    km/h, whose source is not known to us.

    References
    ----------
    [Boullanger2009]_, eq. (2.6) and (F.5).
    """
    if rail == Rail.WET:
        return adhesive_mass_kg * GRAVITY_M_S2 * 3.78 / (23.6 + speed)
    return adhesive_mass_kg * GRAVITY_M_S2 * (0.161 + 7.5 / (44.0 + 3.6 * speed))
