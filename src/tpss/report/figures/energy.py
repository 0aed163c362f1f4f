"""Where the energy of a run comes from, and where it goes."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from tpss.report.palette import COLOURS
from tpss.report.style import STYLE, as_text, legend, panels
from tpss.results.result import Result
from tpss.results.tables import J_PER_MWH

Parts = dict[str, tuple[float, Any]]
"""Energy of the parts of a bar [MWh], and their colours."""

NARROWEST = 0.06
"""Share of the whole width from which a part of a bar has room for its figure."""

SMALLEST = 0.0005
"""Share of the whole width below which a part is not to be seen, and is left out."""

TINTS = (1.0, 0.72, 0.5, 0.34)
"""Strengths of a colour that tell stations apart, and kinds of losses."""

USES = {
    "auxiliaries": "#E69F00",
    "motors and gears": "#CC79A7",
    "running resistance": "#009E73",
    "climb": "#56B4E9",
    "brakes": "#444444",
    "kinetic energy": "#F0E442",
}
"""Colours of what trains do; with those of stations and losses, the palette of Okabe and Ito."""


@rc_context(STYLE)
def energy_flow(result: Result) -> Figure:
    """Three bars of one length: what is fed, what the network loses and trains draw, what trains do.

    A part of what trains do that is negative on balance, such as the climb of trains that run
    downhill, is fed in the first bar.  Parts that are too small to be seen are left out.

    Parameters
    ----------
    result : Result
    """
    losses, stations = result.standards.losses, result.stations
    used = used_by_trains(result)
    given = {name: (-mwh, USES[name]) for name, mwh in used.items() if mwh < 0.0}
    taken = {name: (mwh, USES[name]) for name, mwh in used.items() if mwh >= 0.0}
    fed = _tinted(stations.station, stations.energy_mwh, COLOURS[0])
    network = _tinted(
        [f"{kind} losses" for kind in losses.branch_kind], losses.energy_mwh, COLOURS[1]
    )
    lost = sum(mwh for mwh, _ in network.values())
    to_trains = sum(mwh for mwh, _ in taken.values())
    bars: dict[str, Parts] = {
        "fed": {**fed, **given},
        "network": {**network, "trains": (to_trains, "#AAAAAA")},
        "trains": taken,
    }
    width = max(lost + to_trains, 1e-9)
    figure, (panel,) = panels([""], "energy [MWh]", panel_inch=4.2)
    for row, parts in enumerate(bars.values()):
        _bar(panel, row, lost if row == 2 else 0.0, parts, width)
    panel.set_yticks(range(len(bars)), list(bars))
    panel.set_ylim(len(bars) - 0.5, -0.5)
    panel.set_xlim(0.0, width)
    panel.grid(visible=False, axis="y")
    panel.tick_params(axis="y", length=0)
    legend(figure, panel, columns=2)
    return figure


def _tinted(names: Iterable[str], mwh: Iterable[float], colour: str) -> Parts:
    """Parts in tints of one colour."""
    parts, pure = {}, np.array(to_rgb(colour))
    for k, (name, value) in enumerate(zip(names, mwh, strict=True)):
        tint = TINTS[k % len(TINTS)]
        parts[str(name)] = (float(value), tuple(1.0 - tint * (1.0 - pure)))
    return parts


def used_by_trains(result: Result) -> dict[str, float]:
    """What became of the energy that all trains have drawn. [MWh]

    Motors and gears have what is left of it between pantograph and wheel, spinning rotors included;
    with power that is billed at the start of the step, the step's error too.
    """
    data, scenario = result.dataset, result.scenario
    h = float(data.attrs["time_step_s"])
    speed = data.speed.to_numpy()
    way_m = h * (speed[:-1] + speed[1:]) / 2.0

    def work(name: str) -> float:
        return float(np.nansum(data[name].to_numpy()[:-1] * way_m))

    kind_of = {entry.name: scenario.trains[entry.train] for entry in scenario.traffic}
    auxiliary_w = [1e3 * kind_of[str(s)].auxiliary_power_kw for s in data.service.to_numpy()]
    active_w = data.active_power.to_numpy()[:-1]
    auxiliaries = float((np.isfinite(active_w) * np.array(auxiliary_w)).sum()) * h
    wheel, running = work("tractive_force"), work("running_resistance")
    climb, brakes = work("gradient_force"), work("braking_force")
    joules = {
        "auxiliaries": auxiliaries,
        "motors and gears": float(np.nansum(active_w)) * h - auxiliaries - wheel,
        "running resistance": running,
        "climb": climb,
        "brakes": brakes,
        "kinetic energy": wheel - running - climb - brakes,
    }
    return {name: value / J_PER_MWH for name, value in joules.items()}


def _bar(panel: Axes, row: int, start: float, parts: Parts, width: float) -> None:
    """Draw the parts of a bar side by side, each named in the legend."""
    for name, (mwh, colour) in parts.items():
        if mwh < SMALLEST * width:
            continue
        panel.barh(
            row,
            mwh,
            left=start,
            height=0.62,
            color=colour,
            edgecolor="white",
            linewidth=0.8,
            label=f"{as_text(name)}: {mwh:.3g} MWh",
        )
        if mwh > NARROWEST * width:
            light = float(np.dot((0.3, 0.59, 0.11), to_rgb(colour)))
            panel.text(
                start + mwh / 2.0,
                row,
                f"{mwh:.3g}",
                ha="center",
                va="center",
                color="black" if light > 0.5 else "white",
            )
        start += mwh
