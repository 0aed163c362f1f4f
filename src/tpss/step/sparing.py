"""Drivers who spare hot motors: what they allow in a step, and how warm the motors are after it."""

import math

from tpss.kernel import at, kernel
from tpss.physics.motor import MOTORS_OF_LOCOMOTIVE, MotorModel
from tpss.step.model import Model
from tpss.step.recording import Recording
from tpss.step.state import Counter, State
from tpss.vehicle.spared_motors import allowed_current, state_after_step
from tpss.vehicle.train import Phase

ROUNDING = 1e-9
"""Share of the allowed current within which a step is one in which the driver spared the motors."""


@kernel
def allow_currents(step: int, step_s: float, model: Model, state: State) -> None:
    """Find what drivers allow their motors in a step; those that were not on the line begin afresh.

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant.
    """
    for i in range(state.trains.size):
        train = state.trains[at(i)]
        motors = model.types[at(train.train_type)].spared
        if motors.continuous_a < math.inf:
            if step == 0 or train.motion.phase == Phase.PENDING:
                train.motor_state = motors.initial_state
            train.allowed_current_a = allowed_current(train.motor_state, step_s, motors)


@kernel
def heat_motors(step: int, step_s: float, model: Model, state: State, recording: Recording) -> None:
    """Find how warm motors are after a step, of the trains that were on the line in it.

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant.
    """
    for k in range(state.clock[0].on_line):
        i = state.flow.standing[at(k)].train
        train = state.trains[at(i)]
        kind = model.types[at(train.train_type)]
        if kind.spared.continuous_a < math.inf:
            current_a = recording.trains[at(step), at(i)].motor_current
            if kind.current_model == MotorModel.NEW:
                current_a *= MOTORS_OF_LOCOMOTIVE
            if current_a >= train.allowed_current_a * (1.0 - ROUNDING):
                recording.counters[Counter.MOTORS_SPARED] += 1
            train.motor_state = state_after_step(train.motor_state, current_a, step_s, kind.spared)
