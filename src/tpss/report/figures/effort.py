"""Speed and force of a train against what its machine, its driver and the rails allow."""

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from tpss.kernel import blank_records, plain
from tpss.model.trains import build_machine, build_train_types
from tpss.physics.adhesion import DRY, WET, adhesion_limit
from tpss.physics.locomotive import DEMAND, FULL_EFFORT_N, take_speed, wheel_force
from tpss.physics.running_resistance import DavisCoefficients, running_resistance
from tpss.report.figures.time_distance import voltage_colours
from tpss.report.style import STYLE, Floats, colour, legend, panels
from tpss.results.result import Result
from tpss.scenario.rolling_stock import Train

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
    rail = WET if simulation.rail == "wet" else DRY
    factor = 1.0 if simulation.adhesion_speed_unit == "m/s" else 3.6
    adhesion = [
        plain(adhesion_limit)(kind.adhesive_mass_t * 1e3, v / 3.6 * factor, rail) / 1e3
        for v in speeds
    ]
    panel.plot(speeds, adhesion, "-.", color=colour(2), label=f"adhesion, {simulation.rail}")
    panel.plot(
        speeds, resistance(kind, speeds / 3.6) / 1e3, ":", color=colour(3), linewidth=1.8,
        label="running resistance",
    )  # fmt: skip
    motoring = kn > 0.0
    points = panel.scatter(
        kmh[motoring], kn[motoring], c=kv[motoring], s=12, cmap=voltage_colours(), zorder=3
    )
    figure.colorbar(points, ax=panel, label="voltage at the pantograph [kV]", pad=0.02, aspect=40)
    panel.set_xlim(0.0, speeds[-1])
    panel.set_ylim(0.0, 1.08 * max(float(np.nanmax(kn)), *adhesion))
    legend(figure, panel)
    return figure


def machine_limit(kind: Train, speed_m_s: Floats, voltage_v: float) -> Floats:
    """Highest force at the wheel rim by machine and line current, on level track. [N]"""
    types, points = build_train_types([kind])
    machine = build_machine()[0]
    train: Any = blank_records(1, DEMAND)[0]
    train.force_cap_n = train.adhesion_n = FULL_EFFORT_N
    train.free_band_v = -1.0
    force, rolling = np.empty_like(speed_m_s), resistance(kind, speed_m_s)
    for k, speed in enumerate(speed_m_s):
        train.speed_m_s, train.taken_speed_m_s = speed, -1.0
        train.resistance_n = rolling[k]
        take_speed(voltage_v, types[0], train, machine, points)
        force[k], _ = wheel_force(voltage_v, types[0], train, machine)
    return force


def resistance(kind: Train, speed_m_s: Floats) -> Floats:
    """Running resistance on level track. [N]"""
    davis = DavisCoefficients(
        kind.resistance_a_n, kind.resistance_b_n_s_per_m, kind.resistance_c_n_s2_per_m2
    )
    return np.array([plain(running_resistance)(speed, davis) for speed in speed_m_s])
