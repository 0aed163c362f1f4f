"""A train's journey, in the thesis's layout."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
import xarray as xr

from tpss.model.routes import Route, routes_of
from tpss.report.corridor import landmarks, span_km
from tpss.report.drawings.held_to import speed_limit
from tpss.report.drawings.parts import DOTTED, POSITION, TIME, Curve, Drawing, Mark, Panel
from tpss.report.gradients import inclination
from tpss.report.sampling import Floats
from tpss.report.trains import chosen_train
from tpss.results.places import LINE
from tpss.results.result import Result
from tpss.scenario.scenario import Scenario

PRINTED = {
    "gradient [‰]": "inclination [‰]",
    "speed [km/h]": "speed [km/h]",
    "active power [MW]": "$P_D$ [MW]",
    "reactive power [Mvar]": "$Q_D$ [Mvar]",
    "voltage [kV]": "$U$ [kV]",
    "minus angle [°]": "$-\\theta$ [°]",
}
"""Labels of a journey's panels, and what is printed instead."""

EXPLAINED = {
    "gradient [‰]": "gradient\n[‰]",
    "speed [km/h]": "speed; limit\n(dashed) [km/h]",
    "active power [MW]": "active power\n$P_D$ [MW]",
    "reactive power [Mvar]": "reactive power\n$Q_D$ [Mvar]",
    "voltage [kV]": "voltage\n$U$ [kV]",
    "minus angle [°]": "minus angle\n$-\\theta$ [°]",
}
"""The same in words, for readers who do not know the symbols."""

ALTERNATING = ("reactive power [Mvar]", "minus angle [°]")
"""Panels of which a line of direct current has none."""


def journey(
    runs: Mapping[str, Result],
    train: str | None = None,
    against: Literal["position", "distance", "time"] = "position",
    shown: Iterable[str] = tuple(PRINTED),
    explained: bool = False,
) -> Drawing:
    """A train's journey: inclination, speed, powers, voltage and angle, as far as there are any.

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
    explained : bool
        Whether to print labels in words, the speed limit of the first run, and over places the stations
        of a line.

    References
    ----------
    [Boullanger2009]_, the layout of figures 3-12 and 3-15, which plot the angle with a minus too.
    """
    direct = all(result.scenario.supply.is_direct for result in runs.values())
    left_out = ALTERNATING if direct else ()
    curves: dict[str, list[Curve]] = {label: [] for label in shown if label not in left_out}
    for k, (name, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=chosen_train(result, train))
        x = _time_or_place(result, data, against)
        values = _values(result, data)
        for label, drawn in curves.items():
            held = label != "speed [km/h]"  # the only one that changes linearly in a step
            drawn.append(Curve(x, values[label], name, k, k, held=held))
        if explained and k == 0 and "speed [km/h]" in curves:
            curves["speed [km/h]"].append(speed_limit(result, data, x))
    marks = _stations(next(iter(runs.values())), against) if explained else []
    printed = EXPLAINED if explained else PRINTED
    panels = [
        Panel(label, [*(marks if n == 0 else map(_nameless, marks)), *drawn], printed[label])
        for n, (label, drawn) in enumerate(curves.items())
    ]
    span = span_km(next(iter(runs.values()))) if marks else None
    return Drawing(TIME if against == "time" else POSITION, panels, span)


def _stations(result: Result, against: str) -> list[Mark]:
    """Marks at the stations of a line or corridor; none over time, and on the way over several lines."""
    if against == "time" or LINE in result.dataset.coords:
        return []
    return [Mark(km, name, dash=DOTTED, upright=True) for name, km in landmarks(result).items()]


def _nameless(mark: Mark) -> Mark:
    return replace(mark, words="")


def _time_or_place(result: Result, data: xr.Dataset, against: str) -> Floats:
    """Times [min], or places [km]: on a route over several lines the way since it began."""
    if against == "time":
        return np.asarray(data.time.to_numpy() / 60.0)
    if LINE in result.dataset.coords:
        along_m = data.route_position.to_numpy()
        return np.asarray((along_m - np.nanmin(along_m)) / 1e3)
    return np.asarray(data.position.to_numpy() / 1e3)


def _rise_ahead(result: Result, data: xr.Dataset) -> Floats:
    """Gradient of the line where a train is, as it runs. [1]"""
    services = [entry.name for entry in result.scenario.traffic]
    route = routes_of(result.scenario)[services.index(str(data.service.values))]
    return rise_ahead(result.scenario, route, data.route_position.to_numpy())


def rise_ahead(scenario: Scenario, route: Route, along_m: Floats) -> Floats:
    """Gradient of the lines at places along a route [m], as trains meet it. [1]"""
    rise = np.full(along_m.shape, np.nan)
    for course in route.courses:  # each as far as the next one begins
        here = along_m >= course.from_m
        line_m = course.sign * along_m[here] + course.offset_m
        rise[here] = course.sign * inclination(scenario.lines_by_name[course.line], line_m)
    return rise


def _values(result: Result, data: xr.Dataset) -> dict[str, Floats]:
    return {
        "gradient [‰]": _rise_ahead(result, data) * 1e3,
        "speed [km/h]": data.speed.to_numpy() * 3.6,
        "active power [MW]": data.active_power.to_numpy() / 1e6,
        "reactive power [Mvar]": data.reactive_power.to_numpy() / 1e6,
        "voltage [kV]": data.pantograph_voltage.to_numpy() / 1e3,
        "minus angle [°]": -np.degrees(data.pantograph_angle.to_numpy()),
    }
