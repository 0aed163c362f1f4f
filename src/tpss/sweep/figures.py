"""Drawings of a study, by their names."""

from collections.abc import Callable

import numpy as np

from tpss.report.drawings.parts import Drawing
from tpss.report.drawings.study import parallel, trade_off
from tpss.report.sampling import Indices
from tpss.sweep.outcome import KEPT, Outcome

MOST_VARIED = 8
"""Axes of what varied that can be told apart beside those of the figures."""

BESIDE = ("trip_time_min", "total_energy_mwh", "peak_loading", "lowest_voltage_kv")
"""Figures of the parallel coordinates; the last one colours the lines of cases within their ratings."""

MOST_LINES = 2_000
"""Lines of parallel coordinates that a browser draws at once."""

THIRDS = ("lowest third of", "middle third of", "highest third of")

PAIR, SHADE = ("peak_loading", "lowest_voltage_kv"), "total_energy_mwh"
"""Figures that are set against each other, and the one that colours their points."""


def coordinates(outcome: Outcome) -> Drawing:
    """Parallel coordinates of what varied and of the key figures."""
    figures = [name for name in BESIDE if name in outcome.figures]
    axes = [outcome.axis(name) for name in (*outcome.varied[:MOST_VARIED], *figures)]
    numbers = outcome.ran["case"].to_numpy(dtype=float)
    every = one_in(outcome)
    groups = {name: rows[::every] for name, rows in _coloured(outcome, figures).items()}
    return parallel(numbers, axes, groups)


def one_in(outcome: Outcome) -> int:
    """Of how many cases one is drawn as a line: of each, up to `MOST_LINES`."""
    return -(-len(outcome.ran) // MOST_LINES)


def _coloured(outcome: Outcome, figures: list[str]) -> dict[str, Indices]:
    """Groups of cases, those within their ratings parted in three by their last figure."""
    groups = outcome.groups
    rows = groups.pop(KEPT, None)
    if rows is None or not figures or len(rows) < len(THIRDS):
        return groups if rows is None else {KEPT: rows, **groups}
    axis = outcome.axis(figures[-1])
    name = axis.label.partition(" [")[0]
    parts = np.array_split(rows[np.argsort(axis.values[rows], kind="stable")], len(THIRDS))
    return {f"{words} {name}": part for words, part in zip(THIRDS, parts, strict=True)} | groups


def trade_offs(outcome: Outcome) -> Drawing:
    """Two key figures of each case against each other."""
    known = outcome.figures
    order = [name for name in (*PAIR, SHADE, *known) if name in known]
    chosen = list(dict.fromkeys(order))[:3]
    across, up, shade = (outcome.axis(name) for name in (chosen * 2)[:3])
    return trade_off(outcome.ran["case"].to_numpy(dtype=float), across, up, shade)


def drawable(outcome: Outcome) -> list[str]:
    """Names of the figures for which enough differs among the cases."""
    figures = len(outcome.figures)
    enough = {"parallel": len(outcome.varied) + figures > 1, "trade-offs": figures > 1}
    return [name for name in FIGURES if enough[name]]


FIGURES: dict[str, Callable[[Outcome], Drawing]] = {
    "parallel": coordinates,
    "trade-offs": trade_offs,
}
"""Figures of a study, by their names."""
