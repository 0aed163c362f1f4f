"""What may follow what, and what it costs: one-off costs of a change of configuration."""

from dataclasses import dataclass

import numpy as np

from tpss.errors import PlanError
from tpss.planning.money import Array
from tpss.planning.tree import Indices


@dataclass(frozen=True)
class Transitions:
    """One-off costs at the start of each stage, of what comes into service then.

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
    def configurations(self) -> int:
        """Number of configurations."""
        return int(self.cost.shape[1])

    def cheapest(
        self, stage: int, after: Array, multiplier: Array | None = None
    ) -> tuple[Array, Indices]:
        """Least cost of a change and of what comes after, from each configuration.

        Parameters
        ----------
        stage : int
            Stage in which the change comes into service.
        after : array
            Cost of each configuration from then on, shape (groups, configurations).
        multiplier : array, optional
            Price of each unit that is spent, shape (groups,), on top of its cost.

        Returns
        -------
        cost : array
            Shape (groups, configurations before).
        to : array
            Which configuration follows, of the same shape; the first of equal ones.
        """
        change = self.cost[stage]
        if multiplier is not None:
            change = change + multiplier[:, np.newaxis, np.newaxis] * self._spent[stage]
        total = change + after[:, np.newaxis, :]
        to = np.argmin(total, axis=2)
        return np.take_along_axis(total, to[:, :, np.newaxis], axis=2)[:, :, 0], to

    @property
    def _spent(self) -> Array:
        return np.where(np.isfinite(self.cost), self.outlay, 0.0)
