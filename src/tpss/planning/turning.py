"""Where the first decision turns: prices, costs, rate and probabilities at which another one leads."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tpss.errors import PlanError
from tpss.planning.answer import Answer
from tpss.planning.decisions import decisions_of
from tpss.planning.dynamic import values_of
from tpss.planning.money import Array, Stages
from tpss.planning.plan_faults import PRICES
from tpss.planning.problem import Problem
from tpss.planning.solve import Model, price_of_node, transitions_of
from tpss.planning.switching import Switching, switching
from tpss.planning.turning_within import Optima, turn_within
from tpss.planning.yearly_use import FIXED

WIDEST = 4.0
"""Times today's price or cost up to which it is looked where the decision turns; down to 0. [1]"""

DISCOUNT_RATE = f"{PRICES}.discount_rate"
"""Key path of the discount rate, which is no price."""

HIGHEST_RATE = 0.12
"""Highest discount rate that is looked at. [1/a]"""

MOST_TO_TURN = 10_000
"""Configurations times nodes up to which it is looked where all numbers turn: some seconds."""

MOST_WITHIN = 200
"""The same with a budget, where each look takes HiGHS some hundredths of a second."""

EDGE = 1e-3
"""Least probability of a scenario, and of the others, that is looked at. [1]"""


@dataclass(frozen=True)
class Turn:
    """What is varied, and where the first decision of an area turns."""

    key: str
    """Key path in the plan."""
    area: int
    found: Switching


@dataclass(frozen=True)
class Varied:
    """A number of the plan that can be varied without a simulation."""

    key: str
    """Key path in the plan."""
    now: float
    low: float
    """Lowest and highest value that is looked at."""
    high: float
    problem_at: Callable[[float], Problem]
    """The problem at a value."""

    @cached_property
    def optima(self) -> Optima:
        """Best plans at its values, within budgets."""
        return Optima(self.problem_at)

    def turn(self, area: int, low: float, high: float) -> Turn:
        """Where the first decision of an area turns between two values."""
        if self.problem_at(self.now).is_limited:
            return Turn(self.key, area, turn_within(self.optima, area, self.now, low, high))

        def cost_of(value: float) -> Array:
            return first_costs(self.problem_at(value), area)

        return Turn(self.key, area, switching(cost_of, self.now, low, high))


def first_costs(problem: Problem, area: int) -> Array:
    """Least cost of a plan without budgets with each first decision of an area, shape (configurations,).

    That of `tpss.planning.switching.costs_of_first`, without the plans, in a fraction of the time.

    Raises
    ------
    PlanError
        The area has several first decisions, as scenarios part at once.
    """
    own = problem.areas[area]
    values = [values_of(each, decisions_of(problem, k)) for k, each in enumerate(problem.areas)]
    stage = own.first_free
    groups = [] if stage is None else values[area].decisions.of_stage[stage].tolist()
    if len(groups) != 1:
        raise PlanError("scenarios part at once, or nothing is decided: no single first decision")
    group, initial = groups[0], own.transitions.initial
    decisions = values[area].decisions
    change = own.transitions.costs_from(int(decisions.stage[group]), initial)
    rest = values[area].after[group] + decisions.weight[group] * change
    # What comes before the first decision is as it is today.
    least = [each.least(problem.areas[k].transitions.initial) for k, each in enumerate(values)]
    total: Array = rest + (math.fsum(least) - values[area].before[group, initial])
    return total


def all_turns(answer: Answer) -> list[Turn]:
    """Where the first decision of each area turns that has a single one.

    An area has several if scenarios part at once.  There are none of a plan of so many configurations
    that it would take minutes, which are fewer with a budget: `Varied.turn` looks for single ones.  Nor
    are there any where some costs are bounds: at other prices others might not hold.
    """
    model = answer.model
    size = sum(area.configurations for area in model.problem.areas) * model.tree.nodes
    most = MOST_WITHIN if model.problem.is_limited else MOST_TO_TURN
    if model.has_bounds or size > most:
        return []
    nodes = [
        {tuple(each.nodes.tolist()) for each in answer.firsts if each.area == area}
        for area in range(len(model.areas))
    ]
    single = [area for area, own in enumerate(nodes) if len(own) == 1]
    return [turn for area in single for turn in turns_of(model, area)]


def turns_of(model: Model, area: int) -> list[Turn]:
    """Where the first decision of an area turns, for prices, costs of measures, rate, probabilities.

    Each is varied alone; probabilities of the other scenarios keep their proportions.

    Raises
    ------
    PlanError
        The area has several first decisions, as scenarios part at once.
    """
    return [each.turn(area, each.low, each.high) for each in varied(model)]


def varied(model: Model) -> Iterator[Varied]:
    """Numbers of a plan that can be varied without a simulation."""
    file, problem = model.plan.file, model.problem
    prices, first = price_of_node(model.plan, model.tree), model.tree.stage == 0
    for k, name in enumerate(model.served[0].quantities.components):
        now = abs(float(model.tree.probability[first] @ prices[first, k]))
        if name != FIXED and now > 0.0:
            at = _at_price(model, problem, prices, k, now)
            yield Varied(f"{PRICES}.{name}", now, 0.0, WIDEST * now, at)
    for number, cases in enumerate(model.areas):
        for name, measure in cases.area.measures.items():
            if (now := max(measure.costs)) > 0.0:
                at = _at_cost(model, problem, number, name)
                yield Varied(f"{cases.area.key(name)}.cost", now, 0.0, WIDEST * now, at)
    rate = file.economics.discount_rate
    highest = max(HIGHEST_RATE, rate)
    yield Varied(DISCOUNT_RATE, rate, 0.0, highest, _at_rate(model, problem))
    for w, name in enumerate(model.tree.names if len(model.tree.names) > 1 else ()):
        now = float(model.tree.scenario_probability[w])
        key, at = f"scenarios.{name}.probability", _at_probability(problem, w)
        yield Varied(key, now, min(EDGE, now), max(1.0 - EDGE, now), at)


def _at_price(
    model: Model, problem: Problem, prices: Array, k: int, now: float
) -> Callable[[float], Problem]:
    """The problem with all prices of a component in proportion to a value of today's."""

    def at(value: float) -> Problem:
        varied = prices.copy()
        varied[:, k] *= value / now
        tables = [each.quantities.priced(varied).yearly_cost for each in model.served]
        return problem.with_costs(tables)

    return at


def _at_cost(model: Model, problem: Problem, area: int, name: str) -> Callable[[float], Problem]:
    """The problem with the costs of a measure in proportion to a value of its highest level."""
    cases = model.areas[area]
    measure = cases.area.measures[name]
    highest = max(measure.costs)

    def at(value: float) -> Problem:
        costs = tuple(cost * value / highest for cost in measure.costs)
        dearer = measure.model_copy(update={"cost": costs})
        measures = {**cases.area.measures, name: dearer}
        changed = replace(cases, area=replace(cases.area, measures=measures))
        transitions = transitions_of(model.plan, changed, model.stages)
        own = replace(problem.areas[area], transitions=transitions)
        return replace(problem, areas=(*problem.areas[:area], own, *problem.areas[area + 1 :]))

    return at


def _at_rate(model: Model, problem: Problem) -> Callable[[float], Problem]:
    """The problem at another discount rate."""

    def at(rate: float) -> Problem:
        stages = Stages(model.stages.start_year, model.stages.end_year, rate)
        areas = tuple(
            replace(own, transitions=transitions_of(model.plan, cases, stages))
            for own, cases in zip(problem.areas, model.areas, strict=True)
        )
        return replace(problem, stages=stages, areas=areas)

    return at


def _at_probability(problem: Problem, w: int) -> Callable[[float], Problem]:
    """The problem with another probability of a scenario."""

    def at(value: float) -> Problem:
        now = problem.tree.scenario_probability
        probability = now * (1.0 - value) / (1.0 - now[w])
        probability[w] = value
        return replace(problem, tree=replace(problem.tree, scenario_probability=probability))

    return at


def is_turned(turn: Turn) -> bool:
    """Whether the first decision turns within the range that is looked at."""
    return turn.found.below is not None or turn.found.above is not None


def nearest(turns: list[Turn]) -> Turn | None:
    """The turn that takes the least change, in proportion to today's value."""

    def change(turn: Turn) -> float:
        ends = [end for end in (turn.found.below, turn.found.above) if end is not None]
        return min(abs(end / turn.found.now - 1.0) if turn.found.now else np.inf for end in ends)

    return min(filter(is_turned, turns), key=change, default=None)
