"""Bounds of what any supply uses: no less than the strongest ones that may stand, less a margin.

A supply that lacks what a stronger one has loses more on the line and makes trains later.  So of a
traffic the railway takes no less energy than with the best of the strongest, its trains lose no fewer
minutes, and what runs is at most what is asked for.  Converters are another matter: the more there are,
the more they lose without load.  Their losses are taken to be no less than those of the strongest
supplies and of today's, whichever lose less.

That is a supposition, not a law: a weak supply slows trains down, which takes less power, and for that
there is a margin.  Who relies on it tests it on every case that was simulated (`tpss.planning.lazily`).
"""

from typing import NamedTuple

import numpy as np

from tpss.planning.cases import AreaCases
from tpss.planning.money import Array
from tpss.planning.tree import Indices

UNCHANGED = 0
"""Number of the configuration that is there today."""


def strongest(area: AreaCases) -> Indices:
    """Configurations of an area to which nothing can be added: no other has all that they have."""
    levels = np.array([each.levels for each in area.configurations])
    found: list[int] = []
    for c in np.argsort(-levels.sum(axis=1), kind="stable").tolist():
        # What has more comes before, and lies below one of those found, or is one.
        if not (levels[found] >= levels[c]).all(axis=1).any():
            found.append(c)
    return np.array(sorted(found), dtype=np.int64)


def anchors(area: AreaCases) -> Indices:
    """Configurations that give the bounds: the strongest ones, and today's for what converters lose."""
    return np.union1d(strongest(area), [UNCHANGED])


class Energies(NamedTuple):
    """Numbers of the components that are energy."""

    drawn: int
    given_back: int | None
    """Not counted where None."""


def bound_of(
    operation: Array, lost: Array, least_lost: float, margin: float, energies: Energies
) -> Array:
    """Least use of a traffic by any configuration, shape (components,).

    Each component is the least of those of the strongest configurations, even where these differ.

    Parameters
    ----------
    operation : array
        Use of the strongest configurations, shape (configurations, components).
    lost : array
        What converters lose of it, in the unit of energy, shape (configurations,).
    least_lost : float
        What they lose at least in any configuration.
    margin : float
        Share by which energy may be less, and what is given back more. [1]
    energies : Energies
    """
    least: Array = operation.min(axis=0)
    railway = (operation[:, energies.drawn] - lost).min()
    least[energies.drawn] = (railway + least_lost) * (1.0 - margin)
    if energies.given_back is not None:
        back = operation[:, energies.given_back]
        most = np.where(back > 0.0, back + lost - least_lost, 0.0).max()
        least[energies.given_back] = most * (1.0 + margin)
    return least
