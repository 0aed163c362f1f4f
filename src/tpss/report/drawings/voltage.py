"""Voltage along the line: of a train, and over a whole run."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from tpss.model.conductors import TERMINALS
from tpss.report.contact_line import LineVoltage, line_voltage
from tpss.report.corridor import is_corridor, landmarks
from tpss.report.drawings import parts
from tpss.report.palette import STRONG_GREY
from tpss.report.trains import chosen_train
from tpss.results.rails import has_rails
from tpss.results.result import Result
from tpss.scenario.standards import VoltageLimits

SAME_PLACE_KM = 1e-3
"""Places no farther apart are one. [km]"""


def voltage_along_line(
    runs: Mapping[str, Result], train: str | None = None, limits: bool = False
) -> parts.Drawing:
    """Voltage of a train along the line; feeding points are marked.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    train : str, optional
        Train of that name in every run; each run's studied train by default.
    limits : bool
        Whether to mark the limits of EN 50163 for the first run, and to name the stations.

    References
    ----------
    [Boullanger2009]_, the layout of figures 3-2 and 3-3; [EN50163]_, the limits.
    """
    marks = feeding_points(runs.values(), named=limits)
    items: list[parts.Item] = [*marks]
    curves: list[parts.Curve] = []
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=chosen_train(result, train))
        km, kv = data.position.to_numpy() / 1e3, data.pantograph_voltage.to_numpy() / 1e3
        curves.append(parts.Curve(km, kv, label, k, k))
    items += curves
    span = None
    if limits:
        judged = limit_marks(next(iter(runs.values())).scenario.standards.voltage_limits)
        items += judged
        seen = (curve.y[np.isfinite(curve.y)] for curve in curves)
        span = _span([mark.value for mark in judged], *seen, margin=0.08)
    panel = parts.Panel("voltage at the pantograph [kV]", items, span=span)
    return parts.Drawing(parts.POSITION, [panel], (marks[0].value, marks[-1].value), panel_inch=3.0)


def voltage_envelope(result: Result) -> parts.Drawing:
    """Lowest, mean and highest voltage along the line over a run, with the limits of EN 50163.

    Parameters
    ----------
    result : Result
        With a time step at least.

    References
    ----------
    [Boullanger2009]_, figures 3-2 and 3-3, of one train there; [EN50163]_, the limits.
    """
    voltage = line_voltage(result.dataset)
    if voltage is None:
        raise ValueError("no time step was simulated, so there is no voltage")
    return envelopes({"": (result, voltage)})


def envelopes(
    runs: Mapping[str, tuple[Result, LineVoltage]], *, with_trains: bool = False
) -> parts.Drawing:
    """Voltage along the line over a run, or the lowest voltage of each of several runs, with the limits.

    Parameters
    ----------
    runs : mapping of str to (Result, LineVoltage)
        By label.
    with_trains : bool
        Whether to add the trains in the first time step, the last item a run, which a page moves.
    """
    several, results = len(runs) > 1, [result for result, _ in runs.values()]
    curves = [
        parts.Curve(voltage.position_km, voltage.lowest_kv, label if several else "lowest", k, k)
        for k, (label, (_, voltage)) in enumerate(runs.items())
    ]
    limits = limit_marks(results[0].scenario.standards.voltage_limits)
    items: list[parts.Item] = [*feeding_points(results, named=True), *limits]
    if not several:
        ((_, voltage),) = runs.values()
        km, highest_kv = voltage.position_km, voltage.highest_kv
        curves.insert(0, parts.Curve(km, voltage.mean_kv, "mean", dash=parts.DASHED))
        curves.insert(0, parts.Curve(km, highest_kv, "highest", dash=parts.DOTTED))
        items.append(parts.Band(km, voltage.lowest_kv, highest_kv))
    items += curves
    if with_trains:
        names = [f"trains now, {label}" if several else "trains now" for label in runs]
        items += map(_trains, results, names, range(len(runs)))
    span_kv = _span([mark.value for mark in limits], *(curve.y for curve in curves), margin=0.08)
    panel = parts.Panel("lowest voltage [kV]" if several else "voltage [kV]", items, span=span_kv)
    span_km = _span(*(curve.x for curve in curves), margin=0.02)
    return parts.Drawing(parts.POSITION, [panel], span_km, panel_inch=3.6)


def _trains(result: Result, name: str, k: int) -> parts.Curve:
    first = result.dataset.isel(time=0)
    km, kv = first.position.to_numpy() / 1e3, first.pantograph_voltage.to_numpy() / 1e3
    trains = [str(train) for train in result.dataset.train.to_numpy()]
    return parts.Curve(km, kv, name, colour=k, joined=False, words=trains)


def limit_marks(limits: VoltageLimits) -> list[parts.Mark]:
    """Nominal voltage and limits by which a result is judged, by their names in EN 50163.

    Under direct current both lowest voltages are the same, and have one mark.
    """
    marks = []
    for name in ("min2", "min1", "n", "max1", "max2"):
        kv: float = getattr(limits, f"u{name}_kv")
        words, printed = f"U{name} {kv:g} kV", f"$U_{{{name}}}$ {kv:g}"
        if limits.umin1_kv == limits.umin2_kv and name.startswith("min"):
            if name == "min1":
                continue
            words, printed = f"Umin1 and Umin2 {kv:g} kV", f"$U_{{min1,2}}$ {kv:g}"
        dash = parts.SOLID if name == "n" else parts.DASHED
        marks.append(parts.Mark(kv, words, printed, dash, STRONG_GREY))
    return marks


def feeding_points(results: Iterable[Result], *, named: bool = False) -> list[parts.Mark]:
    """Marks at transformers and stations by their places; the stations with their names.

    Where lines that are drawn as one meet or end, it is the name of the place.
    """
    names: dict[float, str] = {}
    for result in results:
        data = result.dataset
        names = dict.fromkeys(_places_km(result), "") | names
        if named:
            stations = data.station.to_numpy().astype(str).tolist()
            names |= zip((data.station_position.to_numpy() / 1e3).tolist(), stations, strict=True)
        if named and is_corridor(result):
            places = landmarks(result).items()
            names |= {
                km: name for name, at_km in places for km in names
                if not names[km] and abs(km - at_km) < SAME_PLACE_KM
            }  # fmt: skip
    return [parts.Mark(km, names[km], dash=parts.DOTTED, upright=True) for km in sorted(names)]


def _places_km(result: Result) -> list[float]:
    """Places of nodes that feed or tie; where rails are conductors, there are others between them."""
    data = result.dataset
    km = data.node_position.to_numpy() / 1e3
    if not has_rails(data):
        return [float(place) for place in km]
    feeds = km[data.node_kind.to_numpy() == TERMINALS]
    return [*feeds.tolist(), *result.autotransformers.position_km.tolist(), km.min(), km.max()]


def _span(*values: ArrayLike, margin: float) -> tuple[float, float]:
    """Lowest and highest of all values, with a margin that is a share of their distance."""
    every = np.concatenate(values)
    low, high = float(every.min()), float(every.max())
    return low - margin * (high - low), high + margin * (high - low)
