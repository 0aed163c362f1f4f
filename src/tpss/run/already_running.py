"""Trains that stand along the line when a run begins: those of services that run already, and others."""

import math
from collections.abc import Hashable
from dataclasses import replace
from itertools import count

from tpss.driving.data import MotionModel, Options
from tpss.driving.passage import LONGEST_PHASE_S
from tpss.errors import TooLargeError
from tpss.kept import Kept, content_of
from tpss.kernel import plain
from tpss.run.lone import EmptyLine, LoneTrain
from tpss.run.services import (
    DEPARTURE_ROUNDING_S,
    ScheduledTrain,
    Service,
    placed_trains,
    train_at,
)
from tpss.step.model import Model, driving_data

MOST_PHASES = 3e8
"""Phases of motion of all lone trains after which a start is refused: some minutes of computing."""

MOST_PHASES_ALONE = 3e8
"""Phases of motion after which one lone train is taken not to come to its destination."""


def trains_on_line(model: Model, services: list[Service]) -> list[ScheduledTrain]:
    """Trains that stand along the line at the start.

    Raises
    ------
    TooLargeError
        It would take too long to find out where they stand.
    """
    return [
        train
        for service in services
        for train in (
            trains_already_running(model, service)
            if service.already_running
            else placed_trains(service)
        )
    ]


def trains_already_running(model: Model, service: Service) -> list[ScheduledTrain]:
    """Trains of a service as if it had run for ever: those that departed before the start.

    They do not know the supply: cases with the same trains on the same line have them in common.

    Raises
    ------
    TooLargeError
        As `find_already_running`.
    """
    key = _known_to_a_lone_train(model, service)
    return list(_kept.of(key, lambda: tuple(find_already_running(model, service))))


_kept = Kept[tuple[ScheduledTrain, ...]](256)


def _known_to_a_lone_train(model: Model, service: Service) -> Hashable:
    """What drivers know, and the voltage: all that decides where trains stand that are alone."""
    known = (*plain(driving_data)(model), model.points)
    return content_of(known), model.network.system.nominal_voltage_v, replace(service, delays=None)


def find_already_running(model: Model, service: Service) -> list[ScheduledTrain]:
    """`trains_already_running`, found by the runs of lone trains.

    The n-th stands where a lone train at nominal voltage is n headways after its departure, with its
    speed and its progress in a dwell or a braking plan.  Where trains depart within a step, the lone
    train departs so that the start is one of its instants: there are as many lone trains as there are
    remainders of n headways in a step, and each runs as far as it is asked for.

    Raises
    ------
    TooLargeError
        So many of them run so far that it would take minutes, or one does not come to its end.
    """
    line = EmptyLine(model)
    demand_few_phases(line, service)
    most_steps = MOST_PHASES_ALONE / phases_of_step(model.options)
    lone_trains: dict[float, LoneTrain] = {}
    found: list[ScheduledTrain] = []
    for number in count(1):
        step, wait_s = _instant(number, service, model.options)
        if wait_s not in lone_trains:
            lone_trains[wait_s] = line.train_of(service, wait_s)
        lone = lone_trains[wait_s]
        if step > most_steps:
            raise never_there(service, step * model.options.step_s)
        line.advance(lone, step)
        if not lone.is_under_way(step):
            break
        if step >= 1:
            found.append(train_at(lone.records[0], lone.train, len(found) + 1))
    return found


def phases_of_step(options: Options) -> float:
    """Phases of motion that a step has at most, but for stops and changes of limits."""
    return max(1.0, options.step_s / LONGEST_PHASE_S)


def never_there(service: Service, under_way_s: float) -> TooLargeError:
    """What is said of a service whose trains do not come to their destination in a time. [s]"""
    return TooLargeError(
        f"traffic {service.name!r}, already_running: a train alone on the line has not arrived after "
        f"{under_way_s / 3600.0:.0f} h, and to look further takes minutes before the simulation begins; "
        "take a train that gets on faster, a longer time_step_min, or already_running = false"
    )


def _instant(number: int, service: Service, options: Options) -> tuple[int, float]:
    """Step at whose start the n-th train has been under way for its time, and its wait before. [s]"""
    since_s = number * service.headway_s - service.first_s
    steps = since_s / options.step_s
    if options.motion == MotionModel.STEPPED:
        return round(steps), 0.0
    step = math.ceil(steps - DEPARTURE_ROUNDING_S / options.step_s)
    wait_s = step * options.step_s - since_s
    return step, wait_s if wait_s > DEPARTURE_ROUNDING_S else 0.0


def demand_few_phases(line: EmptyLine, service: Service) -> None:
    """Refuse a service whose trains it would take minutes to find.

    Raises
    ------
    TooLargeError
    """
    options = line.model.options
    if all(_instant(number, service, options)[1] == 0.0 for number in (1, 2)):
        return  # of a headway in whole steps all trains are one lone train
    first = line.train_of(service)
    line.advance_to_end(first)
    most_steps = MOST_PHASES / phases_of_step(options)
    steps, furthest = 0, dict[float, int]()
    for number in count(1):
        step, wait_s = _instant(number, service, options)
        if step > first.step:
            return
        steps += step - furthest.get(wait_s, 0)
        furthest[wait_s] = step
        if steps > most_steps:
            break
    way_s = first.step * options.step_s
    raise TooLargeError(
        f"traffic {service.name!r}, already_running: about {way_s / service.headway_s:.0f} trains would "
        f"be under way at the start, for up to {way_s / 3600.0:.0f} h.  As headway_min = "
        f"{service.headway_s / 60.0:g} is no multiple of time_step_min = {options.step_s / 60.0:g}, "
        "each of them is another run, and all of them take minutes before the simulation begins; take a "
        "headway_min that is a multiple of time_step_min, a longer one, or already_running = false"
    )
