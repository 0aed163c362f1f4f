"""Stores of energy over time: how full they are, and what power they take and give."""

from collections.abc import Mapping

import numpy as np

from tpss.report.drawings.parts import TIME, Curve, Drawing, Mark, Panel
from tpss.report.palette import STRONG_GREY
from tpss.report.trains import NothingToDrawError
from tpss.results.result import Result
from tpss.results.storage import ON_BOARD, Store, stores_of

MOST_ON_BOARD = 6
"""Trains whose stores are drawn; of more, those that move most energy."""


def storage(runs: Mapping[str, Result]) -> Drawing:
    """State of charge of all stores of energy, and the power that they take, over time.

    A colour is a store, a line style for each run.  Below 0 a store gives power.  Of many trains with
    stores on board those are drawn that move most energy.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    Raises
    ------
    NothingToDrawError
        No run has any.
    """
    charge: list[Curve] = []
    power: list[Curve] = []
    for k, (label, result) in enumerate(runs.items()):
        minutes = result.dataset.time.to_numpy() / 60.0
        for m, store in enumerate(_shown(list(stores_of(result.dataset, result.scenario)))):
            name, dash = (f"{store.name}, {label}", k) if len(runs) > 1 else (store.name, m // 6)
            soc = 100.0 * store.energy_j / store.given.capacity_j
            charge.append(Curve(minutes, soc, name, m % 6, dash))
            megawatts = np.append(store.power_w, np.nan) / 1e6
            power.append(Curve(minutes, megawatts, name, m % 6, dash, held=True))
    if not charge:
        raise NothingToDrawError("there is no store of energy")
    zero = Mark(0.0, colour=STRONG_GREY)
    panels = [
        Panel("state of charge [%]", charge, "state of\ncharge [%]", span=(-2.0, 102.0)),
        Panel("power taken [MW]", [zero, *power], "power taken\n[MW]"),
    ]
    return Drawing(TIME, panels, panel_inch=2.0, names_one=True)


def _shown(stores: list[Store]) -> list[Store]:
    """All stores at the line, and of those on board the ones that move most energy."""
    on_board = [each for each in stores if each.place == ON_BOARD]
    if len(on_board) <= MOST_ON_BOARD:
        return stores
    by_energy = sorted(on_board, key=lambda each: -float(np.nansum(np.abs(each.power_w))))
    chosen = {each.name for each in by_energy[:MOST_ON_BOARD]}
    return [each for each in stores if each.place != ON_BOARD or each.name in chosen]
