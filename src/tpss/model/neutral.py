"""Neutral sections along the routes: where trains have no power, and whether they get through."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tpss.driving.data import WITH_POWER, Profile, Profiles
from tpss.kernel import plain
from tpss.model.profiles import Seen, filled
from tpss.model.resistance import resistance_of
from tpss.model.routes import Course
from tpss.numerics.staircase import index_at
from tpss.physics.running_resistance import gradient_force
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import NeutralSection
from tpss.step.model import Model
from tpss.units import si
from tpss.vehicle.train_type import TrainType

PIECE_M = 5.0
"""Length over which forces on a coasting train are taken to be constant. [m]"""


def build_neutral(scenario: Scenario, rows: Sequence[Seen]) -> Profiles:
    """Neutral sections as `driving.neutral` knows them, one row for each length of train and route.

    Parameters
    ----------
    scenario : Scenario
    rows : sequence of Seen
        What each row belongs to.
    """
    seen = [_along(row.courses, scenario) for row in rows]
    most = max(each.from_m.size for each in seen)
    return Profiles(
        from_m=np.array([filled(each.from_m, most, np.inf) for each in seen]),
        value=np.array([filled(each.value, most, WITH_POWER) for each in seen]),
    )


def _along(courses: Sequence[Course], scenario: Scenario) -> Profile:
    """Neutral sections along a route."""
    ends_m = [*(course.from_m for course in courses[1:]), math.inf]
    found = sorted(
        (max(begin_m, course.from_m), min(stop_m, end_m), si(each, "raise_s"))
        for course, end_m in zip(courses, ends_m, strict=True)
        for each in scenario.supply.neutral_sections
        if scenario.line_of(each) == course.line
        for begin_m, stop_m in [_bounds_m(each, course)]
        if stop_m > course.from_m and begin_m < end_m
    )
    from_m, value = [-math.inf], [WITH_POWER]
    for begin_m, stop_m, raise_s in found:
        if begin_m == from_m[-1]:  # it begins where another ends
            del from_m[-1], value[-1]
        from_m += [begin_m, stop_m]
        value += [raise_s, WITH_POWER]
    return Profile(np.array(from_m), np.array(value))


def _bounds_m(section: NeutralSection, course: Course) -> tuple[float, float]:
    """Positions at which trains of a course enter and leave a neutral section. [m]"""
    ends = sorted(course.position_m(1e3 * km) for km in (section.from_km, section.to_km))
    return ends[0], ends[1]


def is_in_neutral(position_m: float, kind: TrainType, model: Model) -> bool:
    """Whether a train with its head at a position has no power. [m]"""
    value, from_m = model.neutral.value[kind.profile], model.neutral.from_m[kind.profile]
    return bool(value[plain(index_at)(position_m, from_m)] >= 0.0)


def strands(
    kind: TrainType, starts_m: Sequence[float], model: Model
) -> Iterator[tuple[float, float, float]]:
    """Neutral sections that a train cannot coast through, however fast it is allowed to enter them.

    Parameters
    ----------
    kind : TrainType
    starts_m : sequence of float
        Where it starts and stops. [m]
    model : Model

    Yields
    ------
    tuple of float
        Where the section begins [m], the speed of which not even that is enough [m/s], and where the
        train comes to stand [m].
    """
    from_m, value = model.neutral.from_m[kind.profile], model.neutral.value[kind.profile]
    for k in np.flatnonzero(value >= 0.0):
        begin_m, stop_m = from_m[k], from_m[k + 1]
        before_m = [m for m in starts_m if m <= begin_m]
        if not before_m or begin_m >= max(starts_m):
            continue
        speed = _fastest_entry(begin_m, max(before_m), kind, model)
        stands_m = _coast(begin_m, stop_m, speed, kind, model)
        if stands_m is not None:
            yield float(begin_m), speed, stands_m


def _fastest_entry(begin_m: float, start_m: float, kind: TrainType, model: Model) -> float:
    """Highest speed at a position of a train that started at another. [m/s]"""
    limits = Profile(*(values[kind.profile] for values in model.limits))
    limit = limits.value[plain(index_at)(begin_m, limits.from_m)]
    if begin_m <= start_m:  # where no acceleration is too high, that times no distance is no number
        return 0.0
    reached = math.sqrt(2.0 * kind.highest_acceleration_m_s2 * (begin_m - start_m))
    return float(min(limit, kind.highest_speed_m_s, reached))


def _coast(
    begin_m: float, stop_m: float, speed_m_s: float, kind: TrainType, model: Model
) -> float | None:
    """Where a coasting train comes to stand between two positions; None: it gets through. [m]"""
    gradients = Profile(*(values[kind.profile] for values in model.gradients))
    limits = Profile(*(values[kind.profile] for values in model.limits))
    square = speed_m_s**2
    pieces = max(1, math.ceil((stop_m - begin_m) / PIECE_M))
    way_m = (stop_m - begin_m) / pieces
    for piece in range(pieces):
        here_m = begin_m + piece * way_m
        slope = gradients.value[plain(index_at)(here_m + way_m / 2.0, gradients.from_m)]
        force = resistance_of(math.sqrt(square), kind)
        force += plain(gradient_force)(kind.mass_kg, slope)
        square -= 2.0 * way_m * force / kind.inertia_kg
        if square <= 0.0:
            return here_m
        limit = limits.value[plain(index_at)(here_m, limits.from_m)]
        square = min(square, float(min(limit, kind.highest_speed_m_s)) ** 2)
    return None
