"""Speed and force of a train against what its machine, its driver and the rails allow."""

import numpy as np

from tpss.model.effort_curve import adhesion, level_resistance, machine_limit
from tpss.report.drawings.parts import DASH_DOTTED, DOTTED, Colours, Curve, Drawing, Panel
from tpss.report.drawings.time_distance import colour_range
from tpss.report.palette import BLACK
from tpss.report.trains import chosen_train
from tpss.results.result import Result

SPEEDS = 120
"""Points of a curve over speed."""


def effort(result: Result, train: str | None = None) -> Drawing:
    """Tractive force of a train over its speed, one point per step, coloured by the voltage.

    The curves are the machine's limit at the highest and lowest voltage of the train, adhesion,
    and running resistance on level track.

    Parameters
    ----------
    result : Result
    train : str, optional
        Name of the train; the studied train by default.
    """
    data = result.dataset.sel(train=chosen_train(result, train))
    train_type = result.scenario.trains_by_service()[str(data.service.item())]
    kmh, kn = data.speed.to_numpy() * 3.6, data.tractive_force.to_numpy() / 1e3
    kv = data.pantograph_voltage.to_numpy() / 1e3
    speeds = np.linspace(0.0, max(float(np.nanmax(kmh)) * 1.1, 10.0), SPEEDS)
    simulation, motoring = result.scenario.simulation, kn > 0.0
    curves = []
    for dash, volts in enumerate((float(np.nanmax(kv)), float(np.nanmin(kv)))):
        limit = machine_limit(train_type, speeds / 3.6, volts * 1e3) / 1e3
        curves.append(Curve(speeds, limit, f"machine at {volts:.2f} kV", BLACK, dash))
    rails = adhesion(train_type, speeds / 3.6, simulation) / 1e3
    rolling = level_resistance(train_type, speeds / 3.6) / 1e3
    curves.append(Curve(speeds, rails, f"adhesion, {simulation.rail}", 2, DASH_DOTTED))
    curves.append(Curve(speeds, rolling, "running resistance", 3, DOTTED, width=1.5))
    colours = Colours(kv[motoring], "voltage at the pantograph [kV]", *colour_range(kv))
    curves.append(Curve(kmh[motoring], kn[motoring], joined=False, colours=colours))
    highest = 1.08 * max(float(np.nanmax(kn)), float(rails.max()))
    panel = Panel("tractive force [kN]", curves, span=(0.0, highest))
    return Drawing("speed [km/h]", [panel], (0.0, float(speeds[-1])), panel_inch=4.2)
