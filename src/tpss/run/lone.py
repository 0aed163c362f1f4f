"""Trains that have the line to themselves, at nominal voltage: no load flow, and nobody ahead.

Of such a run only the state of its train counts.  Its recording has room for a stretch of steps, and
each stretch uses it again: to fill one as long as the way takes several times as long as the motion.
"""

import math
from dataclasses import dataclass, replace

from tpss.kernel import switch
from tpss.record import Records, copy_of_records
from tpss.run.limits import LONGEST_RUN_S
from tpss.run.services import ScheduledTrain, Service, departing_trains, train_records
from tpss.step.advance import advance
from tpss.step.model import Model, RunControl
from tpss.step.recording import new_recording
from tpss.step.separation import Separation
from tpss.step.state import Status, new_state
from tpss.track.gate import Precedence
from tpss.vehicle.train import Train

STRETCH = 1024
"""Steps after which the recording is used again."""


@dataclass
class LoneTrain:
    """A train alone on its line, at the instant to which it has been brought."""

    train: ScheduledTrain
    records: Records[Train]
    """Its state: one record."""
    last_step_s: float
    """Length of the step that was carried out last. [s]"""
    step: int = 0
    status: Status = Status.RUNNING

    def is_under_way(self, step: int) -> bool:
        """Whether it is on the line at an instant to which it was to be brought, and not at its end."""
        return self.status != Status.FINISHED and self.step >= step


class EmptyLine:
    """A line on which there is one train at a time."""

    def __init__(self, model: Model) -> None:
        nominal_v = model.network.system.nominal_voltage_v
        self.nominal_v = nominal_v
        alone = model.signalling._replace(
            separation=switch(Separation.NONE), precedence=switch(Precedence.FREE)
        )
        control = RunControl(nominal_v, studied_train=0)
        self.model = model._replace(control=control, signalling=alone)
        self._state = new_state(self.model, Train.blank(1))
        self._recording = new_recording(self.model, STRETCH + 1, 1)

    def train_of(self, service: Service, wait_s: float = 0.0) -> LoneTrain:
        """A train of a service, which departs after a wait in the first step. [s]"""
        on_time = replace(service, first_s=wait_s, delays=None)
        train = departing_trains([on_time], self.model.options, 0, 1)[0]
        records = train_records([train], self.nominal_v)
        return LoneTrain(train, records, self.model.options.step_s)

    def advance(self, lone: LoneTrain, step: int) -> None:
        """Bring a train to an instant, or to its end if that comes before."""
        state = self._state._replace(trains=copy_of_records(lone.records))
        while lone.status == Status.RUNNING and lone.step < step:
            # Only the first step of all is numbered 0: it is the one in which the train departs.
            first = min(lone.step, 1)
            last = first + min(step - lone.step, STRETCH)
            status, reached = advance(first, last, self.model, state, self._recording)
            lone.step += reached - first
            lone.status = Status(status)
            lone.last_step_s = float(state.clock[0].last_step_s)
        lone.records = state.trains

    def advance_to_end(self, lone: LoneTrain) -> None:
        """Bring a train to its destination, or as far as it comes."""
        self.advance(lone, math.ceil(LONGEST_RUN_S / self.model.options.step_s))

    def arrival_s(self, lone: LoneTrain) -> float:
        """When a train came to stand at its destination; NaN: it has not. [s]"""
        if lone.status != Status.FINISHED:
            return math.nan
        step_s = self.model.options.step_s
        instant_s = lone.step * step_s
        if lone.last_step_s != step_s:
            instant_s = (lone.step - 1) * step_s + lone.last_step_s
        return instant_s - float(lone.records[0].timetable.stood_s)
