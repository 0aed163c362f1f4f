"""Types of trains with limits of their own: speeds that they hold, and stretches on which they coast."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.driving.data import Profile, Profiles
from tpss.model.profiles import filled
from tpss.step.model import Model
from tpss.vehicle.train_type import TrainType

LEAST_SHARE = 0.25
"""Down to this share of the speed that it holds a train coasts, and then holds that. [1]"""


class Held(NamedTuple):
    """A stretch on which a train holds no more than a speed, and may coast at its end."""

    from_m: float
    """Position where it begins. [m]"""
    to_m: float
    """Where it ends. [m]"""
    speed_m_s: float
    """The speed; infinite: any. [m/s]"""
    coasts_from_m: float
    """Position from which it coasts; that of the end: it does not. [m]"""


def with_types(model: Model, rows: Sequence[tuple[int, Sequence[Held]]]) -> Model:
    """A model with more types of trains: each like one of its own, with other limits."""
    before, like = model.types.size, [number for number, _ in rows]
    types: Any = TrainType.blank(before + len(rows))
    types[:before], types[before:] = model.types, model.types[np.array(like)]
    types["profile"][before:] = len(model.limits.value) + np.arange(len(rows))
    own = model.types["profile"][like]
    seen = [
        capped(Profile(*(values[row] for values in model.limits)), held)
        for row, (_, held) in zip(own, rows, strict=True)
    ]
    coasting = [
        coasted(held, float(min(limits.value.max(), model.types[number].highest_speed_m_s)))
        for (number, held), limits in zip(rows, seen, strict=True)
    ]
    return model._replace(
        types=types,
        gradients=_repeated(model.gradients, own),
        neutral=_repeated(model.neutral, own),
        limits=_with_rows(model.limits, seen),
        coasting=_with_rows(model.coasting, coasting),
    )


def without_coasting(rows: int) -> Profiles:
    """`Model.coasting` of trains that do not coast."""
    return Profiles(np.full((rows, 1), -np.inf), np.full((rows, 1), np.inf))


def _repeated(profiles: Profiles, rows: npt.NDArray[np.int64]) -> Profiles:
    """Profiles with some of their rows once more."""
    return Profiles(*(np.concatenate([each, each[rows]]) for each in profiles))


def _with_rows(profiles: Profiles, more: Sequence[Profile]) -> Profiles:
    """Profiles with further rows."""
    rows = [*(Profile(*row) for row in zip(*profiles, strict=True)), *more]
    most = max(each.from_m.size for each in rows)
    return Profiles(
        from_m=np.array([filled(each.from_m, most, np.inf) for each in rows]),
        value=np.array([filled(each.value, most, each.value[-1]) for each in rows]),
    )


def capped(limits: Profile, held: Sequence[Held]) -> Profile:
    """Limits that are no higher than a speed on each stretch. [m/s]"""
    known = np.isfinite(limits.from_m)
    ends_m = [end_m for stretch in held for end_m in stretch[:2]]
    from_m = np.unique(np.append(limits.from_m[known], ends_m))
    stair = np.searchsorted(limits.from_m[known], from_m, side="right") - 1
    value = limits.value[np.maximum(stair, 0)]
    for begin_m, end_m, speed_m_s, _ in held:
        there = (from_m >= begin_m) & (from_m < end_m)
        value[there] = np.minimum(value[there], speed_m_s)
    changes = np.append(True, np.diff(value) != 0.0)
    return Profile(from_m[changes], value[changes])


def coasted(held: Sequence[Held], fastest_m_s: float) -> Profile:
    """Speeds down to which a train coasts on each stretch. [m/s]"""
    from_m, value = [-np.inf], [np.inf]
    for stretch in held:
        if stretch.coasts_from_m < stretch.to_m:
            from_m += [stretch.coasts_from_m, stretch.to_m]
            value += [LEAST_SHARE * min(stretch.speed_m_s, fastest_m_s), np.inf]
    return Profile(np.array(from_m), np.array(value))
