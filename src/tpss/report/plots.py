"""Interactive plots of results, one function a figure.

As the static figures, each takes runs by their labels and overlays them, a line style a run.  The
figure's ``layout.meta`` says what its horizontal axis is: "time" (in minutes; such figures share a
cursor) or "position".
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from tpss.report.contact_line import LineVoltage, voltage_marks
from tpss.report.gradients import inclination
from tpss.report.palette import COLOURS, LEAST_SPAN_KV, VOLTAGE_SCALE
from tpss.report.sampling import MOST_OF_CURVES, Floats, kept, share
from tpss.results.result import Result

DASHES = ("solid", "dash", "dashdot", "dot")
"""Line styles, so that curves differ in black and white too."""

SYMBOLS = ("circle", "square", "diamond", "star")
"""Marks of the trains of a run; a train beyond a limit is a triangle."""

TIME, POSITION = "time [min]", "position [km]"


def time_distance(result: Result, voltage: LineVoltage) -> go.Figure:
    """Time-distance graph: the trains' paths over the voltage along the line.

    Parameters
    ----------
    result : Result
    voltage : LineVoltage
        Of this run.
    """
    figure = _figure(["position [km]"], TIME, "time", height=520)
    lowest, highest = float(voltage.map_kv.min()), float(voltage.map_kv.max())
    figure.add_heatmap(
        x=_single(voltage.time_min + 0.5 * _column_min(result, voltage)),
        y=_single(voltage.position_km),
        z=_single(voltage.map_kv),
        colorscale=VOLTAGE_SCALE,
        zmin=min(lowest, highest - LEAST_SPAN_KV),
        zmax=highest,
        colorbar={"title": {"text": "kV"}, "thickness": 12, "len": 0.9},
        hovertemplate="%{x:.1f} min, %{y:.1f} km: %{z:.2f} kV<extra></extra>",
        name="voltage",
    )
    minutes, km, names = [], [], []
    position_km = result.dataset.position.to_numpy() / 1e3
    most = share(MOST_OF_CURVES // 2, position_km.shape[1])
    for i, name in enumerate(result.dataset.train.to_numpy()):
        there = np.flatnonzero(np.isfinite(position_km[:, i]))
        if not there.size:
            continue
        few = there[np.unique(np.linspace(0, len(there) - 1, most).astype(int))]
        minutes += [*(result.dataset.time.to_numpy()[few] / 60.0).round(2).tolist(), None]
        km += [*position_km[few, i].round(2).tolist(), None]
        names += [*[str(name)] * len(few), ""]
    figure.add_scatter(
        x=minutes,
        y=km,
        text=names,
        mode="lines",
        line={"color": "#000000", "width": 1.1},
        hovertemplate="%{text}<br>%{x:.1f} min, %{y:.1f} km<extra></extra>",
        name="trains",
        showlegend=False,
    )
    return figure.update_layout(hovermode="closest")


def line_at_a_moment(result: Result, voltage: LineVoltage) -> go.Figure:
    """Voltage along the line: its envelope over the run, the limits, and the trains at a moment.

    The last trace holds the trains: its points are those of the first time step, and the page moves
    them.

    Parameters
    ----------
    result : Result
    voltage : LineVoltage
        Of this run.
    """
    figure = _figure(["voltage [kV]"], POSITION, "position", height=460)
    _add_envelope(figure, voltage)
    _add_trains(figure, result, "trains now", 0)
    _mark_feeding_points(figure, [result])
    shown_kv = [float(voltage.lowest_kv.min()), float(voltage.highest_kv.max())]
    _mark_limits(figure, result, shown_kv)
    figure.update_xaxes(range=_with_margin(voltage.position_km))
    return figure.update_layout(hovermode="closest")


def envelopes(runs: Mapping[str, tuple[Result, LineVoltage]]) -> go.Figure:
    """Lowest voltage along the line of each run, with the limits and the trains at a moment.

    The last traces hold the trains, one a run: the page moves them.

    Parameters
    ----------
    runs : mapping of str to (Result, LineVoltage)
        By label.
    """
    figure = _figure(["lowest voltage [kV]"], POSITION, "position", height=460)
    for k, (label, (_, voltage)) in enumerate(runs.items()):
        _add_line(figure, 1, voltage.position_km, voltage.lowest_kv, label, k, "kV")
    lowest = [float(voltage.lowest_kv.min()) for _, voltage in runs.values()]
    _mark_feeding_points(figure, [result for result, _ in runs.values()])
    _mark_limits(figure, next(result for result, _ in runs.values()), lowest)
    for k, (label, (result, _)) in enumerate(runs.items()):
        _add_trains(figure, result, f"trains now, {label}", k)
    figure.update_xaxes(range=_with_margin(*(v.position_km for _, v in runs.values())))
    return figure.update_layout(hovermode="closest")


def journey(runs: Mapping[str, Result], train: str | None = None) -> go.Figure:
    """Speed of a train, the voltage at its pantograph, and the gradient below it, over its way.

    Parameters
    ----------
    runs : mapping of str to Result
        By label.
    train : str, optional
        Train of that name in every run; by default each run's studied train, or its first one.
    """
    labels = ["speed [km/h]", "voltage [kV]", "gradient [‰]"]
    figure = _figure(labels, POSITION, "position", height=560)
    for k, (label, result) in enumerate(runs.items()):
        name = train or result.summary["studied_train"] or str(result.dataset.train.to_numpy()[0])
        data = result.dataset.sel(train=name)
        km = data.position.to_numpy() / 1e3
        text = f"{label}: {name}" if len(runs) > 1 else name
        there = np.isfinite(km)
        kmh, kv = data.speed.to_numpy() * 3.6, data.pantograph_voltage.to_numpy() / 1e3
        _add_line(figure, 1, km[there], kmh[there], text, k, "km/h")
        _add_held(figure, 2, km[there], kv[there], text, (k, k), "kV", show_legend=False)
        permille = inclination(result, data.position.to_numpy()) * 1e3
        _add_held(figure, 3, km[there], permille[there], text, (k, k), "‰", show_legend=False)
    return figure


def station_powers(runs: Mapping[str, Result]) -> go.Figure:
    """Active and reactive power that each converter station feeds into the railway, over time.

    Parameters
    ----------
    runs : mapping of str to Result
        By label.
    """
    names = ("station_active_power", "station_reactive_power")
    return _stations(runs, names, ["active [MW]", "reactive [Mvar]"], (1e-6, 1e-6), "MW", "Mvar")


def converters(runs: Mapping[str, Result]) -> go.Figure:
    """Loading of the running converters of each station, and how many run, over time.

    Parameters
    ----------
    runs : mapping of str to Result
        By label.
    """
    names = ("converter_loading", "active_converters")
    figure = _stations(runs, names, ["loading [%]", "converters running"], (100.0, 1.0), "%", "")
    figure.add_hline(100.0, row=1, col=1, line={"color": "#000000", "dash": "dot", "width": 1})
    return figure.update_yaxes(rangemode="tozero")


def losses(runs: Mapping[str, Result]) -> go.Figure:
    """Losses of the network over time.

    Parameters
    ----------
    runs : mapping of str to Result
        By label.
    """
    figure = _figure(["losses [MW]"], TIME, "time", height=260)
    for k, (label, result) in enumerate(runs.items()):
        minutes = result.dataset.time.to_numpy() / 60.0
        megawatts = result.dataset.network_losses.to_numpy() / 1e6
        _add_held(figure, 1, minutes, megawatts, label or "losses", (k, k), "MW", len(runs) > 1)
    return figure.update_yaxes(rangemode="tozero")


def is_thinned(runs: Iterable[Result]) -> bool:
    """Whether curves over time leave values out; see `sampling.kept`."""
    found = list(runs)
    curves = sum(run.dataset.sizes["station"] for run in found) * 2
    return any(run.dataset.sizes["time"] > share(MOST_OF_CURVES, curves) for run in found)


def _stations(
    runs: Mapping[str, Result],
    names: Sequence[str],
    labels: Sequence[str],
    scales: Sequence[float],
    *units: str,
) -> go.Figure:
    """A panel a variable, a curve a station and run."""
    figure = _figure(labels, TIME, "time", height=440)
    curves = sum(run.dataset.sizes["station"] for run in runs.values()) * len(names)
    for k, (label, result) in enumerate(runs.items()):
        minutes = result.dataset.time.to_numpy() / 60.0
        for s, station in enumerate(result.dataset.station.to_numpy()):
            look = (s, k if len(runs) > 1 else s)
            text = f"{label}: {station}" if len(runs) > 1 else str(station)
            for row, (name, scale, unit) in enumerate(zip(names, scales, units, strict=True), 1):
                values = result.dataset[name].to_numpy()[:, s] * scale
                _add_held(figure, row, minutes, values, text, look, unit, row == 1, curves)
    return figure


def _figure(labels: Sequence[str], axis: str, meta: str, height: int) -> go.Figure:
    """Figure with a panel for each label, above each other with one horizontal axis."""
    figure = make_subplots(rows=len(labels), cols=1, shared_xaxes=True, vertical_spacing=0.06)
    figure.update_layout(
        template=None,
        meta=meta,
        height=height,
        margin={"l": 58, "r": 16, "t": 40, "b": 48},
        font={"family": "system-ui, sans-serif", "size": 13, "color": "#1a1a1a"},
        paper_bgcolor="#FFFFFF",
        plot_bgcolor="#FFFFFF",
        hovermode="x unified",
        legend={"orientation": "h", "yanchor": "bottom", "y": 1.01, "x": 0},
    )
    look = {"gridcolor": "#DDDDDD", "zeroline": False, "linecolor": "#666666", "ticks": "outside"}
    figure.update_xaxes(**look).update_yaxes(**look)
    for row, label in enumerate(labels, 1):
        figure.update_yaxes(title={"text": label}, row=row, col=1)
    return figure.update_xaxes(title={"text": axis}, row=len(labels), col=1)


def _add_line(
    figure: go.Figure, row: int, x: Floats, y: Floats, name: str, k: int, unit: str
) -> None:
    """Curve of a state: straight between instants."""
    few = kept((y,), share(MOST_OF_CURVES, 1))
    figure.add_scatter(
        x=_single(x[few]),
        y=_single(y[few]),
        name=name,
        mode="lines",
        line={"color": COLOURS[k % len(COLOURS)], "dash": DASHES[k % len(DASHES)], "width": 1.8},
        hovertemplate=f"%{{y:.2f}} {unit}",
        legendgroup=name,
        row=row,
        col=1,
    )


def _add_held(
    figure: go.Figure,
    row: int,
    x: Floats,
    y: Floats,
    name: str,
    look: tuple[int, int],
    unit: str,
    show_legend: bool = True,
    curves: int = 1,
) -> None:
    """Curve of what holds from one instant to the next, in a colour and a line style."""
    few = kept((y,), share(MOST_OF_CURVES, curves))
    colour, dash = COLOURS[look[0] % len(COLOURS)], DASHES[look[1] % len(DASHES)]
    figure.add_scatter(
        x=_single(x[few]),
        y=_single(y[few]),
        name=name,
        mode="lines",
        line={"color": colour, "dash": dash, "width": 1.8, "shape": "hv"},
        hovertemplate=f"%{{y:.2f}} {unit}",
        legendgroup=name,
        showlegend=show_legend,
        row=row,
        col=1,
    )


def _add_envelope(figure: go.Figure, voltage: LineVoltage) -> None:
    """The band between lowest and highest voltage, and the mean in it."""
    for name, values, dash, fill in (
        ("highest", voltage.highest_kv, "dot", None),
        ("lowest", voltage.lowest_kv, "solid", "tonexty"),
        ("mean", voltage.mean_kv, "dash", None),
    ):
        figure.add_scatter(
            x=_single(voltage.position_km),
            y=_single(values),
            name=name,
            mode="lines",
            line={"color": COLOURS[0], "dash": dash, "width": 1.5},
            fill=fill,
            fillcolor="rgba(86,180,233,0.18)",
            hovertemplate=f"{name} at %{{x:.1f}} km: %{{y:.2f}} kV<extra></extra>",
        )


def _add_trains(figure: go.Figure, result: Result, name: str, k: int) -> None:
    """Trains of a run at their places and voltages in its first time step."""
    first = result.dataset.isel(time=0)
    figure.add_scatter(
        x=_single(first.position.to_numpy() / 1e3),
        y=_single(first.pantograph_voltage.to_numpy() / 1e3),
        text=[str(train) for train in result.dataset.train.to_numpy()],
        mode="markers",
        marker={
            "size": 11,
            "color": COLOURS[k % len(COLOURS)],
            "symbol": SYMBOLS[k % len(SYMBOLS)],
            "line": {"color": "#FFFFFF", "width": 1},
        },
        hovertemplate="%{text}<extra></extra>",
        name=name,
    )


def _mark_limits(figure: go.Figure, result: Result, shown_kv: Sequence[float]) -> None:
    """Nominal voltage and limits by which the result is judged."""
    marks = voltage_marks(result.scenario.standards.voltage_limits)
    for name, kilovolts in marks.items():
        figure.add_hline(
            kilovolts,
            line={"color": "#444444", "width": 1, "dash": "solid" if name == "Un" else "dash"},
            annotation={
                "text": f"{name} {kilovolts:g} kV",
                "font": {"size": 11, "color": "#444444"},
            },
            annotation_position="top right",
        )
    low, high = min(*marks.values(), *shown_kv), max(*marks.values(), *shown_kv)
    margin = 0.1 * (high - low)
    figure.update_yaxes(range=[low - margin, high + margin])


def _mark_feeding_points(figure: go.Figure, runs: Sequence[Result]) -> None:
    """Dotted lines at transformers and stations, the stations with their names."""
    nodes = {km for run in runs for km in run.dataset.node_position.to_numpy() / 1e3}
    for km in sorted(nodes):
        figure.add_vline(km, line={"color": "#999999", "width": 1, "dash": "dot"})
    places = {
        float(km): str(name)
        for run in runs
        for name, km in zip(
            run.dataset.station.to_numpy(),
            run.dataset.station_position.to_numpy() / 1e3,
            strict=True,
        )
    }
    middle_km = 0.5 * (min(nodes) + max(nodes))
    for km, name in places.items():
        figure.add_annotation(
            x=km, y=0.0, yref="paper", yanchor="bottom", text=name, showarrow=False,
            xanchor="left" if km <= middle_km else "right", font={"size": 11, "color": "#444444"},
        )  # fmt: skip


def _column_min(result: Result, voltage: LineVoltage) -> float:
    return float(voltage.steps_a_column * result.dataset.attrs["time_step_s"] / 60.0)


def _with_margin(*positions_km: Floats) -> list[float]:
    low, high = min(p[0] for p in positions_km), max(p[-1] for p in positions_km)
    margin = 0.02 * (high - low)
    return [float(low - margin), float(high + margin)]


def _single(values: Floats) -> Any:
    """Values in single precision, in which the page carries them."""
    return np.asarray(values, dtype=np.float32)
