"""The largest force of a locomotive's motors, over speed, line voltage and motor current.

The voltage is the only input that changes while a step is solved; over it the network is a series.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined
from tpss.numerics.neural_network import (
    NEURONS,
    FeedForwardNetwork,
    logistic,
    outside,
    weigh,
)
from tpss.numerics.series import Series, make_series

Array = npt.NDArray[np.float64]

SPEED, VOLTAGE, CURRENT = 0, 1, 2


@inlined
def _given_to(
    n: int, speed_m_s: float, voltage_v: float, current_a: float, network: FeedForwardNetwork
) -> float:
    """What a neuron is given.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.7)-(F.10).
    """
    weight = network.weight
    fixed = network.bias[n] + weight[SPEED, n] * speed_m_s + weight[CURRENT, n] * current_a
    return fixed + weight[VOLTAGE, n] * voltage_v


@inlined
def _put_in(
    speed_m_s: float,
    voltage_v: float,
    current_a: float,
    network: FeedForwardNetwork,
    scratch: Array,
) -> None:
    """Put what each neuron is given into the first row of the scratch.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.7)-(F.10).
    """
    for n in range(NEURONS):
        scratch[0, n] = _given_to(n, speed_m_s, voltage_v, current_a, network)


@inlined
def motor_force(
    speed_m_s: float,
    voltage_v: float,
    current_a: float,
    network: FeedForwardNetwork,
    scratch: Array,
) -> float:
    """Largest force of all motors. [N]

    Parameters are those of `motor_force_series`.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.7)-(F.10).
    """
    # In one loop: neurons that are put down one by one would be waited for to be taken up together.
    for n in range(NEURONS):
        scratch[0, n] = logistic(_given_to(n, speed_m_s, voltage_v, current_a, network))
    return network.output_bias + weigh(network.output, scratch[0])


@inlined
def motor_force_series(
    speed_m_s: float,
    voltage_v: float,
    current_a: float,
    network: FeedForwardNetwork,
    scratch: Array,
    series: Series,
) -> float:
    """Make the series of the largest force of all motors over the line voltage. [N], [V]

    Return the slope over the speed at this voltage. [N s/m]

    Negative only by the network's error (at most 2.1 kN); the caller clips it and counts that.

    Parameters
    ----------
    speed_m_s : float
        Train speed; trained on 0 to 250 km/h. [m/s]
    voltage_v : float
        Voltage at the pantograph; trained on 10.5 to 16.5 kV. [V]
    current_a : float
        Highest current allowed in one motor; trained on 0 to 2080 A. [A]
    network, scratch, series
        As in `make_series`.

    References
    ----------
    [Boullanger2009]_, eq. (C.1)-(C.17) and (F.7)-(F.10).
    """
    _put_in(speed_m_s, voltage_v, current_a, network, scratch)
    make_series(voltage_v, network, scratch, series)
    return weigh(network.by_first, scratch[1])


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
