r"""Gradients and speed limits of routes as trains of a length see them, over their heads' positions.

Positions are along the routes, see `model.routes`: trains that run towards falling kilometres see the
mirrored line, and where a route leads to another line, what is ahead is that line's.

A limit rises for a train once its tail has passed: it has to keep the lowest limit under it.  The
gradient acts on all of its mass, taken as spread evenly over its length L,

.. math:: \bar\alpha(x) = \frac{1}{L} \int_{x - L}^{x} \alpha(s) \, ds,

which changes linearly over L after each change of the line's gradient.  Drivers know staircases: such
a ramp becomes `PIECES` stairs, each with the mean over it, so that the climb over whole stairs is exact.

Curves oppose trains, which go towards higher positions, as gradients do, and are added to them.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.driving.data import Profile, Profiles
from tpss.kernel import plain
from tpss.model.routes import Course, Running
from tpss.physics.running_resistance import by_radius, curve_resistance
from tpss.scenario.line import CurveResistance, Line, TrackCurve
from tpss.units import si, si_of_each

Array = npt.NDArray[np.float64]

PIECES = 16
"""Stairs over the length of a train after a change of gradient."""


class Seen(NamedTuple):
    """What a row of the profiles belongs to."""

    length_m: float
    """Length of trains. [m]"""
    courses: tuple[Course, ...]
    """Courses of their route."""


def rows_seen(running: Sequence[Running]) -> list[Seen]:
    """Rows of the profiles, each once."""
    return list(dict.fromkeys(row_seen(each) for each in running))


def row_seen(running: Running) -> Seen:
    """Row of the profiles of a train on a route."""
    return Seen(si(running.train, "length_m"), running.courses)


def build_profiles(lines: Mapping[str, Line], rows: Sequence[Seen]) -> tuple[Profiles, Profiles]:
    """Gradients [1] and speed limits [m/s] of lines, a row for each length of train and route."""
    seen = {
        key: _profiles_of(lines[key[0]] if key[1] > 0.0 else lines[key[0]].mirrored())
        for row in rows
        for key in ((course.line, course.sign) for course in row.courses)
    }
    routes = {
        courses: [
            _joined(courses, [seen[course.line, course.sign][which] for course in courses])
            for which in (0, 1)
        ]
        for courses in dict.fromkeys(row.courses for row in rows)
    }
    return (
        _rows([routes[row.courses][0] for row in rows], mean_under_train, rows),
        _rows([routes[row.courses][1] for row in rows], lowest_under_train, rows),
    )


def _joined(courses: Sequence[Course], profiles: Sequence[Profile]) -> Profile:
    """The profile of a route from those of its courses, each over plus or minus the places there."""
    if len(courses) == 1:
        return profiles[0]
    from_m, value = [], []
    ends_m = [*(course.from_m for course in courses[1:]), np.inf]
    for course, end_m, profile in zip(courses, ends_m, profiles, strict=True):
        along_m = profile.from_m - course.sign * course.offset_m
        first = max(int(np.searchsorted(along_m, course.from_m, side="right")) - 1, 0)
        begin_m = max(course.from_m, min(along_m[0], end_m - 1.0))
        last = int(np.searchsorted(along_m, end_m))
        from_m.append(np.append(begin_m, along_m[first + 1 : last]))
        value.append(np.append(profile.value[first], profile.value[first + 1 : last]))
    return Profile(np.concatenate(from_m), np.concatenate(value))


def _profiles_of(line: Line) -> tuple[Profile, Profile]:
    """Gradients and limits under a point. [1], [m/s]"""
    gradients = Profile(
        from_m=np.array(si_of_each(line.gradients, "from_km")),
        value=np.array([item.permille for item in line.gradients]) * 1e-3,
    )
    if line.curves:
        gradients = with_curves(gradients, line.curves, line.curve_resistance)
    limits = Profile(
        from_m=np.array(si_of_each(line.speed_limits, "from_km")),
        value=np.array(si_of_each(line.speed_limits, "speed_kmh")),
    )
    return gradients, limits


def _rows(
    profiles: Sequence[Profile],
    under_train: Callable[[Profile, float], Profile],
    rows: Sequence[Seen],
) -> Profiles:
    """What each row sees of its profile, in rows of the same number of stairs."""
    seen = [
        under_train(profile, row.length_m) if row.length_m > 0.0 else profile
        for profile, row in zip(profiles, rows, strict=True)
    ]
    most = max(each.from_m.size for each in seen)
    return Profiles(
        from_m=np.array([filled(each.from_m, most, np.inf) for each in seen]),
        value=np.array([filled(each.value, most, float(each.value[-1])) for each in seen]),
    )


def filled(values: Array, count: int, rest: float) -> Array:
    """A row of so many values, the rest of one kind."""
    return np.append(values, np.full(count - values.size, rest))


def with_curves(
    gradients: Profile, curves: Sequence[TrackCurve], formula: CurveResistance | None = None
) -> Profile:
    """Gradients and resistances of curves, as shares of the weight of what is there. [1]"""
    begin_m, end_m = (np.array(si_of_each(curves, name)) for name in ("from_km", "to_km"))
    from_m = np.unique(np.concatenate([gradients.from_m, begin_m, end_m]))
    stair = np.maximum(np.searchsorted(gradients.from_m, from_m, side="right") - 1, 0)
    value = gradients.value[stair]
    for begin, end, curve in zip(begin_m, end_m, curves, strict=True):
        value[(from_m >= begin) & (from_m < end)] += _resistance(curve, formula)
    if from_m[0] == begin_m[0]:  # the first stair holds before it too, where there is no curve
        from_m, value = np.append(from_m[0] - 1.0, from_m), np.append(gradients.value[0], value)
    return Profile(from_m, value)


def _resistance(curve: TrackCurve, formula: CurveResistance | None) -> float:
    if formula is None:
        return plain(curve_resistance)(curve.radius_m)
    return plain(by_radius)(curve.radius_m, formula.permille_m, formula.offset_m)


def lowest_under_train(limits: Profile, length_m: float) -> Profile:
    """Lowest of the limits under a train. [m/s]"""
    left_m = np.append(limits.from_m[1:] + length_m, np.inf)
    from_m = np.unique(np.append(limits.from_m, left_m[:-1]))
    lowest = np.array(
        [limits.value[(limits.from_m <= head_m) & (head_m < left_m)].min() for head_m in from_m]
    )
    changes = np.append(True, np.diff(lowest) != 0.0)
    return Profile(from_m[changes], lowest[changes])


def mean_under_train(gradients: Profile, length_m: float) -> Profile:
    """Mean of the gradients under a train. [1]"""
    if gradients.from_m.size == 1:
        return gradients
    ramps = gradients.from_m[1:, None] + np.linspace(0.0, length_m, PIECES + 1)
    from_m = np.unique(ramps)
    mean = (climb_to(from_m, gradients) - climb_to(from_m - length_m, gradients)) / length_m
    inner = (mean[:-1] + mean[1:]) / 2.0
    value = np.concatenate([gradients.value[:1], inner, gradients.value[-1:]])
    return Profile(np.append(gradients.from_m[0], from_m), value)


def climb_to(position_m: Array, gradients: Profile) -> Array:
    """Altitude over that of the profile's first position. [m]"""
    from_m, gradient = gradients
    altitude_m = np.append(0.0, np.cumsum(np.diff(from_m) * gradient[:-1]))
    stair = np.maximum(np.searchsorted(from_m, position_m, side="right") - 1, 0)
    climbed: Array = altitude_m[stair] + gradient[stair] * (position_m - from_m[stair])
    return climbed
