"""What the converter stations feed, how loaded they are, and how many converters run."""

from collections.abc import Mapping

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tpss.report.style import STYLE, as_text, colour, held, legend, line, panels, style
from tpss.results.result import Result


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
            name = as_text(f"{station}, {label}" if len(runs) > 1 else station)
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
        held(axes[0], minutes, percent, style(s), as_text(station))
        held(axes[1], minutes, data.active_converters.to_numpy()[:, s], style(s))
    axes[0].set_ylim(bottom=0.0)
    most = max(station.installed for station in result.scenario.supply.stations)
    axes[1].set_ylim(0.0, most + 0.5)
    axes[1].yaxis.set_major_locator(MaxNLocator(integer=True))
    legend(figure, axes[0])
    return figure
