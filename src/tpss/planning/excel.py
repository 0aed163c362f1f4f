"""All tables of an answer in one workbook of Excel, with a sheet that says what they hold."""

from collections.abc import Mapping

import pandas as pd

from tpss.planning.plan import Economics
from tpss.results.export import with_units
from tpss.results.workbook import workbook

WORKBOOK = "plan.xlsx"
"""File of the workbook, beside those of CSV."""

CONTENTS = "contents"
"""Name of the sheet that says what the others hold."""

MOST_ROWS = 20_000
"""Rows of a table that gets a sheet; longer ones are in CSV only, as Excel would take seconds."""

HOLDS = {
    "decisions": "what is ordered and in service when, if which scenarios may still come",
    "first_decisions": "every first decision, with what the best plan costs that contains it",
    "first_costs": "these costs by component, of the best first decisions",
    "best_plans": "the best plans in the order of their costs, node by node",
    "costs": "cost of the plan by component, stage and scenario, plain and discounted",
    "regret": "what each plan costs more in a scenario than the best one of that scenario",
    "values": "worth of knowing the future, of deciding later, of planning for more than the mean",
    "configurations": "every configuration with every traffic: whether it carries it, and why not",
    "switching_values": "at which price, cost, rate or probability the first decision turns",
    "finer_step": "the best first decisions at a finer time step, if the plan asks for one",
}
"""Tables of an answer by the names of their files, and what they hold."""


def excel_of(tables: Mapping[str, pd.DataFrame], economics: Economics) -> bytes:
    """Workbook of tables by name.

    Parameters
    ----------
    tables : mapping of str to DataFrame
    economics : Economics
        Whose currency and year all money is in.
    """
    sheets = {name: with_units(table) for name, table in tables.items() if len(table) <= MOST_ROWS}
    money = f"all money is in {economics.currency} of {economics.price_year}, real"
    listed = [
        {
            "table": name,
            "what it holds": HOLDS[name],
            "rows": len(table),
            "where": "a sheet of this book" if name in sheets else f"{name}.csv, for its length",
        }
        for name, table in tables.items()
    ]
    listed.append({"table": "", "what it holds": money, "rows": None, "where": ""})
    contents = pd.DataFrame(listed).astype({"rows": object})
    return workbook({CONTENTS: contents, **sheets})
