"""The best first decisions once more, at a finer time step: whether the step decides between them.

Each is taken with the plan that was found; what it uses is simulated again.  Nothing else is, so a plan
that only the finer step would make the best is not looked for.
"""

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from tpss.planning.answer import Answer
from tpss.planning.cases import Case, CaseList
from tpss.planning.costs import expected_cost
from tpss.planning.dynamic import FirstDecision
from tpss.planning.sentence import ALTERNATIVES, groups_of, in_words, money
from tpss.planning.served import Served, whole_ones, with_outcomes
from tpss.planning.solve import Model

COLUMNS = ["area", "if", "configuration", "cost", "surplus", "finer_cost", "finer_surplus"]
"""Of the table of first decisions at a finer step."""

Compared = tuple[FirstDecision, float]
"""A first decision, and what its plan costs at the finer step."""


def compare_finer(
    answer: Answer, simulate: Callable[[CaseList, Sequence[Case]], pd.DataFrame]
) -> list[list[Compared]]:
    """First decisions that the answer names, and what their plans cost at the plan's finer step.

    A list for each first decision of each area, in the order of their costs; none if the plan asks for
    no finer step.

    Parameters
    ----------
    answer : Answer
    simulate : callable
        Gives the rows of a folder, by digest, once some cases of a list are among them.

    Raises
    ------
    ScenarioError, AuditError
        As `tpss.planning.solve.model_of`.
    """
    step = answer.model.plan.file.evaluate.finer_step_min
    if step is None:
        return []
    chosen = [
        [each for each in firsts[: ALTERNATIVES + 1] if not answer.is_bound(each.policy)]
        for firsts in groups_of(answer)
    ]
    fine = CaseList(answer.model.plan.with_({"evaluate.time_step_min": step}))
    by_unit: dict[tuple[int, int, int], list[Case]] = {}
    for case in fine.cases:
        by_unit.setdefault((case.area, case.state, case.configuration), []).append(case)
    table = simulate(fine, [])
    while True:
        model = _at_finer_step(answer.model, fine, table)
        lacking = {
            unit for firsts in chosen for each in firsts for unit in model.lacking_of(each.policy)
        }
        if not lacking:
            break
        table = simulate(fine, [case for unit in sorted(lacking) for case in by_unit[unit]])
    return [
        [(each, expected_cost(model.problem, each.policy)) for each in firsts] for firsts in chosen
    ]


def _at_finer_step(coarse: Model, fine: CaseList, table: pd.DataFrame) -> Model:
    """A model with what was simulated at the finer step in its place; all else is as if bounds."""
    served: list[Served] = []
    for number, own in enumerate(coarse.served):
        cases = [case for case in fine.cases if case.area == number]
        known = with_outcomes(own, fine, number, whole_ones(cases, table), table)
        served.append(known)
    return Model(coarse.case_list, coarse.table, tuple(served))


def finer_table(answer: Answer, compared: Sequence[Sequence[Compared]]) -> pd.DataFrame:
    """First decisions at both steps; empty if the plan asks for no finer one."""
    model, rows = answer.model, []
    for firsts in compared:
        best = min(cost for _, cost in firsts)
        for each, cost in firsts:
            through = (w for n in each.nodes for w in model.tree.scenarios_through(n))
            rows.append(
                {
                    "area": model.problem.areas[each.area].name,
                    "if": " or ".join(dict.fromkeys(through)),
                    "configuration": model.areas[each.area].configurations[each.configuration].name,
                    "cost": each.cost,
                    "surplus": each.surplus,
                    "finer_cost": cost,
                    "finer_surplus": cost - best,
                }
            )
    return pd.DataFrame(rows, columns=COLUMNS)


def finer_sentences(answer: Answer, compared: Sequence[Sequence[Compared]]) -> list[str]:
    """What the finer step says of each first decision; none if the plan asks for none."""
    step, found = answer.model.plan.file.evaluate.finer_step_min, []
    for firsts in compared:
        costs = np.array([cost for _, cost in firsts])
        names = [in_words(answer, each) for each, _ in firsts]
        where = answer.model.areas[firsts[0][0].area].area.name
        begin = f"{f'{where}: ' if where else ''}At a step of {step:g} min"
        others = "".join(
            f", {name} {money(abs(more))} {'more' if more >= 0.0 else 'less'}"
            for name, more in zip(names[1:], costs[1:] - costs[0], strict=True)
        )
        told = f"{names[0]} {money(costs[0])}{others}."
        if costs.argmin() == 0:
            found.append(f"{begin} the best is the same: {told}")
        else:
            found.append(
                f"{begin} {names[int(costs.argmin())]} is better: {told} The time step decides between "
                "them: let evaluate.time_step_min be finer."
            )
    return found
