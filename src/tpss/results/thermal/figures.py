"""Figures of a run on its equipment, from its recording: its use, how hot it gets, how old."""

import math
from collections.abc import Iterable

import numpy as np

from tpss.model.outages import layout_of
from tpss.model.supply import CONTACT_LINE, TRANSFORMER
from tpss.results.standards.windows import Floats
from tpss.results.thermal.elements import CONVERTER, MOTORS, Readings, rated_elements
from tpss.results.thermal.judge import ROUNDING, Thermal
from tpss.run.run import Run
from tpss.scenario.scenario import Scenario

USES = {
    "contact_line_use_percent": CONTACT_LINE,
    "transformer_use_percent": TRANSFORMER,
    "converter_use_percent": CONVERTER,
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
    own = Thermal.of(rated_elements(Readings(recorded, trains), scenario), run.instants_s)
    kinds = [element.kind for element in own.elements]
    bodies = [element.body for element in own.elements]
    hot_spots_c = (
        body.ambient_c + body.rise_k * state
        for body, state in zip(bodies, own.states.highest.tolist(), strict=True)
        if body.cooling is not None
    )
    return {
        **{
            name: 100.0
            * _highest(use for use, of in zip(own.uses, kinds, strict=True) if of == kind)
            for name, kind in USES.items()
        },
        "hot_spot_c": _highest(hot_spots_c),
        "loss_of_life_min": _highest(own.states.aged_s.tolist()) / 60.0,
        "over": float(sum(use > 1.0 + ROUNDING for use in own.uses)),
    }


def _highest(values: Iterable[float]) -> float:
    return max((value for value in values if not math.isnan(value)), default=math.nan)
