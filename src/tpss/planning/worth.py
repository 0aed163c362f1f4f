r"""What a plan, knowledge and freedom are worth: the values around the optimum.

=============  =====================================================================================
SP             the best plan, which learns as the future unfolds (stochastic programming)
WS             each future known beforehand: wait and see
EVPI           SP less the expected WS: what knowing the future is worth at most
fixed          the best plan that is decided today for ever
flexibility    fixed less SP: what being able to decide later is worth
EEV            today's decisions are those of a mean future, later ones are the best that remain
VSS            EEV less SP: what it costs to plan for the mean
=============  =====================================================================================

None of the differences is negative, as costs are minimised.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tpss.errors import NoPlanError
from tpss.planning.costs import expected_cost, node_costs
from tpss.planning.dynamic import solve
from tpss.planning.money import Array
from tpss.planning.problem import Area, Problem, Solution
from tpss.planning.tree import Indices, Tree

Solver = Callable[[Problem], Solution]


@dataclass(frozen=True)
class Worth:
    """Values around the optimum, expected and discounted to the start of the first stage."""

    best: Solution
    known: tuple[Solution, ...]
    """Best plan of each scenario if it is known beforehand; its policy is of that scenario's stages."""
    probability: Array
    """Of each scenario, shape (scenarios,)."""
    fixed: Solution | None
    """The best that is decided today for ever; None if each leaves some future without a plan."""
    mean: Solution | None
    """Today's decisions are those of a mean future; None if none was given, or nothing can follow."""

    @property
    def known_cost(self) -> Array:
        """WS: cost of each scenario if it is known beforehand, shape (scenarios,)."""
        return np.array([each.cost for each in self.known])

    @property
    def expected_known_cost(self) -> float:
        """Expected WS."""
        return float(self.probability @ self.known_cost)

    @property
    def of_information(self) -> float:
        """EVPI: what it would be worth at most to know the future."""
        return self.best.cost - self.expected_known_cost

    @property
    def of_flexibility(self) -> float | None:
        """What it is worth to be able to decide later; None if nothing else is possible."""
        return None if self.fixed is None else self.fixed.cost - self.best.cost

    @property
    def of_the_tree(self) -> float | None:
        """VSS: what it costs to plan for the mean future."""
        return None if self.mean is None else self.mean.cost - self.best.cost


def worth_of(
    problem: Problem, mean_cost: Sequence[Array] | None = None, solver: Solver = solve
) -> Worth:
    """Values around the optimum.

    Parameters
    ----------
    problem : Problem
    mean_cost : sequence of arrays, optional
        Yearly costs of a mean future, for each area of the shape (stages, configurations).
    solver : callable
        Finds the best plan of a problem: with budgets `tpss.planning.program.solve_program`.

    Raises
    ------
    NoPlanError
        There is no plan.
    """
    return Worth(
        best=solver(problem),
        known=known_plans(problem, solver),
        probability=problem.tree.scenario_probability,
        fixed=_if_any(solver, problem.decided_today()),
        mean=None if mean_cost is None else _planned_for_mean(problem, mean_cost, solver),
    )


def _if_any(solver: Solver, problem: Problem) -> Solution | None:
    """Best plan of a problem that may have none."""
    try:
        return solver(problem)
    except NoPlanError:
        return None


def known_plans(problem: Problem, solver: Solver = solve) -> tuple[Solution, ...]:
    """Best plan of each scenario if it is known beforehand."""
    count = len(problem.tree.names)
    return tuple(solver(problem.of_scenario(scenario)) for scenario in range(count))


def _planned_for_mean(
    problem: Problem, mean_cost: Sequence[Array], solver: Solver
) -> Solution | None:
    """Best plan whose decisions of today are those of the best plan of a mean future."""
    stages = np.arange(problem.tree.stages)
    chain = Tree(("mean",), np.ones(1), stages[np.newaxis, :])
    areas = tuple(
        replace(area, yearly_cost=table)
        for area, table in zip(problem.areas, mean_cost, strict=True)
    )
    # Of different budgets the mean future has the tightest: then its decisions are possible.
    budget = None
    if problem.budget is not None:
        budget = np.array([problem.budget[problem.tree.stage == s].min() for s in stages])
    mean = _if_any(solver, Problem(chain, problem.stages, areas, budget))
    if mean is None:
        return None
    for k, area in enumerate(problem.areas):
        for stage in decided_first(area):
            nodes = np.flatnonzero(problem.tree.stage == stage)
            problem = problem.only(k, nodes, int(mean.policy[k, stage]))
    return _if_any(solver, problem)


def decided_first(area: Area) -> list[int]:
    """Stages whose configuration is the first that is decided, all at the same time."""
    if area.first_free is None:
        return []
    first = area.ordered_at[area.first_free]
    return [s for s, at in enumerate(area.ordered_at) if at == first]


def costs_by_part(
    problem: Problem, policy: Indices, by_component: Sequence[Array]
) -> tuple[Array, Array]:
    """What a plan costs by component, stage and scenario.

    Parameters
    ----------
    problem : Problem
    policy : array
        Configuration of each node, shape (areas, nodes).
    by_component : sequence of arrays
        Cost a year of each component, for each area of the shape (nodes, components).

    Returns
    -------
    plain : array
        What is paid in all years of a stage together, and charged for changes at its start, not
        discounted, shape (components + 1, stages, scenarios); the last component are the changes.
    discounted : array
        The same, discounted to the start of the first stage.
    """
    stage, stages = problem.tree.stage, problem.stages
    yearly = np.sum(by_component, axis=0).T
    once = node_costs(problem, policy)[1].sum(axis=0)
    plain = np.vstack([yearly * stages.length_a[stage], once])
    present = np.vstack([yearly * stages.annuity[stage], once]) * stages.discount[stage]
    paths = problem.tree.node_of.T
    return plain[:, paths], present[:, paths]


@dataclass(frozen=True)
class Comparison:
    """A plan beside another one, such as to leave everything as it is."""

    saved: float
    """How much less it costs altogether: its net present value."""
    invested: float
    """How much more is charged for changes."""

    @property
    def ratio(self) -> float:
        """Net present value for each unit that is invested; NaN if nothing is."""
        return self.saved / self.invested if self.invested > 0.0 else np.nan


def compare(problem: Problem, policy: Indices, other: Indices) -> Comparison:
    """Value of a plan against another one.

    Parameters
    ----------
    problem : Problem
    policy, other : array
        Configuration of each node, shape (areas, nodes).
    """
    saved = expected_cost(problem, other) - expected_cost(problem, policy)
    changes = [
        float(problem.weight @ node_costs(problem, p)[1].sum(axis=0)) for p in (policy, other)
    ]
    return Comparison(saved, changes[0] - changes[1])
