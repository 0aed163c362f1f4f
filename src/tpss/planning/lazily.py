"""Prove a plan by bounds: simulate what gives the bounds, then what the best plan uses.

What is simulated is a configuration with a traffic, with all outages required.  First come those that
give the bounds, whichever way (`tpss.planning.ways`), and all that have none; then the loop of
`tpss.planning.prove`.  Everything is kept in the folder of the plan, so an interrupted proof
goes on where it was.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd

from tpss.errors import Finding, PlanError, ScenarioError
from tpss.planning.cases import Case, CaseList
from tpss.planning.learnt import Learnt
from tpss.planning.money import Array
from tpss.planning.plan import SIMULATION
from tpss.planning.problem import Problem, Solution
from tpss.planning.prove import ROUNDING, Costs, Evidence, Grade, Proof, Round, Violation, audit_of
from tpss.planning.prove import Case as Cell
from tpss.planning.prove import prove as proved
from tpss.planning.served import bounds_of
from tpss.planning.solve import Model, Units, model_of
from tpss.planning.tree import Indices
from tpss.planning.ways import WAYS, Way

Simulate = Callable[[Sequence[Case]], pd.DataFrame]
"""Gives the rows of a folder, by digest, once some cases are among them."""

ALL = "tpss plan run --all"
"""Command that simulates what a proof by bounds has left out."""


def prove_lazily(
    case_list: CaseList,
    simulate: Simulate,
    solver: Callable[[Problem], Solution],
    tell: Callable[[Round], None] | None = None,
    learnt: Learnt | None = None,
) -> Model:
    """Simulate what proves a plan to be the best one, if the bounds hold.

    Parameters
    ----------
    case_list : CaseList
    simulate : callable
    solver : callable
        Finds the best plan of a problem.
    tell : callable, optional
        Is told how far the proof has come, each round.
    learnt : Learnt, optional
        What was learnt before for the bounds.

    Returns
    -------
    Model
        All that its best plan uses was simulated.

    Raises
    ------
    ScenarioError
        More cases are needed than the plan allows, or one could not be simulated.
    AuditError
        The audit of a case failed.
    NoPlanError
        There is no plan.
    """
    search = _Search(case_list, simulate, learnt or Learnt())
    way, (count, seed) = search.way, audit_asked(case_list)
    while True:
        evidence = evidence_of(search.model)
        proof = proved(
            evidence,
            partial(search.find_out, evidence=evidence),
            way.grade,
            count,
            seed,
            solver,
            None if tell is None else lambda each: tell(search.counted(each)),
        )
        # A bound that did not hold may have hidden a better plan, of which more is to be simulated.
        model = search.model
        if not violations(model) or np.array_equal(
            proof.solution.policy, solver(model.problem).policy
        ):
            return model


def audit_asked(case_list: CaseList) -> tuple[int, int]:
    """How many configurations with a traffic are drawn to test the bounds of a plan, and the seed."""
    evaluation = case_list.plan.file.evaluate
    count = evaluation.audit_cases
    if count is None:
        count = WAYS[evaluation.by].audit_cases
    return count, evaluation.audit_seed


class _Search:
    """What was simulated so far, and the model that it makes."""

    def __init__(self, case_list: CaseList, simulate: Simulate, learnt: Learnt) -> None:
        self.case_list, self.simulate, self.learnt = case_list, simulate, learnt
        self.way: Way = WAYS[case_list.plan.file.evaluate.by]
        self.table = simulate([])
        self.own = {case.digest for case in case_list.cases}
        self.by_unit: dict[tuple[int, int, int], list[Case]] = {}
        for case in self.case_list.cases:
            unit = (case.area, case.state, case.configuration)
            self.by_unit.setdefault(unit, []).append(case)
        evaluation = case_list.plan.file.evaluate
        self._simulate(
            {(k, *pair) for k, area in enumerate(case_list.areas)
             for pair in self.way.first(area, evaluation)}
        )  # fmt: skip
        self._simulate(self._without_bounds())
        self.model = self._modelled()

    def _without_bounds(self) -> Units:
        """Configurations with a traffic that have no bound."""
        found: Units = set()
        for k in range(len(self.case_list.areas)):
            bound = bounds_of(self.case_list, k, self.table, self.learnt)
            found |= {(k, int(d), int(c)) for d, c in np.argwhere(np.isnan(bound).any(axis=2))}
        return found

    def _modelled(self) -> Model:
        return model_of(self.case_list, self.table, self.learnt)

    def _simulate(self, units: Units) -> None:
        cases = [case for unit in sorted(units) for case in self.by_unit[unit]]
        most = self.case_list.plan.file.evaluate.most_cases
        count = len((set(self.table.index) & self.own) | {case.digest for case in cases})
        if count > most:
            problem = f"the proof takes {count:,} cases by now"
            place = (self.case_list.plan.given, "evaluate.most_cases", str(most))
            raise ScenarioError([Finding(*place, problem, "raise it; finished cases are kept")])
        self.table = self.simulate(cases)

    def find_out(self, cells: Sequence[Cell], evidence: Evidence) -> Iterable[tuple[Cell, Costs]]:
        """Simulate what the costs of some configurations with a traffic depend on."""
        while lacking := {unit for cell in cells for unit in self._lacking(cell, evidence)}:
            self._simulate(lacking)
            self.model = self._modelled()
        evidence.tighten([each.yearly_cost for each in self.model.priced])
        return list(_costs(self.model, cells, evidence))

    def _lacking(self, cell: Cell, evidence: Evidence) -> Units:
        nodes = evidence.nodes(cell)
        return self.model.lacking(cell.area, nodes, np.full(len(nodes), cell.configuration))

    def counted(self, each: Round) -> Round:
        """A round, with the number of cases that were simulated."""
        return each._replace(simulated=simulated_and_all(self.model)[0])


def _costs(model: Model, cells: Iterable[Cell], evidence: Evidence) -> Iterator[tuple[Cell, Costs]]:
    for cell in cells:
        yield cell, model.priced[cell.area].yearly_cost[evidence.nodes(cell), cell.configuration]


def evidence_of(model: Model) -> Evidence:
    """Bounds of all costs of a model, and those that were simulated."""
    states = [each.quantities.state_of_node for each in model.served]
    evidence = Evidence(model.problem, _lower(model), states, {})
    evidence.tighten([each.yearly_cost for each in model.priced])
    cells = [cell for k in range(len(model.areas)) for cell in _known(model, k, evidence)]
    for cell, cost in _costs(model, cells, evidence):
        evidence.known[cell] = cost
        evidence.enter(cell)
    return evidence


def _lower(model: Model) -> list[Array]:
    """Costs as if nothing had been simulated that has a bound, shape (nodes, configurations) each."""
    found = []
    for each, priced in zip(model.served, model.priced, strict=True):
        quantities, bound = each.quantities, each.bound
        if bound is None:
            raise PlanError("a plan that is simulated as a whole has no bounds")
        there = ~np.isnan(bound).any(axis=2)
        operation, carried = quantities.operation.copy(), quantities.carried.copy()
        fixed = operation[-1]
        operation[:-1][there] = (bound + fixed)[there]
        carried[:-1][there] = True
        without = replace(quantities, operation=operation, carried=carried)
        found.append(without.priced(priced.price).yearly_cost)
    return found


def _known(model: Model, area: int, evidence: Evidence) -> Iterator[Cell]:
    """Configurations with a traffic whose costs depend on nothing that was not simulated."""
    own = model.served[area]
    for state in np.unique(own.quantities.state_of_node).tolist():
        for c in np.flatnonzero(own.is_simulated[state]).tolist():
            cell = Cell(area, state, c)
            nodes = evidence.nodes(cell)
            if not model.lacking(area, nodes, np.full(len(nodes), c)):
                yield cell


def simulated_and_all(model: Model) -> tuple[int, int]:
    """How many cases of a model were simulated, and how many there are."""
    own = {case.digest for case in model.case_list.cases}
    return len(own & set(model.table.index)), len(own)


def proof_of(model: Model, best: Solution) -> Proof:
    """What was simulated says of the best plan of a model.

    Raises
    ------
    PlanError
        The plan uses what was not simulated, so nothing is proved.
    """
    simulated, cases = simulated_and_all(model)
    if model.plan.file.evaluate.by == SIMULATION:
        return Proof(best, Grade.EXHAUSTIVE, (), (), simulated, cases, 0)
    refuse_bounds(model, best.policy, "the best plan")
    evidence = evidence_of(model)
    drawn = audit_of(evidence, *audit_asked(model.case_list))
    audited = len(drawn) if all(cell in evidence.known for cell in drawn) else 0
    grade = WAYS[model.plan.file.evaluate.by].grade
    return Proof(best, grade, violations(model), (), simulated, cases, audited)


def refuse_bounds(model: Model, policy: Indices, what: str) -> None:
    """Refuse to tell costs that were not simulated.

    Raises
    ------
    PlanError
        They are bounds.
    """
    if units := model.lacking_of(policy):
        area, g, c = sorted(units)[0]
        first = f"{model.areas[area].configurations[c].name} with {model.served[area].traffic[g]}"
        raise PlanError(
            f"{what} may be another one: it takes cases that were not simulated ({len(units):,}, such "
            f"as {first}); write what has changed into the plan file and run it again, which adds "
            f"them, or simulate all: {ALL}"
        )


def violations(model: Model) -> tuple[Violation, ...]:
    """Simulated configurations with a traffic that cost less than their bound, at any of the prices."""
    found = []
    for k, (own, priced) in enumerate(zip(model.served, model.priced, strict=True)):
        if own.bound is None:
            continue
        prices, of = np.unique(priced.price, axis=0), own.quantities
        bound = (own.bound + of.operation[-1]) @ prices.T
        cost = of.operation[:-1] @ prices.T
        tested = own.is_simulated[:-1] & of.carried[:-1]
        below = np.where(tested[:, :, np.newaxis], bound - cost - ROUNDING * np.abs(bound), 0.0)
        for d, c in np.argwhere((below > 0.0).any(axis=2)).tolist():
            p = int(np.argmax(np.nan_to_num(below[d, c])))
            found.append(Violation(Cell(k, d, c), float(bound[d, c, p]), float(cost[d, c, p])))
    return tuple(found)
