"""Drawings as matplotlib figures, for print."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from tpss.report.drawings.parts import (
    Band,
    Bar,
    Colours,
    Curve,
    Drawing,
    Item,
    Map,
    Mark,
    Panel,
    Places,
    Words,
)
from tpss.report.palette import AREA_SCALE, LINE_SCALE, STRONG_GREY, Stops
from tpss.report.palette import colour as colour

LINES = ("-", "--", "-.", ":")
"""Line styles, so that curves differ in black and white too."""

SYMBOLS = ("o", "o", "s", "v", "D", "X", "")
"""Symbols of places by their numbers."""

SIZES = (3.5, 7.0, 8.0, 6.0, 5.0, 6.0, 0.0)
"""Sizes of these. [pt]"""

LETTER_INCH = 0.08
"""Width of a letter, rather too much than too little."""

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

Asked = ParamSpec("Asked")


def static(describe: Callable[Asked, Drawing]) -> Callable[Asked, Figure]:
    """Turn a function that describes a drawing into one that returns its matplotlib figure."""

    @wraps(describe)
    def drawn(*args: Asked.args, **kwargs: Asked.kwargs) -> Figure:
        return render(describe(*args, **kwargs))

    return drawn


@rc_context(STYLE)
def render(drawing: Drawing) -> Figure:
    """Make a matplotlib figure of a drawing; it is neither shown nor saved."""
    labels = [panel.printed or as_text(panel.label) for panel in drawing.panels]
    figure, places = panels(
        labels, as_text(drawing.axis), panel_inch=drawing.panel_inch, width_inch=drawing.width_inch
    )
    for panel, axes in zip(drawing.panels, places, strict=True):
        if drawing.span:
            axes.set_xlim(drawing.span)
        for item in panel.items:
            _draw(item, axes)
        _set_vertical_axis(panel, axes)
        if not (drawing.axis or drawing.columns):
            axes.set_xticks([])
            axes.spines["bottom"].set_visible(False)
    if drawing.columns:
        room_inch = drawing.width_inch / len(drawing.columns)
        _name_columns(drawing.columns, room_inch, places[0])
    legend(figure, places[0], least=1 if drawing.names_one else 2)
    return figure


def _set_vertical_axis(panel: Panel, axes: Axes) -> None:
    if panel.span:
        axes.set_ylim(panel.span)
    elif panel.from_zero:
        axes.set_ylim(bottom=0.0)
    if panel.tick:
        axes.yaxis.set_major_locator(MultipleLocator(panel.tick))
    if panel.rows:
        axes.set_yticks(range(len(panel.rows)), [as_text(name) for name in panel.rows])
        axes.set_ylim(len(panel.rows) - 0.5, -0.5)
        axes.tick_params(axis="y", length=0)
        axes.grid(visible=False, axis="y")
    if panel.bare:
        axes.set_yticks([])
        axes.spines["left"].set_visible(False)


def _name_columns(names: Sequence[str], room_inch: float, axes: Axes) -> None:
    """Names above columns, upright if they are longer than there is room for each."""
    axes.set_xticks(range(len(names)), [as_text(name) for name in names])
    longest = max(len(each) for name in names for each in name.splitlines() or [""])
    turned = 90.0 if LETTER_INCH * longest > room_inch else 0.0
    axes.tick_params(
        axis="x", length=0, top=False, labeltop=True, labelbottom=False, labelrotation=turned
    )
    axes.xaxis.set_label_position("top")
    axes.set_xlabel(axes.get_xlabel(), loc="left")  # seen first where it is wider than a page
    axes.grid(visible=False, axis="x")
    for side in ("bottom", "left"):
        axes.spines[side].set_visible(False)


def _draw(item: Item, axes: Axes) -> None:
    match item:
        case Curve(colours=Colours() as colours):
            _draw_coloured(item, colours, axes)
        case Curve():
            look: Any = {"color": colour(item.colour), "label": as_text(item.name) or "_nolegend_"}
            look |= {"lw": 1.2 * item.width, "drawstyle": "steps-post" if item.held else "default"}
            look |= {"ls": line(item.dash)} if item.joined else {"ls": "", "marker": "o"}
            axes.plot(item.x, item.y, **look)
        case Band():
            look = {"color": colour(item.colour), "alpha": 0.15, "lw": 0}
            axes.fill_between(item.x, item.lowest, item.highest, **look)
        case Mark():
            _draw_mark(item, axes)
        case Map():
            look = _scaled(item.colours, AREA_SCALE)
            drawn = axes.pcolormesh(item.x, item.y, item.colours.values, shading="nearest", **look)
            _add_scale(axes, drawn, item.colours)
        case Bar():
            _draw_bar(item, axes)
        case Places():
            _draw_places(item, axes)
        case Words():
            _write(item, axes)


def _draw_coloured(item: Curve, colours: Colours, axes: Axes) -> None:
    look = _scaled(colours, LINE_SCALE)
    drawn: ScalarMappable
    if item.joined:
        points = np.stack([item.x, item.y], axis=1)
        pieces = np.stack([points[:-1], points[1:]], axis=1)
        whole = np.isfinite(pieces).all(axis=(1, 2))
        look |= {"array": colours.values[:-1][whole], "lw": 1.2 * item.width, "capstyle": "round"}
        drawn = axes.add_collection(LineCollection(list(pieces[whole]), **look))
    else:
        drawn = axes.scatter(
            item.x, item.y, c=colours.values, s=12 * item.width**2, zorder=3, **look
        )
    _add_scale(axes, drawn, colours)


def _draw_mark(item: Mark, axes: Axes) -> None:
    x, y, across = [0.0, 1.0], [item.value, item.value], axes.get_yaxis_transform()
    place: Any = {"xytext": (4, 0), "ha": "left", "va": "center"}
    if item.upright:
        x, y, across = y, x, axes.get_xaxis_transform()
        low, high = axes.get_xlim()
        share = (item.value - low) / (high - low)
        side = "left" if share < 0.1 else "right" if share > 0.9 else "center"
        place = {"xytext": (0, 3), "ha": side, "va": "bottom"}
    # Unlike axhline, an artist leaves the limits of the axes alone.
    look: Any = {"color": item.colour, "lw": 0.8, "ls": line(item.dash), "zorder": 0.9}
    axes.add_artist(Line2D(x, y, transform=across, **look))
    axes.annotate(
        item.printed or as_text(item.words), (x[1], y[1]), xycoords=across,
        textcoords="offset points", fontsize="small", color=STRONG_GREY, annotation_clip=False, **place,
    )  # fmt: skip


def _draw_bar(item: Bar, axes: Axes) -> None:
    look: Any = {"color": item.colour, "edgecolor": "white", "lw": 0.8}
    look["height"] = item.height
    axes.barh(item.row, item.length, left=item.start, label=as_text(item.name), **look)
    light = float(np.dot((0.3, 0.59, 0.11), to_rgb(item.colour)))
    look = {"color": "black" if light > 0.5 else "white", "ha": "center", "va": "center"}
    axes.text(item.start + item.length / 2.0, item.row, as_text(item.words), **look)


def _draw_places(item: Places, axes: Axes) -> None:
    look: Any = {"marker": SYMBOLS[item.symbol], "ms": SIZES[item.symbol], "mec": item.colour}
    look |= {"mfc": "white" if item.hollow else item.colour, "ls": "", "zorder": 4}
    axes.plot(item.x, item.y, label=as_text(item.name), **look)
    beside: Any = {"xytext": (0, -7), "ha": "center", "va": "top"}
    if item.above:
        turned = {"rotation": 35.0, "rotation_mode": "anchor"}
        beside = {"xytext": (1, 6), "ha": "left", "va": "bottom", **turned}
    beside |= {"textcoords": "offset points", "fontsize": "small", "annotation_clip": False}
    for x, y, words in zip(item.x, item.y, item.labels, strict=False):
        axes.annotate(as_text(words), (x, y), **beside)


BESIDE: tuple[Any, ...] = (
    {"xytext": (-5, 0), "ha": "right", "va": "center"},
    {"xytext": (5, 0), "ha": "left", "va": "center"},
    {"xytext": (0, 3), "ha": "left", "va": "bottom"},
    {"xytext": (0, -3), "ha": "left", "va": "top"},
)
"""Where words stand, by the side of their place."""


def _write(item: Words, axes: Axes) -> None:
    look: Any = {"color": item.colour, "fontweight": "bold" if item.bold else "normal"}
    look |= {"textcoords": "offset points", "annotation_clip": False}
    axes.annotate(as_text(item.text), (item.x, item.y), **look, **BESIDE[item.side])


def _scaled(colours: Colours, stops: Stops) -> Any:
    scale = LinearSegmentedColormap.from_list("values", stops)
    return {"cmap": scale, "norm": Normalize(colours.low, colours.high)}


def _add_scale(axes: Axes, drawn: ScalarMappable, colours: Colours) -> None:
    if not colours.explained:
        return
    axes.figure.colorbar(drawn, ax=axes, label=colours.label, pad=0.02, aspect=40)


def as_text(name: object) -> str:
    """A name in which matplotlib finds no formula."""
    return str(name).replace("$", r"\$")


def line(k: int) -> str:
    """Line style of the k-th curve."""
    return LINES[k % len(LINES)]


def panels(
    labels: Sequence[str], axis: str, *, panel_inch: float = 1.25, width_inch: float = 7.0
) -> tuple[Figure, list[Axes]]:
    """Figure with panels above each other, so many [inch] high and wide, by what their axes carry."""
    figure = Figure(figsize=(width_inch, 0.8 + panel_inch * len(labels)))
    axes = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0].tolist()
    for panel, text in zip(axes, labels, strict=True):
        panel.set_ylabel(text)
        panel.margins(x=0.0)
    axes[-1].set_xlabel(axis)
    figure.align_ylabels(axes)
    return figure, axes


def legend(figure: Figure, panel: Axes, least: int = 2) -> None:
    """Legend of a panel's curves below the figure, if there are as many as it has at least."""
    handles, names = panel.get_legend_handles_labels()
    if len(handles) >= least:
        columns = 4 if max(map(len, names)) < 20 else 2  # four long ones are wider than the page
        figure.legend(handles, names, loc="outside lower center", ncols=min(columns, len(handles)))
