"""Powers of the feeding stations, their loading, and the number of running units."""

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

from tpss.report.drawings.parts import DOTTED, TIME, Curve, Drawing, Mark, Panel
from tpss.report.palette import BLACK, COLOURS, STRONG_GREY
from tpss.results.result import Result

VISIBLE_MW = 0.01
"""Power below 0 from which a station is said to take power back. [MW]"""


def station_powers(runs: Mapping[str, Result]) -> Drawing:
    """Power that each feeding station feeds into the railway, active and reactive, over time.

    A colour is a station, a line style for each run.  Where a station takes power back, a line marks 0:
    what is below it goes to the station.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    References
    ----------
    [Boullanger2009]_, the layout of figure 3-14.
    """
    active = _curves(runs, lambda data: data.station_active_power / 1e6)
    reactive = _curves(runs, lambda data: data.station_reactive_power / 1e6)
    takes_back = any(np.nanmin(curve.y, initial=0.0) < -VISIBLE_MW for curve in active)
    zero = [Mark(0.0, colour=STRONG_GREY)] if takes_back else []
    panels = [Panel("active [MW]", [*zero, *active], "$P_G$ [MW]")]
    if not all(result.scenario.supply.is_direct for result in runs.values()):
        panels.append(Panel("reactive [Mvar]", reactive, "$Q_G$ [Mvar]"))
    return Drawing(TIME, panels, panel_inch=2.0)


def station_loading(runs: Result | Mapping[str, Result]) -> Drawing:
    """Loading of the running converters or transformers of each station, and how many run, over time.

    Parameters
    ----------
    runs : Result or mapping of str to Result
        A result, or results to overlay by their labels.

    References
    ----------
    [Boullanger2009]_, figures 3-13 and 3-16, which draw a tenth of the number in the same panel.
    """
    runs = {"": runs} if isinstance(runs, Result) else runs
    rating = Mark(100.0, dash=DOTTED, colour=COLOURS[BLACK])
    loading = _curves(runs, lambda data: data.converter_loading * 100.0)
    running = _curves(runs, lambda data: data.active_converters)
    supplies = [result.scenario.supply for result in runs.values()]
    most = max(each.installed for supply in supplies for each in supply.stations)
    span, tick = (0.0, most + 0.5), 1.0 + most // 8
    panels = [
        Panel("loading [%]", [*loading, rating], "loading of running\nunits [%]", from_zero=True),
        Panel("units running", running, "units\nrunning", span=span, tick=tick),
    ]
    return Drawing(TIME, panels, panel_inch=1.8)


def _curves(
    runs: Mapping[str, Result], values: Callable[[xr.Dataset], xr.DataArray]
) -> list[Curve]:
    """One curve per station and run; stations of a single run differ by their line styles too."""
    curves, several = [], len(runs) > 1
    for k, (label, result) in enumerate(runs.items()):
        minutes, drawn = result.dataset.time.to_numpy() / 60.0, values(result.dataset).to_numpy()
        for s, station in enumerate(result.dataset.station.to_numpy()):
            name, dash = (f"{station}, {label}", k) if several else (str(station), s)
            curves.append(Curve(minutes, drawn[:, s], name, s, dash, held=True))
    return curves
