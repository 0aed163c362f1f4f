r"""Running-time supplements: trains hold less speed than they might, as their timetables have them do.

A timetable gives a train more than its technical running time T from stop to stop, by a share p of it
and a time q for each length of way L,

.. math:: T' = T (1 + p) + q L.

Here the highest speed that is held between two stops is lowered, until a lone train at nominal voltage
takes T'; or the train uses the time in another way, see `model.spare_time`.  Without a supplement T' is
what its schedule leaves it, if its service asks for that.  Each such row of limits has a type of train
of its own.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tpss.driving.data import Stop
from tpss.model.held_limits import Held, with_types
from tpss.model.spare_time import Leg, Manner, way_that_takes
from tpss.run.lone import EmptyLine
from tpss.run.services import Service
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic
from tpss.step.model import Model
from tpss.units import si

CLOSE = 1e-4
"""A running time this close to the wanted one is taken, as a share of it."""

NO_TIME = -1.0
"""In place of a scheduled running time where there is none; equal to itself, as keys have to be. [s]"""

NARROW_M_S = 1e-6
"""Speeds that are closer to each other are the same. [m/s]"""


class Wanted(NamedTuple):
    """What a service asks of a stretch."""

    share: float
    """Supplement as a share of the technical running time. [1]"""
    s_per_m: float
    """Supplement for each length of way. [s/m]"""
    scheduled_s: float
    """Scheduled running time in place of both; `NO_TIME`: none. [s]"""
    manner: Manner
    """How its trains use the time."""

    def time_s(self, technical_s: float, length_m: float) -> float:
        """Time that the stretch is to take. [s]"""
        if self.scheduled_s != NO_TIME:
            return max(technical_s, self.scheduled_s)
        return technical_s * (1.0 + self.share) + length_m * self.s_per_m


class Stretch(NamedTuple):
    """The way of a kind of train from stop to stop."""

    train_type: int
    from_m: float
    to_m: float
    wanted: Wanted


def with_supplements(
    scenario: Scenario, model: Model, services: Sequence[Service]
) -> tuple[Model, list[Service]]:
    """A model whose trains use their spare time, and its services; as they are without any."""
    held: dict[Stretch, Held] = {}
    rows: dict[tuple[Stretch, ...], int] = {}
    changed = []
    for service, entry in zip(services, scenario.traffic, strict=True):
        if not entry.uses_spare_time:
            changed.append(service)
            continue
        stretches = stretches_of(service, entry)
        for stretch in stretches:
            if stretch not in held:
                held[stretch] = held_on(model, stretch, service.route)
        number = rows.setdefault(stretches, len(rows))
        changed.append(replace(service, train_type=model.types.size + number))
    profiles = [(stretches[0].train_type, [held[s] for s in stretches]) for stretches in rows]
    return (with_types(model, profiles) if profiles else model), changed


def stretches_of(service: Service, entry: Traffic) -> tuple[Stretch, ...]:
    """The way of a service from stop to stop, and what it asks of each part."""
    share, s_per_m = si(entry, "supplement_percent"), si(entry, "supplement_min_per_100km")
    manner = entry.spare_time or "held-speed"
    times_s = [NO_TIME] * (len(entry.stops) + 1)
    if not entry.has_supplement:
        times_s = [NO_TIME if m is None else 60.0 * m for m in entry.scheduled_running_min]
    stands_m = (service.start_m, *service.stops_m)
    return tuple(
        Stretch(service.train_type, *ends_m, Wanted(share, s_per_m, time_s, manner))
        for ends_m, time_s in zip(pairwise(stands_m), times_s, strict=True)
    )


def held_on(model: Model, stretch: Stretch, route: int) -> Held:
    """Speed that a train holds on a stretch, and where it begins to coast."""
    ends_m, wanted = (stretch.from_m, stretch.to_m), stretch.wanted
    if wanted.manner == "held-speed":
        return Held(*ends_m, held_speed(model, stretch, route), stretch.to_m)
    leg = Leg(model, stretch.train_type, *ends_m)
    wanted_s = wanted.time_s(leg.way().time_s, stretch.to_m - stretch.from_m)
    way = way_that_takes(leg, wanted_s, wanted.manner)
    return Held(*ends_m, way.speed_m_s, way.coasts_from_m)


def held_speed(model: Model, stretch: Stretch, route: int) -> float:
    """Highest speed that a train holds to take its supplement, found by bisection. [m/s]

    Its trials run in the steps of the model, as those of supplements always did; the other manners of
    `model.spare_time` take one passage each, which ends parts of a second elsewhere.

    Infinite if a lone train does not come to the end of the stretch, or has no supplement on it.
    """
    kind = model.types[stretch.train_type]
    length_m = stretch.to_m - stretch.from_m
    fastest = min(float(model.limits.value[kind.profile].max()), float(kind.highest_speed_m_s))
    technical_s = running_time(model, stretch, route, np.inf)
    wanted_s = stretch.wanted.time_s(technical_s, length_m)
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
    held = Held(stretch.from_m, stretch.to_m, speed_m_s, stretch.to_m)
    trial = with_types(model, [(stretch.train_type, [held])])
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
