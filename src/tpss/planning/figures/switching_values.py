"""Tornado of switching values: how far each number may go before another first decision leads."""

import math
from typing import Any

from tpss.planning.turning import EDGE, HIGHEST_RATE, WIDEST
from tpss.planning.wording import number, varied_in_words
from tpss.planning.written import Written
from tpss.report.drawings.parts import Bar, Drawing, Mark, Panel, Words
from tpss.report.palette import tint

MOST_ROWS = 16
"""Numbers that are drawn, those first that need change the least."""

WIDTH_INCH, BAR_INCH = 9.0, 0.3

TURNS, STAYS = "#E69F00", tint("#0072B2", 0.35)


def switching_values(written: Written, area: str) -> Drawing | None:
    """Ranges of numbers of the plan within which the first decision of an area stays what it is.

    Each is varied alone, from nothing to a multiple of today's value.  None if nothing is known.
    """
    found = [row for row in written.rows("switching_values", area) if row["now"] > 0.0]
    found = sorted(found, key=_least_change)[:MOST_ROWS]
    if not found:
        return None
    items: list[Any] = []
    rows = []
    named: set[str] = set()
    for k, row in enumerate(found):
        low, high = _ends(row)
        turned = [end for end in (row["below"], row["above"]) if not math.isnan(end)]
        name = "turns at its end" if turned else "does not turn in the range looked at"
        colour = TURNS if turned else STAYS
        items.append(Bar(k, low, high - low, "" if name in named else name, "", colour))
        named.add(name)
        rows.append(f"{varied_in_words(row['key'])}, now {number(row['now'])}")
        items.append(Words(high, k, _turns(row)))
    items.append(Mark(1.0, "today", upright=True, colour="#444444"))
    panel = Panel("", items, rows=rows)
    inch = BAR_INCH * len(rows) + 0.35
    axis = "value as a multiple of today’s"
    return Drawing(axis, [panel], (0.0, 1.6 * WIDEST), panel_inch=inch, width_inch=WIDTH_INCH)


def _least_change(row: dict[str, Any]) -> float:
    changes = [abs(row[end] / row["now"] - 1.0) for end in ("below", "above")]
    return min((each for each in changes if not math.isnan(each)), default=math.inf)


def _ends(row: dict[str, Any]) -> tuple[float, float]:
    """Ends of the range in which the first decision stays, in multiples of today's value."""
    key, now = row["key"], row["now"]
    low, high = 0.0, WIDEST
    if key.endswith("discount_rate"):
        high = max(HIGHEST_RATE, now) / now
    elif key.endswith("probability"):
        low, high = min(EDGE, now) / now, max(1.0 - EDGE, now) / now
    below, above = row["below"] / now, row["above"] / now
    ends = (low if math.isnan(below) else below), (high if math.isnan(above) else above)
    return ends[0], min(ends[1], WIDEST)


def _turns(row: dict[str, Any]) -> str:
    """Where it turns, and to what, in words."""
    parts = []
    for end, words in (("below", "below"), ("above", "above")):
        if not math.isnan(row[end]):
            parts.append(f"{words} {number(row[end])}: {row[f'{end}_to']}")
    return ";  ".join(parts)
