"""Where the energy goes that trains brake."""

from collections.abc import Mapping

import pandas as pd

from tpss.report.drawings.parts import Bar, Drawing, Panel
from tpss.report.palette import COLOURS
from tpss.report.trains import NothingToDrawError
from tpss.results.regeneration import by_service
from tpss.results.result import Result

PARTS = {
    "used_by_others_mwh": ("other trains and the line", COLOURS[2]),
    "to_stores_mwh": ("stores at the line", "#F0E442"),
    "to_grid_mwh": ("to the grid", COLOURS[0]),
    "own_use_mwh": ("own use", "#56B4E9"),
    "own_storage_mwh": ("own stores", "#DDCC77"),
    "burnt_in_stations_mwh": ("burnt in stations", COLOURS[3]),
    "machine_losses_mwh": ("lost in machines", COLOURS[1]),
    "rheostat_mwh": ("burnt in rheostats", "#882255"),
    "refused_mwh": ("refused by the line", COLOURS[4]),
    "friction_mwh": ("friction", "#777777"),
}
"""Words and colours of the parts, by their columns: first what is used, then what becomes heat."""

NARROWEST = 0.06
"""Share of the whole width from which a part of a bar is wide enough for its figure."""

OF_A_LETTER = 0.014
"""Share of the whole width that a letter of such a figure takes."""

SMALLEST = 0.0005
"""Share of the whole width below which a part is not visible, and left out."""

MOST_ROWS = 12
"""Bars; of more services those that brake less are one."""

ROW_INCH = 0.42


def braking(runs: Mapping[str, Result]) -> Drawing:
    """A bar for each service: the work of its brakes, and where it goes; of friction brakes into heat.

    Of many services those that brake least have one bar together.  Parts that are too small to be
    visible are left out.

    Parameters
    ----------
    runs : mapping of str to Result
        Results by label; the bars of one stand above those of the next.

    Raises
    ------
    NothingToDrawError
        No train was on the line.
    """
    found = {label: by_service(run.dataset, run.scenario) for label, run in runs.items()}
    rows = {
        f"{service}, {label}" if len(runs) > 1 else str(service): each
        for label, table in found.items()
        for service, each in _few(table).iterrows()
    }
    if not rows:
        raise NothingToDrawError("no train was on the line")
    width = max(1e-9, *(float(each["braked_mwh"]) for each in rows.values()))
    bars: list[Bar] = []
    named: set[str] = set()
    for row, each in enumerate(rows.values()):
        start = 0.0
        for column, (name, colour) in PARTS.items():
            mwh = float(each[column])
            if mwh < SMALLEST * width:
                continue
            words = f"{mwh:.3g}"
            if mwh <= max(NARROWEST, OF_A_LETTER * len(words)) * width:
                words = ""
            bars.append(Bar(row, start, mwh, "" if name in named else name, words, colour))
            named.add(name)
            start += mwh
    inch = 0.8 + ROW_INCH * len(rows)
    panel = Panel("", bars, rows=list(rows))
    return Drawing("energy braked [MWh]", [panel], (0.0, 1.02 * width), panel_inch=inch)


def _few(table: pd.DataFrame) -> pd.DataFrame:
    """All services, of many those that brake least together."""
    if len(table) <= MOST_ROWS:
        return table
    least = table.braked_mwh.rank(method="first") <= len(table) - MOST_ROWS + 1
    together = table[least].sum().to_frame(f"{least.sum()} others").T
    return pd.concat([table[~least], together])
