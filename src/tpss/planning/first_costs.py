"""What the best first decisions cost, by component: energy, minutes, trains not run, investment."""

import numpy as np
import pandas as pd

from tpss.planning.answer import Answer
from tpss.planning.tables import INVESTMENT, configuration_names
from tpss.planning.worth import costs_by_part

MOST_FIRSTS = 12
"""First decisions, of an area and of what one may know then, whose costs are told apart."""


def first_costs(answer: Answer) -> pd.DataFrame:
    """Expected discounted cost by component of the best plan that contains each first decision.

    The best first decisions only, and of each only what costs something, or is paid for; none of those
    whose costs are bounds.
    """
    model, rows = answer.model, []
    components = (*model.served[0].quantities.components, INVESTMENT)
    told: dict[tuple[int, str], int] = {}
    for each in answer.firsts:
        through = " or ".join(
            dict.fromkeys(w for n in each.nodes for w in model.tree.scenarios_through(n))
        )
        told[each.area, through] = told.get((each.area, through), 0) + 1
        if told[each.area, through] > MOST_FIRSTS or answer.is_bound(each.policy):
            continue
        parts = [p.by_component(row) for p, row in zip(model.priced, each.policy, strict=True)]
        discounted = costs_by_part(model.problem, each.policy, parts)[1].sum(axis=1)
        expected = np.asarray(discounted) @ model.tree.scenario_probability
        rows += [
            {
                "area": model.problem.areas[each.area].name,
                "if": through,
                "configuration": configuration_names(model, each.area)[each.configuration],
                "component": component,
                "discounted": float(cost),
            }
            for component, cost in zip(components, expected, strict=True)
            if cost != 0.0
        ]
    return pd.DataFrame(rows, columns=["area", "if", "configuration", "component", "discounted"])
