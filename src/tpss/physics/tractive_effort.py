"""The largest force of a locomotive's motors, over speed, line voltage and motor current.

The voltage is the only input that changes while a step is solved, so the two others are summed once
a step into a bias for each neuron.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import fused, inlined
from tpss.physics.neural_network import (
    NEURONS,
    FeedForwardNetwork,
    logsig,
    logsig_slope,
    outside,
    weigh,
)

Array = npt.NDArray[np.float64]

SPEED, VOLTAGE, CURRENT = 0, 1, 2


@inlined
def speed_and_current_bias(
    speed_m_s: float, current_a: float, network: FeedForwardNetwork, bias: Array
) -> None:
    """Write what speed and current limit add to each neuron into `bias`, shape (NEURONS,).

    Parameters
    ----------
    speed_m_s : float
        Train speed; trained on 0 to 250 km/h. [m/s]
    current_a : float
        Highest current allowed in one motor; trained on 0 to 2080 A. [A]

    References
    ----------
    [Boullanger2009]_, eq. (F.7), the inputs that the voltage does not move.
    """
    weight = network.weight
    for n in range(NEURONS):
        bias[n] = network.bias[n] + weight[SPEED, n] * speed_m_s + weight[CURRENT, n] * current_a


@fused
def maximum_motor_force(
    voltage_v: float, bias: Array, network: FeedForwardNetwork, neurons: Array
) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Negative only by the network's error (at most 2.1 kN); the caller clips it and counts that.

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph; trained on 10.5 to 16.5 kV. [V]
    bias : Array, shape (NEURONS,)
        From `speed_and_current_bias`.
    neurons : Array, shape (NEURONS,)
        Scratch.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.8)-(F.10).
    """
    for n in range(NEURONS):
        neurons[n] = bias[n] + network.weight[VOLTAGE, n] * voltage_v
    logsig(neurons)
    force = network.output_bias + weigh(network.output, neurons)
    logsig_slope(neurons)
    return force, weigh(network.slope[VOLTAGE], neurons)


@inlined
def effort_outside_training(
    speed_m_s: float, voltage_v: float, current_a: float, network: FeedForwardNetwork
) -> bool:
    """Whether the tractive-effort network extrapolates at this point."""
    return (
        outside(speed_m_s, network, SPEED)
        or outside(voltage_v, network, VOLTAGE)
        or outside(current_a, network, CURRENT)
    )
