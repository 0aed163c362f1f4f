"""What the rounding of a position does to the braking that is found from it."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def excess_of_braking(position_m: Floats, stops_m: Floats, brakes: npt.NDArray[np.bool_]) -> Floats:
    r"""Share by which a train may have to brake harder in each interval, as its positions are rounded.

    A train that brakes within steps finds its retardation anew in each of them, b = v²/2d, from its
    distance d to the stop.  The position at the end of a step is off by half a spacing ε of floats, and
    so is the distance left, which is a difference of positions: b changes by ε/2d of itself.  What is
    behind in one step stays behind in the next, as d and v² shrink alike, so the shares add up:

    .. math:: \frac{\Delta b}{b} \le \sum_j \frac{\varepsilon_j}{2 d_j}

    over the instants j since the train began to brake.  At 1400 km ε is 2.3e-10 m; a step of 0.06 s at
    0.85 m/s² begins 1.5 mm before its end, so it may be 8e-8 of the retardation.

    Parameters
    ----------
    position_m : array, shape (n + 1,)
        Positions at the instants. [m]
    stops_m : array, shape (m,)
        Where the train stops, ascending. [m]
    brakes : array of bool, shape (n,)
        Whether its brakes act, between two instants.

    Returns
    -------
    array, shape (n,)
        None where the brakes do not act, or no stop is ahead. [1]
    """
    share, found = 0.0, np.zeros(brakes.size)
    for k in np.flatnonzero(brakes):
        ahead = stops_m[stops_m > position_m[k]]
        begins = k == 0 or not brakes[k - 1]
        left_m = ahead[0] - position_m[k] if ahead.size else np.inf
        here = np.spacing(abs(position_m[k])) / (2.0 * left_m)
        found[k] = share = here + (0.0 if begins else share)
    return found
