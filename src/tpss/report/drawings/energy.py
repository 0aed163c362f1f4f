"""Where the energy of a run comes from, and where it goes."""

from collections.abc import Iterable, Iterator

import numpy as np

from tpss.report.drawings.parts import Bar, Drawing, Panel
from tpss.report.palette import COLOURS, tint
from tpss.report.sampling import Floats
from tpss.results.regeneration import OWN_STORAGE, STORED
from tpss.results.result import Result
from tpss.results.tables import J_PER_MWH, over_time

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
    "stores on board": "#DDCC77",
}
"""Colours of the uses by trains; with those of stations and losses, the palette of Okabe and Ito."""


GIVEN = {
    "climb": "descent",
    "kinetic energy": "kinetic energy given up",
    "stores on board": "from stores on board",
}
"""What a use is called where it is negative, and so feeds."""

AT_THE_LINE = ("stores at the line", "#997700")
"""Name and colour of what stores at the line take."""


def energy_flow(result: Result) -> Drawing:
    """Three bars of equal length: energy fed, network losses and trains, and use by the trains.

    A use that is negative in total, such as the climb of trains that run downhill, is a part of the
    first bar, and so is what stores give beyond what they take.  Parts that are too small to be visible
    are left out.

    Parameters
    ----------
    result : Result
    """
    losses, stations, used = result.standards.losses, result.stations, used_by_trains(result)
    fed = _tinted(stations.station, stations.energy_mwh, COLOURS[0])
    fed |= {GIVEN.get(name, name): (-mwh, USES[name]) for name, mwh in used.items() if mwh < 0.0}
    drawn = {name: (mwh, USES[name]) for name, mwh in used.items() if mwh >= 0.0}
    kinds = [f"{kind} losses" for kind in losses.branch_kind]
    network = _tinted(kinds, losses.energy_mwh, COLOURS[1])
    name, colour = AT_THE_LINE
    stored = _taken_mwh(result, STORED)
    if stored != 0.0:
        (network if stored > 0.0 else fed)[name] = (abs(stored), colour)
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
    trains = scenario.trains_by_service()
    auxiliary_w = np.array(
        [1e3 * trains[str(s)].auxiliary_power_kw for s in data.service.to_numpy()]
    )
    auxiliaries = float((auxiliary_w * _supplied_s(result)).sum())
    drawn, wheel, running, climb, brakes = (
        float(over_time(data[f"{name}_power"].to_numpy()[:-1], data).sum())
        for name in ("active", "traction", "resistance", "gradient", "braking")
    )
    stored = J_PER_MWH * _taken_mwh(result, OWN_STORAGE)
    joules = {
        "auxiliaries": auxiliaries,
        "motors and gears": drawn - stored - auxiliaries - wheel,
        "running resistance": running,
        "climb": climb,
        "brakes": brakes,
        "kinetic energy": wheel - running - climb - brakes,
        **({"stores on board": stored} if stored else {}),
    }
    return {name: value / J_PER_MWH for name, value in joules.items()}


def _taken_mwh(result: Result, name: str) -> float:
    """What stores take, less what they give, by the variable of their power; 0 without any. [MWh]"""
    if name not in result.dataset:
        return 0.0
    power_w = result.dataset[name].to_numpy()[:-1]
    return float(over_time(power_w, result.dataset).sum()) / J_PER_MWH


def _supplied_s(result: Result) -> Floats:
    """Time for which each train has supplied its auxiliaries. [s], shape (trains,)

    Trains that move in steps do so from instant to instant, others from departure to arrival.
    """
    data = result.dataset
    there = np.isfinite(data.active_power.to_numpy()[:-1])
    supplied_s = over_time(there.astype(float), data)
    if result.scenario.simulation.how_trains_move == "stepped":
        return supplied_s
    time_s = data.time.to_numpy()
    first_s = time_s[there.argmax(axis=0)]
    end_s = time_s[len(there) - there[::-1].argmax(axis=0)]
    waited_s = np.fmax(data.departure_time.to_numpy() - first_s, 0.0)
    stood_s = np.fmax(end_s - data.arrival_time.to_numpy(), 0.0)
    return np.asarray(supplied_s - waited_s - stood_s)


def _bar(row: int, start: float, parts: Parts, width: float) -> Iterator[Bar]:
    """The parts of a bar side by side, each named in the legend."""
    for name, (mwh, colour) in parts.items():
        if mwh < SMALLEST * width:
            continue
        words = f"{mwh:.3g}" if mwh > NARROWEST * width else ""
        yield Bar(row, start, mwh, f"{name}: {mwh:.3g} MWh", words, colour)
        start += mwh
