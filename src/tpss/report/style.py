"""The look of all figures: colours, line styles, panels above each other with one horizontal axis."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tpss.report.palette import COLOURS

Floats = npt.NDArray[np.float64]

LINES = ("-", "--", "-.", ":")
"""Line styles, so that curves differ in black and white too."""

STYLE: Any = {
    "font.size": 9.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "figure.constrained_layout.use": True,
    "figure.dpi": 110.0,
}
"""Settings for ``matplotlib.rc_context``; how it types their names depends on its version."""


def as_text(name: object) -> str:
    """A name in which matplotlib finds no formula."""
    return str(name).replace("$", r"\$")


def colour(k: int) -> str:
    """Colour of the k-th curve."""
    return COLOURS[k % len(COLOURS)]


def line(k: int) -> str:
    """Line style of the k-th curve."""
    return LINES[k % len(LINES)]


def style(k: int) -> tuple[str, str]:
    """Colour and line style of the k-th curve."""
    return colour(k), line(k)


def panels(
    labels: Sequence[str], axis: str, *, panel_inch: float = 1.25
) -> tuple[Figure, list[Axes]]:
    """Figure with a panel for each label, above each other with one horizontal axis.

    Parameters
    ----------
    labels : sequence of str
        What each panel's vertical axis carries, with its unit.
    axis : str
        What the horizontal axis carries, with its unit.
    panel_inch : float
        Height of a panel. [inch]
    """
    figure = Figure(figsize=(7.0, 0.8 + panel_inch * len(labels)))
    axes = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0].tolist()
    for panel, text in zip(axes, labels, strict=True):
        panel.set_ylabel(text)
        panel.margins(x=0.0)
    axes[-1].set_xlabel(axis)
    figure.align_ylabels(axes)
    return figure, axes


def legend(figure: Figure, panel: Axes, columns: int = 4) -> None:
    """Legend of a panel's curves below the figure, if there is more than one."""
    handles, names = panel.get_legend_handles_labels()
    if len(handles) > 1:
        figure.legend(handles, names, loc="outside lower center", ncols=min(columns, len(handles)))


def held(panel: Axes, x: Floats, y: Floats, look: tuple[str, str], label: str = "") -> None:
    """Draw what holds from one instant to the next, in a colour and a line style."""
    shown = label or "_nolegend_"
    panel.plot(x, y, look[1], color=look[0], drawstyle="steps-post", label=shown)
