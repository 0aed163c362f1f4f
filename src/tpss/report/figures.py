"""Figures of results, one function a figure.

Each takes runs by their labels and overlays them: the first solid, the next dashed, then dash-dotted.
It returns a matplotlib figure, which is neither shown nor saved:
``journey({"as built": result}).savefig("journey.png")``.
"""

from collections.abc import Mapping
from typing import Literal

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tpss.report.style import STYLE, Floats, colour, held, legend, line, panels, style
from tpss.results.result import Result

JOURNEY = (
    "inclination [‰]",
    "speed [km/h]",
    "$P_D$ [MW]",
    "$Q_D$ [MVAr]",
    "$U$ [kV]",
    "$-\\theta$ [°]",
)
"""Panels of a journey."""


@rc_context(STYLE)
def journey(
    runs: Mapping[str, Result],
    train: str | None = None,
    against: Literal["position", "time"] = "position",
) -> Figure:
    """What a train meets and does: inclination, speed, powers, voltage and angle.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    train : str, optional
        Train of that name in every run; each run's studied train by default.
    against : {"position", "time"}
        What the horizontal axis carries.

    References
    ----------
    [Boullanger2009]_, the layout of figures 3-12 and 3-15, which plot the angle with a minus too.
    """
    figure, axes = panels(list(JOURNEY), "position [km]" if against == "position" else "time [min]")
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=train or result.summary["studied_train"])
        x = data.position.to_numpy() / 1e3 if against == "position" else data.time.to_numpy() / 60.0
        held(axes[0], x, inclination(result, data.position.to_numpy()) * 1e3, style(k), label)
        axes[1].plot(x, data.speed.to_numpy() * 3.6, line(k), color=colour(k))
        held(axes[2], x, data.active_power.to_numpy() / 1e6, style(k))
        held(axes[3], x, data.reactive_power.to_numpy() / 1e6, style(k))
        held(axes[4], x, data.pantograph_voltage.to_numpy() / 1e3, style(k))
        held(axes[5], x, -np.degrees(data.pantograph_angle.to_numpy()), style(k))
    legend(figure, axes[0])
    return figure


def inclination(result: Result, position_m: Floats) -> Floats:
    """Rise over run at positions on the line; NaN where there is no position. [1]"""
    profile = result.scenario.line.gradients
    from_m = np.array([gradient.from_km for gradient in profile]) * 1e3
    rise = np.array([gradient.permille for gradient in profile]) / 1e3
    index = np.clip(np.searchsorted(from_m, position_m, side="right") - 1, 0, None)
    return np.where(np.isfinite(position_m), rise[np.minimum(index, len(rise) - 1)], np.nan)


@rc_context(STYLE)
def voltage_along_line(runs: Mapping[str, Result], train: str | None = None) -> Figure:
    """Voltage that a train meets along the line; feeding points are marked.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    train : str, optional
        Train of that name in every run; each run's studied train by default.

    References
    ----------
    [Boullanger2009]_, the layout of figures 3-2 and 3-3.
    """
    figure, (panel,) = panels(["voltage at the pantograph [kV]"], "position [km]", panel_inch=3.0)
    feeding = {km for run in runs.values() for km in run.dataset.node_position.to_numpy() / 1e3}
    for km in sorted(feeding):
        panel.axvline(km, color="#888888", linewidth=0.8, linestyle=":")
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=train or result.summary["studied_train"])
        voltage_kv = data.pantograph_voltage.to_numpy() / 1e3
        panel.plot(
            data.position.to_numpy() / 1e3, voltage_kv, line(k), color=colour(k), label=label
        )
    legend(figure, panel)
    return figure


@rc_context(STYLE)
def station_powers(runs: Mapping[str, Result]) -> Figure:
    """Active and reactive power that each converter station feeds into the railway, over time.

    A colour is a station, a line style a run.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    References
    ----------
    [Boullanger2009]_, the layout of figure 3-14.
    """
    figure, axes = panels(["$P_G$ [MW]", "$Q_G$ [MVAr]"], "time [min]", panel_inch=2.0)
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset
        minutes = data.time.to_numpy() / 60.0
        for s, station in enumerate(data.station.to_numpy()):
            name = f"{station}, {label}" if len(runs) > 1 else str(station)
            for panel, power in zip(axes, ("active", "reactive"), strict=True):
                megawatts = data[f"station_{power}_power"].to_numpy()[:, s] / 1e6
                held(panel, minutes, megawatts, (colour(s), line(k)), name)
    legend(figure, axes[0])
    return figure


@rc_context(STYLE)
def station_loading(result: Result) -> Figure:
    """Loading of the running converters of each station, and how many run, over time.

    Parameters
    ----------
    result : Result

    References
    ----------
    [Boullanger2009]_, figures 3-13 and 3-16, which draw a tenth of the number in the same panel.
    """
    names = ["loading of running\nconverters [%]", "converters\nrunning"]
    figure, axes = panels(names, "time [min]", panel_inch=1.8)
    data = result.dataset
    minutes = data.time.to_numpy() / 60.0
    for s, station in enumerate(data.station.to_numpy()):
        percent = data.converter_loading.to_numpy()[:, s] * 100.0
        held(axes[0], minutes, percent, style(s), str(station))
        held(axes[1], minutes, data.active_converters.to_numpy()[:, s], style(s))
    axes[0].set_ylim(bottom=0.0)
    most = max(station.converters for station in result.scenario.supply.converter_stations)
    axes[1].set_ylim(0.0, most + 0.5)
    axes[1].yaxis.set_major_locator(MaxNLocator(integer=True))
    legend(figure, axes[0])
    return figure
