"""A train's journey, in the thesis's layout."""

from collections.abc import Mapping
from typing import Literal

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from tpss.report.gradients import inclination
from tpss.report.style import STYLE, as_text, colour, held, legend, line, panels, style
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
        held(
            axes[0],
            x,
            inclination(result, data.position.to_numpy()) * 1e3,
            style(k),
            as_text(label),
        )
        axes[1].plot(x, data.speed.to_numpy() * 3.6, line(k), color=colour(k))
        held(axes[2], x, data.active_power.to_numpy() / 1e6, style(k))
        held(axes[3], x, data.reactive_power.to_numpy() / 1e6, style(k))
        held(axes[4], x, data.pantograph_voltage.to_numpy() / 1e3, style(k))
        held(axes[5], x, -np.degrees(data.pantograph_angle.to_numpy()), style(k))
    legend(figure, axes[0])
    return figure
