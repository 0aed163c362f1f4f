"""Speed and force of a train against what its machine, its driver and the rails allow."""

from typing import Any

import numpy as np

from tpss.kernel import blank_records, plain
from tpss.model.trains import build_machine, build_train_types
from tpss.physics.adhesion import DRY, WET, adhesion_limit
from tpss.physics.locomotive import DEMAND, FULL_EFFORT_N, take_speed, wheel_force
from tpss.physics.running_resistance import DavisCoefficients, running_resistance
from tpss.report.drawings.parts import DASH_DOTTED, DOTTED, Colours, Curve, Drawing, Panel
from tpss.report.drawings.time_distance import colour_range
from tpss.report.palette import BLACK
from tpss.report.sampling import Floats
from tpss.report.trains import chosen_train
from tpss.results.result import Result
from tpss.scenario.rolling_stock import Train
from tpss.scenario.simulation import Simulation

SPEEDS = 120
"""Points of a curve over speed."""


def effort(result: Result, train: str | None = None) -> Drawing:
    """Tractive force of a train over its speed, a point a step, coloured by the voltage.

    The curves are the machine's limit at the highest and lowest voltage that the train met, adhesion,
    and running resistance on level track.

    Parameters
    ----------
    result : Result
    train : str, optional
        Name of the train; the studied train by default.
    """
    data = result.dataset.sel(train=chosen_train(result, train))
    kind_of = {entry.name: entry.train for entry in result.scenario.traffic}
    kind = result.scenario.trains[kind_of[str(data.service.item())]]
    kmh, kn = data.speed.to_numpy() * 3.6, data.tractive_force.to_numpy() / 1e3
    kv = data.pantograph_voltage.to_numpy() / 1e3
    speeds = np.linspace(0.0, max(float(np.nanmax(kmh)) * 1.1, 10.0), SPEEDS)
    simulation, motoring = result.scenario.simulation, kn > 0.0
    curves = []
    for dash, volts in enumerate((float(np.nanmax(kv)), float(np.nanmin(kv)))):
        limit = machine_limit(kind, speeds / 3.6, volts * 1e3) / 1e3
        curves.append(Curve(speeds, limit, f"machine at {volts:.2f} kV", BLACK, dash))
    adhesion, rolling = adhesion_kn(kind, speeds, simulation), resistance(kind, speeds / 3.6) / 1e3
    curves.append(Curve(speeds, adhesion, f"adhesion, {simulation.rail}", 2, DASH_DOTTED))
    curves.append(Curve(speeds, rolling, "running resistance", 3, DOTTED, width=1.5))
    colours = Colours(kv[motoring], "voltage at the pantograph [kV]", *colour_range(kv))
    curves.append(Curve(kmh[motoring], kn[motoring], joined=False, colours=colours))
    highest = 1.08 * max(float(np.nanmax(kn)), float(adhesion.max()))
    panel = Panel("tractive force [kN]", curves, span=(0.0, highest))
    return Drawing("speed [km/h]", [panel], (0.0, float(speeds[-1])), panel_inch=4.2)


def adhesion_kn(kind: Train, speed_kmh: Floats, simulation: Simulation) -> Floats:
    """Highest force that the rails carry. [kN]"""
    rail = WET if simulation.rail == "wet" else DRY
    factor = 1.0 if simulation.adhesion_speed_unit == "m/s" else 3.6
    limit, mass_kg = plain(adhesion_limit), kind.adhesive_mass_t * 1e3
    return np.array([limit(mass_kg, v / 3.6 * factor, rail) for v in speed_kmh]) / 1e3


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
