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
from tpss.planning.learnt import Learnt
from tpss.planning.money import Array
from tpss.planning.plan import Evaluation
from tpss.planning.tree import Indices
from tpss.planning.yearly_use import ENERGY, FED_BACK, KWH_PER_MWH, Row, Simulated

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


def first_units(area: AreaCases, _: Evaluation) -> set[tuple[int, int]]:
    """States and configurations that are simulated first: those of the anchors."""
    states = range(len(area.states.states))
    return {(d, c) for d in states for c in anchors(area).tolist()}


def bounds_by_strongest(simulated: Simulated, _: Learnt) -> Array:
    """Least use of each traffic, the same for all configurations; NaN where no strongest came through.

    Shape (states, configurations, components).
    """
    case_list, components = simulated.case_list, simulated.components
    area, through = case_list.areas[simulated.number], simulated.through
    energies = energies_of(components)
    lost = {key: _lost_by_converters(row) * _kwh(simulated) for key, row in through.items()}
    # Where today's supply does not come through, its converters lose no less than with other traffic.
    ever = min((lost[key] for key in lost if key[1] == UNCHANGED), default=0.0)
    shape = (len(simulated.trains), len(area.configurations), len(components))
    bound = np.full(shape, np.nan)
    best = strongest(area).tolist()
    for d in range(shape[0]):
        there = [c for c in best if (d, c) in through]
        if there:
            uses = np.array([simulated.use(d, c) for c in there])
            losses = np.array([lost[d, c] for c in there])
            least = min(float(losses.min()), lost.get((d, UNCHANGED), ever))
            margin = case_list.plan.file.evaluate.bound_margin_percent / 100.0
            bound[d] = bound_of(uses, losses, least, margin, energies)
    return bound


def _kwh(simulated: Simulated) -> float:
    """Energy of a mean power of 1 MW in the hours of a year. [kWh]"""
    return simulated.hours * KWH_PER_MWH


def _lost_by_converters(row: Row) -> float:
    """What converters lose that describe it, in the mean. [MW]"""
    lost = row.get("converter_losses_mw")
    return 0.0 if lost is None or np.isnan(lost) else float(lost)


class Energies(NamedTuple):
    """Numbers of the components that are energy."""

    drawn: int
    given_back: int | None
    """Not counted where None."""


def energies_of(components: tuple[str, ...]) -> Energies:
    """Which components are energy."""
    back = components.index(FED_BACK) if FED_BACK in components else None
    return Energies(components.index(ENERGY), back)


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
