"""The traffic as services: who departs when, and who is on the line from the start."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tpss.driving.data import MotionModel, Options
from tpss.record import Records
from tpss.run.delays import Delays
from tpss.vehicle.train import Motion, Phase, Plan, Train

DEPARTURE_ROUNDING_S = 1e-6
"""A train departs at the first instant that is no more than this before its time. [s]"""


@dataclass(frozen=True)
class Service:
    """Trains of one kind on one route; positions are along it, see `model.routes`.

    Departures repeat every `headway_s` from `first_s` on, or are those of `departures_s`.
    """

    name: str
    train_type: int
    route: int
    start_m: float
    stops_m: tuple[float, ...]
    headway_s: float = math.inf
    first_s: float = 0.0
    departures_s: tuple[float, ...] = ()
    is_one_train: bool = False
    """Whether it is a single train, which has its name."""
    delays: Delays | None = None
    origin: str = ""
    """Station where its trains begin."""
    starts_apart_s: float = 0.0
    """Least time between two trains that begin there. [s]"""
    already_running: bool = False
    initial: tuple[tuple[float, float], ...] = ()
    """Position [m] and speed [m/s] of each train on the line at the start."""

    def delay_s(self, number: int) -> float:
        """How much later than scheduled the n-th train departs, counted from 1. [s]"""
        return 0.0 if self.delays is None else self.delays.of(self.name_of(number))

    def departure_times_s(self, until_s: float) -> Iterator[float]:
        """Scheduled times of departure before `until_s`, ascending. [s]"""
        if self.departures_s:
            yield from (time for time in self.departures_s if time < until_s)
            return
        count = 0
        while (time := self.first_s + count * self.headway_s) < until_s:
            yield time
            count += 1

    @property
    def departs_by_schedule(self) -> bool:
        """Whether scheduled times stay where a departure is late; they follow it otherwise."""
        return self.is_one_train or self.delays is not None

    def name_of(self, number: int) -> str:
        """Name of the train that departs as the n-th, counted from 1."""
        return self.name if self.is_one_train else f"{self.name} {number}"

    def departures_before(self, until_s: float) -> int:
        """Number of departures scheduled before `until_s`."""
        if self.departures_s:
            return sum(time < until_s for time in self.departures_s)
        return max(0, math.ceil((until_s - self.first_s) / self.headway_s))


class ScheduledTrain(NamedTuple):
    """A train as it enters a run; from `phase` on the fields are those of `Motion`, then of `Plan`."""

    name: str
    service: str
    train_type: int
    route: int
    departure_step: int
    departure_wait_s: float = 0.0
    """Time in that step until it departs. [s]"""
    delay_s: float = 0.0
    """How much later than scheduled that is, where the schedule does not follow the departure. [s]"""
    phase: Phase = Phase.PENDING
    position_m: float = 0.0
    speed_m_s: float = 0.0
    gradient: int = 0
    next_stop: int = 0
    dwell_steps_left: int = 0
    wait_s: float = 0.0
    under_way_s: float = 0.0
    power_off_s: float = 0.0
    authority_m: float = math.inf
    ceiling_m_s: float = math.inf
    plan_step: int = 0
    plan_hold_steps: int = 0
    plan_first: float = 0.0
    plan_full_steps: int = 0
    plan_last: float = 0.0


def departure(time_s: float, options: Options) -> tuple[int, float]:
    """Step of a departure, and the time in it until then: none where trains move in steps. [s]"""
    step_s = options.step_s
    if options.motion == MotionModel.STEPPED:
        return max(0, math.ceil((time_s - DEPARTURE_ROUNDING_S) / step_s)), 0.0
    step = math.floor((time_s + DEPARTURE_ROUNDING_S) / step_s)
    wait_s = time_s - step * step_s
    return step, wait_s if wait_s > DEPARTURE_ROUNDING_S else 0.0


def departing_trains(
    services: list[Service], options: Options, first: int, last: int
) -> list[ScheduledTrain]:
    """Trains that depart in steps `first` to `last` - 1, by time and, at the same time, by service."""
    trains = []
    for service, number, time_s, delay_s in _departures(services, last * options.step_s):
        step, wait_s = departure(time_s + delay_s, options)
        if first <= step < last:
            if service.departs_by_schedule and options.motion == MotionModel.STEPPED:
                delay_s = step * options.step_s - time_s
            trains.append(
                ScheduledTrain(
                    name=service.name_of(number),
                    service=service.name,
                    train_type=service.train_type,
                    route=service.route,
                    departure_step=step,
                    departure_wait_s=wait_s,
                    delay_s=delay_s if service.departs_by_schedule else 0.0,
                    position_m=service.start_m,
                )
            )
    return sorted(trains, key=lambda train: (train.departure_step, train.departure_wait_s))


def _departures(
    services: list[Service], until_s: float
) -> Iterator[tuple[Service, int, float, float]]:
    """Departures scheduled before a time: service, number of the train, time and delay. [s]"""
    every = [
        (service, number, time_s, service.delay_s(number))
        for service in services
        for number, time_s in enumerate(service.departure_times_s(until_s), 1)
    ]
    if not any(service.starts_apart_s for service in services):
        yield from every
        return
    free_s: dict[str, float] = {}
    for service, number, time_s, delay_s in sorted(every, key=lambda each: each[2] + each[3]):
        starts_s = max(time_s + delay_s, free_s.get(service.origin, -math.inf))
        free_s[service.origin] = starts_s + service.starts_apart_s
        yield service, number, time_s, starts_s - time_s


def placed_trains(service: Service) -> list[ScheduledTrain]:
    """Trains that a service names as on the line at the start, each heading for its next stop."""
    return [
        ScheduledTrain(
            name=f"{service.name} initial {number}",
            service=service.name,
            train_type=service.train_type,
            route=service.route,
            departure_step=0,
            phase=Phase.DRIVING,
            position_m=position_m,
            speed_m_s=speed_m_s,
            under_way_s=math.inf,
            next_stop=next(i for i, stop_m in enumerate(service.stops_m) if stop_m > position_m),
        )
        for number, (position_m, speed_m_s) in enumerate(service.initial, 1)
    ]


def train_records(trains: list[ScheduledTrain], voltage_v: float) -> Records[Train]:
    """Records of the trains, in their order, with a first guess of their voltage. [V]"""
    records = Train.blank(len(trains))
    fields = np.asarray(records)  # whose fields take numpy a tenth of the time
    for (part, field), column in zip(_ENTERING, list(zip(*trains, strict=True))[2:], strict=False):
        if any(column):  # most of them are zero
            (fields[part] if part else fields)[field] = column
    fields["timetable"]["arrival_step"] = -1
    fields["demand"]["voltage_v"] = fields["line_voltage_v"] = voltage_v
    fields["demand"]["terms_speed_m_s"] = -1.0
    fields["allowed_current_a"] = math.inf
    return records


_ENTERING = (
    ("", "train_type"),
    ("", "route"),
    ("timetable", "departure_step"),
    ("timetable", "departure_wait_s"),
    ("timetable", "delay_s"),
    *(("motion", name) for name in Motion.dtype.names or ()),
    *(("plan", name) for name in Plan.dtype.names or ()),
)
"""Part and name of the fields of `Train` that follow the names in a `ScheduledTrain`."""


def train_at(record: Any, train: ScheduledTrain, number: int) -> ScheduledTrain:
    """A train where it once was, by its record, ready to enter another run at its start."""
    name = f"{train.service} initial {number}"
    motion, plan = record["motion"].tolist(), record["plan"].tolist()
    return ScheduledTrain(
        name, train.service, train.train_type, train.route, 0, 0.0, 0.0, *motion, *plan
    )
