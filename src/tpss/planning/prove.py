"""Prove a plan by simulation: solve with lower bounds, simulate what the plan uses, and repeat.

When everything that the best plan uses was simulated it is the best of all: any other plan costs at
least its bounds, and these are no less than what this one costs.  The bounds themselves are tested: each
simulated case that costs less than its bound is a violation, and withdraws the claim.
"""

from collections.abc import Callable, Iterable, MutableMapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError
from tpss.planning.costs import expected_cost
from tpss.planning.dynamic import solve
from tpss.planning.money import Array
from tpss.planning.problem import Problem, Solution
from tpss.planning.tree import Indices

Flags = npt.NDArray[np.bool_]

ROUNDING = 1e-9
"""Share of a bound by which a cost may be below it."""

CONFIDENCE = 3.0
"""If none of m cases drawn at random is a fault, at most 3/m of all are with 95 % confidence."""


class Case(NamedTuple):
    """What one simulation finds out: the yearly cost of a configuration in a state of traffic."""

    area: int
    state: int
    configuration: int


Costs = float | Array
"""Yearly cost of a case, in every node of its state, or one for each of them in their order."""


class Grade(Enum):
    """Where bounds come from, and so what may be claimed."""

    EXHAUSTIVE = "exhaustive"
    """There are none: everything was simulated."""
    BOUNDED = "bounded"
    """From the best supply that can be imagined."""
    APPROXIMATED = "approximated"
    """Lower ends of an approximator's predictions."""


class Violation(NamedTuple):
    """A case that costs less than its bound."""

    case: Case
    bound: float
    cost: float


class Round(NamedTuple):
    """How far a proof has come."""

    simulated: int
    """Cases simulated so far, in this run or before."""
    lower: float
    """No plan costs less, if the bounds hold."""
    upper: float
    """The best plan so far all of whose cases were simulated; infinite if there is none."""


@dataclass(frozen=True)
class Proof:
    """The best plan, and what may be claimed of it."""

    solution: Solution
    grade: Grade
    violations: tuple[Violation, ...]
    rounds: tuple[Round, ...]
    simulated: int
    """Cases simulated, in this run or before."""
    cases: int
    """Cases there are."""
    audited: int
    """Cases drawn at random beforehand, and simulated."""

    @property
    def holds(self) -> bool:
        """Whether the claim of the grade stands: no bound was violated."""
        return not self.violations

    @property
    def fault_rate(self) -> float | None:
        """Share of bounds that may be too high, with 95 % confidence, as the audit shows; else None."""
        return min(1.0, CONFIDENCE / self.audited) if self.audited and self.holds else None


@dataclass
class Evidence:
    """Yearly costs as far as they are known: simulated, or a lower bound."""

    problem: Problem
    lower: Sequence[Array]
    """Bounds, for each area of the shape (nodes, configurations); NaN where there is none, so the case
    has to be simulated, and infinite where a configuration is not allowed, which is no case."""
    state_of_node: Sequence[Indices]
    """State of each node, for each area of the shape (nodes,)."""
    known: MutableMapping[Case, Costs]
    """What was simulated; whoever makes it may keep it on disk."""
    tables: list[Array] = field(init=False)
    """Simulated costs, or else bounds."""
    is_known: list[Flags] = field(init=False)

    def __post_init__(self) -> None:
        shapes = [area.yearly_cost.shape for area in self.problem.areas]
        states = [each.shape for each in self.state_of_node]
        if [each.shape for each in self.lower] != shapes or states != [(n,) for n, _ in shapes]:
            raise PlanError("bounds and states do not have the shapes of the yearly costs")
        self.tables = [table.copy() for table in self.lower]
        self.is_known = [np.zeros(shape, dtype=np.bool_) for shape in shapes]
        for case in list(self.known):
            self.enter(case)

    def nodes(self, case: Case) -> Indices:
        """Nodes that a case stands for."""
        return np.flatnonzero(self.state_of_node[case.area] == case.state)

    def enter(self, case: Case) -> None:
        """Put what a case costs in the place of its bound."""
        nodes = self.nodes(case)
        cost = np.asarray(self.known[case], dtype=np.float64)
        if cost.shape not in ((), (len(nodes),)) or np.isnan(cost).any():
            raise PlanError(f"{case} has no cost for each of its {len(nodes)} nodes")
        self.tables[case.area][nodes, case.configuration] = cost
        self.is_known[case.area][nodes, case.configuration] = True

    def tighten(self, lower: Sequence[Array]) -> None:
        """Put other bounds in the place of those of cases that are not known."""
        for own, known, better in zip(self.tables, self.is_known, lower, strict=True):
            own[~known] = better[~known]

    def cases(self, wanted: Sequence[Flags]) -> list[Case]:
        """Cases of some cells that are not known, each once; the most probable ones first."""
        weight: dict[Case, float] = {}
        probability = self.problem.tree.probability
        for k, flags in enumerate(wanted):
            for n, c in np.argwhere(flags & ~self.is_known[k]):
                case = Case(k, int(self.state_of_node[k][n]), int(c))
                weight[case] = weight.get(case, 0.0) + float(probability[n])
        return sorted(weight, key=lambda case: (-weight[case], case))

    def used(self, policy: Indices) -> list[Flags]:
        """Cells that a plan uses, for each area."""
        found = []
        for table, row in zip(self.tables, policy, strict=True):
            flags = np.zeros(table.shape, dtype=np.bool_)
            flags[np.arange(len(row)), row] = True
            found.append(flags)
        return found

    def violations(self) -> list[Violation]:
        """All cases known by now that cost less than their bounds."""
        found = []
        for case in sorted(self.known):
            nodes = self.nodes(case)
            bound = self.lower[case.area][nodes, case.configuration]
            cost = self.tables[case.area][nodes, case.configuration]
            bound_or_0 = np.where(np.isfinite(bound), bound, 0.0)
            if (below := (cost < bound - ROUNDING * np.abs(bound_or_0))).any():
                worst = int(np.argmax(np.where(below, bound - cost, -np.inf)))
                found.append(Violation(case, float(bound[worst]), float(cost[worst])))
        return found


def prove(
    evidence: Evidence,
    simulate: Callable[[list[Case]], Iterable[tuple[Case, Costs]]],
    grade: Grade,
    audit: int = 0,
    seed: int = 0,
    solver: Callable[[Problem], Solution] = solve,
    tell: Callable[[Round], None] | None = None,
) -> Proof:
    """Find the best plan, simulating only what it takes to prove it.

    No case is simulated that is known.  What is known is entered as it comes, so whoever keeps it can
    go on after an interruption, and comes to the same plan.

    Parameters
    ----------
    evidence : Evidence
        Bounds, and what was simulated before; it is added to.
    simulate : callable
        Gives each case that it is handed with its yearly cost, in any order.
    grade : Grade
        Where the bounds come from.
    audit : int
        Cases that are drawn at random among those with a bound, and simulated at the end.
    seed : int
        Of the draw, which depends on nothing else.
    solver : callable
        Finds the best plan of a problem: with budgets `tpss.planning.program.solve_program`.
    tell : callable, optional
        Is told how far the proof has come, each round.

    Raises
    ------
    NoPlanError
        There is no plan.
    PlanError
        A case that was asked for was not simulated, or the grade is exhaustive and there are bounds.
    """
    bounded = [np.isfinite(table) for table in evidence.lower]
    if grade is Grade.EXHAUSTIVE and any(flags.any() for flags in bounded):
        raise PlanError("an exhaustive proof has no bounds: all cases are simulated")
    _find_out(evidence, simulate, evidence.cases([np.isnan(table) for table in evidence.lower]))
    rounds: list[Round] = []
    solution = _close(evidence, simulate, solver, rounds, tell)
    drawn = audit_of(evidence, audit, seed)
    open_ones = [case for case in drawn if case not in evidence.known]
    if open_ones:
        _find_out(evidence, simulate, open_ones)
        solution = _close(evidence, simulate, solver, rounds, tell)
    violations = tuple(evidence.violations())
    total = len(_all_cases(evidence, [table != np.inf for table in evidence.lower]))
    return Proof(solution, grade, violations, tuple(rounds), len(evidence.known), total, len(drawn))


def _close(
    evidence: Evidence,
    simulate: Callable[[list[Case]], Iterable[tuple[Case, Costs]]],
    solver: Callable[[Problem], Solution],
    rounds: list[Round],
    tell: Callable[[Round], None] | None,
) -> Solution:
    """Simulate what the best plan uses until nothing of it is left."""
    upper = np.inf
    while True:
        solution = solver(evidence.problem.with_costs(evidence.tables))
        lacking = evidence.cases(evidence.used(solution.policy))
        _find_out(evidence, simulate, lacking)
        cost = expected_cost(evidence.problem.with_costs(evidence.tables), solution.policy)
        upper = min(upper, cost)
        rounds.append(Round(len(evidence.known), solution.bound, upper))
        if tell:
            tell(rounds[-1])
        if not lacking:
            return solution


def _find_out(
    evidence: Evidence,
    simulate: Callable[[list[Case]], Iterable[tuple[Case, Costs]]],
    cases: list[Case],
) -> None:
    """Simulate cases, and enter each as it comes."""
    if not cases:
        return
    for case, cost in simulate(cases):
        evidence.known[case] = cost
        evidence.enter(case)
    if missing := [case for case in cases if case not in evidence.known]:
        raise PlanError(f"{missing[0]} was to be simulated, and was not")


def _all_cases(evidence: Evidence, cells: Sequence[Flags]) -> list[Case]:
    """Cases of some cells, known or not, each once and in order."""
    found = {
        Case(k, int(evidence.state_of_node[k][n]), int(c))
        for k, flags in enumerate(cells)
        for n, c in np.argwhere(flags)
    }
    return sorted(found)


def audit_of(evidence: Evidence, count: int, seed: int) -> list[Case]:
    """Cases with a bound that an audit draws at random, whatever was simulated already."""
    if not count:
        return []
    cases = _all_cases(evidence, [np.isfinite(table) for table in evidence.lower])
    chosen = np.random.default_rng(seed).permutation(len(cases))[:count]
    return [cases[k] for k in chosen]
