"""Drawings as plotly figures, for a page.

The figure's ``layout.meta`` says what its horizontal axis carries: "time", "position" or so.  Of long
curves it holds a part of the values, and all of them in single precision.
"""

from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from tpss.report.drawings import parts
from tpss.report.palette import AREA_SCALE, LINE_SCALE, STRONG_GREY, Stops, colour, translucent
from tpss.report.sampling import MOST_OF_CURVES, Floats, Indices, kept, share

DASHES = ("solid", "dash", "dashdot", "dot")
"""Line styles by their numbers."""

SYMBOLS = ("circle", "square", "diamond", "star")
"""Symbols of points by the number of their colour."""

OF_PLACES = ("circle", "circle", "square", "triangle-down", "diamond", "x", "circle")
SIZES = (6, 11, 13, 10, 10, 11, 6)
"""Symbols of places by their numbers, and their sizes. [px]"""

BESIDE: tuple[dict[str, Any], ...] = (
    {"xanchor": "right", "yanchor": "middle", "xshift": -5},
    {"xanchor": "left", "yanchor": "middle", "xshift": 5},
    {"xanchor": "left", "yanchor": "bottom", "yshift": 2},
    {"xanchor": "left", "yanchor": "top", "yshift": -2},
)
"""Where words stand, by the side of their place."""

LAYOUT = {
    "template": None,
    "margin": {"l": 58, "r": 16, "t": 40, "b": 48},
    "font": {"family": "system-ui, sans-serif", "size": 13, "color": "#1a1a1a"},
    "paper_bgcolor": "#FFFFFF",
    "plot_bgcolor": "#FFFFFF",
    "barmode": "overlay",
    "legend": {"orientation": "h", "yanchor": "bottom", "y": 1.01, "x": 0},
}
AXIS = {"gridcolor": "#DDDDDD", "zeroline": False, "linecolor": "#666666", "ticks": "outside"}


def render(drawing: parts.Drawing, height_px: int) -> go.Figure:
    """Make a plotly figure of a drawing."""
    count = len(drawing.panels)
    figure = make_subplots(rows=count, cols=1, shared_xaxes=True, vertical_spacing=0.06)
    figure.update_layout(LAYOUT, meta=drawing.axis.partition(" ")[0], height=height_px)
    # Wide numbers, and names of rows, find room beside the axis.
    figure.update_xaxes(AXIS, range=drawing.span).update_yaxes(AXIS, automargin=True)
    figure.update_xaxes(title={"text": drawing.axis}, row=count, col=1)
    if not (drawing.axis or drawing.columns):
        figure.update_xaxes(visible=False)
    items = [item for panel in drawing.panels for item in panel.items]
    curves = [item for item in items if isinstance(item, parts.Curve)]
    # The values of all curves are read at once, unless points have words of their own.
    alone = any(curve.words or curve.colours for curve in curves)
    figure.update_layout(hovermode="closest" if alone else "x unified")
    for row, panel in enumerate(drawing.panels, 1):
        figure.update_yaxes(
            title={"text": panel.label}, range=panel.span, dtick=panel.tick, row=row, col=1,
            rangemode="tozero" if panel.from_zero else "normal",
        )  # fmt: skip
        if panel.bare:
            figure.update_yaxes(visible=False, row=row, col=1)
        if panel.rows:
            names: Any = {"tickvals": [*range(len(panel.rows))], "ticktext": panel.rows}
            figure.update_yaxes(names, autorange="reversed", row=row, col=1)
        units = parts.unit_of(drawing.axis), parts.unit_of(panel.label)
        for item in panel.items:
            if isinstance(item, parts.Mark):
                _add_mark(figure, row, item)
                continue
            if isinstance(item, parts.Words):
                _write(figure, row, item)
                continue
            said = _hover(item, *units, alone, panel.bare)
            trace = _trace(item, len(curves)).update(hovertemplate=said)
            if panel.bare and said is None:
                trace.hoverinfo = "skip"
            trace.showlegend = row == 1 and bool(trace.name)
            figure.add_trace(trace, row=row, col=1)
            if isinstance(item, parts.Places):
                _add_labels(figure, row, item)
    if drawing.columns:
        named_x = {"tickvals": [*range(len(drawing.columns))], "ticktext": drawing.columns}
        figure.update_xaxes(named_x, side="top", showgrid=False, row=1, col=1)
    named = sum(trace.showlegend for trace in figure.data)
    least = 1 if drawing.names_one else 2
    return figure.update_layout(showlegend=named >= least or count > 1)


def _trace(
    item: parts.Curve | parts.Band | parts.Map | parts.Bar | parts.Places, curves: int
) -> Any:
    """A trace that shows an item of a figure of so many curves."""
    match item:
        case parts.Curve():
            return _curve(item, _few(item, curves))
        case parts.Band():
            x = _single(np.concatenate([item.x, item.x[::-1]]))
            y = _single(np.concatenate([item.lowest, item.highest[::-1]]))
            faint = translucent(colour(item.colour), 0.15)
            area: Any = {"mode": "none", "fill": "toself", "fillcolor": faint, "hoverinfo": "skip"}
            return go.Scatter(x=x, y=y, **area)
        case parts.Map():
            x, y, z = _single(item.x), _single(item.y), _single(item.colours.values)
            return go.Heatmap(x=x, y=y, z=z, **_scaled(item.colours, AREA_SCALE, "z"))
        case parts.Bar():
            marker = {"color": item.colour, "line": {"color": "#FFFFFF", "width": 1}}
            look: Any = {"marker": marker, "width": item.height}
            part = {"base": [item.start], "x": [item.length], "y": [item.row], "orientation": "h"}
            return go.Bar(part, name=item.name, text=item.words, textangle=0, **look)
        case parts.Places():
            fill = "#FFFFFF" if item.hollow else item.colour
            look = {"symbol": OF_PLACES[item.symbol], "size": SIZES[item.symbol], "color": fill}
            look["line"] = {"color": item.colour, "width": 2}
            look["opacity"] = float(item.symbol != parts.NO_SYMBOL)
            place = {"x": _single(item.x), "y": _single(item.y), "text": list(item.words)}
            return go.Scatter(place, name=item.name, mode="markers", marker=look)


def _curve(item: parts.Curve, few: Indices) -> Any:
    trace = go.Scatter(
        x=_single(item.x[few]),
        y=_single(item.y[few]),
        text=[item.words[k] for k in few] if item.words else None,
        name=item.name,
        legendgroup=item.name,
        mode="lines" if item.joined and not item.colours else "markers",
    )
    look = {"color": colour(item.colour)}
    if item.colours:  # plotly draws a line in one colour only
        values = _single(item.colours.values[few])
        scale = _scaled(item.colours, LINE_SCALE, "c")
        size = 5.0 if item.joined else 5.0 * item.width
        edge = {"color": "#1a1a1a", "width": 1.5 if size > 5.0 else 0.0}
        return trace.update(marker={"size": size, "color": values, "line": edge, **scale})
    if item.joined:
        look |= {"dash": DASHES[item.dash % len(DASHES)], "shape": "hv" if item.held else "linear"}
        return trace.update(line={"width": 1.8 * item.width, **look})
    around = {"color": "#FFFFFF", "width": 1}
    symbol = SYMBOLS[item.colour % len(SYMBOLS)]
    return trace.update(marker={"size": 11, "symbol": symbol, "line": around, **look})


def _few(item: parts.Curve, curves: int) -> Indices:
    """Indices of the points to draw of a curve: of each of its pieces a share, and the gap after it."""
    if not item.joined:
        return np.arange(len(item.x))
    there = np.isfinite(item.x) & np.isfinite(item.y)
    ends = np.flatnonzero(np.diff(there, prepend=False, append=False)).reshape(-1, 2)
    most = share(MOST_OF_CURVES, curves * len(ends))
    few = [np.append(begin + kept((item.y[begin:end],), most), end) for begin, end in ends]
    return np.concatenate([np.empty(0, dtype=np.int64), *few])[:-1]


def _hover(item: parts.Item, x_unit: str, y_unit: str, alone: bool, bare: bool) -> str | None:
    """What is said at a point of an item, as a template of plotly's; of a bare panel no coordinates."""
    at, end = f"%{{x:.1f}} {x_unit}, %{{y:.1f}} {y_unit}", "<extra></extra>"
    match item:
        case parts.Curve(words=[_, *_]) | parts.Places() if bare:
            return f"%{{text}}{end}"
        case parts.Curve() if bare:
            return None
        case parts.Curve(words=[_, *_]):
            return f"%{{text}}<br>{at}{end}" if item.joined else f"%{{text}}{end}"
        case parts.Curve():
            value = f"%{{y:.2f}} {y_unit}"
            return f"{item.name} at %{{x:.1f}} {x_unit}: {value}{end}" if alone else value
        case parts.Map():
            return f"{at}: %{{z:.2f}} {parts.unit_of(item.colours.label)}{end}"
    return None


def _add_mark(figure: go.Figure, row: int, mark: parts.Mark) -> None:
    look: Any = {"line": {"color": mark.colour, "width": 1, "dash": DASHES[mark.dash]}}
    look |= {"row": row, "col": 1, "exclude_empty_subplots": False}
    if mark.words:
        low, high = figure.layout.xaxis.range or (mark.value, mark.value)
        beside = "bottom right" if mark.value <= 0.5 * (low + high) else "bottom left"
        look["annotation"] = {"text": mark.words, "font": {"size": 11, "color": STRONG_GREY}}
        look["annotation_position"] = beside if mark.upright else "top right"
    (figure.add_vline if mark.upright else figure.add_hline)(mark.value, **look)


def _add_labels(figure: go.Figure, row: int, places: parts.Places) -> None:
    beside: Any = {"xanchor": "center", "yanchor": "top", "yshift": -8}
    if places.above:
        # Turned about its middle: the longer a label, the farther its middle is from its place.
        beside = {"xanchor": "left", "yanchor": "bottom", "textangle": -35, "yshift": 5}
    for x, y, words in zip(places.x.tolist(), places.y.tolist(), places.labels, strict=False):
        if words:
            text = words.replace("\n", "<br>")
            beside |= {"text": text, "showarrow": False, "font": {"size": 11}}
            figure.add_annotation(x=x, y=y, row=row, col=1, **beside)


def _write(figure: go.Figure, row: int, words: parts.Words) -> None:
    text = f"<b>{words.text}</b>" if words.bold else words.text
    beside: Any = BESIDE[words.side] | {"font": {"size": 11, "color": words.colour}}
    beside |= {"text": text.replace("\n", "<br>"), "showarrow": False}
    figure.add_annotation(x=words.x, y=words.y, row=row, col=1, **beside)


def _scaled(colours: parts.Colours, stops: Stops, letter: str) -> Any:
    """Scale of colours of a trace, whose limits plotly calls by the letter of what is coloured."""
    bar = {"title": {"text": colours.label, "side": "right"}, "thickness": 12, "len": 0.9}
    limits = {f"{letter}min": colours.low, f"{letter}max": colours.high}
    if not colours.explained:
        return {"colorscale": stops, "showscale": False, **limits}
    return {"colorscale": stops, "colorbar": bar, **limits}


def _single(values: Floats) -> Any:
    """Values in single precision."""
    return np.asarray(values, dtype=np.float32)
