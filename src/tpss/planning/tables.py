"""Tables of an answer: decisions, first decisions, costs, regret, values, configurations."""

from collections.abc import Iterator
from itertools import takewhile
from typing import Any

import numpy as np
import pandas as pd

from tpss.planning.answer import Answer, as_today, saved_against_today
from tpss.planning.cases import INTACT
from tpss.planning.costs import change_costs, change_outlays
from tpss.planning.problem import Solution
from tpss.planning.ranking import best_plans as ranked
from tpss.planning.ranking_within import best_plans_within
from tpss.planning.regret import least_regret, parts_at_orders, regrets
from tpss.planning.solve import Model
from tpss.planning.tree import NONE, Indices
from tpss.planning.worth import costs_by_part

RANKING_S = 10.0
"""Time that it may take to find the best plans within a budget. [s]"""

INVESTMENT = "investment"
"""Names what is charged for changes, among the components of costs."""


KNOWN, SIMULATED, AT_LEAST = "known", "simulated", "at least"
"""Column that says how well a cost is known, and what it says, where some costs are bounds."""

NOT_SIMULATED = "not simulated"
"""Stands where it is not known whether a configuration carries a traffic."""


def configuration_names(model: Model, area: int) -> list[str]:
    """Names of the configurations of an area."""
    return [each.name for each in model.areas[area].configurations]


def decisions(answer: Answer) -> pd.DataFrame:
    """What is ordered and in service when, if which scenarios may still come."""
    return pd.DataFrame([row for k in range(len(answer.model.areas)) for row in _of(answer, k)])


def _of(answer: Answer, k: int) -> Iterator[dict[str, Any]]:
    model, policy = answer.model, answer.best.policy[k]
    problem, names = model.problem, configuration_names(model, k)
    area, tree = problem.areas[k], model.tree
    start = model.plan.file.stages.start
    served, priced = model.served[k], model.priced[k]
    runs = priced.served(policy)
    outlay = change_outlays(problem, k, policy)
    charged = change_costs(problem, k, policy)
    for n in range(tree.nodes):
        before = area.transitions.initial if tree.parent[n] == NONE else policy[tree.parent[n]]
        stage = int(tree.stage[n])
        order = area.ordered_at[stage]
        yield {
            "area": area.name,
            "in_service": start[stage],
            "ordered": start[order] if order != NONE else None,
            "if": " or ".join(tree.scenarios_through(n)),
            "probability": float(tree.probability[n]),
            "builds": "+".join(built(model, k, int(before), int(policy[n]))),
            "configuration": names[policy[n]],
            "traffic_asked_for": served.traffic[served.quantities.state_of_node[n]],
            "traffic_run": served.traffic[runs[n]],
            "spent": float(outlay[n]),
            "charged": float(charged[n]),
            "operation_per_year": float(priced.yearly_cost[n, policy[n]]),
        }


def built(model: Model, area: int, before: int, after: int) -> list[str]:
    """Measures that come between two configurations of an area, with their levels."""
    configurations = model.areas[area].configurations
    found = []
    for number, (name, measure) in enumerate(model.areas[area].area.measures.items()):
        old, new = (configurations[c].levels[number] for c in (before, after))
        if new > old:
            found.append(name if measure.levels is None else f"{name}={measure.levels[new - 1]}")
    return found


def first_decisions(answer: Answer) -> pd.DataFrame:
    """Every first decision with what the best plan costs that contains it."""
    model = answer.model
    rows = []
    for each in answer.firsts:
        area = model.problem.areas[each.area]
        stage = int(model.tree.stage[each.nodes[0]])
        start = model.plan.file.stages.start
        rows.append(
            {
                "area": area.name,
                "ordered": start[area.ordered_at[stage]],
                "in_service": start[stage],
                "if": " or ".join(
                    dict.fromkeys(w for n in each.nodes for w in model.tree.scenarios_through(n))
                ),
                "configuration": configuration_names(model, each.area)[each.configuration],
                "cost": each.cost,
                "surplus": each.surplus,
                **({KNOWN: _known(answer, each.policy)} if model.has_bounds else {}),
            }
        )
    return pd.DataFrame(rows)


def _known(answer: Answer, policy: Indices) -> str:
    """How well the cost of a plan is known."""
    return AT_LEAST if answer.is_bound(policy) else SIMULATED


def costs(answer: Answer) -> pd.DataFrame:
    """Cost of the plan by component, stage and scenario, plain and discounted."""
    model = answer.model
    by_component = [
        priced.by_component(row)
        for priced, row in zip(model.priced, answer.best.policy, strict=True)
    ]
    plain, discounted = costs_by_part(model.problem, answer.best.policy, by_component)
    components = (*model.served[0].quantities.components, INVESTMENT)
    return pd.DataFrame(
        [
            {
                "component": component,
                "stage": model.plan.file.stages.start[s],
                "scenario": name,
                "plain": float(plain[k, s, w]),
                "discounted": float(discounted[k, s, w]),
            }
            for k, component in enumerate(components)
            for s in range(model.plan.stages)
            for w, name in enumerate(model.tree.names)
        ]
    )


def cost_difference(model: Model, policy: Indices, other: Indices) -> pd.DataFrame:
    """Expected discounted costs of two plans by component, and what the first costs more."""
    totals = []
    for plan in (policy, other):
        parts = [p.by_component(row) for p, row in zip(model.priced, plan, strict=True)]
        discounted = costs_by_part(model.problem, plan, parts)[1]
        totals.append(discounted.sum(axis=1) @ model.tree.scenario_probability)
    components = (*model.served[0].quantities.components, INVESTMENT)
    frame = pd.DataFrame({"component": components, "with": totals[0], "best": totals[1]})
    frame["more"] = frame["with"] - frame["best"]
    return frame[(frame["with"] != 0.0) | (frame["best"] != 0.0)].reset_index(drop=True)


def best_plans(answer: Answer, count: int = 20) -> pd.DataFrame:
    """The best plans in the order of their costs, node by node.

    With a budget as many as are found in `RANKING_S`.  Where some costs are bounds: only as far as the
    order is known.
    """
    model = answer.model
    columns = ["rank", "cost", "surplus", "area", "in_service", "if", "configuration"]
    start = model.plan.file.stages.start
    return pd.DataFrame(
        [
            {
                "rank": rank,
                "cost": solution.cost,
                "surplus": solution.cost - answer.best.cost,
                "area": area.name,
                "in_service": start[model.tree.stage[n]],
                "if": " or ".join(model.tree.scenarios_through(n)),
                "configuration": configuration_names(model, k)[solution.policy[k, n]],
            }
            for rank, solution in enumerate(
                takewhile(lambda each: not answer.is_bound(each.policy), _ranked(answer, count)),
                start=1,
            )
            for k, area in enumerate(model.problem.areas)
            for n in range(model.tree.nodes)
        ],
        columns=columns,
    )


def _ranked(answer: Answer, count: int) -> list[Solution]:
    """The best plans, within budgets too."""
    problem = answer.model.problem
    if not problem.is_limited:
        return ranked(problem, count)
    return best_plans_within(problem, answer.best, count, time_limit_s=RANKING_S)


def regret(answer: Answer) -> pd.DataFrame:
    """What each plan costs more than the best one of a scenario would, were that known.

    Where some costs are bounds: none, unless the best plan of each scenario was simulated, and then
    only of plans that were.
    """
    model = answer.model
    if any(answer.is_bound(each.policy, w) for w, each in enumerate(answer.worth.known)):
        return pd.DataFrame(columns=["plan", *model.tree.names, "largest"])
    plans = {"as today": as_today(model.problem)}
    if answer.worth.fixed is not None:
        plans["decided today"] = answer.worth.fixed.policy
    for each in reversed(answer.firsts):
        names = configuration_names(model, each.area)
        first = model.problem.areas[each.area].name
        label = names[each.configuration]
        plans[f"first {label}" if len(model.areas) == 1 else f"first {label} at {first}"] = (
            each.policy
        )
    may_be_least = len(model.areas) == 1 and not (model.problem.is_limited or model.has_bounds)
    if may_be_least and parts_at_orders(model.problem):
        plans["least regret"] = least_regret(model.problem, answer.worth.known_cost)
    plans["the plan"] = answer.best.policy
    plans = {name: policy for name, policy in plans.items() if not answer.is_bound(policy)}
    values = regrets(model.problem, list(plans.values())[::-1], answer.worth.known_cost)
    frame = pd.DataFrame(values, columns=list(model.tree.names))
    frame.insert(0, "plan", list(plans)[::-1])
    return frame.assign(largest=values.max(axis=1))


def values(answer: Answer) -> pd.DataFrame:
    """What the plan, knowledge and freedom are worth; "at least", where costs are bounds."""
    worth, least = answer.worth, f", {AT_LEAST}"
    known = any(answer.is_bound(each.policy, w) for w, each in enumerate(worth.known))
    decided = worth.fixed is not None and answer.is_bound(worth.fixed.policy)
    today = answer.is_bound(as_today(answer.model.problem))
    fixed = np.nan if worth.fixed is None else worth.fixed.cost
    rows: list[tuple[str, float, str]] = [
        ("plan", worth.best.cost, "expected cost of the plan"),
        ("bound", worth.best.bound, "no plan costs less"),
        (
            "known",
            worth.expected_known_cost,
            f"expected cost if each future were known{least * known}",
        ),
        ("information", worth.of_information, "worth of knowing the future, at most"),
        ("fixed", fixed, f"expected cost if all is decided today{least * decided}"),
        (
            "flexibility",
            fixed - worth.best.cost,
            f"worth of being able to decide later{least * decided}",
        ),
        *_of_the_mean(answer),
        (
            "saved",
            saved_against_today(answer),
            f"saved against leaving everything as it is{least * today}",
        ),
    ]
    return pd.DataFrame(rows, columns=["value", "cost", "meaning"])


def _of_the_mean(answer: Answer) -> Iterator[tuple[str, float, str]]:
    """What it costs to plan for the mean future, where there is one."""
    worth = answer.worth
    if answer.mean is not None:
        held = np.nan if worth.mean is None else worth.mean.cost
        yield ("mean", held, "expected cost with the first decision of the mean future")
        yield ("tree", held - worth.best.cost, "cost of planning for the mean future only")


def mean_future(answer: Answer) -> pd.DataFrame:
    """Traffic of the mean future by area and stage; empty where there is none."""
    model, mean = answer.model, answer.mean
    rows = [
        {
            "area": model.problem.areas[k].name,
            "stage": model.plan.file.stages.start[s],
            "traffic": model.areas[k].states.states[d].name,
        }
        for k, states in enumerate(mean.states if mean is not None else ())
        for s, d in enumerate(states.tolist())
    ]
    return pd.DataFrame(rows, columns=["area", "stage", "traffic"])


SHOWN = (
    "drawn_from_grid_mw", "fed_back_to_grid_mw", "converter_losses_mw", "network_losses_mw",
    "lowest_voltage_kv", "mean_useful_voltage_kv", "peak_loading",
)  # fmt: skip
"""Columns of the outcomes in the table of configurations."""


def configurations(model: Model) -> pd.DataFrame:
    """Every configuration with every traffic: whether it carries it, why not, and its outcome."""
    rows = []
    for case in model.case_list.cases:
        if case.outage != INTACT:
            continue
        area, served = model.areas[case.area], model.served[case.area]
        reasons = served.reasons.get((case.state, case.configuration), [NOT_SIMULATED])
        is_known = served.is_simulated[case.state, case.configuration]
        outcome = model.table.loc[case.digest] if is_known else pd.Series(dtype=object)
        rows.append(
            {
                "area": model.problem.areas[case.area].name,
                "configuration": area.configurations[case.configuration].name,
                "traffic": area.states.states[case.state].name,
                "carried": not reasons if is_known else None,
                "why_not": "; ".join(reasons),
                **{name: outcome.get(name, np.nan) for name in SHOWN},
            }
        )
    return pd.DataFrame(rows).replace({np.inf: np.nan})
