"""Gradient of the track under a train, at a point or as a mean over the distance of a step."""

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined

Array = npt.NDArray[np.float64]

CREEPING_M = 1e-6
"""Distance below which a train stands as far as gradients go: a position rounds to some 1e-10 m, by
which a shorter distance would be off too far. [m]"""


@inlined
def mean_gradient(
    index: int, position_m: float, distance_m: float, from_m: Array, gradient: Array
) -> float:
    """Rise over a distance ahead, divided by the distance; the gradient at the point if it is short. [1]

    The climb of a long step is then the true one, wherever the gradient changes.  The gradients
    are summed one by one rather than by the difference of two altitudes, which would cancel.

    Parameters
    ----------
    index : int
        Of the gradient that holds at the position.
    position_m : float
        Position. [m]
    distance_m : float
        Distance ahead, not negative. [m]
    from_m, gradient : Array, shape (n,)
        The profile: positions from which the gradients hold, ascending [m]; rise over run, positive
        uphill [1].

    References
    ----------
    [Boullanger2009]_, the inclination of eq. (F.3).
    """
    if distance_m < CREEPING_M:
        return gradient[at(index)]
    end_m = position_m + distance_m
    climb_m = 0.0
    at_m = position_m
    while index + 1 < from_m.size and from_m[at(index + 1)] < end_m:
        climb_m += gradient[at(index)] * (from_m[at(index + 1)] - at_m)
        at_m = from_m[at(index + 1)]
        index += 1
    climb_m += gradient[at(index)] * (end_m - at_m)
    return climb_m / distance_m
