"""Where the energy of a run comes from, and where it goes."""

from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from tpss.report.drawings.parts import Bar, Drawing, Panel
from tpss.report.palette import COLOURS, tint
from tpss.report.sampling import Floats
from tpss.results.result import Result
from tpss.results.tables import J_PER_MWH, step_s

Parts = dict[str, tuple[float, str]]
"""Energy of the parts of a bar [MWh], and their colours."""

NARROWEST = 0.06
"""Share of the whole width from which a part of a bar is wide enough for its figure."""

SMALLEST = 0.0005
"""Share of the whole width below which a part is not visible, and left out."""

TINTS = (1.0, 0.72, 0.5, 0.34)
"""Strengths of a colour that distinguish stations, and kinds of losses."""

USES = {
    "auxiliaries": "#E69F00",
    "motors and gears": "#CC79A7",
    "running resistance": "#009E73",
    "climb": "#56B4E9",
    "brakes": "#444444",
    "kinetic energy": "#F0E442",
}
"""Colours of the uses by trains; with those of stations and losses, the palette of Okabe and Ito."""


def energy_flow(result: Result) -> Drawing:
    """Three bars of equal length: energy fed, network losses and trains, and use by the trains.

    A use that is negative in total, such as the climb of trains that run downhill, is a part of the
    first bar.  Parts that are too small to be visible are left out.

    Parameters
    ----------
    result : Result
    """
    losses, stations, used = result.standards.losses, result.stations, used_by_trains(result)
    fed = _tinted(stations.station, stations.energy_mwh, COLOURS[0])
    fed |= {name: (-mwh, USES[name]) for name, mwh in used.items() if mwh < 0.0}
    drawn = {name: (mwh, USES[name]) for name, mwh in used.items() if mwh >= 0.0}
    kinds = [f"{kind} losses" for kind in losses.branch_kind]
    network = _tinted(kinds, losses.energy_mwh, COLOURS[1])
    lost, to_trains = (sum(mwh for mwh, _ in each.values()) for each in (network, drawn))
    network["trains"] = (to_trains, "#AAAAAA")
    width = max(lost + to_trains, 1e-9)
    bars = [*_bar(0, 0.0, fed, width), *_bar(1, 0.0, network, width), *_bar(2, lost, drawn, width)]
    panel = Panel("", bars, rows=("fed", "network", "trains"))
    return Drawing("energy [MWh]", [panel], (0.0, width), panel_inch=4.2)


def _tinted(names: Iterable[str], mwh: Iterable[float], colour: str) -> Parts:
    """Parts in tints of one colour."""
    return {
        str(name): (float(value), tint(colour, TINTS[k % len(TINTS)]))
        for k, (name, value) in enumerate(zip(names, mwh, strict=True))
    }


def used_by_trains(result: Result) -> dict[str, float]:
    """Use of the energy that all trains have drawn. [MWh]

    Motors and gears have the difference between pantograph and wheel, rotating rotors included; with
    power that is computed at the start of the step, the error of the step too.
    """
    data, scenario = result.dataset, result.scenario
    h = step_s(data)
    trains = scenario.trains_by_service()
    auxiliary_w = [1e3 * trains[str(s)].auxiliary_power_kw for s in data.service.to_numpy()]
    active_w = data.active_power.to_numpy()[:-1]
    auxiliaries = float((np.isfinite(active_w) * np.array(auxiliary_w)).sum()) * h
    wheel, running, climb, brakes = (float(np.nansum(work_j)) for work_j in work_of_forces(data))
    joules = {
        "auxiliaries": auxiliaries,
        "motors and gears": float(np.nansum(active_w)) * h - auxiliaries - wheel,
        "running resistance": running,
        "climb": climb,
        "brakes": brakes,
        "kinetic energy": wheel - running - climb - brakes,
    }
    return {name: value / J_PER_MWH for name, value in joules.items()}


def work_of_forces(data: xr.Dataset) -> tuple[Floats, Floats, Floats, Floats]:
    """Work of motors, running resistance, gradients and brakes. [J], shape (steps, trains) each

    Recorded forces are means over time.  In a step of constant acceleration they act over its distance.
    A step that holds the speed v for τ and then brakes over β to v' has its motors in traction at v; the
    resistances are constant; the brakes hold the train on a descent, then slow it down.
    With its distance x, β = 2 (x - v τ)/(v + v').
    """
    h = step_s(data)
    force = {
        name: data[name].to_numpy()[:-1]
        for name in ("tractive_force", "running_resistance", "gradient_force", "braking_force")
    }
    traction, running, climb, brakes = force.values()
    speed, hold_s = data.speed.to_numpy(), data.holding_time.to_numpy()[:-1]
    v, mean = speed[:-1], (speed[:-1] + speed[1:]) / 2.0
    distance_m = np.diff(data.position.to_numpy(), axis=0)
    held = hold_s > 0.0
    moving_s = np.where(held, hold_s, np.nan)
    moving_s = moving_s + np.divide(distance_m - v * hold_s, mean, where=held, out=np.zeros_like(v))
    along_m = np.where(held, distance_m * h / moving_s, mean * h)
    holding_ns = np.where(held, np.maximum(0.0, -(running + climb)) * h * hold_s / moving_s, 0.0)
    return (
        traction * np.where(held, v, mean) * h,
        running * along_m,
        climb * along_m,
        holding_ns * v + (brakes * h - holding_ns) * mean,
    )


def _bar(row: int, start: float, parts: Parts, width: float) -> Iterator[Bar]:
    """The parts of a bar side by side, each named in the legend."""
    for name, (mwh, colour) in parts.items():
        if mwh < SMALLEST * width:
            continue
        words = f"{mwh:.3g}" if mwh > NARROWEST * width else ""
        yield Bar(row, start, mwh, f"{name}: {mwh:.3g} MWh", words, colour)
        start += mwh
