"""Figures of a run on the unbalance of its grids and the voltage of its rails, from its recording."""

import math
from collections.abc import Iterable

from tpss.model.build import Layout
from tpss.model.phases import phases_of
from tpss.results.dataset import build_dataset
from tpss.results.judged_rails import JudgedRails
from tpss.results.standards.unbalance import unbalance_of
from tpss.run.run import Outcome
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model

UNBALANCE, RAILS = ("unbalance_percent",), ("rail_permanent_v", "rail_short_v", "stray_ma_per_m")
FIGURES = (*UNBALANCE, *RAILS)
"""All of them."""


def has_phases(scenario: Scenario) -> bool:
    """Whether stations tell the phases of their grid."""
    return any(phases_of(station) for station in scenario.supply.stations)


def has_own_rails(scenario: Scenario) -> bool:
    """Whether rails are conductors of their own."""
    return scenario.supply.conductors is not None


def grid_and_rails(
    outcome: Outcome, model: Model, layout: Layout, scenario: Scenario, steps: slice = slice(None)
) -> dict[str, float]:
    """The highest unbalance of a busbar, and the highest voltages and stray current of rails.

    The unbalance is the highest mean over 10 min, of a shorter run over all of it; rail voltages are the
    highest means over 300 s, NaN if the run is shorter, and over a second or a step; the stray current
    is that of the line with most, NaN of an alternating current.  What a scenario does not have is NaN.

    Parameters
    ----------
    outcome : Outcome
        With a step at least.
    scenario : Scenario
        Whose stations tell their phases, or whose rails are conductors of their own.
    steps : slice, optional
        Steps that count; by default all.
    """
    rows = range(outcome.steps)[steps]
    dataset = build_dataset(outcome, model, layout).isel(time=slice(rows.start, rows.stop + 1))
    dataset.attrs = {"time_step_s": model.options.step_s, "last_step_s": model.options.step_s}
    found = dict.fromkeys(FIGURES, math.nan)
    if has_phases(scenario):
        means = [each.mean_10_min_percent for each in unbalance_of(dataset, scenario)]
        found["unbalance_percent"] = _highest(means)
    if has_own_rails(scenario):
        rails = JudgedRails(dataset, scenario)
        found["rail_permanent_v"] = _highest(rails.voltages.permanent_v)
        found["rail_short_v"] = _highest(rails.voltages.short_v)
        found["stray_ma_per_m"] = _highest(rails.stray_current.leaving_ma_per_m)
    return found


def _highest(values: Iterable[float]) -> float:
    return max((float(value) for value in values if not math.isnan(value)), default=math.nan)
