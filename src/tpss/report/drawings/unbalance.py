"""Unbalance of the grid's busbars over time, and the currents of its phases."""

from collections.abc import Mapping

import numpy as np

from tpss.physics.three_phase import PHASES
from tpss.report.drawings.parts import TIME, Curve, Drawing, Mark, Panel
from tpss.report.palette import STRONG_GREY
from tpss.report.sampling import Floats
from tpss.report.trains import NothingToDrawError
from tpss.results.result import Result
from tpss.results.standards.unbalance import WINDOW_MIN
from tpss.results.standards.windows import between_instants, integrals
from tpss.results.tables import step_s
from tpss.results.three_phase import busbars


def unbalance(runs: Mapping[str, Result]) -> Drawing:
    """Unbalance at each busbar of the grid, its mean over 10 min, and the phase currents, over time.

    A colour is a busbar, a line style a run; the means are those of the 10 min before.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.

    Raises
    ------
    NothingToDrawError
        No transformer station tells its phases.
    """
    shares: list[Curve] = []
    means: list[Curve] = []
    currents: list[list[Curve]] = [[] for _ in PHASES]
    limit = 0.0
    for k, (label, result) in enumerate(runs.items()):
        minutes = result.dataset.time.to_numpy() / 60.0
        for b, each in enumerate(busbars(result.dataset, result.scenario)):
            name, dash = (f"{each.name}, {label}", k) if len(runs) > 1 else (each.name, b)
            limit = max(limit, 100.0 * each.limit)
            mean = _means_before(each.unbalance, step_s(result.dataset) / 60.0)
            shares.append(_held(minutes, 100.0 * each.unbalance, name, b, dash))
            means.append(Curve(minutes, 100.0 * mean, name, b, dash))
            for of_phase, phasors in zip(currents, each.phase_currents_a.T, strict=True):
                of_phase.append(_held(minutes, np.abs(phasors), name, b, dash))
    if not shares:
        raise NothingToDrawError("no transformer station tells its phases")
    highest = max(limit, *(float(np.nanmax(curve.y, initial=0.0)) for curve in means))
    panels = [
        Panel("u₂ [%]", shares, "$U_2/U_1$ [%]", from_zero=True),
        Panel(
            f"of {WINDOW_MIN:g} min [%]",
            [Mark(limit, "limit", "limit", colour=STRONG_GREY), *means],
            f"mean of\n{WINDOW_MIN:g} min [%]",
            span=(0.0, 1.15 * highest),
        ),
        *(
            Panel(f"phase {phase} [A]", of_phase, f"$I_{phase}$ [A]", from_zero=True)
            for phase, of_phase in zip(PHASES, currents, strict=True)
        ),
    ]
    return Drawing(TIME, panels, names_one=True)


def _held(minutes: Floats, values: Floats, name: str, colour: int, dash: int) -> Curve:
    """A curve of values of steps."""
    return Curve(minutes, np.append(values, np.nan), name, colour, dash, held=True)


def _means_before(values: Floats, step_min: float) -> Floats:
    """Means over the 10 min before every instant, NaN where the run has not lasted so long yet."""
    instants = np.arange(len(values) + 1.0)
    begins = instants - WINDOW_MIN / step_min
    integral = integrals(values[:, None])
    known = begins >= -1e-9
    means = np.full(len(instants), np.nan)
    areas = between_instants(integral, instants[known])
    areas = areas - between_instants(integral, np.maximum(begins[known], 0.0))
    means[known] = areas[:, 0] / (WINDOW_MIN / step_min)
    return means
