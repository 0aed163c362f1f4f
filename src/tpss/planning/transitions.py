"""What may follow what, and what it costs: one-off costs of a change of configuration."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError
from tpss.planning.money import Array
from tpss.planning.tree import Indices

Flags = npt.NDArray[np.bool_]


class Changes(Protocol):
    """Changes of configuration at the start of each stage, of what comes into service then."""

    @property
    def initial(self) -> int:
        """Configuration that is there before the first stage."""

    @property
    def stages(self) -> int:
        """Number of stages."""

    @property
    def configurations(self) -> int:
        """Number of configurations."""

    def cheapest(self, stage: int, after: Array) -> tuple[Array, Indices]:
        """Least cost of a change and of what comes after, from each configuration.

        Parameters
        ----------
        stage : int
            Stage in which the change comes into service.
        after : array
            Cost of each configuration from then on, shape (groups, configurations).

        Returns
        -------
        cost : array
            Shape (groups, configurations before).
        to : array
            Which configuration follows, of the same shape; one of equal ones.
        """

    def costs_from(self, stage: int, before: int) -> Array:
        """What each change from a configuration is charged, shape (configurations,).

        Infinite where one is not possible.
        """

    def costs(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes are charged, of the shape of each."""

    def outlays(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes spend, of the shape of each."""

    def ways(self, stage: int, after: Array) -> Array:
        """Sum over all possible changes from each configuration of a figure of the one after.

        Both of the shape (configurations,).
        """

    def reached(self, stage: int, before: Flags) -> Flags:
        """Which configurations can follow one of some, shape (configurations,)."""


@dataclass(frozen=True)
class Transitions:
    """Changes as a table of every configuration before and after.

    Raises
    ------
    PlanError
        A shape does not fit, a cost is no number, or spending is not known where a change is possible.
    """

    cost: Array
    """What is charged to the plan, at the start of the stage, shape (stages, from, to); infinite where
    one configuration cannot follow another."""
    outlay: Array
    """What is spent, and counts towards a budget, of the same shape."""
    initial: int = 0
    """Configuration that is there before the first stage."""

    def __post_init__(self) -> None:
        shape = self.cost.shape
        if len(shape) != 3 or shape[1] != shape[2] or self.outlay.shape != shape:
            raise PlanError(
                "costs and outlays of transitions have the shape (stages, from, to), "
                f"not {shape} and {self.outlay.shape}"
            )
        if np.isnan(self.cost).any() or (self.cost == -np.inf).any():
            raise PlanError("a cost of a transition is missing: each is a number, or infinite")
        if not np.isfinite(self.outlay[np.isfinite(self.cost)]).all():
            raise PlanError("what a transition spends is missing")
        if not 0 <= self.initial < shape[1]:
            raise PlanError(f"there is no configuration {self.initial}, which is there at first")

    @property
    def stages(self) -> int:
        """Number of stages."""
        return len(self.cost)

    @property
    def configurations(self) -> int:
        """Number of configurations."""
        return int(self.cost.shape[1])

    def cheapest(
        self,
        stage: int,
        after: Array,
        multiplier: Array | None = None,
        limit: Array | None = None,
    ) -> tuple[Array, Indices]:
        """Least cost of a change and of what comes after; the first of equal ones.

        As `Changes` has it, and with budgets:

        Parameters
        ----------
        stage : int
        after : array
        multiplier : array, optional
            Price of each unit that is spent, shape (groups,), on top of its cost.
        limit : array, optional
            What may be spent, shape (groups,).
        """
        change = self.cost[stage]
        if multiplier is not None:
            change = change + multiplier[:, np.newaxis, np.newaxis] * self.spent[stage]
        total = change + after[:, np.newaxis, :]
        if limit is not None:
            total[self.spent[stage] > limit[:, np.newaxis, np.newaxis]] = np.inf
        to = np.argmin(total, axis=2)
        return np.take_along_axis(total, to[:, :, np.newaxis], axis=2)[:, :, 0], to

    def costs_from(self, stage: int, before: int) -> Array:
        """What each change from a configuration is charged, shape (configurations,)."""
        cost: Array = self.cost[stage, before]
        return cost

    def costs(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes are charged, of the shape of each."""
        cost: Array = self.cost[stage, before, after]
        return cost

    def outlays(self, stage: Indices, before: Indices, after: Indices) -> Array:
        """What some changes spend, of the shape of each."""
        outlay: Array = self.outlay[stage, before, after]
        return outlay

    def ways(self, stage: int, after: Array) -> Array:
        """Sum over all possible changes of a figure of the configuration after."""
        total: Array = np.isfinite(self.cost[stage]) @ after
        return total

    def reached(self, stage: int, before: Flags) -> Flags:
        """Which configurations can follow one of some, shape (configurations,)."""
        follows: Flags = np.isfinite(self.cost[stage])[before].any(axis=0)
        return follows

    @cached_property
    def spent(self) -> Array:
        """What is spent, with 0 where a change is not possible."""
        return np.where(np.isfinite(self.cost), self.outlay, 0.0)
