"""A train's journey, in the thesis's layout."""

from collections.abc import Iterable, Mapping
from typing import Literal

import numpy as np
import xarray as xr

from tpss.model.directions import runs_down
from tpss.report.drawings.parts import POSITION, TIME, Curve, Drawing, Panel
from tpss.report.gradients import inclination
from tpss.report.sampling import Floats
from tpss.report.trains import chosen_train
from tpss.results.result import Result

PRINTED = {
    "gradient [‰]": "inclination [‰]",
    "speed [km/h]": "speed [km/h]",
    "active power [MW]": "$P_D$ [MW]",
    "reactive power [Mvar]": "$Q_D$ [MVAr]",
    "voltage [kV]": "$U$ [kV]",
    "minus angle [°]": "$-\\theta$ [°]",
}
"""Labels of a journey's panels, and what is printed instead."""


def journey(
    runs: Mapping[str, Result],
    train: str | None = None,
    against: Literal["position", "distance", "time"] = "position",
    shown: Iterable[str] = tuple(PRINTED),
) -> Drawing:
    """A train's journey: inclination, speed, powers, voltage and angle.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    train : str, optional
        Train of that name in every run; each run's studied train by default.
    against : {"position", "distance", "time"}
        Quantity of the horizontal axis; distance is position.
    shown : iterable of str
        Labels of the panels, of `PRINTED`.

    References
    ----------
    [Boullanger2009]_, the layout of figures 3-12 and 3-15, which plot the angle with a minus too.
    """
    curves: dict[str, list[Curve]] = {label: [] for label in shown}
    for k, (name, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=chosen_train(result, train))
        x = (data.time / 60.0 if against == "time" else data.position / 1e3).to_numpy()
        values = _values(result, data)
        for label, drawn in curves.items():
            held = label != "speed [km/h]"  # the only one that changes linearly in a step
            drawn.append(Curve(x, values[label], name, k, k, held=held))
    panels = [Panel(label, drawn, PRINTED[label]) for label, drawn in curves.items()]
    return Drawing(TIME if against == "time" else POSITION, panels)


def _rise_ahead(result: Result, data: xr.Dataset) -> Floats:
    """Gradient of the line where a train is, as it runs. [1]"""
    entry = next(each for each in result.scenario.traffic if each.name == str(data.service.values))
    sign = -1.0 if runs_down(entry, result.scenario.line) else 1.0
    return sign * inclination(result, data.position.to_numpy())


def _values(result: Result, data: xr.Dataset) -> dict[str, Floats]:
    return {
        "gradient [‰]": _rise_ahead(result, data) * 1e3,
        "speed [km/h]": data.speed.to_numpy() * 3.6,
        "active power [MW]": data.active_power.to_numpy() / 1e6,
        "reactive power [Mvar]": data.reactive_power.to_numpy() / 1e6,
        "voltage [kV]": data.pantograph_voltage.to_numpy() / 1e3,
        "minus angle [°]": -np.degrees(data.pantograph_angle.to_numpy()),
    }
