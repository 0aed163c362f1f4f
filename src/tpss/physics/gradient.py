"""Gradient of the track under a train, at a point or as a mean over the way of a step.

A profile is a staircase: each gradient holds from its position to the next one's; the outer ones go
on beyond the profile's ends.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, kernel

Array = npt.NDArray[np.float64]


@kernel
def step_index(position_m: float, from_m: Array) -> int:
    """Index of the stair that holds at a position (the first one before the profile begins)."""
    low, high = 0, from_m.size
    while high - low > 1:
        middle = (low + high) // 2
        if from_m[middle] <= position_m:
            low = middle
        else:
            high = middle
    return low


@inlined
def stair_ahead(stair: int, position_m: float, from_m: Array) -> int:
    """`step_index`, found from a stair that held not far behind: a search mispredicts its branches."""
    if from_m[at(stair)] > position_m:
        return step_index(position_m, from_m)
    while stair + 1 < from_m.size and from_m[at(stair + 1)] <= position_m:
        stair += 1
    return stair


@inlined
def mean_gradient(
    stair: int, position_m: float, way_m: float, from_m: Array, gradient: Array
) -> float:
    """Altitude difference over a way, divided by the way; the gradient at a point if it is zero. [1]

    The climb of a long step is then the true one, whatever the profile does on the way.  The stairs
    are summed one by one rather than by the difference of two altitudes, which would cancel.

    Parameters
    ----------
    stair : int
        The stair that holds where the way begins.
    position_m : float
        Where that is. [m]
    way_m : float
        Length of the way ahead, not negative. [m]
    from_m, gradient : Array, shape (n,)
        The profile: positions from which the gradients hold, ascending [m]; rise over run, positive
        uphill [1].

    References
    ----------
    [Boullanger2009]_, the inclination of eq. (F.3).
    """
    if way_m <= 0.0:
        return gradient[at(stair)]
    end_m = position_m + way_m
    climb_m = 0.0
    at_m = position_m
    while stair + 1 < from_m.size and from_m[at(stair + 1)] < end_m:
        climb_m += gradient[at(stair)] * (from_m[at(stair + 1)] - at_m)
        at_m = from_m[at(stair + 1)]
        stair += 1
    climb_m += gradient[at(stair)] * (end_m - at_m)
    return climb_m / way_m
