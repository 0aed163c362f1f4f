"""Stops of a train: how far the next one is, and what happens there."""

import math

from tpss.driving.data import Stop
from tpss.kernel import at, fused, kernel
from tpss.record import Records
from tpss.vehicle.train import Phase, Train

ROUNDING = 1e-9
"""A wait that exceeds whole steps by less than this share of a step ends with them."""


@fused
def distance_to_stop(train: Train, stops: Records[Stop]) -> float:
    """Distance of a train to its next stop. [m]"""
    return stops[at(train.route), at(train.motion.next_stop)].position_m - train.motion.position_m


@kernel
def stand_at_stop(step: int, step_s: float, train: Train, stops: Records[Stop]) -> None:
    """A train has come to its stop, at the end of a step: it has arrived, dwells, or goes on at once."""
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
    early_s = stop.leaves_after_s - (motion.under_way_s + step_s)
    if early_s > stop.dwell_steps * step_s:
        motion.dwell_steps_left = math.ceil(early_s / step_s - ROUNDING)
    motion.phase = Phase.DWELLING if motion.dwell_steps_left > 0 else Phase.DRIVING
