"""Running resistance of a train: A + B v + C v², or by a law of somebody's own."""

from tpss.kernel import inlined, kernel
from tpss.numerics.called import find_number
from tpss.physics.running_resistance import running_resistance
from tpss.vehicle.train_type import TrainType


@kernel
def _by_own_law(speed_m_s: float, kind: TrainType) -> float:
    """Running resistance by the law of its own that a train has. [N]"""
    davis = kind.resistance
    given = (
        speed_m_s, kind.mass_kg, davis.a_n, davis.b_n_s_per_m, davis.c_n_s2_per_m2,
    )  # fmt: skip
    return find_number(kind.own_resistance, given)[0]


@inlined
def resistance_at(speed_m_s: float, kind: TrainType) -> float:
    """Running resistance of a train on straight level track. [N]

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    kind : TrainType

    References
    ----------
    [Boullanger2009]_, eq. (2.8) and (F.2), unless the train has a law of its own.
    """
    if kind.own_resistance.address != 0:
        return _by_own_law(speed_m_s, kind)
    return running_resistance(speed_m_s, kind.resistance)
