r"""A plan to be found: which configuration each area has in service in each node of the tree.

Its expected cost, discounted to the start of the first stage, is

.. math:: \sum_n \pi_n \delta_n \big[ a_n f(c_n, n) + K(c_{parent(n)}, c_n) \big]

with the probability :math:`\pi` of a node, the discount factor :math:`\delta` of its stage, the present
factor :math:`a` of its years, the yearly cost :math:`f` and the cost of the transition :math:`K`.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tpss.errors import PlanError
from tpss.planning.money import Array, Stages
from tpss.planning.transitions import Changes
from tpss.planning.tree import NONE, Indices, Tree


@dataclass(frozen=True)
class Area:
    """A line that is simulated as a whole; areas have in common their budget only.

    Raises
    ------
    PlanError
        A cost is no number, or orders of a later stage are placed earlier than those of one before it.
    """

    name: str
    yearly_cost: Array
    """Cost a year, shape (nodes, configurations); infinite where a configuration is not allowed."""
    transitions: Changes
    ordered_at: tuple[int, ...]
    """Stage at whose start it is decided what each stage has in service; -1: it was before the first, so
    it is what is there today."""

    def __post_init__(self) -> None:
        if np.isnan(self.yearly_cost).any() or (self.yearly_cost == -np.inf).any():
            raise PlanError(
                f"area {self.name}: a yearly cost is missing: each is a number, or infinite"
            )
        if (
            self.yearly_cost.ndim != 2
            or self.yearly_cost.shape[1] != self.transitions.configurations
        ):
            raise PlanError(
                f"area {self.name}: yearly costs have the shape (nodes, configurations), "
                f"not {self.yearly_cost.shape}"
            )
        order = self.ordered_at
        late = any(at > s or at < NONE for s, at in enumerate(order))
        if late or any(after < before for before, after in itertools.pairwise(order)):
            raise PlanError(f"area {self.name}: stages cannot be ordered at {list(order)}")
        if len(order) != self.transitions.stages:
            raise PlanError(f"area {self.name}: transitions and orders have different stages")

    @property
    def configurations(self) -> int:
        """Number of configurations."""
        return self.transitions.configurations

    @property
    def first_free(self) -> int | None:
        """First stage whose configuration can be chosen, if there is one."""
        return next((s for s, at in enumerate(self.ordered_at) if at != NONE), None)


@dataclass(frozen=True)
class Problem:
    """Areas, the tree of what may become, and what may be spent.

    Raises
    ------
    PlanError
        Shapes do not fit, or two areas have the same name.
    """

    tree: Tree
    stages: Stages
    areas: tuple[Area, ...]
    budget: Array | None = None
    """What all areas may spend in each node, shape (nodes,); infinite where there is no limit."""

    def __post_init__(self) -> None:
        if self.tree.stages != len(self.stages):
            raise PlanError(
                f"{self.tree.stages} stages of values, and {len(self.stages)} of the plan"
            )
        if not self.areas or len({area.name for area in self.areas}) < len(self.areas):
            raise PlanError("a plan has an area at least, and each its own name")
        for area in self.areas:
            if len(area.yearly_cost) != self.tree.nodes or len(area.ordered_at) != len(self.stages):
                raise PlanError(f"area {area.name} has not the stages and nodes of the tree")
        if self.budget is not None:
            if self.budget.shape != (self.tree.nodes,) or np.isnan(self.budget).any():
                raise PlanError("a budget has a number for each node")
            if (self.budget < 0.0).any():
                raise PlanError("a budget is not negative")

    @property
    def weight(self) -> Array:
        """Probability of each node times the discount factor of its start, shape (nodes,)."""
        weight: Array = self.tree.probability * self.stages.discount[self.tree.stage]
        return weight

    def label(self, node: int) -> str:
        """A node in words: its stage, counted from 1, the year it begins, and its scenarios."""
        through = self.tree.scenarios_through(node)
        whose = "every scenario" if len(through) == len(self.tree.names) else " or ".join(through)
        stage = int(self.tree.stage[node])
        return f"stage {stage + 1} ({self.stages.start_year[stage]:g}), {whose}"

    @property
    def is_limited(self) -> bool:
        """Whether a budget couples areas or nodes."""
        return self.budget is not None and bool(np.isfinite(self.budget).any())

    def with_costs(self, yearly_cost: Sequence[Array]) -> "Problem":
        """The same with other yearly costs, one table for each area."""
        areas = (
            replace(area, yearly_cost=table)
            for area, table in zip(self.areas, yearly_cost, strict=True)
        )
        return replace(self, areas=tuple(areas))

    def only(self, area: int, nodes: Indices, configuration: int) -> "Problem":
        """The same with one configuration of an area allowed in some nodes."""
        table = self.areas[area].yearly_cost.copy()
        others = np.arange(table.shape[1]) != configuration
        table[np.ix_(nodes, others)] = np.inf
        tables = [table if k == area else one.yearly_cost for k, one in enumerate(self.areas)]
        return self.with_costs(tables)

    def of_scenario(self, scenario: int) -> "Problem":
        """The problem if one scenario were certain."""
        path = self.tree.node_of[scenario]
        areas = tuple(replace(area, yearly_cost=area.yearly_cost[path]) for area in self.areas)
        budget = None if self.budget is None else self.budget[path]
        return Problem(self.tree.alone(scenario), self.stages, areas, budget)

    def decided_today(self) -> "Problem":
        """The problem if everything that can be decided is decided at the start of the first stage."""
        areas = (
            replace(area, ordered_at=tuple(min(0, at) for at in area.ordered_at))
            for area in self.areas
        )
        return replace(self, areas=tuple(areas))


@dataclass(frozen=True)
class Solution:
    """A plan, what it costs, and what is known of the best one."""

    policy: Indices
    """Configuration in service, shape (areas, nodes)."""
    cost: float
    """Expected cost, discounted to the start of the first stage."""
    bound: float
    """No plan costs less."""

    @property
    def gap(self) -> float:
        """How much less a plan could cost at most, as a share of this one's cost."""
        return max(0.0, self.cost - self.bound) / max(abs(self.cost), 1e-300)
