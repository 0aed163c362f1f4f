"""Running resistance of a train outside a run, where a few values are not worth a compilation."""

from tpss.kernel import plain
from tpss.physics.running_resistance import running_resistance
from tpss.vehicle.resistance import resistance_at
from tpss.vehicle.train_type import TrainType


def resistance_of(speed_m_s: float, kind: TrainType) -> float:
    """Running resistance of a train on straight level track. [N]

    That by A, B and C is found as plain Python; a law of the train's own is compiled anyway.

    Parameters
    ----------
    speed_m_s : float
        Train speed, not negative. [m/s]
    kind : TrainType
    """
    if kind.own_resistance.address != 0:
        return resistance_at(speed_m_s, kind)
    return plain(running_resistance)(speed_m_s, kind.resistance)
