r"""Running-time supplements: trains hold less speed than they might, as their timetables have them do.

A timetable gives a train more than its technical running time T from stop to stop, by a share p of it
and a time q for each length of way L,

.. math:: T' = T (1 + p) + q L.

Here the highest speed that is held between two stops is lowered, until a lone train at nominal voltage
takes T'.  Each such row of limits has a type of train of its own.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.driving.data import Profile, Profiles, Stop
from tpss.model.profiles import filled
from tpss.run.lone import EmptyLine
from tpss.run.services import Service
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic
from tpss.step.model import Model
from tpss.units import si
from tpss.vehicle.train_type import TrainType

CLOSE = 1e-4
"""A running time this close to the wanted one is taken, as a share of it."""

NARROW_M_S = 1e-6
"""Speeds that are closer to each other are the same. [m/s]"""


class Supplement(NamedTuple):
    """What a service takes longer than it might."""

    share: float
    """Of the technical running time. [1]"""
    s_per_m: float
    """Time for each length of way. [s/m]"""


class Stretch(NamedTuple):
    """The way of a kind of train from stop to stop."""

    train_type: int
    from_m: float
    to_m: float
    supplement: Supplement


Held = tuple[float, float, float]
"""Beginning and end of a stretch [m], and the highest speed that is held on it [m/s]."""


def with_supplements(
    scenario: Scenario, model: Model, services: Sequence[Service]
) -> tuple[Model, list[Service]]:
    """A model whose trains take their supplements, and its services; as they are without any."""
    speeds: dict[Stretch, float] = {}
    rows: dict[tuple[Stretch, ...], int] = {}
    changed = []
    for service, entry in zip(services, scenario.traffic, strict=True):
        supplement = _supplement(entry)
        if supplement is None:
            changed.append(service)
            continue
        stands_m = (service.start_m, *service.stops_m)
        stretches = tuple(
            Stretch(service.train_type, *ends_m, supplement) for ends_m in pairwise(stands_m)
        )
        for stretch in stretches:
            if stretch not in speeds:
                speeds[stretch] = held_speed(model, stretch, service.route)
        number = rows.setdefault(stretches, len(rows))
        changed.append(replace(service, train_type=model.types.size + number))
    profiles = [
        (stretches[0].train_type, [(s.from_m, s.to_m, speeds[s]) for s in stretches])
        for stretches in rows
    ]
    return (with_types(model, profiles) if profiles else model), changed


def _supplement(entry: Traffic) -> Supplement | None:
    if not entry.has_supplement:
        return None
    return Supplement(si(entry, "supplement_percent"), si(entry, "supplement_min_per_100km"))


def held_speed(model: Model, stretch: Stretch, route: int) -> float:
    """Highest speed that a train holds to take its supplement, found by bisection. [m/s]

    Infinite if a lone train does not come to the end of the stretch, or has no supplement on it.
    """
    kind = model.types[stretch.train_type]
    length_m = stretch.to_m - stretch.from_m
    fastest = min(float(model.limits.value[kind.profile].max()), float(kind.highest_speed_m_s))
    technical_s = running_time(model, stretch, route, np.inf)
    wanted_s = (
        technical_s * (1.0 + stretch.supplement.share) + length_m * stretch.supplement.s_per_m
    )
    if not wanted_s > technical_s:
        return np.inf
    low, high = length_m / wanted_s, fastest
    while high - low > NARROW_M_S:
        speed = (low + high) / 2.0
        off_s = running_time(model, stretch, route, speed) - wanted_s
        if abs(off_s) <= CLOSE * wanted_s:
            return speed
        low, high = (low, speed) if off_s <= 0.0 else (speed, high)
    return high


def running_time(model: Model, stretch: Stretch, route: int, speed_m_s: float) -> float:
    """Time of a lone train at nominal voltage that holds no more than a speed; NaN: no end. [s]"""
    trial = with_types(model, [(stretch.train_type, [(stretch.from_m, stretch.to_m, speed_m_s)])])
    stops: Any = Stop.blank(1, 1)
    stops[0, 0] = (stretch.to_m, 0, 0.0, 0.0, True)
    trial = trial._replace(stops=stops, legs=trial.legs[route : route + 1])
    alone = Service(
        name="alone",
        train_type=model.types.size,
        route=0,
        start_m=stretch.from_m,
        stops_m=(stretch.to_m,),
        departures_s=(0.0,),
    )
    line = EmptyLine(trial)
    lone = line.train_of(alone)
    line.advance_to_end(lone)
    return line.arrival_s(lone)


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
    limits = [*(Profile(*row) for row in zip(*model.limits, strict=True)), *seen]
    most = max(each.from_m.size for each in limits)
    return model._replace(
        types=types,
        gradients=_repeated(model.gradients, own),
        neutral=_repeated(model.neutral, own),
        limits=Profiles(
            from_m=np.array([filled(each.from_m, most, np.inf) for each in limits]),
            value=np.array([filled(each.value, most, each.value[-1]) for each in limits]),
        ),
    )


def _repeated(profiles: Profiles, rows: npt.NDArray[np.int64]) -> Profiles:
    """Profiles with some of their rows once more."""
    return Profiles(*(np.concatenate([each, each[rows]]) for each in profiles))


def capped(limits: Profile, held: Sequence[Held]) -> Profile:
    """Limits that are no higher than a speed on each stretch. [m/s]"""
    known = np.isfinite(limits.from_m)
    ends_m = [end_m for stretch in held for end_m in stretch[:2]]
    from_m = np.unique(np.append(limits.from_m[known], ends_m))
    stair = np.searchsorted(limits.from_m[known], from_m, side="right") - 1
    value = limits.value[np.maximum(stair, 0)]
    for begin_m, end_m, speed_m_s in held:
        there = (from_m >= begin_m) & (from_m < end_m)
        value[there] = np.minimum(value[there], speed_m_s)
    changes = np.append(True, np.diff(value) != 0.0)
    return Profile(from_m[changes], value[changes])
