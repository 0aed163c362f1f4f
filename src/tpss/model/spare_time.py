r"""How trains use the time that their timetables leave them, and what energy that takes.

A train that has more time from stop to stop than it needs may hold a lower speed, or coast before it
brakes, or do both.  Of all pairs of a held speed V and a place x where the power is shut off that take
the wanted time T,

.. math:: t(V, x) = T,

one takes the least energy.  For each V the place is found as the root of t, which falls with x; the
energy is then a function of V alone, of which the least value is looked for between the held speed
that takes T without coasting, and the highest speed.  On a level or evenly inclined way the best way of
all consists of these parts: all power, a held speed, coasting, all brakes [Howlett1995]_.

Time and energy are those of a lone train at nominal voltage, on one passage from stop to stop.
"""

import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import numpy as np

from tpss.driving.alone import drive_alone
from tpss.driving.data import DrivingData, Profile, Profiles, Stop
from tpss.model.held_limits import Held, capped, coasted
from tpss.model.searches import lowest_between, root_between
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.run.services import ScheduledTrain, train_records
from tpss.step.model import Model
from tpss.vehicle.train import Phase

Manner = Literal["held-speed", "coasting", "least-energy"]
"""How spare time is used."""

LONG_S = 86_400.0
"""A train that has not arrived after this time does not. [s]"""

LONGER = 2.0
"""A way that takes so many times the wanted time is too long, however long it takes. [1]"""

CLOSE_M = 1e-2
"""Places that are closer to each other are the same. [m]"""

CLOSE_M_S = 1e-2
"""Speeds likewise. [m/s]"""

TRIALS = 8
"""Speeds of the grid among which the best one is looked for first."""


class Way(NamedTuple):
    """How a train goes from one stop to the next."""

    speed_m_s: float
    """Speed that it holds; infinite: the limits. [m/s]"""
    coasts_from_m: float
    """Position from which it coasts; that of the stop: it does not. [m]"""
    time_s: float
    """Time from stop to stop; infinite: it does not arrive. [s]"""
    energy_j: float
    """Energy at the pantograph, less what it feeds back. [J]"""


class Leg:
    """The way of a kind of train from stop to stop, alone and at nominal voltage.

    Parameters
    ----------
    model : Model
    train_type : int
        Index of the kind of train.
    from_m, to_m : float
        Positions of the stops. [m]
    """

    def __init__(self, model: Model, train_type: int, from_m: float, to_m: float) -> None:
        stops: Any = Stop.blank(1, 1)
        stops[0, 0] = (to_m, 0, 0.0, 0.0, True)
        types: Any = model.types[train_type : train_type + 1].copy()
        row, types["profile"] = model.types[train_type].profile, 0
        own = slice(row, row + 1)
        self._limits = Profile(*(values[row] for values in model.limits))
        self._longest_s = LONG_S
        self._data = DrivingData(
            options=model.options._replace(step_s=LONG_S),
            gradients=Profiles(*(values[own] for values in model.gradients)),
            limits=Profiles(*(values[own] for values in model.limits)),
            neutral=Profiles(*(values[own] for values in model.neutral)),
            coasting=Profiles(*(values[own] for values in model.coasting)),
            stops=stops,
            types=types,
        )
        self._points, self._scratch = model.points, np.zeros(SCRATCH_SHAPE)
        self._voltage_v = model.network.system.nominal_voltage_v
        self.from_m, self.to_m = from_m, to_m
        highest, machine = float(self._limits.value.max()), float(types[0].highest_speed_m_s)
        self.fastest_m_s = min(highest, machine)
        train = ScheduledTrain("", "", 0, 0, 0, phase=Phase.DRIVING, position_m=from_m)
        self._records = train_records([train], self._voltage_v)

    def demand_no_more(self, time_s: float) -> None:
        """Follow ways no longer than a time: one that takes more does not arrive. [s]"""
        self._longest_s = min(LONG_S, time_s)
        options = self._data.options._replace(step_s=self._longest_s)
        self._data = self._data._replace(options=options)

    def later(self, speed_m_s: float, coasts_from_m: float, wanted_s: float) -> float:
        """By what a way takes more than a time; finite, also if the train does not arrive. [s]"""
        return min(self.way(speed_m_s, coasts_from_m).time_s, self._longest_s) - wanted_s

    def way(self, speed_m_s: float = math.inf, coasts_from_m: float = math.inf) -> Way:
        """The way of a train that holds no more than a speed, and coasts from a position on."""
        coasts_from_m = min(coasts_from_m, self.to_m)
        held = [Held(self.from_m, self.to_m, speed_m_s, coasts_from_m)]
        data = self._data._replace(
            limits=_one_row(capped(self._limits, held)),
            coasting=_one_row(coasted(held, self.fastest_m_s)),
        )
        drive_alone(self._voltage_v, self._records, data, self._points, self._scratch)
        passage = self._records[0].passage
        if passage.motion.phase != Phase.ARRIVED:
            return Way(speed_m_s, coasts_from_m, math.inf, math.inf)
        energy_j = float(passage.active_j - passage.offered_j)
        time_s = self._longest_s - float(passage.stood_s)
        return Way(speed_m_s, coasts_from_m, time_s, energy_j)


def _one_row(profile: Profile) -> Profiles:
    return Profiles(profile.from_m[np.newaxis], profile.value[np.newaxis])


def way_that_takes(leg: Leg, wanted_s: float, manner: Manner) -> Way:
    """The way by which a train uses its time; as fast as it can, if it has none to spare.

    Parameters
    ----------
    leg : Leg
    wanted_s : float
        Time from stop to stop. [s]
    manner : str
        By a lower held speed, by coasting before the stop, or by both, at the least energy.
    """
    fastest = leg.way()
    if not fastest.time_s < wanted_s:
        return fastest
    leg.demand_no_more(LONGER * wanted_s)
    return _MANNERS[manner](leg, wanted_s)


def _by_held_speed(leg: Leg, wanted_s: float) -> Way:
    def later_at(speed_m_s: float) -> float:
        return leg.later(speed_m_s, leg.to_m, wanted_s)

    slowest = (leg.to_m - leg.from_m) / wanted_s
    if not leg.way(slowest).time_s > wanted_s:
        return leg.way(slowest)
    return leg.way(root_between(later_at, slowest, leg.fastest_m_s, CLOSE_M_S / 10.0))


def _by_coasting(leg: Leg, wanted_s: float, speed_m_s: float = math.inf) -> Way:
    """The way of a train that holds a speed, and then coasts so long that it takes the time."""

    def later_from(place_m: float) -> float:
        return leg.later(speed_m_s, place_m, wanted_s)

    if not leg.way(speed_m_s, leg.from_m).time_s > wanted_s:
        return leg.way(speed_m_s, leg.from_m)
    if not leg.way(speed_m_s).time_s < wanted_s:
        return leg.way(speed_m_s)
    return leg.way(speed_m_s, root_between(later_from, leg.from_m, leg.to_m, CLOSE_M))


def _at_least_energy(leg: Leg, wanted_s: float) -> Way:
    held = _by_held_speed(leg, wanted_s)
    tried = {held.speed_m_s: held}

    def energy_j(speed_m_s: float) -> float:
        tried.setdefault(speed_m_s, _by_coasting(leg, wanted_s, speed_m_s))
        return tried[speed_m_s].energy_j

    # 1. A grid of speeds, as changing limits and gradients may leave several valleys.
    grid = [float(v) for v in np.linspace(held.speed_m_s, leg.fastest_m_s, TRIALS)]
    best = int(np.argmin([energy_j(speed) for speed in grid]))
    # 2. The valley around the best of them.
    bounds = grid[max(0, best - 1)], grid[min(TRIALS - 1, best + 1)]
    lowest_between(energy_j, *bounds, CLOSE_M_S)
    return min(tried.values(), key=lambda way: way.energy_j)


_MANNERS: dict[Manner, Callable[[Leg, float], Way]] = {
    "held-speed": _by_held_speed,
    "coasting": _by_coasting,
    "least-energy": _at_least_energy,
}
