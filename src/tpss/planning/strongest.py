"""Bounds of what any supply uses: no less than the strongest ones that may stand, less a margin.

A supply that lacks what a stronger one has loses more and makes trains later.  So of a traffic no
configuration uses less energy than the best of the strongest, its trains lose no fewer minutes, and
it runs at most what it is asked for.  That is a supposition, not a law: a weak supply slows trains
down, which takes less power, and for that there is a margin.  Who relies on it tests it on every case
that was simulated (`tpss.planning.lazily`).
"""

import numpy as np

from tpss.planning.cases import AreaCases
from tpss.planning.money import Array
from tpss.planning.tree import Indices


def strongest(area: AreaCases) -> Indices:
    """Configurations of an area to which nothing can be added: no other has all that they have."""
    levels = np.array([each.levels for each in area.configurations])
    found: list[int] = []
    for c in np.argsort(-levels.sum(axis=1), kind="stable").tolist():
        # What has more comes before, and lies below one of those found, or is one.
        if not (levels[found] >= levels[c]).all(axis=1).any():
            found.append(c)
    return np.array(sorted(found), dtype=np.int64)


def bound_of(operation: Array, margin: float, drawn: int, given_back: int | None) -> Array:
    """Least use of a traffic by any configuration, shape (components,).

    Each component is the least of those of the strongest configurations, even where these differ.

    Parameters
    ----------
    operation : array
        Use of the strongest configurations, shape (configurations, components).
    margin : float
        Share by which energy may be less. [1]
    drawn : int
        Number of the component that is energy from the grid.
    given_back : int, optional
        Number of the component that is energy given back, of which there is as much more at most.
    """
    least: Array = operation.min(axis=0)
    least[drawn] *= 1.0 - margin
    if given_back is not None:
        least[given_back] = operation[:, given_back].max() * (1.0 + margin)
    return least
