"""The figures that cases name, by their names."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import tpss
from tpss.report import figures
from tpss.report.render.static import STYLE, colour, legend, line, panels

from outcomes import Outcome


@rc_context(STYLE)
def stop(runs: Mapping[str, tpss.Result], stop_km: float, trains: str) -> Figure:
    """Way and speed of a train around a stop; time 0 is when it comes to stand.

    ``trains`` is ``departed`` (the studied train) or ``placed`` (of those on the line at the start, the
    last one that has the stop ahead of it).
    """
    figure, (way, speed) = panels(
        ["way to the stop [km]", "speed [km/h]"], "time from standstill [min]", panel_inch=1.8
    )
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset
        name = result.summary["studied_train"]
        if trains == "placed":
            start_m = data.position.isel(time=0)
            ahead = start_m.where(~np.isfinite(data.departure_time) & (start_m < stop_km * 1e3))
            name = str(data.train[int(ahead.argmin("train"))].item())
        data = data.sel(train=name)
        minutes = data.time.to_numpy() / 60.0
        way_km = stop_km - data.position.to_numpy() / 1e3
        kmh = data.speed.to_numpy() * 3.6
        stood = (kmh == 0.0) & (np.abs(way_km) < 1.0)
        minutes = minutes - minutes[np.argmax(stood)]
        shown = np.abs(minutes) <= 5.0
        style = {"color": colour(k), "linestyle": line(k), "marker": "o" if k == 0 else ""}
        way.plot(minutes[shown], way_km[shown], markersize=4.0, label=label, **style)
        speed.plot(minutes[shown], kmh[shown], markersize=4.0, **style)
    legend(figure, way)
    return figure


@rc_context(STYLE)
def overview(outcomes: Sequence[Outcome]) -> Figure:
    """Differences of judged total energies and trip times, each on its tolerance."""
    names = ("E1 + E2", "trip time")
    outcomes = [o for o in outcomes if o.quantity.name in names and o.agrees is not None]
    figure = Figure(figsize=(7.0, 7.0))
    axes = figure.subplots(1, 2, sharey=True)
    labels = list(dict.fromkeys(row_label(outcome) for outcome in outcomes))
    for panel, name, axis in zip(
        axes,
        names,
        ("difference of E1 + E2 [%]", "difference of the trip time [min]"),
        strict=True,
    ):
        for outcome in outcomes:
            if outcome.quantity.name == name:
                mark(panel, outcome, labels.index(row_label(outcome)))
        panel.axvline(0.0, color="#444444", linewidth=0.8)
        panel.set_xlabel(axis)
        panel.grid(visible=False, axis="y")
        panel.use_sticky_edges = False
        panel.margins(x=0.05)
    axes[0].set_yticks(range(len(labels)), labels)
    axes[0].set_ylim(len(labels) - 0.4, -0.6)
    for k, variant in enumerate("AB"):
        axes[0].plot([], [], "os"[k], color=colour(k), label=f"profile {variant}")
    legend(figure, axes[0])
    return figure


def row_label(outcome: Outcome) -> str:
    """Table and run of an outcome."""
    return f"{outcome.case.title.split(':')[0]}, {outcome.run}"


def mark(panel: Axes, outcome: Outcome, row: int) -> None:
    """Draw an outcome's difference in its row, on its tolerance."""
    quantity = outcome.quantity
    allowed = quantity.within or quantity.within_percent or 0.0
    panel.barh(row, 2 * allowed, left=-allowed, height=0.8, color="#E3E8EF")
    k = "AB".index(outcome.variant)
    panel.plot(outcome.difference, row + (-0.17, 0.17)[k], "os"[k], color=colour(k), markersize=5.0)


DRAWINGS: dict[str, Callable[..., Figure]] = {
    "journey": figures.journey,
    "voltage_along_line": figures.voltage_along_line,
    "station_powers": figures.station_powers,
    "station_loading": figures.station_loading,
    "stop": stop,
}
