"""Scenarios of a study's cases: values are set, and what depends on them is adapted."""

import math
from collections.abc import Mapping
from itertools import accumulate
from typing import Any

import numpy as np

from tpss.errors import Finding, ScenarioError
from tpss.scenario.fields import LINE
from tpss.scenario.override import copy_of
from tpss.scenario.scenario import Scenario
from tpss.sweep.design import DEVIATION, DRAWN, MEAN, PROFILE, Design
from tpss.sweep.settings import Settings, apply
from tpss.sweep.timetables import apply_timetables, is_of_timetables


def scenario_of(design: Design, case: int) -> Scenario:
    """Scenario of a case.

    Raises
    ------
    ScenarioError
        The values of the case do not give a valid scenario.
    """
    with design.study.named_as_given():
        return scenario_with(design, design.values(case), case)


def scenario_with(design: Design, values: Mapping[str, Any], case: int) -> Scenario:
    """Scenario with values of the parameters.

    Raises
    ------
    ScenarioError
        They do not give a valid scenario.
    """
    study = design.study
    document = copy_of({**study.base, "name": f"{study.file.name}-{case}"})
    settings: Settings = {}
    for name, value in values.items():
        if name in study.file.choices:
            settings |= study.file.choices[name][value]
        elif name not in DRAWN:
            settings[name] = value
    if study.timetables:
        places = (study.source, study.base_source)
        settings = apply_timetables(document, settings, study.timetables, *places)
        of_all = {path: v for path, v in study.file.set.items() if not is_of_timetables(path)}
        apply(document, of_all, study.source)
    apply(document, settings, study.source)
    if study.file.gradients is not None:
        number = values.get(PROFILE, case)
        draw_gradients(document, values[MEAN], values[DEVIATION], number, design)
    return Scenario.from_own_document(document, study.base_source)


MOST_PIECES = 1_000_000
"""Pieces of a line with a drawn profile; no line that a scenario may have is cut into more."""


def draw_gradients(
    document: dict[str, Any], mean: float, deviation: float, number: int, design: Design
) -> None:
    """Draw a gradient profile with exactly this mean and standard deviation over the line. [‰]

    Gradients of neighbouring pieces are correlated: each is ρ = exp(-piece / correlation) times the
    one before, and a normal number.  Then the profile is shifted and scaled.
    """
    drawn = design.study.file.gradients
    assert drawn is not None, "they are asked for"
    line = document["line"] if drawn.key == LINE else document["lines"][drawn.line]
    if not isinstance(line, dict):
        return  # it is refused where the scenario is made, and so is what follows
    length_km: Any = line.get("length_km")
    begin_km: Any = line.get("begins_at_km", 0.0)
    if not all(isinstance(km, int | float) for km in (length_km, begin_km)):
        return
    if not 0.0 < length_km <= MOST_PIECES * drawn.piece_km:
        return
    pieces = max(1, math.ceil(length_km / drawn.piece_km - 1e-9))
    if pieces == 1 and deviation > 0.0:
        problem = f"a line of {length_km:g} km is one piece, which has no standard deviation"
        remedy = "lower gradients.piece_km"
        place = (str(design.study.source), "gradients.piece_km", f"{drawn.piece_km:g}")
        raise ScenarioError([Finding(*place, problem, remedy)])
    from_begin_km = np.arange(pieces) * drawn.piece_km
    share = np.diff(np.append(from_begin_km, length_km)) / length_km
    rho = math.exp(-drawn.piece_km / drawn.correlation_km) if drawn.correlation_km > 0.0 else 0.0
    numbers = np.random.default_rng([design.study.file.seed, number]).standard_normal(pieces)
    numbers[1:] *= math.sqrt(1.0 - rho**2)
    profile = np.array(_correlated(numbers.tolist(), rho))
    profile -= share @ profile
    spread = math.sqrt(share @ profile**2)
    profile *= deviation / spread if spread > 0.0 else 0.0
    for key in ("gradients_file", "gradients_smoothed_over_km"):
        line.pop(key, None)
    line["gradients"] = [
        {"from_km": begin_km + km, "permille": permille}
        for km, permille in zip(from_begin_km.tolist(), (profile + mean).tolist(), strict=True)
    ]


def _correlated(numbers: list[float], rho: float) -> list[float]:
    """Numbers of which each is ρ times the one before, and one of those given."""
    return list(accumulate(numbers, lambda last, number: rho * last + number))
