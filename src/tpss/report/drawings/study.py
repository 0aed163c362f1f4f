"""Cases of a study: parallel coordinates of what varied and what came of it, and two figures of each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tpss.report.drawings.parts import NO_SYMBOL, Colours, Curve, Drawing, Panel, Places
from tpss.report.palette import GREY, STRONG_GREY
from tpss.report.sampling import Floats, Indices

TOP = 1.12
"""Where the highest value of an axis is written, and its name begins; the axis ends at 1."""

LONGEST = 16
"""Characters of a text that are written beside an axis."""

MARGIN = 0.03
"""What is free at both sides of points, as a share of what is between."""

MOST_LEVELS = 8
"""Texts of an axis that are written beside it."""


@dataclass(frozen=True)
class Axis:
    """A quantity of all cases: a number, or one of some texts, which are numbered."""

    label: str
    values: Floats
    """Shape (cases,); NaN: a case has none."""
    levels: Sequence[str] = ()
    """Texts by their numbers; empty of a number."""

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest value."""
        known = self.values[np.isfinite(self.values)]
        return (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)

    @property
    def shares(self) -> Floats:
        """Places on the axis, from 0 below to 1 above; half-way where all cases are alike."""
        low, high = self.ends
        if low == high:
            return np.where(np.isfinite(self.values), 0.5, np.nan)
        return (self.values - low) / (high - low)

    @property
    def written(self) -> list[tuple[float, str]]:
        """Places on the axis and what is written there."""
        low, high = self.ends
        if self.levels:
            chosen = np.unique(
                np.linspace(0, len(self.levels) - 1, MOST_LEVELS).round().astype(int)
            )
            span = max(len(self.levels) - 1, 1)
            only = len(self.levels) == 1
            return [(0.5 if only else k / span, _short(self.levels[k])) for k in chosen.tolist()]
        if low == high:
            return [(0.5, f"{low:.4g}")]
        return [(0.0, f"{low:.4g}"), (1.0, f"{high:.4g}")]


def _short(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def parallel(cases: Floats, axes: Sequence[Axis], groups: dict[str, Indices]) -> Drawing:
    """A line for each case over upright axes beside each other, in the colour of its group.

    A case that lacks a quantity has a gap there.

    Parameters
    ----------
    cases : array, shape (cases,)
        Their numbers.
    axes : sequence of Axis
    groups : dict of str to array of int
        Rows of the cases by the names of the groups.
    """
    shares = np.array([axis.shares for axis in axes])
    places = np.arange(len(axes), dtype=float)
    items: list[Curve | Places] = []
    for k, (name, rows) in enumerate(groups.items()):
        y = np.column_stack([shares[:, rows].T, np.full(len(rows), np.nan)]).ravel()
        x = np.tile(np.append(places, np.nan), len(rows))
        words = [f"case {cases[row]:.0f}" for row in rows for _ in range(len(axes) + 1)]
        items.append(Curve(x, y, name, colour=k, width=0.5, words=words))
    for place, axis in zip(places.tolist(), axes, strict=True):
        y = np.array([TOP if at == 1.0 else at for at, _ in axis.written])
        texts = [text for _, text in axis.written]
        at = np.full(len(y), place)
        items.append(Curve(np.full(2, place), np.array([0.0, 1.0]), colour=5, width=0.8))
        items.append(Places(at, y - 0.01, "", NO_SYMBOL, STRONG_GREY, texts, texts, above=False))
    top = np.full(len(axes), TOP)
    names = [axis.label for axis in axes]
    items.append(Places(places, top, "", NO_SYMBOL, GREY, names, names))
    panel = Panel("", items, span=(-0.12, 1.8), bare=True)
    return Drawing("", [panel], span=(-0.4, len(axes) - 0.1), panel_inch=4.0)


def trade_off(cases: Floats, across: Axis, up: Axis, shade: Axis) -> Drawing:
    """A point for each case: two quantities along the axes, and a third as its colour."""
    known = np.isfinite(across.values) & np.isfinite(up.values)
    words = [
        f"case {case:.0f}<br>{across.label}: {x:.4g}<br>{up.label}: {y:.4g}<br>{shade.label}: {z:.4g}"
        for case, x, y, z in zip(
            cases[known], across.values[known], up.values[known], shade.values[known], strict=True
        )
    ]
    low, high = shade.ends
    coloured = Colours(shade.values[known], shade.label, low, high if high > low else low + 1.0)
    points = Curve(
        across.values[known], up.values[known], "", joined=False, width=1.2,
        words=words, colours=coloured,
    )  # fmt: skip
    begin, end = across.ends
    room = MARGIN * (end - begin if end > begin else 1.0)
    span = (begin - room, end + room)
    return Drawing(across.label, [Panel(up.label, [points])], span=span, panel_inch=4.0)
