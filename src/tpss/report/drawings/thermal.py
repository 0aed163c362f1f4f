"""Thermal states and temperatures of the equipment that comes closest to what it bears, over time."""

from collections.abc import Mapping

import numpy as np

from tpss.report.drawings.parts import DOTTED, TIME, Curve, Drawing, Mark, Panel
from tpss.report.palette import BLACK, COLOURS
from tpss.report.trains import NothingToDrawError
from tpss.results.result import Result
from tpss.results.thermal.judge import Thermal

MOST_CURVES, MOST_OF_A_KIND = 6, 2
"""Pieces of equipment that are drawn of a run, and those of a kind among them."""


def thermal(runs: Mapping[str, Result]) -> Drawing:
    """Thermal states over time and, where they are known, temperatures.

    A colour is a piece of equipment, a line style for each run.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    Raises
    ------
    NothingToDrawError
        No equipment of any run has a rating.
    """
    states, temperatures = [], []
    for k, (label, result) in enumerate(runs.items()):
        own, minutes = result.equipment, result.dataset.time.to_numpy() / 60.0
        for colour, e in enumerate(_drawn(own)):
            element, state = own.elements[e], own.states.state[:, e]
            name = f"{element.name}, {label}" if label else element.name
            dash = k if len(runs) > 1 else colour
            states.append(Curve(minutes, 100.0 * state, name, colour, dash))
            celsius = element.body.ambient_c + element.body.rise_k * state
            if np.isfinite(celsius).all():
                temperatures.append(Curve(minutes, celsius, name, colour, dash))
    if not states:
        raise NothingToDrawError("no equipment has a rating")
    rated = Mark(100.0, dash=DOTTED, colour=COLOURS[BLACK])
    panels = [Panel("state [%]", [*states, rated], "thermal state [%]", from_zero=True)]
    if temperatures:
        panels.append(Panel("temperature [°C]", temperatures))
    return Drawing(TIME, panels, panel_inch=2.0, names_one=True)


def _drawn(own: Thermal) -> list[int]:
    """Indices of the equipment that is drawn: the hottest, but few of a kind, as trains are many."""
    chosen: list[int] = []
    for e in own.hottest:
        kind = own.elements[e].kind
        if sum(own.elements[other].kind == kind for other in chosen) < MOST_OF_A_KIND:
            chosen.append(e)
    return chosen[:MOST_CURVES]
