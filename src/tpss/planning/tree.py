"""The tree of what may become of traffic and prices, from scenarios as rows of values.

Two scenarios are one node as long as their values are equal: until then nobody can tell them apart, so
no plan can treat them differently.
"""

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError

Indices = npt.NDArray[np.int64]
Array = npt.NDArray[np.float64]

ROUNDING = 1e-9
"""By how much the sum of probabilities may differ from 1."""

NONE = -1
"""Parent of a node of the first stage."""


@dataclass(frozen=True)
class Parting:
    """Where scenarios part that were one until then."""

    stage: int
    """First stage in which they differ."""
    groups: tuple[tuple[str, ...], ...]
    """Names of those that are still one, group by group."""


@dataclass(frozen=True)
class Tree:
    """Nodes in the order of their stages, so a parent comes before its children."""

    names: tuple[str, ...]
    """Names of the scenarios."""
    scenario_probability: Array
    """Shape (scenarios,); their sum is 1."""
    node_of: Indices
    """Node of each scenario in each stage, shape (scenarios, stages)."""

    @property
    def stages(self) -> int:
        """Number of stages."""
        return int(self.node_of.shape[1])

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.stage)

    @cached_property
    def stage(self) -> Indices:
        """Stage of each node, shape (nodes,)."""
        stage = np.empty(int(self.node_of.max()) + 1, dtype=np.int64)
        for s in range(self.stages):
            stage[self.node_of[:, s]] = s
        return stage

    @cached_property
    def parent(self) -> Indices:
        """Node before each node, shape (nodes,); -1 in the first stage."""
        parent = np.full(self.nodes, NONE, dtype=np.int64)
        for s in range(1, self.stages):
            parent[self.node_of[:, s]] = self.node_of[:, s - 1]
        return parent

    @cached_property
    def probability(self) -> Array:
        """Probability of each node, shape (nodes,); the sum of each stage is 1."""
        probability = np.zeros(self.nodes)
        for s in range(self.stages):
            np.add.at(probability, self.node_of[:, s], self.scenario_probability)
        return probability

    def ancestors(self, stage: int, at: int) -> Indices:
        """Nodes of a stage and the ancestor of each in an earlier one, shape (2, nodes of the stage)."""
        nodes, first = np.unique(self.node_of[:, stage], return_index=True)
        return np.stack([nodes, self.node_of[first, at]])

    def scenarios_through(self, node: int) -> tuple[str, ...]:
        """Names of the scenarios that a node belongs to."""
        rows = np.flatnonzero(self.node_of[:, self.stage[node]] == node)
        return tuple(self.names[row] for row in rows)

    def partings(self) -> tuple[Parting, ...]:
        """Where scenarios part, in the order of the stages: from then on one knows."""
        found = []
        for s in range(self.stages):
            before = self.node_of[:, s - 1] if s else np.zeros(len(self.names), dtype=np.int64)
            for node in np.unique(before):
                rows = np.flatnonzero(before == node)
                now = self.node_of[rows, s]
                if len(each := np.unique(now)) > 1:
                    groups = (tuple(self.names[row] for row in rows[now == one]) for one in each)
                    found.append(Parting(s, tuple(groups)))
        return tuple(found)

    def alone(self, scenario: int) -> "Tree":
        """The tree if one scenario were certain: a chain of a node a stage."""
        return Tree((self.names[scenario],), np.ones(1), np.arange(self.stages)[np.newaxis, :])


def make_tree(
    names: Sequence[str], probabilities: Sequence[float], values: Sequence[Sequence[Hashable]]
) -> Tree:
    """Tree of some scenarios.

    Parameters
    ----------
    names : sequence of str
        Names of the scenarios.
    probabilities : sequence of float
        Their probabilities.
    values : sequence of sequences
        For each scenario a value a stage, whatever it consists of; equal ones are one state.

    Raises
    ------
    PlanError
        Probabilities are not positive or do not add up to 1, a scenario has another number of stages,
        or a name is not unique.
    """
    _check(names, probabilities, values)
    node_of = np.empty((len(names), len(values[0])), dtype=np.int64)
    nodes: dict[tuple[int, Hashable], int] = {}
    for s in range(node_of.shape[1]):
        for w, row in enumerate(values):
            before = int(node_of[w, s - 1]) if s else NONE
            node_of[w, s] = nodes.setdefault((before, row[s]), len(nodes))
    return Tree(tuple(names), np.asarray(probabilities, dtype=np.float64), node_of)


def _check(
    names: Sequence[str], probabilities: Sequence[float], values: Sequence[Sequence[Hashable]]
) -> None:
    if not names or len(names) != len(probabilities) or len(names) != len(values):
        raise PlanError(
            "each scenario has a name, a probability and values, and there is one at least"
        )
    if len(set(names)) < len(names):
        raise PlanError(f"scenarios have different names, not {', '.join(names)}")
    for name, probability in zip(names, probabilities, strict=True):
        if not probability > 0.0:
            raise PlanError(f"scenario {name}: a probability is positive, not {probability:g}")
    if not abs(math.fsum(probabilities) - 1.0) <= ROUNDING:
        total = math.fsum(probabilities)
        raise PlanError(f"the probabilities of the scenarios add up to 1, not {total:.10g}")
    for name, row in zip(names, values, strict=True):
        if not row or len(row) != len(values[0]):
            stages = f"{len(row)} values, and {names[0]} {len(values[0])}"
            raise PlanError(f"scenario {name}: a value a stage is needed; it has {stages}")
