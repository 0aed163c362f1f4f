"""Questions to a plan that was solved: what if something else is done, or may not be done."""

from dataclasses import dataclass

import numpy as np

from tpss.errors import NoPlanError, PlanError, no_such
from tpss.planning.answer import Effort
from tpss.planning.problem import Solution
from tpss.planning.program import solve_any
from tpss.planning.sentence import measure_names
from tpss.planning.solve import Model
from tpss.planning.states import TODAY
from tpss.planning.wording import in_order, traffic_in_words


@dataclass(frozen=True)
class Question:
    """Measures that are in service, or ordered, in a year, in an area."""

    area: int
    measures: tuple[str, ...]
    """None of them: the area is as today."""
    stage: int
    """In which they are in service."""


def question_of(text: str, model: Model) -> Question:
    """What ``AT in 2030`` asks: of several measures ``B+D in 2030``, in an area ``north: AT in 2030``.

    The year is that of the order.

    Raises
    ------
    PlanError
        It is not of that form, or names what there is not.
    """
    area_name, colon, rest = text.rpartition(":")
    names, found, year = rest.strip().rpartition(" in ")
    if not found or not year.strip().isdecimal():
        raise PlanError(f'{text!r} is no question; ask such as "AT in 2030" or "B+D in 2030"')
    areas = [each.area.name for each in model.areas]
    area = _index("area", area_name.strip(), areas) if colon else 0
    if not colon and len(areas) > 1:
        raise PlanError(f'say of which area: "{areas[0]}: {text}"; areas: {", ".join(areas)}')
    known = list(model.areas[area].area.measures)
    names = names.strip()
    wanted = () if names in (TODAY, "nothing") else tuple(n.strip() for n in names.split("+"))
    for name in wanted:
        _index("measure", name, known)
    start = model.plan.file.stages.start
    ordered = _index("stage", year.strip(), [str(each) for each in start])
    orders = model.problem.areas[area].ordered_at
    stages = [s for s, at in enumerate(orders) if at == ordered]
    if not stages:
        raise PlanError(
            f"nothing that is ordered in {year.strip()} is in service before {start[-1]}"
        )
    return Question(area, wanted, stages[0])


def _index(kind: str, name: str, known: list[str]) -> int:
    if name not in known:
        problem, remedy = no_such(kind, name, known)
        raise PlanError(f"{name}: {problem}; {remedy}")
    return known.index(name)


def best_with(question: Question, model: Model, effort: Effort) -> Solution | None:
    """The best plan in which the measures that are asked for are in service; None if there is none.

    Of ``as today`` nothing else may be built by then.
    """
    problem = model.problem
    area = model.areas[question.area]
    nodes = np.flatnonzero(problem.tree.stage == question.stage)
    stands = [set(measure_names(area.area, each)) for each in area.configurations]
    wanted = set(question.measures)
    allowed = np.array([each >= wanted if wanted else not each for each in stands])
    table = problem.areas[question.area].yearly_cost.copy()
    table[np.ix_(nodes, ~allowed)] = np.inf
    tables = [
        table if k == question.area else each.yearly_cost for k, each in enumerate(problem.areas)
    ]
    try:
        return solve_any(problem.with_costs(tables), effort.gap, effort.time_limit_s)
    except NoPlanError:
        return None


def not_carried(question: Question, model: Model) -> list[str]:
    """Which traffic the measures alone do not carry, and why."""
    area, served = model.areas[question.area], model.served[question.area]
    wanted = set(question.measures)
    c = next(
        (
            number
            for number, each in enumerate(area.configurations)
            if set(measure_names(area.area, each)) == wanted
        ),
        None,
    )
    if c is None:
        return []
    states = {state.name: state for state in area.states.states}
    words, number = traffic_in_words(states).full, list(states)
    return [
        f"{area.configurations[c].name} does not carry {words[name]}: {'; '.join(reasons)}"
        for name in in_order(states)
        if (reasons := served.reasons.get((number.index(name), c)))
    ]
