r"""Physics times prices: what each configuration costs a year, from quantities that know no money.

A line under configuration :math:`c` that is asked for traffic :math:`d` runs the traffic :math:`g` which
costs least, of those that it can carry; what is not run of :math:`d` costs too:

.. math:: f(c, d) = \min_g \big[ p \cdot q_{c,g} + p \cdot u_{d,g} \big]

with the prices :math:`p`.  New prices therefore need no simulation, only two matrix products.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError
from tpss.planning.money import Array
from tpss.planning.tree import Indices

Flags = npt.NDArray[np.bool_]

BLOCK = 2_000_000
"""Costs that are worked on at a time, 8 bytes each."""


@dataclass(frozen=True)
class Quantities:
    """What an area uses and misses a year, in the units of its components.

    Raises
    ------
    PlanError
        Shapes do not fit, or a quantity is no number where its traffic can be run.
    """

    components: tuple[str, ...]
    """Names of what has a price: energy, late minutes, trains not run, ..."""
    operation: Array
    """Use by the traffic that is run, shape (traffic, configurations, components)."""
    carried: Flags
    """Whether a configuration carries that traffic, shape (traffic, configurations)."""
    unserved: Array
    """What is missing if other traffic is run than asked for, shape (asked for, traffic, components)."""
    may_serve: Flags
    """Whether traffic is no more than what is asked for, shape (asked for, traffic)."""
    state_of_node: Indices
    """Traffic that each node of the tree asks for, shape (nodes,)."""

    def __post_init__(self) -> None:
        traffic, configurations, components = self.operation.shape
        asked = len(self.unserved)
        if (
            components != len(self.components)
            or self.carried.shape != (traffic, configurations)
            or self.unserved.shape != (asked, traffic, components)
            or self.may_serve.shape != (asked, traffic)
            or not ((self.state_of_node >= 0) & (self.state_of_node < asked)).all()
        ):
            raise PlanError("quantities have shapes that do not fit each other")
        if not np.isfinite(self.operation[self.carried]).all():
            raise PlanError("a quantity of operation is missing")
        if not np.isfinite(self.unserved[self.may_serve]).all():
            raise PlanError("a quantity of what is not served is missing")

    def priced(self, price: Array) -> "Priced":
        """Costs at some prices.

        Parameters
        ----------
        price : array
            Price of a unit of each component, shape (components,), or (nodes, components) where
            prices differ between scenarios or stages.

        Raises
        ------
        PlanError
            A price is missing.
        """
        nodes = len(self.state_of_node)
        prices = np.broadcast_to(np.asarray(price, dtype=np.float64), (nodes, len(self.components)))
        if not np.isfinite(prices).all():
            missing = np.flatnonzero(~np.isfinite(prices).all(axis=0))
            raise PlanError(f"no price of {', '.join(self.components[k] for k in missing)}")
        rows, row = _different(prices)
        cells, cell = np.unique(np.stack([self.state_of_node, row]), axis=1, return_inverse=True)
        per_block = max(1, BLOCK // self.carried.size)
        blocks = [
            self._all_costs(rows[of_block[1]] if len(rows) > 1 else rows, of_block[0]).min(axis=1)
            for of_block in np.split(cells, range(per_block, cells.shape[1], per_block), axis=1)
        ]
        cost = np.concatenate(blocks, axis=1)[:, cell.reshape(-1)]
        return Priced(self, prices, np.ascontiguousarray(cost.T))

    def _all_costs(self, price: Array, states: Indices) -> Array:
        """Cost a year in some states, whatever is run, shape (configurations, traffic, states).

        At one price for all, or at one each; infinite where that traffic cannot be run.
        """
        missing = (self._unserved[states] * price[:, np.newaxis, :]).sum(axis=2)
        missing = np.where(self.may_serve[states], missing, np.inf)
        cost: Array = np.matmul(self._operation, price.T)
        cost += self._blocked[:, :, np.newaxis]
        if len(price) < len(states):  # one price for all
            return cost + missing.T
        cost += missing.T  # in its place: memory for another such table takes longer than the sum
        return cost

    @cached_property
    def _blocked(self) -> Array:
        """Infinite where a configuration does not carry its traffic, shape (configurations, traffic)."""
        return np.where(self.carried.T, 0.0, np.inf)

    @cached_property
    def _operation(self) -> Array:
        """Use, with 0 where it has no meaning, shape (configurations, traffic, components)."""
        use = np.where(self.carried[:, :, np.newaxis], self.operation, 0.0)
        return np.ascontiguousarray(use.transpose(1, 0, 2))

    @cached_property
    def _unserved(self) -> Array:
        """What is missing, with 0 where it has no meaning."""
        return np.where(self.may_serve[:, :, np.newaxis], self.unserved, 0.0)


@dataclass(frozen=True)
class Priced:
    """Costs of an area at some prices."""

    quantities: Quantities
    price: Array
    """Shape (nodes, components)."""
    yearly_cost: Array
    """Cost a year, shape (nodes, configurations); infinite where no traffic can be run."""

    def served(self, configuration: Indices) -> Indices:
        """Traffic that is run under the configuration of each node, shape (nodes,).

        The first of equal ones; without meaning where none can be run.
        """
        of = self.quantities
        use = (of.operation[:, configuration] * self.price).sum(axis=2).T
        missing = (of.unserved[of.state_of_node] * self.price[:, np.newaxis, :]).sum(axis=2)
        possible = of.may_serve[of.state_of_node] & of.carried[:, configuration].T
        traffic: Indices = np.argmin(np.where(possible, use + missing, np.inf), axis=1)
        return traffic

    def by_component(self, configuration: Indices) -> Array:
        """Cost a year by component, the configuration of each node given, shape (nodes, components)."""
        of, traffic = self.quantities, self.served(configuration)
        used = of.operation[traffic, configuration]
        missed = of.unserved[of.state_of_node, traffic]
        cost: Array = (used + missed) * self.price
        return cost


def _different(rows: Array) -> tuple[Array, Indices]:
    """Rows that are different, and which of them each row is."""
    if (rows == rows[0]).all():
        return rows[:1], np.zeros(len(rows), dtype=np.int64)
    different, which = np.unique(rows, axis=0, return_inverse=True)
    return different, which.reshape(-1)
