r"""Changes as sums over measures: for so many configurations that a table of all pairs is too large.

What a change costs is a sum of what each measure's change of level costs, and of what depends on the
configuration after it alone, such as renewals.  The best configuration after is therefore found measure
by measure,

.. math:: \min_{c'} \Big[ \sum_m K_m(c_m, c'_m) + V(c') \Big]
    = \min_{c'_1} \Big[ K_1(c_1, c'_1) + \min_{c'_2} \big[ K_2(c_2, c'_2) + \dots \big] \Big]

on the grid of all levels, in which what is no configuration costs without end: the work grows with
the number of measures, and not with that of pairs.  Measures of which one takes the place of another are
one axis of the grid together.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError
from tpss.planning.money import Array
from tpss.planning.transitions import Changes, Transitions
from tpss.planning.tree import Indices

Flags = npt.NDArray[np.bool_]

MOST_PLACES = 20_000_000
"""Places of the grid of levels that are worked with, 32 bytes each."""

MOST_IN_PROGRAM = 1_000
"""Configurations of an area up to which plans with a budget are looked for."""


@dataclass(frozen=True)
class LevelTransitions:
    """Changes by axes, on each of which a configuration has a place.

    Raises
    ------
    PlanError
        Shapes do not fit, two configurations have the same places, or the grid is too large.
    """

    axes: Sequence[Transitions]
    """Changes of place on each axis."""
    place: Indices
    """Place of each configuration on each axis, shape (configurations, axes)."""
    extra_cost: Array
    """What a configuration is charged whatever was before it, shape (stages, configurations)."""
    extra_outlay: Array
    """What it spends whatever was before it, of the same shape."""
    initial: int = 0
    """Configuration that is there before the first stage."""

    def __post_init__(self) -> None:
        count, axes = self.place.shape
        shape = (self.stages, count)
        if axes != len(self.axes) or not self.extra_cost.shape == self.extra_outlay.shape == shape:
            raise PlanError("changes by measures have shapes that do not fit each other")
        if np.prod(self._shape, dtype=float) > MOST_PLACES:
            raise PlanError(
                f"the levels of the measures make {np.prod(self._shape, dtype=float):.3g} combinations, "
                f"more than {MOST_PLACES:,}: let fewer measures be built"
            )
        if len(np.unique(self._grid_index)) < count:
            raise PlanError("two configurations have the same levels of all measures")
        if not 0 <= self.initial < count:
            raise PlanError(f"there is no configuration {self.initial}, which is there at first")

    @property
    def stages(self) -> int:
        """Number of stages."""
        return len(self.extra_cost)

    @property
    def configurations(self) -> int:
        """Number of configurations."""
        return len(self.place)

    @cached_property
    def _shape(self) -> tuple[int, ...]:
        return tuple(axis.configurations for axis in self.axes)

    @cached_property
    def _grid_index(self) -> Indices:
        """Place of each configuration in the grid of all axes."""
        index: Indices = np.ravel_multi_index(tuple(self.place.T), self._shape).astype(np.int64)
        return index

    def cheapest(self, stage: int, after: Array) -> tuple[Array, Indices]:
        """Least cost of a change and of what comes after, from each configuration; one of equal ones."""
        cost = np.empty_like(after)
        to = np.empty(after.shape, dtype=np.int64)
        for group, row in enumerate(after + self.extra_cost[stage]):
            cost[group], to[group] = self._cheapest(stage, row)
        return cost, to

    def _cheapest(self, stage: int, after: Array) -> tuple[Array, Indices]:
        grid = np.full(self._shape, np.inf)
        grid.reshape(-1)[self._grid_index] = after
        to = np.zeros(self._shape, dtype=np.int64)
        to.reshape(-1)[self._grid_index] = np.arange(self.configurations)
        for k, axis in enumerate(self.axes):
            grid, to = _along(axis.cost[stage], grid, to, k)
        return grid.reshape(-1)[self._grid_index], to.reshape(-1)[self._grid_index]

    def costs_from(self, stage: int, before: int) -> Array:
        """What each change from a configuration is charged, shape (configurations,)."""
        total: Array = self.extra_cost[stage].copy()
        for k, axis in enumerate(self.axes):
            total += axis.cost[stage, self.place[before, k]][self.place[:, k]]
        return total

    def costs(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes are charged, of the shape of each."""
        return self._sum("cost", stage, before, after) + self.extra_cost[stage, after]

    def outlays(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes spend, of the shape of each."""
        return self._sum("outlay", stage, before, after) + self.extra_outlay[stage, after]

    def _sum(
        self, what: Literal["cost", "outlay"], stage: Indices, before: Indices, after: Indices
    ) -> Array:
        total: Array = np.zeros(np.broadcast(stage, before, after).shape)
        for k, axis in enumerate(self.axes):
            table: Array = getattr(axis, what)
            total = total + table[stage, self.place[before, k], self.place[after, k]]
        return total

    def ways(self, stage: int, after: Array) -> Array:
        """Sum over all possible changes of a figure of the configuration after."""
        possible = [np.isfinite(axis.cost[stage]) for axis in self.axes]
        return self._summed(possible, np.where(np.isfinite(self.extra_cost[stage]), after, 0.0))

    def reached(self, stage: int, before: Flags) -> Flags:
        """Which configurations can follow one of some, shape (configurations,)."""
        backwards = [np.isfinite(axis.cost[stage]).T for axis in self.axes]
        follows: Flags = self._summed(backwards, before) > 0.0
        follows &= np.isfinite(self.extra_cost[stage])
        return follows

    def _summed(self, possible: Sequence[Flags], figures: Array | Flags) -> Array:
        """Sum over possible changes of figures at their ends, for each beginning."""
        grid = np.zeros(self._shape)
        grid.reshape(-1)[self._grid_index] = figures
        for k, one in enumerate(possible):
            grid = np.moveaxis(np.tensordot(one.astype(np.float64), grid, axes=(1, k)), 0, k)
        total: Array = np.ascontiguousarray(grid).reshape(-1)[self._grid_index]
        return total

    def table(self) -> Transitions:
        """The same as a table of every configuration before and after."""
        every = np.arange(self.configurations)
        stage, before, after = np.ix_(np.arange(self.stages), every, every)
        return Transitions(
            self.costs(stage, before, after), self.outlays(stage, before, after), self.initial
        )


def table_of(changes: Changes) -> Transitions:
    """Changes as a table of all pairs, as programs with budgets need it.

    Raises
    ------
    PlanError
        There are too many configurations.
    """
    if isinstance(changes, Transitions):
        return changes
    if not isinstance(changes, LevelTransitions) or changes.configurations > MOST_IN_PROGRAM:
        raise PlanError(
            f"{changes.configurations:,} configurations of an area are too many for plans with a "
            f"budget, {MOST_IN_PROGRAM:,} at most: leave it out, or let fewer measures be built"
        )
    return changes.table()


def _along(change: Array, grid: Array, to: Indices, axis: int) -> tuple[Array, Indices]:
    """Least cost of a change along one axis and of what is there, and which configuration that is."""
    grid, to = np.moveaxis(grid, axis, 0), np.moveaxis(to, axis, 0)
    least, best = np.full(grid.shape, np.inf), np.zeros(to.shape, dtype=np.int64)
    for before, after in np.argwhere(np.isfinite(change)):
        cost = change[before, after] + grid[after]
        better = cost < least[before]
        np.copyto(least[before], cost, where=better)
        np.copyto(best[before], to[after], where=better)
    return np.moveaxis(least, 0, axis), np.moveaxis(best, 0, axis)
