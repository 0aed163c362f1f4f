"""The largest force of a locomotive's motors, over speed, line voltage and motor current.

The voltage is the only input that changes while a step is solved, so the two others are summed once
a step into a bias for each neuron.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.physics.neural_network import FeedForwardNetwork, outside, tansig

Array = npt.NDArray[np.float64]

NEURONS = 15
"""Neurons of the network. [Boullanger2009]_, section 2.2.1."""

SPEED, VOLTAGE, CURRENT, BIAS, OUTPUT = 0, 1, 2, 3, 4


@inlined
def speed_and_current_bias(
    speed_m_s: float, current_a: float, network: FeedForwardNetwork, bias: Array
) -> None:
    """Write what speed and current limit add to each neuron into `bias`, shape (neurons,).

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
    hidden = network.hidden
    for neuron in range(NEURONS):
        bias[neuron] = (
            hidden[neuron, BIAS]
            + hidden[neuron, SPEED] * speed_m_s
            + hidden[neuron, CURRENT] * current_a
        )


@kernel
def maximum_motor_force(
    voltage_v: float, bias: Array, network: FeedForwardNetwork
) -> tuple[float, float]:
    """Largest force of all motors at a line voltage, and its slope. [N], [N/V]

    Negative only by the network's error (at most 2.1 kN); the caller clips it and counts that.

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph; trained on 10.5 to 16.5 kV. [V]
    bias : Array, shape (neurons,)
        From `speed_and_current_bias`.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.8)-(F.10).
    """
    force = network.output_bias
    slope = 0.0
    hidden = network.hidden
    for neuron in range(NEURONS):
        weight, output = hidden[neuron, VOLTAGE], hidden[neuron, OUTPUT]
        activation = tansig(bias[neuron] + weight * voltage_v)
        force += output * activation
        slope += output * weight * (1.0 - activation * activation)
    return force, slope


@kernel
def steepest_slope(network: FeedForwardNetwork) -> float:
    """Bound of the slope of `maximum_motor_force` at any speed, voltage and current. [N/V]

    The derivative of tansig never exceeds 1, so no slope exceeds the sum of the weights' products.
    """
    bound = 0.0
    for neuron in range(NEURONS):
        bound += abs(network.hidden[neuron, OUTPUT] * network.hidden[neuron, VOLTAGE])
    return bound


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
