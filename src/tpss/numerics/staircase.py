"""Staircases over position: each value holds from its position to the next one's.

The outer values continue beyond the ends.
"""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, kernel

Array = npt.NDArray[np.float64]


@kernel
def index_at(position_m: float, from_m: Array) -> int:
    """Index of the value that holds at a position (the first one before the staircase begins)."""
    low, high = 0, from_m.size
    while high - low > 1:
        middle = (low + high) // 2
        if from_m[middle] <= position_m:
            low = middle
        else:
            high = middle
    return low


@inlined
def index_from(index: int, position_m: float, from_m: Array) -> int:
    """`index_at`, searched upwards from an index that held not far behind: a binary search mispredicts
    its branches.
    """
    if from_m[at(index)] > position_m:
        return index_at(position_m, from_m)
    while index + 1 < from_m.size and from_m[at(index + 1)] <= position_m:
        index += 1
    return index


@inlined
def room_to_next(position_m: float, from_m: Array) -> float:
    """Distance to where the next value begins; infinite: there is none. [m]"""
    following = index_at(position_m, from_m) + 1
    return from_m[at(following)] - position_m if following < from_m.size else math.inf
