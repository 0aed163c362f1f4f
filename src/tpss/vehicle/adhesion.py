"""What the rails pass on to a train: by their state, or by an adhesion of the train's own."""

from tpss.kernel import inlined
from tpss.numerics.curve import Points, curve_at
from tpss.physics.adhesion import adhesion_limit
from tpss.physics.constants import GRAVITY_M_S2
from tpss.vehicle.train_type import TrainType


@inlined
def adhesion_of(
    kind: TrainType, speed_m_s: float, rail: int, in_km_h: bool, points: Points
) -> float:
    """Largest tractive force that wheel and rail transmit. [N]

    Parameters
    ----------
    kind : TrainType
    speed_m_s : float
        Speed. [m/s]
    rail : int
        Of `Rail`.
    in_km_h : bool
        Whether the law of the rails takes the speed in km/h.
    points : Points
        Of all curves of the trains.

    References
    ----------
    [Boullanger2009]_, eq. (2.6), (F.5); with a coefficient of one's own its definition, F = μ m_adh g.
    """
    curve = kind.adhesion
    if curve.points > 0:
        coefficient = curve_at(speed_m_s, curve.first, curve.points, points)
        return kind.adhesive_mass_kg * GRAVITY_M_S2 * coefficient
    speed = speed_m_s * 3.6 if in_km_h else speed_m_s
    return adhesion_limit(kind.adhesive_mass_kg, speed, rail)
