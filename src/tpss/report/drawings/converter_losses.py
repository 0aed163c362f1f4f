"""The 50 Hz side of converter stations over time: what they take, and what they lose."""

from collections.abc import Mapping

import numpy as np

from tpss.report.drawings.parts import TIME, Curve, Drawing, Panel
from tpss.report.sampling import Floats
from tpss.report.trains import NothingToDrawError
from tpss.results.converter_losses import station_powers
from tpss.results.grid_side import Powers
from tpss.results.result import Result


def converter_losses(runs: Mapping[str, Result]) -> Drawing:
    """Power that each converter station takes from the 50 Hz grid, and its losses, over time.

    A colour is a station, a line style for each run.  Below 0 a station gives power to the grid.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    Raises
    ------
    NothingToDrawError
        No run describes losses of converters.
    """
    taken: list[Curve] = []
    lost: list[Curve] = []
    for k, (label, result) in enumerate(runs.items()):
        minutes = result.dataset.time.to_numpy() / 60.0
        found = station_powers(result.dataset, result.scenario)
        for s, (station, powers) in enumerate(found.items()):
            name, dash = (f"{station}, {label}", k) if len(runs) > 1 else (station, s)
            for curves, watts in ((taken, _net_w(powers)), (lost, powers.losses)):
                megawatts = np.append(watts, np.nan) / 1e6
                curves.append(Curve(minutes, megawatts, name, s, dash, held=True))
    if not taken:
        raise NothingToDrawError("no converter type describes its losses")
    panels = [
        Panel("from the 50 Hz grid [MW]", taken, "$P_{50}$ [MW]"),
        Panel("losses of stations [MW]", lost, "losses [MW]", from_zero=True),
    ]
    return Drawing(TIME, panels, panel_inch=2.0)


def losses_by_control(runs: Mapping[str, Result]) -> Drawing:
    """Losses of converter stations of runs that switch differently, and units that run, over time.

    A colour is a station, a line style for each run.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    """
    lost: list[Curve] = []
    running: list[Curve] = []
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset
        minutes = data.time.to_numpy() / 60.0
        for s, (name, powers) in enumerate(station_powers(data, result.scenario).items()):
            units = data.active_converters.sel(station=name).to_numpy()
            megawatts = np.append(powers.losses, np.nan) / 1e6
            for curves, values in ((lost, megawatts), (running, units)):
                curves.append(Curve(minutes, values, f"{name}, {label}", s, k, held=True))
    panels = [
        Panel("losses of stations [MW]", lost, "losses of\nstations [MW]", from_zero=True),
        Panel("units running", running, "units\nrunning", from_zero=True),
    ]
    return Drawing(TIME, panels, panel_inch=2.0)


def _net_w(powers: Powers) -> Floats:
    return np.asarray(powers.from_grid - powers.to_grid)
