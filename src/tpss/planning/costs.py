"""What a plan costs, and what it spends: however it was found, this is how it is counted."""

import numpy as np

from tpss.planning.money import Array
from tpss.planning.problem import Problem
from tpss.planning.tree import NONE, Indices


def change_costs(problem: Problem, area: int, configuration: Indices) -> Array:
    """What the change into each node is charged, of one area, shape (nodes,)."""
    before = _before(problem, area, configuration)
    return problem.areas[area].transitions.costs(problem.tree.stage, before, configuration)


def change_outlays(problem: Problem, area: int, configuration: Indices) -> Array:
    """What the change into each node spends, of one area, shape (nodes,)."""
    before = _before(problem, area, configuration)
    return problem.areas[area].transitions.outlays(problem.tree.stage, before, configuration)


def _before(problem: Problem, area: int, configuration: Indices) -> Indices:
    """Configuration before each node, shape (nodes,)."""
    parent, initial = problem.tree.parent, problem.areas[area].transitions.initial
    before: Indices = np.where(parent == NONE, initial, configuration[parent])
    return before


def node_costs(problem: Problem, policy: Indices) -> tuple[Array, Array]:
    """What a plan costs in each node, undiscounted: a year, and once at its start.

    Each of the shape (areas, nodes).
    """
    nodes = np.arange(problem.tree.nodes)
    yearly = np.array(
        [a.yearly_cost[nodes, row] for a, row in zip(problem.areas, policy, strict=True)]
    )
    once = np.array([change_costs(problem, k, row) for k, row in enumerate(policy)])
    return yearly, once


def present_costs(problem: Problem, policy: Indices) -> Array:
    """What a plan costs in each node, discounted but without its probability, shape (nodes,)."""
    yearly, once = node_costs(problem, policy)
    stage = problem.tree.stage
    present: Array = problem.stages.discount[stage] * (
        problem.stages.annuity[stage] * yearly.sum(axis=0) + once.sum(axis=0)
    )
    return present


def expected_cost(problem: Problem, policy: Indices) -> float:
    """Expected discounted cost of a plan; infinite if it is not allowed."""
    return float(problem.tree.probability @ present_costs(problem, policy))


def cost_by_scenario(problem: Problem, policy: Indices) -> Array:
    """Discounted cost of a plan if a scenario comes true, shape (scenarios,)."""
    cost: Array = present_costs(problem, policy)[problem.tree.node_of].sum(axis=1)
    return cost


def outlay(problem: Problem, policy: Indices) -> Array:
    """What a plan spends in each node, shape (nodes,), in all areas."""
    spent = [change_outlays(problem, k, row) for k, row in enumerate(policy)]
    total: Array = np.sum(spent, axis=0)
    return total


def meets_budget(problem: Problem, policy: Indices) -> bool:
    """Whether a plan spends no more than its budget in any node, up to rounding."""
    if problem.budget is None:
        return True
    spent = outlay(problem, policy)
    return bool((spent <= problem.budget + 1e-9 * np.maximum(1.0, spent)).all())
