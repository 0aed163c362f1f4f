"""Costs of the best first decisions, by component."""

from collections.abc import Sequence
from typing import Any

from tpss.planning.tables import AT_LEAST, KNOWN
from tpss.planning.wording import component_in_words
from tpss.planning.written import Written, rows_of
from tpss.report.drawings.parts import Bar, Drawing, Panel, Words
from tpss.report.palette import tint

MOST_ROWS = 8
"""Bars that are drawn."""

WIDTH_INCH, BAR_INCH = 9.0, 0.36

NARROWEST = 0.06
"""Share of the whole width from which a part of a bar is wide enough for its figure."""

PURE = ("#0072B2", "#E69F00", "#D55E00", "#009E73", "#CC79A7", "#56B4E9")
TINTS = (1.0, 0.6, 0.35)
"""Colours of components, and their strengths where there are more components than colours."""


def first_costs(written: Written, area: str) -> Drawing | None:
    """Expected discounted costs of the best plans that contain the best first decisions."""
    firsts, parts = written.of("first_decisions", area), written.of("first_costs", area)
    if firsts.empty:
        return None
    groups = firsts["if"].unique()
    chosen = firsts.groupby("if", sort=False).head(max(1, MOST_ROWS // len(groups)))[
        : 3 * MOST_ROWS
    ]
    components = list(dict.fromkeys(written.tables["first_costs"].component))
    items: list[Any] = []
    rows: list[str] = []
    widest = float(chosen.cost.max())
    shown: set[str] = set()
    first_rows = set(chosen.groupby("if").head(1).index)
    best = [index in first_rows for index in chosen.index]
    for row, first in enumerate(rows_of(chosen)):
        own = parts[(parts.configuration == first["configuration"]) & (parts["if"] == first["if"])]
        costs = dict(zip(own.component, own.discounted, strict=True))
        when = f"\nif {written.futures_in_words(first['if'])}" if len(groups) > 1 else ""
        rows.append(f"{first['configuration']} in {int(first['in_service'])}{when}")
        bars, end = _bars(row, costs, components, shown, NARROWEST * widest)
        items += bars
        more = "" if best[row] else f"  +{first['surplus']:,.1f}"
        least = f"{AT_LEAST} " if first.get(KNOWN) == AT_LEAST else ""
        items.append(Words(end, row, f"{least}{first['cost']:,.1f}{more}", bold=best[row]))
    low = min([0.0, *(bar.start for bar in items if isinstance(bar, Bar))])
    inch = (BAR_INCH + 0.16 * (len(groups) > 1)) * len(rows)
    panel = Panel("", items, rows=rows)
    axis = f"expected discounted cost [{written.money}]"
    return Drawing(
        axis, [panel], (low, 1.22 * widest), panel_inch=inch + 0.3, width_inch=WIDTH_INCH
    )


def _bars(
    row: int, costs: dict[str, float], order: Sequence[str], shown: set[str], narrowest: float
) -> tuple[list[Bar], float]:
    """Parts of a bar, those that are paid for to the left of 0, and where it ends."""
    bars: list[Bar] = []
    end, begin = 0.0, 0.0
    for k, component in enumerate(order):
        cost = costs.get(component, 0.0)
        if cost == 0.0:
            continue
        begin += min(cost, 0.0)
        words = f"{cost:,.0f}" if abs(cost) > narrowest else ""
        colour = tint(PURE[k % len(PURE)], TINTS[k // len(PURE) % len(TINTS)])
        name = "" if component in shown else component_in_words(component)
        shown.add(component)
        bars.append(Bar(row, end if cost > 0.0 else begin, abs(cost), name, words, colour))
        end += max(cost, 0.0)
    return bars, end
