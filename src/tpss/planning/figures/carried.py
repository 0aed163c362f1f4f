"""Map of configuration over traffic: carried, limited by a requirement, or collapsed."""

from typing import Any

import pandas as pd

from tpss.planning.requirements import LIMITS
from tpss.planning.tables import NOT_SIMULATED
from tpss.planning.wording import in_order, traffic_in_words
from tpss.planning.written import Written, rows_of
from tpss.report.drawings.parts import Bar, Drawing, Panel, Words
from tpss.report.palette import tint

MOST_ROWS = 40
"""Configurations that are drawn; the table has more."""

MOST_WORDS, MOST_COLUMNS = 12, 60
"""Traffics up to which a cell has words, and that are drawn."""

LEAST_INCH, LABELS_INCH, ROW_INCH = 9.0, 3.0, 0.34
COLUMN_INCH, NARROW_INCH = 0.95, 0.3
"""Width of a column with words, and of one without."""

CARRIED, LIMITED, COLLAPSED = "carried", "limited by a requirement", "does not come through"
UNKNOWN = NOT_SIMULATED
COLOURS = {
    UNKNOWN: "#E8E8E8",
    CARRIED: tint("#009E73", 0.35),
    LIMITED: tint("#E69F00", 0.75),
    COLLAPSED: "#A63D00",
}
"""What becomes of a traffic, from pale to dark: in black and white too."""

WITH = " with "
"""Stands between what is not kept and the outage with which it is not."""


def carried(written: Written, area: str) -> Drawing | None:
    """Which configuration carries which traffic, and what limits it otherwise."""
    table = written.of("configurations", area)
    states = written.traffic[area]
    order = [name for name in in_order(states) if name in set(table.traffic)][:MOST_COLUMNS]
    used = list(dict.fromkeys(written.of("decisions", area).configuration))
    rows = _rows(written, area, used)
    words = traffic_in_words(states)
    with_words = len(order) <= MOST_WORDS
    items: list[Any] = []
    named: set[str] = set()
    cells = {(r["configuration"], r["traffic"]): r for r in rows_of(table)}
    for row, configuration in enumerate(rows):
        for k, name in enumerate(order):
            verdict, text = _verdict(cells[configuration, name])
            label = "" if verdict in named else verdict
            named.add(verdict)
            text = text if with_words else ""
            items.append(Bar(row, k - 0.5, 1.0, label, text, COLOURS[verdict], height=0.94))
        if configuration in used:
            items.append(Words(len(order) - 0.5, row, "in the plan", bold=True))
    column = COLUMN_INCH if with_words else NARROW_INCH
    width = max(LEAST_INCH, LABELS_INCH + column * len(order))
    room = 0.95 * len(order) / (width - LABELS_INCH)
    return Drawing(
        words.axis, [Panel("", items, rows=rows)], (-0.5, len(order) - 0.5 + room),
        panel_inch=ROW_INCH * len(rows), columns=[words.short[name] for name in order],
        width_inch=width,
    )  # fmt: skip


def _rows(written: Written, area: str, used: list[str]) -> list[str]:
    """Configurations in their order; of many, those of the plan and of the best first decisions."""
    every = list(dict.fromkeys(written.of("configurations", area).configuration))
    if len(every) <= MOST_ROWS:
        return every
    firsts = list(dict.fromkeys(written.of("first_decisions", area).configuration))
    best = set(list(dict.fromkeys([every[0], *used, *firsts]))[:MOST_ROWS])
    return [name for name in every if name in best]


def _verdict(row: dict[str, Any]) -> tuple[str, str]:
    """What becomes of a traffic, and in a few words why, or its lowest voltage."""
    if row["why_not"] == NOT_SIMULATED:
        return UNKNOWN, ""
    if row["carried"]:
        return CARRIED, f"{row['lowest_voltage_kv']:.2f} kV"
    first = row["why_not"].split("; ")[0]
    reason, _, outage = first.partition(WITH)
    through = pd.notna(row["lowest_voltage_kv"])
    return (LIMITED if through else COLLAPSED), _short(reason) + (" *" if outage else "")


def _short(reason: str) -> str:
    """A reason in as few words as fit into a cell."""
    for *_, words in LIMITS:
        before = words.partition("{")[0]
        if reason.startswith(before):
            told = reason.removeprefix(before)
            return told if "kV" in told and "mean" not in before else f"{before.split()[-1]} {told}"
    return reason
