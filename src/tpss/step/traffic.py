"""Who is on the line: departures and arrivals, and each train's motion to the next instant."""

import math

from tpss.driving import continuous
from tpss.driving.data import DrivingData, MotionModel
from tpss.driving.manners import move
from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Flow
from tpss.record import Records
from tpss.step.recording import Recording
from tpss.step.state import Clock
from tpss.vehicle.train import Phase, Train, is_on_line


@inlined
def depart(step: int, trains: Records[Train]) -> None:
    """Put trains on the line whose departure has come."""
    for i in range(trains.size):
        train = trains[at(i)]
        if train.motion.phase == Phase.PENDING and train.timetable.departure_step <= step:
            train.motion.phase = Phase.DRIVING
            train.motion.wait_s = train.timetable.departure_wait_s
            train.motion.under_way_s = train.timetable.delay_s - train.timetable.departure_wait_s


@kernel
def withhold(step: int, step_s: float, trains: Records[Train], recording: Recording) -> bool:
    """Take trains off the line that would depart after the end of a step that ends the run.

    Return whether there are any.
    """
    found = False
    for i in range(trains.size):
        train = trains[at(i)]
        waits = train.timetable.departure_wait_s >= step_s
        if train.timetable.departure_step == step and waits and train.motion.phase == Phase.DRIVING:
            train.motion.phase = Phase.PENDING
            recording.trains[at(step), at(i)].route_position = math.nan
            recording.trains[at(step), at(i)].speed = math.nan
            found = True
    return found


@inlined
def remove_arrived(trains: Records[Train]) -> None:
    """Take trains off the line that stand at their destination."""
    for i in range(trains.size):
        if trains[at(i)].motion.phase == Phase.ARRIVED:
            trains[at(i)].motion.phase = Phase.GONE


@kernel
def list_trains(trains: Records[Train], flow: Flow) -> int:
    """Bring the trains on the line to the front of `flow.standing`, in the order in which they stood
    there; return their number.
    """
    count = 0
    for k in range(trains.size):
        i = flow.standing[at(k)].train
        if is_on_line(trains[at(i)].motion.phase):
            flow.standing[at(k)].train = flow.standing[at(count)].train
            flow.standing[at(count)].train = i
            count += 1
    return count


@inlined
def move_train(step: int, train: Train, data: DrivingData, clock: Clock) -> None:
    """Bring a train to the next instant; note how far from its stop it came to stand."""
    if data.options.motion == MotionModel.CONTINUOUS:
        clock.stop_error_m = max(clock.stop_error_m, continuous.move(step, train, data))
    elif train.motion.phase == Phase.DWELLING:
        train.motion.dwell_steps_left -= 1
        if train.motion.dwell_steps_left <= 0:
            train.motion.phase = Phase.DRIVING
    else:
        clock.stop_error_m = max(clock.stop_error_m, move(step, train, data))
    train.motion.under_way_s += data.options.step_s
