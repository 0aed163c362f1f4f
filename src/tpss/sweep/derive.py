"""Scenarios of a study's cases: values put in their places, what depends on them moved along."""

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import accumulate
from typing import Any

import numpy as np

from tpss.errors import Finding, ScenarioError
from tpss.scenario.override import copy_of, put_in
from tpss.scenario.scenario import Scenario
from tpss.sweep.design import DEVIATION, MEAN, PROFILE, Design
from tpss.sweep.study import Settings, settings_of

LENGTH = "line.length_km"

PLACES = (
    "line.stations.*.position_km",
    "line.speed_limits.*.from_km",
    "supply.converter_stations.*.position_km",
    "supply.high_voltage_line.transformers_km.*",
    "traffic.*.initial_trains.*.position_km",
    "standards.zones.*.from_km",
    "standards.zones.*.to_km",
)
"""What moves with the end of the line, in proportion.  The ground, that is the gradients, stays."""

INSTEAD_OF = {
    "transformers": "transformers_km",
    "transformers_km": "transformers",
    "headway_min": "departures_min",
    "departures_min": "headway_min",
    "duration_min": "until",
    "until": "duration_min",
    "gradients": "gradients_file",
}
"""Keys that take the place of another one."""


def scenario_of(design: Design, case: int) -> Scenario:
    """Scenario of a case.

    Raises
    ------
    ScenarioError
        The values of the case make no scenario.
    """
    return scenario_with(design, design.values(case), case)


def scenario_with(design: Design, values: Mapping[str, Any], case: int) -> Scenario:
    """Scenario with values of the parameters.

    Raises
    ------
    ScenarioError
        They make no scenario.
    """
    study = design.study
    document = {**study.base, "name": f"{study.file.name}-{case}"}
    if study.file.gradients is not None:
        line = study.base.get("line", {})
        document["line"] = {key: line[key] for key in line if not key.startswith("gradients")}
    document = copy_of(document)
    settings: Settings = {}
    for name, value in values.items():
        if name in study.file.choices:
            settings |= settings_of(study.file.choices[name][value])
        elif name not in (MEAN, DEVIATION, PROFILE):
            settings |= settings_of({name: value})
    length_km = settings.pop(LENGTH, None)
    if length_km is not None:
        move_places(document, length_km)
    put(document, settings, design)
    if study.file.gradients is not None:
        number = values.get(PROFILE, case)
        draw_gradients(document, values[MEAN], values[DEVIATION], number, design)
    return Scenario.from_document(document, study.base_source)


def put(document: dict[str, Any], settings: Settings, design: Design) -> None:
    """Put values of a document in all the places that their paths mean."""
    changes: dict[str, Any] = {}
    for path, value in settings.items():
        found = list(places_of(document, path))
        if not found:
            problem = "there is no such place in the base scenario"
            remedy = (
                "name tables by their keys, list items by their number from 0 or all of them by *"
            )
            source = str(design.study.source)
            raise ScenarioError([Finding(source, path, repr(value), problem, remedy)])
        for place in found:
            above, _, key = place.rpartition(".")
            if key in INSTEAD_OF and value is not None:
                changes[f"{above}.{INSTEAD_OF[key]}"] = None
            changes[place] = value
    put_in(document, changes, design.study.source)


def places_of(document: Any, path: str) -> Iterator[str]:
    """Key paths that a path with ``*`` means in a document."""
    before, star, after = path.partition("*")
    if not star:
        yield path
        return
    container = document
    for name in filter(None, before.split(".")):
        container = _item(container, name)
    keys: Iterable[Any] = (
        container if isinstance(container, Mapping) else range(len(container or ()))
    )
    for key in keys:
        yield from places_of(document, f"{before}{key}{after}")


def _item(container: Any, key: str) -> Any:
    """An item of a table or list; None if there is none."""
    if isinstance(container, Mapping):
        return container.get(key)
    is_there = isinstance(container, list | tuple) and key.isdigit() and int(key) < len(container)
    return container[int(key)] if is_there else None


def move_places(document: dict[str, Any], length_km: float) -> None:
    """Give a line another length; what stands along it moves in proportion."""
    before_km = _item(_item(document, "line"), "length_km")
    if isinstance(before_km, int | float) and isinstance(length_km, int | float) and before_km > 0:
        for place in (place for pattern in PLACES for place in places_of(document, pattern)):
            *above, last = place.split(".")
            container: Any = document
            for key in above:
                container = _item(container, key)
            position = _item(container, last)
            if isinstance(position, int | float):
                key_or_number: Any = int(last) if isinstance(container, list) else last
                # Multiplied first, what stands at the end stands there exactly.
                container[key_or_number] = position * length_km / before_km
    document["line"]["length_km"] = length_km


def draw_gradients(
    document: dict[str, Any], mean: float, deviation: float, number: int, design: Design
) -> None:
    """Draw a gradient profile with exactly this mean and standard deviation over the line. [‰]

    Gradients of neighbouring pieces are correlated: each is ρ = exp(-piece / correlation) times the
    one before, and a normal number.  Then the profile is shifted and stretched.
    """
    drawn = design.study.file.gradients
    length_km = document["line"]["length_km"]
    if drawn is None or not isinstance(length_km, int | float):
        return
    pieces = max(1, math.ceil(length_km / drawn.piece_km - 1e-9))
    if pieces == 1 and deviation > 0.0:
        problem = f"a line of {length_km:g} km is one piece, which has no standard deviation"
        remedy = "lower gradients.piece_km"
        place = (str(design.study.source), "gradients.piece_km", f"{drawn.piece_km:g}")
        raise ScenarioError([Finding(*place, problem, remedy)])
    from_km = np.arange(pieces) * drawn.piece_km
    share = np.diff(np.append(from_km, length_km)) / length_km
    rho = math.exp(-drawn.piece_km / drawn.correlation_km) if drawn.correlation_km > 0.0 else 0.0
    numbers = np.random.default_rng([design.study.file.seed, number]).standard_normal(pieces)
    numbers[1:] *= math.sqrt(1.0 - rho**2)
    profile = np.array(list(accumulate(numbers.tolist(), lambda last, new: rho * last + new)))
    profile -= share @ profile
    spread = math.sqrt(share @ profile**2)
    profile *= deviation / spread if spread > 0.0 else 0.0
    document["line"]["gradients"] = [
        {"from_km": km, "permille": permille}
        for km, permille in zip(from_km.tolist(), (profile + mean).tolist(), strict=True)
    ]
