"""The tree of decisions of an area: nodes that must have the same in service are one group.

What is in service in a node was ordered in an ancestor, so all nodes after that ancestor share it.  An
order without lead time makes each node its own group; one decided today for ever a group a stage.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tpss.planning.money import Array
from tpss.planning.problem import Problem
from tpss.planning.tree import NONE, Indices


@dataclass(frozen=True)
class Decisions:
    """Groups of nodes in the order of their stages, with what they cost."""

    group_of_node: Indices
    """Shape (nodes,)."""
    stage: Indices
    """Stage of each group, shape (groups,)."""
    parent: Indices
    """Group before each group, shape (groups,); -1 in the first stage."""
    weight: Array
    """Probability times discount factor, shape (groups,)."""
    cost: Array
    """Expected discounted cost of each configuration's operation, shape (groups, configurations);
    infinite where it is not allowed."""

    @property
    def groups(self) -> int:
        """Number of groups."""
        return len(self.stage)

    @cached_property
    def of_stage(self) -> list[Indices]:
        """Groups of each stage."""
        return [np.flatnonzero(self.stage == s) for s in range(int(self.stage.max()) + 1)]

    @cached_property
    def children(self) -> list[Indices]:
        """Groups after each group."""
        return [np.flatnonzero(self.parent == g) for g in range(self.groups)]

    def total(self, of_node: Array) -> Array:
        """Sum of a figure of each node over the nodes of each group, shape (groups,)."""
        return _total(self.group_of_node, of_node, self.groups)

    def smallest(self, of_node: Array) -> Array:
        """Smallest figure of the nodes of each group, shape (groups,)."""
        least = np.full(self.groups, np.inf)
        np.minimum.at(least, self.group_of_node, of_node)
        return least

    def nodes(self, group: int) -> Indices:
        """Nodes of a group."""
        return np.flatnonzero(self.group_of_node == group)


def decisions_of(problem: Problem, area: int) -> Decisions:
    """Decisions of an area of a plan, with their expected discounted costs."""
    tree, one = problem.tree, problem.areas[area]
    groups = np.empty(tree.nodes, dtype=np.int64)
    stage: list[int] = []
    for s, at in enumerate(one.ordered_at):
        nodes, ancestors = tree.ancestors(s, max(at, 0))
        key = ancestors if at != NONE else np.zeros_like(ancestors)
        different, which = np.unique(key, return_inverse=True)
        groups[nodes] = len(stage) + which
        stage += [s] * len(different)
    parent = np.full(len(stage), NONE, dtype=np.int64)
    later = tree.parent != NONE
    parent[groups[later]] = groups[tree.parent[later]]
    weight = _total(groups, problem.weight, len(stage))
    cost = np.zeros((len(stage), one.configurations))
    yearly = (problem.weight * problem.stages.annuity[tree.stage])[:, np.newaxis]
    np.add.at(cost, groups, yearly * one.yearly_cost)
    for s, at in enumerate(one.ordered_at):
        if at == NONE:
            others = np.arange(one.configurations) != one.transitions.initial
            cost[np.ix_(np.asarray(stage) == s, others)] = np.inf
    return Decisions(groups, np.asarray(stage), parent, weight, cost)


def _total(group: Indices, figure: Array, groups: int) -> Array:
    return np.bincount(group, figure, groups).astype(np.float64)
