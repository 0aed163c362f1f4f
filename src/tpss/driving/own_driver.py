"""Drivers by a law of somebody's own: the speed that he wants, found at the start of each step.

A slower train accelerates up to it, a faster one coasts down to it (`driving.coasting`); limits and
stops hold as ever.
"""

import math

from tpss.driving.data import DrivingData
from tpss.driving.lookahead import highest_speed
from tpss.driving.stops import distance_to_stop
from tpss.kernel import at, inlined, kernel
from tpss.numerics.called import find_number
from tpss.numerics.staircase import index_at
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

SLOWEST_WISH_M_S = 1.0 / 3.6
"""Least speed that a driver may want, so that a train which stands goes on. [m/s]"""


@kernel
def _by_own_law(train: Train, kind: TrainType, data: DrivingData) -> float:
    """Speed that a driver wants by the law of his own. [m/s]"""
    motion, row = train.motion, at(kind.profile)
    here = index_at(motion.position_m, data.limits.from_m[row])
    limit_m_s = highest_speed(data.limits.value[row][at(here)], kind)
    room_m = distance_to_stop(train, data.stops)
    wanted = find_number(kind.driver, (motion.speed_m_s, limit_m_s, motion.position_m, room_m))[0]
    # Not `max`, which would let pass what is not a number.
    return wanted if wanted > SLOWEST_WISH_M_S else SLOWEST_WISH_M_S


@inlined
def wanted_speed(train: Train, kind: TrainType, data: DrivingData) -> float:
    """Speed that the driver of a train wants in this step; infinite: what the limits allow. [m/s]"""
    return _by_own_law(train, kind, data) if kind.driver.address != 0 else math.inf
