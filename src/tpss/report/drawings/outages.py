"""Voltages of the cases of a table of outages, a row each."""

from collections.abc import Sequence

import numpy as np

from tpss.report.drawings.parts import DASH_DOTTED, DOTTED, Curve, Drawing, Mark, Panel
from tpss.report.sampling import Floats
from tpss.scenario.standards import VoltageLimits

MARGIN = 0.05
"""What is free at both sides, as a share of what is between."""


def voltages_of_cases(
    names: Sequence[str], lowest_kv: Floats, useful_kv: Floats, limits: VoltageLimits
) -> Drawing:
    """Lowest voltages and lowest mean useful voltages of cases, and their limits.

    Parameters
    ----------
    names : sequence of str
        Of the cases, from above.
    lowest_kv, useful_kv : array, shape (cases,)
        NaN: there is none. [kV]
    limits : VoltageLimits
    """
    rows = np.arange(len(names), dtype=float)
    told = {"lowest voltage": lowest_kv, "lowest mean useful voltage of a zone": useful_kv}
    points = [
        Curve(
            values, rows, name, colour=k, joined=False,
            words=[f"{case}<br>{name}: {kv:.2f} kV" for case, kv in zip(names, values, strict=True)],
        )
        for k, (name, values) in enumerate(told.items())
    ]  # fmt: skip
    marks = {"Umin2": limits.umin2_kv, "Umin1": limits.umin1_kv}
    lines = [Mark(kv, words, dash=DOTTED, upright=True) for words, kv in marks.items()]
    if limits.mean_useful_kv is not None:
        mark = Mark(limits.mean_useful_kv, "least mean useful", dash=DASH_DOTTED, upright=True)
        lines.append(mark)
    every = np.concatenate([lowest_kv, useful_kv, [mark.value for mark in lines]])
    low, high = float(np.nanmin(every)), float(np.nanmax(every))
    room = MARGIN * max(high - low, 1.0)
    panel = Panel("", [*lines, *points], rows=list(names))
    return Drawing("voltage [kV]", [panel], span=(low - room, high + room))
