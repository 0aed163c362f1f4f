"""A plan from its file to its answer: checked, simulated, solved and written."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from tpss.errors import Finding, ScenarioError
from tpss.extras import demand
from tpss.planning.answer import Answer, Effort, answer_of, as_today, solver_of
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import Case, CaseList
from tpss.planning.configurations import check_configurations
from tpss.planning.costs import meets_budget
from tpss.planning.finer import Compared, compare_finer
from tpss.planning.lazily import prove_lazily
from tpss.planning.learnt import Learnt
from tpss.planning.load import Plan
from tpss.planning.plan import APPROXIMATOR, SIMULATION
from tpss.planning.program import demand_enough
from tpss.planning.prove import Round
from tpss.planning.simulate import simulate_cases
from tpss.planning.solve import model_of, unpriced_problem
from tpss.planning.turning import Turn, all_turns
from tpss.planning.write import write_answer
from tpss.sweep.progress import Advance


@dataclass(frozen=True)
class Answered:
    """The answer to a plan, and where its first decisions turn."""

    answer: Answer
    turns: tuple[Turn, ...]
    finer: list[list[Compared]]
    """First decisions at a finer step, if the plan asks for one."""


def check_plan(plan: Plan) -> CaseList:
    """Build every configuration of a plan; give its cases.

    Raises
    ------
    ScenarioError
        Configurations are no valid scenarios, or there are more cases than the plan allows.
    NoPlanError
        No plan meets the budgets.
    PlanError
        The package is missing that plans with a budget need.
    """
    with plan.named_as_given():
        return _checked(plan)


def _checked(plan: Plan) -> CaseList:
    _demand_packages(plan)
    case_list = CaseList(plan)
    most = plan.file.evaluate.most_cases
    if len(case_list) > most and plan.file.evaluate.by == SIMULATION:
        problem = f"{len(case_list):,} cases are more than that"
        remedy = (
            'raise it, let measures exclude each other, or prove by bounds: by = "bounds" or '
            '"approximator"'
        )
        place = (str(plan.source), "evaluate.most_cases", str(most))
        raise ScenarioError([Finding(*place, problem, remedy)])
    for each in case_list.areas:
        check_configurations(plan, each.area, list(each.configurations), each.states)
    _demand_enough(case_list)
    return case_list


def _demand_packages(plan: Plan) -> None:
    """Demand what some plans need, before anything is simulated."""
    if plan.file.budget is not None:
        demand("budget")
    if plan.file.evaluate.by == APPROXIMATOR:
        demand("training")


def _demand_enough(case_list: CaseList) -> None:
    """Refuse budgets that no plan meets, before anything is simulated."""
    problem = unpriced_problem(case_list)
    if not meets_budget(problem, as_today(problem)):
        demand_enough(problem)


def run_plan(
    plan: Plan,
    folder: str | Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    gap: float | None = None,
    time_limit_s: float | None = None,
    report: Callable[[Advance], None] | None = None,
    tell: Callable[[Round], None] | None = None,
) -> Answered:
    """Simulate the cases of a plan that its folder does not hold, solve it, and write the answer there.

    With ``evaluate.by = "bounds"`` or ``"approximator"`` only those cases that prove a plan to be the
    best one, if no case costs less than its bound.

    Parameters
    ----------
    plan : Plan
    folder : path
        Made, or continued if it is one of a plan.
    workers : int, optional
        Cases at a time; by default one for each core.  Many of them are simulated on processes of their
        own: call it below ``if __name__ == "__main__":`` in a script.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers simulate in place of this computer.
    gap : float, optional
        With a budget: share of the cost within which a better plan is not looked for.
    time_limit_s : float, optional
        With a budget: time after which the best plan so far is taken, of each search. [s]
    report : callable, optional
        Called after every case.
    tell : callable, optional
        By bounds: called after every round of the proof.

    Returns
    -------
    Answered
        If the time was over, or a bound did not hold, its ``answer.is_closed`` says that a better plan
        may exist.

    Raises
    ------
    ScenarioError
        The plan has faults, or a case could not be simulated.
    AuditError
        The audit of a case failed.
    NoPlanError
        No plan meets the budgets.
    StudyError, PlanError
        The folder cannot be written, the scheduler does not answer, or a package is missing.
    """
    effort = Effort()
    effort = Effort(effort.gap if gap is None else gap, time_limit_s or math.inf)
    demand("plan")
    case_list, target = check_plan(plan), CaseFolder(Path(folder))
    with plan.named_as_given(), target.opened():

        def simulate_of(of: CaseList, cases: Sequence[Case]) -> pd.DataFrame:
            return simulate_cases(
                of, target, cases, workers=workers, scheduler=scheduler, report=report
            )

        def simulate(cases: Sequence[Case]) -> pd.DataFrame:
            return simulate_of(case_list, cases)

        if plan.file.evaluate.by == SIMULATION:
            model = model_of(case_list, simulate(case_list.cases))
        else:
            learnt = Learnt(target.path)
            model = prove_lazily(case_list, simulate, solver_of(effort), tell, learnt)
        answer = answer_of(model, effort)
        finer = compare_finer(answer, simulate_of)
        answered = Answered(answer, tuple(all_turns(answer)), finer)
        write_answer(target.path, answer, answered.turns, finer)
    return answered
