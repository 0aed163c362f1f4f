"""Voltage along the line: of a train, and over a whole run."""

from collections.abc import Iterable, Mapping

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tpss.report.contact_line import line_voltage, voltage_marks
from tpss.report.style import STYLE, as_text, colour, legend, line, panels
from tpss.results.result import Result


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
    _mark_feeding_points(panel, runs.values())
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset.sel(train=train or result.summary["studied_train"])
        voltage_kv = data.pantograph_voltage.to_numpy() / 1e3
        panel.plot(
            data.position.to_numpy() / 1e3,
            voltage_kv,
            line(k),
            color=colour(k),
            label=as_text(label),
        )
    legend(figure, panel)
    return figure


@rc_context(STYLE)
def voltage_envelope(result: Result) -> Figure:
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
    figure, (panel,) = panels(["voltage [kV]"], "position [km]", panel_inch=3.6)
    km = voltage.position_km
    panel.fill_between(km, voltage.lowest_kv, voltage.highest_kv, color=colour(0), alpha=0.15, lw=0)
    panel.plot(km, voltage.highest_kv, ":", color=colour(0), label="highest")
    panel.plot(km, voltage.mean_kv, "--", color=colour(0), label="mean")
    panel.plot(km, voltage.lowest_kv, "-", color=colour(0), label="lowest", linewidth=1.6)
    shown = np.concatenate([voltage.lowest_kv, voltage.highest_kv])
    _mark_limits(panel, result, float(shown.min()), float(shown.max()))
    _mark_feeding_points(panel, [result])
    _name_stations(panel, result)
    panel.grid(visible=False, axis="x")
    legend(figure, panel)
    return figure


def _mark_limits(panel: Axes, result: Result, lowest_kv: float, highest_kv: float) -> None:
    """Lines at nominal voltage and limits, named beside the panel."""
    marks = voltage_marks(result.scenario.standards.voltage_limits)
    for name, kilovolts in marks.items():
        dashes = "-" if name == "Un" else (0, (6, 3))
        panel.axhline(kilovolts, color="#555555", linewidth=0.8, linestyle=dashes)
        panel.annotate(
            f"$U_{{{name.removeprefix('U')}}}$ {kilovolts:g}",
            (1.0, kilovolts),
            xytext=(4, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            va="center",
            fontsize="small",
            color="#444444",
            annotation_clip=False,
        )
    low, high = min(lowest_kv, *marks.values()), max(highest_kv, *marks.values())
    margin = 0.08 * (high - low)
    panel.set_ylim(low - margin, high + margin)


def _mark_feeding_points(panel: Axes, results: Iterable[Result]) -> None:
    """Dotted lines at transformers and stations."""
    places_m = {float(m) for result in results for m in result.dataset.node_position.to_numpy()}
    for m in sorted(places_m):
        panel.axvline(m / 1e3, color="#888888", linewidth=0.8, linestyle=":")


def _name_stations(panel: Axes, result: Result) -> None:
    """Names of the converter stations above the panel."""
    data = result.dataset
    places = data.station_position.to_numpy() / 1e3
    low, high = panel.get_xlim()
    for km, name in zip(places, data.station.to_numpy(), strict=True):
        share = (km - low) / (high - low)
        panel.annotate(
            as_text(name),
            (km, 1.0),
            xytext=(0, 3),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            ha="left" if share < 0.1 else "right" if share > 0.9 else "center",
            fontsize="small",
            color="#444444",
        )
