"""Small plans for tests: the two-stage one by hand, textbook tables, and random ones."""

import itertools
from functools import cache

import numpy as np

from tpss.planning.money import Stages
from tpss.planning.problem import Area, Problem
from tpss.planning.transitions import Transitions
from tpss.planning.tree import make_tree

INF = np.inf


def two_stages(lead: int = 0) -> Problem:
    """Two stages of 10 years at no interest; ``weak`` (0) is there, ``strong`` (1) costs 100.

    A year of little traffic costs 2 with weak and 1 with strong supply, of much 20 and 2.  Stage 1 has
    little, stage 2 little with 0.6 and much with 0.4.
    """
    tree = make_tree(["low", "high"], [0.6, 0.4], [["little", "little"], ["little", "much"]])
    stages = Stages((2030, 2040), 2050, 0.0)
    cost = np.array([[2.0, 1.0], [2.0, 1.0], [20.0, 2.0]])
    change = np.array([[[0.0, 100.0], [INF, 0.0]]] * 2)
    ordered = (0, 1) if lead == 0 else (-1, 0)
    return Problem(tree, stages, (one_area(cost, change, ordered),))


def one_area(cost, change, ordered, outlay=None, name="line", initial=0) -> Area:
    outlay = np.where(np.isfinite(change), change, 0.0) if outlay is None else outlay
    return Area(
        name, np.asarray(cost), Transitions(np.asarray(change), outlay, initial), tuple(ordered)
    )


def random_plan(seed, *, areas=1, budget=False, forbid=0.15, nodes=6) -> Problem:
    """A random plan of up to 3 stages, 6 nodes and 5 configurations.

    Changes may be impossible (exclusions), configurations not allowed, orders at once or a stage ahead.
    """
    rng = np.random.default_rng(seed)
    shapes = [shape for shape in SHAPES if _size(shape) <= nodes]
    shape = shapes[rng.integers(len(shapes))]
    tree = make_tree(
        [f"s{k}" for k in range(len(shape))], rng.dirichlet(np.full(len(shape), 3.0)), shape
    )
    starts = np.cumsum([2030, *rng.integers(3, 12, len(shape[0]))])
    stages = Stages(tuple(starts[:-1]), starts[-1], float(rng.choice([0.0, 0.035, 0.1])))
    found = []
    for k in range(areas):
        size = int(rng.integers(2, 6 if areas == 1 else 4))
        cost = rng.uniform(5.0, 50.0, (tree.nodes, size))
        cost[rng.random(cost.shape) < forbid] = INF
        cost[:, 0] = np.where(np.isfinite(cost[:, 0]), cost[:, 0], 60.0)
        change = rng.uniform(20.0, 200.0, (len(stages), size, size))
        change[rng.random(change.shape) < 2 * forbid] = INF
        change[:, np.arange(size), np.arange(size)] = 0.0
        outlay = rng.uniform(20.0, 200.0, change.shape)
        outlay[:, np.arange(size), np.arange(size)] = 0.0
        ahead = int(rng.integers(2))
        ordered = [max(s - ahead, -1) for s in range(len(stages))]
        found.append(one_area(cost, change, ordered, outlay, f"line {k}"))
    limit = rng.uniform(30.0, 200.0, tree.nodes) * areas if budget else None
    return Problem(tree, stages, tuple(found), limit)


SHAPES = [
    [[0, 0]],
    [[0, 0], [0, 1]],
    [[0, 0], [0, 1], [0, 2]],
    [[0, 0, 0], [0, 0, 1], [0, 1, 0]],
    [[0, 0, 0], [0, 1, 0], [0, 1, 1]],
    [[0, 0], [1, 0], [1, 1]],
    [[0, 0, 0], [0, 0, 1], [0, 0, 2]],
]
"""Values of scenarios, a row each; trees of 2 to 6 nodes, one of which parts at once."""


def _size(shape):
    """Nodes of a tree."""
    return len({tuple(row[: s + 1]) for row in shape for s in range(len(row))})


def every_policy(problem):
    """All plans: any configuration in each node, the same where nodes are ordered together."""
    rows = [list(_of_area(problem, area)) for area in problem.areas]
    for combination in itertools.product(*rows):
        yield np.array(combination)


def _of_area(problem, area):
    tree = problem.tree
    for row in itertools.product(range(area.configurations), repeat=tree.nodes):
        if all(_follows_orders(tree, area, row, w) for w in range(len(tree.names))):
            yield row


def _follows_orders(tree, area, row, w):
    """What a scenario has is there today, or was ordered by all scenarios of its node then."""
    for s, at in enumerate(area.ordered_at):
        here = row[tree.node_of[w, s]]
        if at < 0 and here != area.transitions.initial:
            return False
        for other in range(len(tree.names)):
            together = at >= 0 and tree.node_of[other, at] == tree.node_of[w, at]
            if together and row[tree.node_of[other, s]] != here:
                return False
    return True


def slow_cost(problem, policy):
    """Expected cost scenario by scenario, year by year."""
    tree, stages = problem.tree, problem.stages
    total = 0.0
    for w, probability in enumerate(tree.scenario_probability):
        for area, row in zip(problem.areas, policy, strict=True):
            before = area.transitions.initial
            for s, start in enumerate(stages.start_year):
                node = tree.node_of[w, s]
                now = row[node]
                years = start - stages.start_year[0]
                total += (
                    probability * area.transitions.cost[s, before, now] / (1 + stages.rate) ** years
                )
                worth = _worth(stages.rate, years, int(stages.length_a[s]))
                total += probability * area.yearly_cost[node, now] * worth
                before = now
    return total


@cache
def _worth(rate, years, length):
    """Of 1 at the end of each year of a stage that begins some years from now."""
    return sum((1 + rate) ** -(years + year + 1) for year in range(length))


def slow_spending(problem, policy):
    """What is spent in each node, all areas together."""
    spent = np.zeros(problem.tree.nodes)
    for n in range(problem.tree.nodes):
        parent = problem.tree.parent[n]
        for area, row in zip(problem.areas, policy, strict=True):
            before = area.transitions.initial if parent < 0 else row[parent]
            spent[n] += area.transitions.outlay[problem.tree.stage[n], before, row[n]]
    return spent


def enumerated(problem):
    """The best plan of all by looking at each: its cost and it; infinite if there is none."""
    best, cheapest = None, INF
    for policy in every_policy(problem):
        if problem.budget is not None and (slow_spending(problem, policy) > problem.budget).any():
            continue
        if (cost := slow_cost(problem, policy)) < cheapest:
            best, cheapest = policy, cost
    return cheapest, best
