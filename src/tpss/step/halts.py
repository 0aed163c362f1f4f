"""Times in which trains go no further than the next station at which they can stop."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, kernel
from tpss.vehicle.braking import braking_distance
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

Floats = npt.NDArray[np.float64]

ROUNDING_M = 0.001
"""A train that is past a station by no more stands there; one that brakes for it is that near. [m]"""


class Halts(NamedTuple):
    """When trains are held, and where."""

    times_s: Floats
    """From when until when, shape (events, 2). [s]"""
    places_m: Floats
    """Positions of the stations along each route, ascending, then infinite; shape (events, routes, n).
    [m]"""


def no_halts(routes: int) -> Halts:
    """Nobody is held."""
    return Halts(np.zeros((0, 2)), np.full((0, routes, 1), math.inf))


@kernel
def halt_ahead(now_s: float, train: Train, kind: TrainType, halts: Halts) -> float:
    """Position of the station at which a train is held; infinite: at none, in this step. [m]"""
    head_m, v, b = train.motion.position_m, train.motion.speed_m_s, kind.highest_retardation_m_s2
    nearest_m = head_m - ROUNDING_M
    if v > 0.0:
        nearest_m += braking_distance(v, b, kind.braking)
    halt_m = math.inf
    for e in range(halts.times_s.shape[0]):
        if not halts.times_s[at(e), 0] <= now_s < halts.times_s[at(e), 1]:
            continue
        for k in range(halts.places_m.shape[2]):
            place_m = halts.places_m[at(e), at(train.route), at(k)]
            if place_m >= nearest_m:
                halt_m = min(halt_m, place_m)
                break
    return halt_m
