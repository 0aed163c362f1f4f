"""Stops of a train: how far the next one is, and what happens there."""

from tpss.driving.data import Stop
from tpss.kernel import at, fused, kernel
from tpss.record import Records
from tpss.vehicle.train import Phase, Train


@fused
def distance_to_stop(train: Train, stops: Records[Stop]) -> float:
    """Distance of a train to its next stop. [m]"""
    return stops[at(train.route), at(train.motion.next_stop)].position_m - train.motion.position_m


@kernel
def stand_at_stop(step: int, train: Train, stops: Records[Stop]) -> None:
    """A train has come to its stop: it has arrived, dwells, or continues at once."""
    motion = train.motion
    stop = stops[at(train.route), at(motion.next_stop)]
    motion.position_m = stop.position_m
    motion.speed_m_s = 0.0
    if stop.destination:
        motion.phase = Phase.ARRIVED
        train.timetable.arrival_step = step
        return
    motion.next_stop += 1
    motion.dwell_steps_left = stop.dwell_steps
    motion.phase = Phase.DWELLING if stop.dwell_steps > 0 else Phase.DRIVING
