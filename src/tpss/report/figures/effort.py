"""Speed and force of a train against what its machine, its driver and the rails allow."""

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from tpss.model.effort_curve import adhesion, level_resistance, machine_limit
from tpss.report.figures.time_distance import voltage_colours
from tpss.report.style import STYLE, colour, legend, panels
from tpss.results.result import Result

SPEEDS = 120
"""Points of a curve over speed."""


@rc_context(STYLE)
def effort(result: Result, train: str | None = None) -> Figure:
    """Tractive force of a train over its speed, a point a step, coloured by the voltage.

    The curves are the machine's limit at the highest and lowest voltage that the train met, adhesion,
    and running resistance on level track.

    Parameters
    ----------
    result : Result
    train : str, optional
        Name of the train; the studied train by default.
    """
    data = result.dataset.sel(train=train or result.summary["studied_train"])
    kind_of = {entry.name: entry.train for entry in result.scenario.traffic}
    kind = result.scenario.trains[kind_of[str(data.service.item())]]
    kmh, kn = data.speed.to_numpy() * 3.6, data.tractive_force.to_numpy() / 1e3
    kv = data.pantograph_voltage.to_numpy() / 1e3
    speeds = np.linspace(0.0, max(float(np.nanmax(kmh)) * 1.1, 10.0), SPEEDS)
    figure, (panel,) = panels(["tractive force [kN]"], "speed [km/h]", panel_inch=4.2)
    for k, voltage_kv in enumerate((float(np.nanmax(kv)), float(np.nanmin(kv)))):
        limit = machine_limit(kind, speeds / 3.6, voltage_kv * 1e3) / 1e3
        panel.plot(
            speeds, limit, "-" if k == 0 else "--", color=colour(5),
            label=f"machine at {voltage_kv:.2f} kV",
        )  # fmt: skip
    simulation = result.scenario.simulation
    rails_kn = adhesion(kind, speeds / 3.6, simulation) / 1e3
    panel.plot(speeds, rails_kn, "-.", color=colour(2), label=f"adhesion, {simulation.rail}")
    panel.plot(
        speeds, level_resistance(kind, speeds / 3.6) / 1e3, ":", color=colour(3), linewidth=1.8,
        label="running resistance",
    )  # fmt: skip
    motoring = kn > 0.0
    points = panel.scatter(
        kmh[motoring], kn[motoring], c=kv[motoring], s=12, cmap=voltage_colours(), zorder=3
    )
    figure.colorbar(points, ax=panel, label="voltage at the pantograph [kV]", pad=0.02, aspect=40)
    panel.set_xlim(0.0, speeds[-1])
    panel.set_ylim(0.0, 1.08 * max(float(np.nanmax(kn)), *rails_kn))
    legend(figure, panel)
    return figure
