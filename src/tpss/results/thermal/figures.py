"""Figures of a run on its equipment, from its recording: its use, how hot it gets, how old."""

import math
from collections.abc import Iterable, Iterator

import numpy as np

from tpss.model.outages import layout_of
from tpss.model.supply_plan import CONTACT_LINE, TRANSFORMER
from tpss.results.standards.windows import Floats
from tpss.results.thermal.elements import (
    CONVERTER,
    MOTORS,
    RECTIFIER,
    Element,
    Readings,
    rated_elements,
)
from tpss.results.thermal.judge import ROUNDING, Thermal
from tpss.run.run import Run
from tpss.scenario.scenario import Scenario

USES = {
    "contact_line_use_percent": CONTACT_LINE,
    "transformer_use_percent": TRANSFORMER,
    "converter_use_percent": CONVERTER,
    "rectifier_use_percent": RECTIFIER,
    "motor_use_percent": MOTORS,
}
"""Figures that are the highest of a kind of equipment."""

FIGURES = (*USES, "hot_spot_c", "loss_of_life_min", "over")
"""All of them."""


def thermal_figures(run: Run, scenario: Scenario) -> dict[str, float]:
    """The highest use of each kind of equipment, and the hottest and the most aged transformer.

    Use is the highest thermal state or r.m.s. load over a window, of what is allowed.  NaN where
    nothing of the kind has a rating, or where no hot spot is known.

    Parameters
    ----------
    run : Run
        With a step at least.
    scenario : Scenario
        In which something has a rating.
    """
    levels = np.array(layout_of(scenario, scenario.outage).plan.branch_levels())

    def recorded(name: str) -> Floats:
        if name == "branch_current":
            return np.asarray(run.recording.branch_current[: run.step] / levels)
        rows = run.recording.trains if name == "motor_current" else run.recording.stations
        return np.asarray(rows[: run.step][name], dtype=float)

    trains = [(train.name, train.service) for train in run.trains[: run.departed]]
    loaded = rated_elements(Readings(recorded, trains), scenario)
    fixed = [each for each in loaded if each[0].train < 0]
    instants_s = run.instants_s
    parts = [Thermal.of(fixed, instants_s)] if fixed else []
    parts += [_while_there(*each, instants_s) for each in loaded if each[0].train >= 0]
    uses = [
        (element.kind, use)
        for part in parts
        for element, use in zip(part.elements, part.uses, strict=True)
    ]
    return {
        **{
            name: 100.0 * _highest(use for of, use in uses if of == kind)
            for name, kind in USES.items()
        },
        "hot_spot_c": _highest(celsius for part in parts for celsius in _hot_spots_c(part)),
        "loss_of_life_min": _highest(s for part in parts for s in part.states.aged_s.tolist())
        / 60.0,
        "over": float(sum(use > 1.0 + ROUNDING for _, use in uses)),
    }


def _while_there(element: Element, load: Floats, instants_s: Floats) -> Thermal:
    """Judgement of equipment on a train over the time that it is on the line, and its windows around."""
    there = np.flatnonzero(np.isfinite(load))
    widest_s = max((lasts_s for _, lasts_s in element.body.overloads), default=0.0)
    ends_s = instants_s[there[0]] - widest_s, instants_s[there[-1] + 1] + widest_s
    first, last = np.searchsorted(instants_s, ends_s)
    steps = slice(max(first - 1, 0), last)
    return Thermal.of([(element, load[steps])], instants_s[steps.start : steps.stop + 1])


def _hot_spots_c(part: Thermal) -> Iterator[float]:
    """Highest temperatures of transformers whose cooling is known. [°C]"""
    for element, state in zip(part.elements, part.states.highest.tolist(), strict=True):
        if element.body.cooling is not None:
            yield element.body.ambient_c + element.body.rise_k * state


def _highest(values: Iterable[float]) -> float:
    return max((value for value in values if not math.isnan(value)), default=math.nan)
