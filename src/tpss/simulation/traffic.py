"""Who is on the line: departures, braking plans towards the next stop, dwell, arrivals, motion."""

from typing import Any

from tpss.driving.braking import braking_plan, plan_length, shortest_stop
from tpss.driving.speed_limits import SLACK_M
from tpss.driving.within_step import braking_distance, way_of_part
from tpss.kernel import at, fused, inlined, kernel
from tpss.powerflow.network import Flow
from tpss.simulation.state import (
    ARRIVED,
    DRIVING,
    DWELLING,
    EVEN,
    GONE,
    LATEST,
    LIMIT_FIRST,
    PENDING,
    PLANNED,
    TO_LIMIT,
    TO_LIMIT_UNIFORMLY,
    USUAL,
    WITHIN_STEP,
    Model,
    Options,
    State,
)


@inlined
def depart(step: int, trains: Any) -> None:
    """Put trains on the line whose departure has come."""
    for i in range(trains.size):
        if trains[at(i)].phase == PENDING and trains[at(i)].departure_step <= step:
            trains[at(i)].phase = DRIVING


@inlined
def remove_arrived(trains: Any) -> None:
    """Take trains off the line that stand at their destination."""
    for i in range(trains.size):
        if trains[at(i)].phase == ARRIVED:
            trains[at(i)].phase = GONE


@kernel
def is_on_line(phase: int) -> bool:
    """Whether a train of this phase draws power."""
    return phase in (DRIVING, PLANNED, DWELLING)


@kernel
def list_trains(trains: Any, flow: Flow) -> int:
    """Bring the trains on the line to the front of `flow.standing`, in the order in which they stood
    there; return their number.
    """
    count = 0
    for k in range(trains.size):
        i = flow.standing[at(k)].train
        if is_on_line(trains[at(i)].phase):
            flow.standing[at(k)].train = flow.standing[at(count)].train
            flow.standing[at(count)].train = i
            count += 1
    return count


@fused
def distance_to_stop(train: Any, stops: Any) -> float:
    """Way of a train to its next stop. [m]"""
    return stops[at(train.route), at(train.next_stop)].position_m - train.position_m


@inlined
def least_room(speed_m_s: float, retardation_m_s2: float, options: Options) -> float:
    """Shortest way in which a train stops, by the choice of `Options.braking`. [m]

    A plan in whole steps makes up for a rounding; braking within steps begins in time for any.
    """
    if options.braking == WITHIN_STEP:
        return braking_distance(speed_m_s, retardation_m_s2)
    return shortest_stop(speed_m_s, retardation_m_s2, options.step_s) - SLACK_M


@inlined
def cannot_hold(train: Any) -> bool:
    """Whether a train that is to hold its speed before it brakes cannot do so."""
    if train.course != LATEST and train.course != TO_LIMIT:
        return False
    return bool(train.force_n < train.wanted_force_n * train.driven_share)


@inlined
def must_plan(train: Any, model: Model) -> bool:
    """Whether this step, driven as it is, would leave a train too little way to stop.

    Or whether a train that is to hold its speed before it brakes cannot do so.

    References
    ----------
    [Boullanger2009]_, ``final_brake`` of figure 3-7.
    """
    if cannot_hold(train):
        return True
    if train.phase != DRIVING or train.course == LIMIT_FIRST or train.speed_m_s <= 0.0:
        return False
    h, speed = model.options.step_s, max(train.next_speed_m_s, 0.0)
    way_m = h * (train.speed_m_s + train.next_speed_m_s) / 2.0
    if train.course == TO_LIMIT:
        way_m = way_of_part(train.speed_m_s, speed, train.hold_s, train.brake_s)
    retardation = model.types[at(train.train_type)].highest_retardation_m_s2
    needed_m = least_room(speed, retardation, model.options)
    return distance_to_stop(train, model.stops) - way_m < needed_m


@kernel
def begin_plan(train: Any, model: Model) -> None:
    """Put a train on its braking plan, from its present speed and position.

    Within steps, one that cannot hold its speed before it brakes is to brake evenly.
    """
    if train.course == TO_LIMIT and cannot_hold(train):
        train.course = TO_LIMIT_UNIFORMLY
        return
    if model.options.braking == WITHIN_STEP:
        train.course = EVEN if train.course == LATEST else USUAL
        train.phase = PLANNED
        return
    hold, first, full, last = braking_plan(
        train.speed_m_s,
        distance_to_stop(train, model.stops),
        model.types[at(train.train_type)].highest_retardation_m_s2,
        model.options.step_s,
    )
    train.phase = PLANNED
    train.plan_step = 0
    train.plan_hold = hold
    train.plan_first = first
    train.plan_full = full
    train.plan_last = last


@inlined
def move(step: int, train: Any, model: Model, state: State) -> None:
    """Bring a train to the next instant: v' = v + a h, x' = x + v h + a h²/2.

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30).
    """
    if train.phase == DWELLING:
        train.dwell_left -= 1
        if train.dwell_left <= 0:
            train.phase = DRIVING
        return
    train.position_m += model.options.step_s * (train.speed_m_s + train.next_speed_m_s) / 2.0
    train.speed_m_s = train.next_speed_m_s
    if train.phase != PLANNED:
        return
    if train.force_n < train.wanted_force_n:
        train.phase = DRIVING  # the machine could not follow: plan anew
        return
    train.plan_step += 1
    if train.plan_step == plan_length(train.plan_hold, train.plan_full, train.plan_last):
        error_m = abs(distance_to_stop(train, model.stops))
        state.clock[0].stop_error_m = max(state.clock[0].stop_error_m, error_m)
        stand_at_stop(step + 1, train, model)


@kernel
def stand_at_stop(step: int, train: Any, model: Model) -> None:
    """A train has come to its stop: it has arrived, dwells, or goes on at once."""
    stop = model.stops[at(train.route), at(train.next_stop)]
    train.position_m = stop.position_m
    train.speed_m_s = 0.0
    if stop.destination:
        train.phase = ARRIVED
        train.arrival_step = step
        return
    train.next_stop += 1
    train.dwell_left = stop.dwell_steps
    train.phase = DWELLING if stop.dwell_steps > 0 else DRIVING
