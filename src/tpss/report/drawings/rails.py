"""Voltage of the rails to earth along each line, over a whole run."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from tpss.report.drawings.parts import DASHED, DOTTED, POSITION, Curve, Drawing, Item, Mark, Panel
from tpss.report.trains import NothingToDrawError
from tpss.results.result import Result

NEAR = 1.5
"""Limits up to this many times what is drawn are drawn too."""


def rail_voltage(result: Result) -> Drawing:
    """Highest and lowest voltage of the rails at each place, highest mean over 300 s, and limits near.

    A panel is a line.

    Raises
    ------
    NothingToDrawError
        Rails are no conductors of their own.

    References
    ----------
    [EN50122]_, on touch voltages; the limits are data.
    """
    found = result.rails
    if not len(found):
        raise NothingToDrawError("rails are no conductors of their own")
    lines = found.groupby("line", sort=False) if "line" in found else [("", found)]
    panels = [
        Panel(f"rails to earth{name and ', '}{name} [V]", list(_items(rows, result)))
        for name, rows in lines
    ]
    return Drawing(POSITION, panels, panel_inch=3.4)


def _items(rows: pd.DataFrame, result: Result) -> Iterator[Item]:
    is_direct = result.scenario.supply.is_direct
    km = rows.position_km.to_numpy()
    yield Curve(km, rows.highest_v.to_numpy(), "highest")
    if is_direct:
        yield Curve(km, rows.lowest_v.to_numpy(), "lowest", 1)
    if np.isfinite(rows.permanent_v).any():
        yield Curve(
            km, rows.permanent_v.to_numpy(), "highest mean of the magnitude over 300 s", 2, DASHED
        )
    limits = result.scenario.standards.rails.completed(is_direct)
    low_v, high_v = float(rows.lowest_v.min()), float(rows.highest_v.max())
    for value in (limits.permanent_v, limits.short_v):
        # One that lies far beyond what is drawn would make that flat.
        if value is not None and value < NEAR * high_v:
            yield Mark(value, f"limit {value:g} V", f"limit {value:g}", dash=DOTTED)
        if value is not None and is_direct and -value > NEAR * low_v:
            yield Mark(-value, f"limit {-value:g} V", f"limit {-value:g}", dash=DOTTED)
