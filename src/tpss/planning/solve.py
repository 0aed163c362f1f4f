"""From a plan and its outcomes to the problem that is solved, and priced anew without a simulation."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from tpss.planning import measures as built
from tpss.planning.cases import AreaCases, CaseList
from tpss.planning.learnt import Learnt
from tpss.planning.load import Plan, PlannedArea
from tpss.planning.money import Array, Stages, ordered_at
from tpss.planning.plan_faults import PRICES, prices_of
from tpss.planning.prices import Priced
from tpss.planning.problem import Area, Problem
from tpss.planning.served import Served, served
from tpss.planning.states import at_stage
from tpss.planning.transitions import Changes
from tpss.planning.tree import Indices, Tree, make_tree
from tpss.planning.yearly_use import FED_BACK, FIXED, components_of

Units = set[tuple[int, int, int]]
"""Areas, traffics and configurations that are simulated together, with all outages required."""


@dataclass(frozen=True)
class Model:
    """A plan with its outcomes, in the tables of its problem."""

    case_list: CaseList
    table: pd.DataFrame
    """Outcomes by digest: of all its cases, or of those that a proof by bounds takes."""
    served: tuple[Served, ...]

    @property
    def plan(self) -> Plan:
        """The plan."""
        return self.case_list.plan

    @property
    def areas(self) -> tuple[AreaCases, ...]:
        """Its areas with their configurations."""
        return self.case_list.areas

    @cached_property
    def tree(self) -> Tree:
        """Tree of the futures."""
        return tree_of(self.case_list)

    @cached_property
    def stages(self) -> Stages:
        """Stages with their discount rate."""
        return stages_of(self.plan)

    @cached_property
    def priced(self) -> tuple[Priced, ...]:
        """Yearly costs of each area."""
        prices = price_of_node(self.plan, self.tree)
        return tuple(each.quantities.priced(prices) for each in self.served)

    @cached_property
    def problem(self) -> Problem:
        """The problem to solve."""
        areas = tuple(
            Area(
                each.area.name or self.plan.file.name,
                priced.yearly_cost,
                transitions_of(self.plan, each, self.stages),
                orders_of(each.area, self.stages),
            )
            for each, priced in zip(self.areas, self.priced, strict=True)
        )
        return Problem(self.tree, self.stages, areas, limit_of(self.plan, self.tree))

    @cached_property
    def has_bounds(self) -> bool:
        """Whether some costs are bounds, as not all cases were simulated."""
        return not all(each.is_simulated.all() for each in self.served)

    def lacking(self, area: int, nodes: Indices, configuration: Indices) -> Units:
        """What was not simulated of that on which the costs of some configurations depend.

        The traffic that is asked for, and the one that is run.

        Parameters
        ----------
        area : int
        nodes : array of int, shape (n,)
        configuration : array of int, shape (n,)
            One for each of these nodes.
        """
        own, priced = self.served[area], self.priced[area]
        policy = np.zeros(self.tree.nodes, dtype=np.int64)
        policy[nodes] = configuration
        asked, run = own.quantities.state_of_node[nodes], priced.served(policy)[nodes]
        return {
            (area, int(g), int(c))
            for traffic in (asked, run)
            for g, c in zip(traffic, configuration, strict=True)
            if not own.is_simulated[g, c]
        }

    def lacking_of(self, policy: Indices, nodes: Indices | None = None) -> Units:
        """What was not simulated of a plan; what it costs is a bound then.

        Parameters
        ----------
        policy : array of int, shape (areas, nodes)
        nodes : array of int, optional
            Nodes that the plan is for; by default all of them.
        """
        if nodes is None:
            nodes = np.arange(self.tree.nodes)
        found: Units = set()
        for k, row in enumerate(policy):
            found |= self.lacking(k, nodes, row)
        return found


def model_of(case_list: CaseList, table: pd.DataFrame, learnt: Learnt | None = None) -> Model:
    """Model of a plan all of whose cases were simulated, or have bounds.

    Parameters
    ----------
    case_list : CaseList
    table : DataFrame
        Outcomes by digest.
    learnt : Learnt, optional
        What was learnt before for bounds.

    Raises
    ------
    ScenarioError
        A case could not be simulated.
    AuditError
        The audit of a case failed.
    PlanError
        The tables make no plan, or a case was neither simulated nor has a bound.
    """
    tree, learnt = tree_of(case_list), learnt or Learnt()
    each = tuple(
        served(case_list, number, table, state_of_node(area, tree), learnt)
        for number, area in enumerate(case_list.areas)
    )
    return Model(case_list, table, each)


def unpriced_problem(case_list: CaseList) -> Problem:
    """The problem of a plan as far as it is known without a simulation: operation costs nothing."""
    plan, tree = case_list.plan, tree_of(case_list)
    stages = stages_of(plan)
    areas = tuple(
        Area(
            each.area.name or plan.file.name,
            np.zeros((tree.nodes, len(each.configurations))),
            transitions_of(plan, each, stages),
            orders_of(each.area, stages),
        )
        for each in case_list.areas
    )
    return Problem(tree, stages, areas, limit_of(plan, tree))


def stages_of(plan: Plan) -> Stages:
    """Stages of a plan with their discount rate."""
    start = tuple(float(year) for year in plan.file.stages.start)
    return Stages(start, float(plan.file.stages.end), plan.file.economics.discount_rate)


def limit_of(plan: Plan, tree: Tree) -> Array | None:
    """What may be spent in each node, shape (nodes,); None without a budget."""
    budget = plan.file.budget
    return None if budget is None else np.array(budget.per_stage)[tree.stage]


def tree_of(case_list: CaseList) -> Tree:
    """Tree of the futures: two are one node as long as traffic and prices are alike."""
    plan = case_list.plan
    names, futures = list(plan.futures), list(plan.futures.values())
    values: list[list[Hashable]] = [
        [
            (
                tuple(area.states.places[w][s] for area in case_list.areas),
                tuple(
                    (key, float(at_stage(value, s)))
                    for key, value in sorted(future.values.items())
                    if plan.is_price(key)
                ),
            )
            for s in range(plan.stages)
        ]
        for w, future in enumerate(futures)
    ]
    return make_tree(names, [each.probability for each in futures], values)


def state_of_node(area: AreaCases, tree: Tree) -> Indices:
    """State of traffic that each node of a tree asks for, shape (nodes,)."""
    states = np.empty(tree.nodes, dtype=np.int64)
    states[tree.node_of] = np.array(area.states.places)
    return states


def price_of_node(plan: Plan, tree: Tree) -> Array:
    """Price of each component in each node, shape (nodes, components); what is fed back is paid for."""
    components = components_of(plan.file)
    prices = np.empty((tree.nodes, len(components)))
    for w, future in enumerate(plan.futures.values()):
        for s in range(plan.stages):
            own = {
                key.removeprefix(f"{PRICES}."): float(at_stage(value, s))
                for key, value in future.values.items()
                if plan.is_price(key)
            }
            prices[tree.node_of[w, s]] = _prices(plan, own, components)
    return prices


def _prices(plan: Plan, changes: Mapping[str, float], components: tuple[str, ...]) -> Array:
    known = {key: each.value for key, each in prices_of(plan.file).items()} | dict(changes)
    known[FIXED] = 1.0
    if FED_BACK in known:
        known[FED_BACK] *= -1.0
    return np.array([known[name] for name in components])


def transitions_of(plan: Plan, area: AreaCases, stages: Stages) -> Changes:
    """What may follow what in an area, and what it costs."""
    planned = area.area.measures
    names = list(planned)
    start = np.asarray(plan.file.stages.start)
    priced = []
    for name, measure in planned.items():
        first = 0 if measure.earliest is None else int((start < measure.earliest).sum())
        last = None if measure.latest is None else int((start <= measure.latest).sum()) - 1
        price = (0.0, *measure.costs)
        priced.append(built.Measure(name, price, measure.lifetime_years, first, last))
    renewals = [
        built.Renewal(
            name,
            each.amount,
            float(each.year),
            tuple(names.index(other) for other in each.unless),
            each.lifetime_years,
            each.in_budget,
        )
        for name, each in area.area.renewals.items()
    ]
    levels = np.array([configuration.levels for configuration in area.configurations])
    return built.make_transitions(
        stages, levels.reshape(len(area.configurations), len(names)), priced, renewals
    )


def orders_of(area: PlannedArea, stages: Stages) -> tuple[int, ...]:
    """Stage at whose start it is decided what each stage has in service; all measures have one."""
    leads = [measure.lead_time_years for measure in area.measures.values()]
    return ordered_at(stages, max(leads, default=0.0))
