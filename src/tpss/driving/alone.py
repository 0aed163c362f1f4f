"""A train that has the line to itself, from stop to stop in one step of its own, at one voltage."""

import math

from tpss.driving.data import DrivingData, Floats
from tpss.driving.passage import pass_through
from tpss.kernel import at, kernel
from tpss.numerics.curve import Points
from tpss.record import Records
from tpss.vehicle.train import Train


@kernel
def drive_alone(
    voltage_v: float, trains: Records[Train], data: DrivingData, points: Points, scratch: Floats
) -> None:
    """Let the first of the trains drive through a step that takes it to its destination. [V]

    What it does is in its passage afterwards; its motion stays.

    References
    ----------
    [Boullanger2009]_, eq. (2.5)-(2.11), as `driving.passage`.
    """
    train = trains[0]
    kind = data.types[at(train.train_type)]
    # Drivers by laws of their own wish anew in each step, of which there is none here.
    train.decision.wanted_m_s = math.inf
    pass_through(voltage_v, train.passage, train, kind, data, points, scratch)
