"""Regret: what each plan costs more than the best one would, were the scenario known."""

import math
from typing import Any

import pandas as pd

from tpss.planning.written import Written, rows_of
from tpss.report.drawings.parts import Bar, Drawing, Panel, Words
from tpss.report.palette import tint

MOST_ROWS, MOST_COLUMNS = 12, 30
"""Plans and scenarios that are drawn; the table has more."""

LEAST_INCH, COLUMN_INCH, ROW_INCH = 9.0, 0.85, 0.34
"""Least width, and room of a column and of a row."""

LABELS_INCH = 3.2
"""Room of the names of the plans, and of what stands behind them."""

LARGEST = "largest"


def regret(written: Written, _: str) -> Drawing | None:
    """Matrix of regrets, a row a plan and a column a scenario; none of more scenarios than fit.

    Nor is there one if no regret is known.
    """
    table = written.tables["regret"]
    futures = [name for name in table.columns if name not in ("plan", LARGEST)]
    if len(futures) > MOST_COLUMNS or table.empty:
        return None
    chosen = _chosen(table)
    columns = [*futures, LARGEST] if len(futures) > 1 else futures
    worst = max((v for v in chosen[futures].to_numpy().flat if math.isfinite(v)), default=0.0)
    least = float(table[LARGEST].min())
    items: list[Any] = []
    for row, plan in enumerate(rows_of(chosen)):
        for k, name in enumerate(columns):
            value = float(plan[name])
            words = f"{value:,.1f}" if math.isfinite(value) else "not possible"
            items.append(Bar(row, k - 0.5, 1.0, "", words, _colour(value, worst), height=0.94))
        if len(futures) > 1 and plan[LARGEST] <= least * (1.0 + 1e-9) + 1e-9:
            items.append(Words(len(columns) - 0.5, row, "the largest is least", bold=True))
    panel = Panel("", items, rows=list(chosen.plan))
    width = max(LEAST_INCH, LABELS_INCH + COLUMN_INCH * len(columns))
    room = 1.45 * len(columns) / (width - LABELS_INCH)
    return Drawing(
        f"regret, discounted [{written.money}]", [panel], (-0.5, len(columns) - 0.5 + room),
        panel_inch=ROW_INCH * len(chosen), columns=columns, width_inch=width,
    )  # fmt: skip


def _chosen(table: pd.DataFrame) -> pd.DataFrame:
    """The plan, the best first decisions, what is decided today, and today's supply."""
    if len(table) <= MOST_ROWS:
        return table
    return pd.concat([table.head(MOST_ROWS - 2), table.tail(2)])


def _colour(value: float, worst: float) -> str:
    """Pale for little, dark for much: by the root, as the worst plans are far from all others."""
    if not math.isfinite(value):
        return "#BBBBBB"
    return tint("#D55E00", 0.04 + 0.8 * math.sqrt(max(value, 0.0) / worst) if worst else 0.04)
