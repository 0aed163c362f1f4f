"""The time-distance graph, coloured by the voltage."""

import numpy as np
from matplotlib import rc_context
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure

from tpss.report.palette import LEAST_SPAN_KV
from tpss.report.style import STYLE, as_text, panels
from tpss.results.result import Result


def voltage_colours() -> Colormap:
    """From a low voltage, dark, to a high one; the palest colours, unseen on white, are left out."""
    from matplotlib import colormaps

    return ListedColormap(colormaps["inferno"](np.linspace(0.05, 0.82, 256)), "voltage")


@rc_context(STYLE)
def time_distance(result: Result) -> Figure:
    """Paths of all trains over time, coloured by the voltage at their pantographs.

    Stations of the line are named at the right.

    Parameters
    ----------
    result : Result
    """
    figure, (panel,) = panels(["position [km]"], "time [min]", panel_inch=4.6)
    data = result.dataset
    km, kv = data.position.to_numpy() / 1e3, data.pantograph_voltage.to_numpy() / 1e3
    minutes = data.time.to_numpy() / 60.0
    lowest, highest = float(np.nanmin(kv)), float(np.nanmax(kv))
    paths = LineCollection(
        [],
        cmap=voltage_colours(),
        norm=Normalize(min(lowest, highest - LEAST_SPAN_KV), highest),
        linewidths=1.6,
        capstyle="round",
    )
    begins, ends = km[:-1], km[1:]
    drawn = np.isfinite(begins) & np.isfinite(ends)
    step, train = np.nonzero(drawn)
    points = np.stack(
        [minutes[step], begins[drawn], minutes[step + 1], ends[drawn]], axis=1
    ).reshape(-1, 2, 2)
    paths.set_segments(list(points))
    paths.set_array(kv[step, train])
    panel.add_collection(paths)
    panel.set_xlim(minutes[0], minutes[-1])
    panel.set_ylim(0.0, result.scenario.line.length_km)
    figure.colorbar(paths, ax=panel, label="voltage at the pantograph [kV]", pad=0.02, aspect=40)
    beside = panel.secondary_yaxis("right")
    stations = result.scenario.line.stations
    beside.set_yticks(
        [station.position_km for station in stations],
        [as_text(station.name) for station in stations],
    )
    beside.tick_params(length=0)
    for station in stations:
        panel.axhline(station.position_km, color="#999999", linewidth=0.6, zorder=0.5)
    return figure
