"""The answer to a plan: what to do when, what else one could do, and what it is worth to know."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from tpss.errors import NoPlanError
from tpss.planning.claim import claim
from tpss.planning.costs import expected_cost
from tpss.planning.counting import number_of_plans
from tpss.planning.dynamic import FirstDecision, first_decisions
from tpss.planning.lazily import proof_of
from tpss.planning.mean_future import MeanFuture, mean_future_of
from tpss.planning.problem import Problem, Solution
from tpss.planning.program import GAP, solve_any
from tpss.planning.prove import Proof
from tpss.planning.solve import Model
from tpss.planning.tree import Indices
from tpss.planning.worth import Worth, decided_first, worth_of


@dataclass(frozen=True)
class Effort:
    """How long a plan with budgets is looked for."""

    gap: float = GAP
    """Share of the cost within which a better plan is not looked for."""
    time_limit_s: float = np.inf
    """Time after which the best plan so far is taken, of each problem. [s]"""


@dataclass(frozen=True)
class Answer:
    """The best plan of a model, and what belongs to it."""

    model: Model
    worth: Worth
    firsts: tuple[FirstDecision, ...]
    """First decisions of each area with the best plan that contains each, the best one first."""
    claim: str
    """What may be claimed of the plan."""
    is_closed: bool
    """Whether no better plan is possible, up to the gap that was asked for, as far as is known."""
    proof: Proof
    """What the claim stands on."""
    mean: MeanFuture | None
    """What someone would plan for who knows the means only; None where there is none."""

    @property
    def best(self) -> Solution:
        """The best plan."""
        return self.worth.best

    def is_bound(self, policy: Indices, scenario: int | None = None) -> bool:
        """Whether what a plan costs is a bound, as not all that it uses was simulated.

        Parameters
        ----------
        policy : array of int, shape (areas, nodes)
            Or of the shape (areas, stages), of one scenario.
        scenario : int, optional
        """
        if not self.model.has_bounds:
            return False
        tree = self.model.tree
        nodes = None if scenario is None else tree.node_of[scenario]
        return bool(self.model.lacking_of(policy, nodes))


def answer_of(model: Model, effort: Effort = Effort()) -> Answer:
    """Solve a model all of whose cases were simulated, or that a proof by bounds has made.

    Raises
    ------
    NoPlanError
        No plan meets the budgets.
    PlanError
        There is no plan yet when the time is over, a solver is not installed, or the best plan uses
        what was not simulated.
    """
    problem, mean = model.problem, mean_future_of(model)
    worth = worth_of(problem, None if mean is None else mean.yearly_cost, solver_of(effort))
    proof = proof_of(model, worth.best)
    firsts = first_choices(problem, worth.best, effort)
    sentence = claim(proof, number_of_plans(problem), effort.gap)
    is_closed = worth.best.gap <= effort.gap and proof.holds
    return Answer(model, worth, tuple(firsts), sentence, is_closed, proof, mean)


def solver_of(effort: Effort) -> Callable[[Problem], Solution]:
    """What finds the best plan of a problem."""
    return partial(solve_any, gap=effort.gap, time_limit_s=effort.time_limit_s)


def first_choices(problem: Problem, best: Solution, effort: Effort) -> list[FirstDecision]:
    """Every first decision with the best plan that contains it, within budgets too."""
    if not problem.is_limited:
        return first_decisions(problem)
    found: list[FirstDecision] = []
    for k, area in enumerate(problem.areas):
        own: list[FirstDecision] = []
        for stage in decided_first(area)[:1]:
            nodes = np.flatnonzero(problem.tree.stage == stage)
            for c in range(area.configurations):
                solution = with_first(problem, k, nodes, c, effort)
                if solution is not None:
                    surplus = max(0.0, solution.cost - best.cost)
                    own.append(FirstDecision(k, nodes, c, solution.cost, surplus, solution.policy))
        found += sorted(own, key=lambda each: each.cost)
    return found


def with_first(
    problem: Problem, area: int, nodes: Indices, configuration: int, effort: Effort
) -> Solution | None:
    """Best plan with a configuration of an area in some nodes; None if there is none."""
    try:
        return solve_any(problem.only(area, nodes, configuration), effort.gap, effort.time_limit_s)
    except NoPlanError:
        return None


def as_today(problem: Problem) -> Indices:
    """The plan that leaves everything as it is, shape (areas, nodes)."""
    initial = [area.transitions.initial for area in problem.areas]
    return np.repeat(np.array(initial)[:, np.newaxis], problem.tree.nodes, axis=1)


def saved_against_today(answer: Answer) -> float:
    """How much less the plan costs than to leave everything as it is; infinite if one may not."""
    problem = answer.model.problem
    return expected_cost(problem, as_today(problem)) - answer.best.cost
