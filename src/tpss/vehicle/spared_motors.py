r"""Motors that their driver spares: he takes no more current than keeps them from getting too hot.

A motor's thermal state θ follows its load K, the current over the rated one, as every body with one
time constant does (`physics.thermal`).  A load that holds over a step of length h brings it to

.. math:: \theta' = K^2 + (\theta - K^2) e^{-h / \tau} ,

so the highest load after which the state is 1, that of the rated current held for ever, has

.. math:: K^2 = \frac{1 - \theta e^{-h / \tau}}{1 - e^{-h / \tau}} .

A cold motor bears any load for a short step: the short-time current limits it too.
"""

import math

from tpss.kernel import inlined
from tpss.physics.motor import MOTORS_OF_LOCOMOTIVE
from tpss.record import Record


class SparedMotors(Record):
    """What a driver who spares the motors of his train knows of them."""

    continuous_a: float = math.inf
    """Current of one motor that it bears for ever; infinite: he does not spare them. [A]"""
    short_time_load: float = 0.0
    """Short-time current over the continuous one. [1]"""
    time_constant_s: float = 0.0
    """Time constant of their temperature. [s]"""
    initial_state: float = 0.0
    """Thermal state when a train departs, or the run begins. [1]"""


@inlined
def allowed_current(state: float, step_s: float, motors: SparedMotors) -> float:
    """Armature current of all motors that their driver allows in a step. [A]

    Parameters
    ----------
    state : float
        Thermal state at the beginning of the step. [1]
    step_s : float
        Length of the step. [s]

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant, solved for the load.
    """
    left = math.exp(-step_s / motors.time_constant_s)
    square = max(0.0, (1.0 - state * left) / (1.0 - left))
    load = min(motors.short_time_load, math.sqrt(square))
    return MOTORS_OF_LOCOMOTIVE * motors.continuous_a * load


@inlined
def state_after_step(state: float, current_a: float, step_s: float, motors: SparedMotors) -> float:
    """Thermal state after a step with an armature current of all motors [A]. [1]

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant.
    """
    load = current_a / (MOTORS_OF_LOCOMOTIVE * motors.continuous_a)
    left = math.exp(-step_s / motors.time_constant_s)
    return load * load + (state - load * load) * left
