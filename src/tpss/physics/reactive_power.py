"""Reactive power of a locomotive with line-commutated bridges.

Sign: positive is inductive, drawn by the train.
"""

import math
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.neural_network import (
    NEURONS,
    FeedForwardNetwork,
    logistic,
    outside,
    weigh,
)
from tpss.numerics.series import Series, make_series

Array = npt.NDArray[np.float64]


class ReactiveModel(IntEnum):
    """What the reactive power of the motors follows from."""

    POWER_FACTOR = 0
    DOUBLE_BRIDGE = 1
    POWER_FACTOR_CURVE = 2


MOTOR, LOCOMOTIVE = 0, 1
"""Inputs of the bridge network: the voltages."""


@inlined
def bridge_sine_series(
    motor_voltage_v: float,
    locomotive_voltage_v: float,
    network: FeedForwardNetwork,
    scratch: Array,
    series: Series,
) -> None:
    r"""Make the series of the sine of the firing angle, β, over the locomotive's voltage. [1], [V]

    β stands for the sin(arccos(...)) of eq. (3.1) of two half-controlled bridges in series; it is
    between 0 and 1 but for the network's error, and the caller clips it and counts that.

    Parameters
    ----------
    motor_voltage_v : float
        U_di, trained on 0 to 770 V. [V]
    locomotive_voltage_v : float
        U_locoRc, trained on 214.28 to 642.84 V. [V]
    network, scratch, series
        As in `make_series`.

    References
    ----------
    [Boullanger2009]_, eq. (D.1)-(D.15) and (F.15)-(F.18).
    """
    weight = network.weight
    for n in range(NEURONS):
        fixed = network.bias[n] + weight[MOTOR, n] * motor_voltage_v
        scratch[0, n] = fixed + weight[LOCOMOTIVE, n] * locomotive_voltage_v
    make_series(locomotive_voltage_v, network, scratch, series)


@inlined
def sine_over_motor_voltage(network: FeedForwardNetwork, scratch: Array) -> float:
    """Slope of β over the motor voltage, where its series has just been made. [1/V]

    References
    ----------
    [Boullanger2009]_, eq. (D.8), derived.
    """
    for n in range(NEURONS):
        scratch[2, n] = network.weight[MOTOR, n] * scratch[1, n]
    return weigh(network.output, scratch[2])


@inlined
def bridge_outside_training(
    motor_voltage_v: float, locomotive_voltage_v: float, network: FeedForwardNetwork
) -> bool:
    """Whether the bridge network extrapolates at this point."""
    return outside(motor_voltage_v, network, 0) or outside(locomotive_voltage_v, network, 1)


@kernel
def bridge_reactive_power(
    locomotive_voltage_v: float, armature_current_a: float, sine: float
) -> float:
    r"""Fundamental reactive power of the double bridges. [var]

    .. math:: Q_{motor} = U_{locoRc} \, 4 I_D \frac{\sqrt 2}{\pi} \beta

    Notes
    -----
    With the former motor current (2.18), I_D already is the sum of the four motors.  Taken with the
    printed factor 4 the reactive power would be four times the physical one, so we read the former
    pair of equations as the same sum of currents.  The text leaves it open.

    References
    ----------
    [Boullanger2009]_, eq. (2.19), (3.1), (3.2) and (F.24).
    """
    return locomotive_voltage_v * armature_current_a * (math.sqrt(2.0) / math.pi) * sine


@inlined
def power_factor(speed_m_s: float, network: FeedForwardNetwork, neurons: Array) -> float:
    """Power factor λ of the locomotive over speed, trained on 0 to 160 km/h. [1]

    The curve drops from 0.92 to 0.64 just above 40 km/h, where the second bridge starts.

    Parameters
    ----------
    speed_m_s : float
        Train speed. [m/s]
    neurons : Array, shape (NEURONS,)
        Scratch.

    References
    ----------
    [Boullanger2009]_, eq. (E.1)-(E.13) and (F.11)-(F.14).
    """
    for n in range(NEURONS):
        neurons[n] = logistic(network.bias[n] + network.weight[0, n] * speed_m_s)
    return network.output_bias + weigh(network.output, neurons)


@kernel
def reactive_ratio(factor: float) -> float:
    r"""Reactive over active power at a power factor, √(1 - λ²) / λ. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.21), (2.24), (F.23b) and (F.27).
    """
    return math.sqrt(1.0 - factor * factor) / factor


@inlined
def filter_reactive_power(voltage_v: float, susceptance_s: float) -> tuple[float, float]:
    r"""Reactive power drawn by the locomotive's filter, and its slope. [var], [var/V]

    Negative: the filter feeds.

    .. math:: Q_f = U_{locoRc}^2 / X_f

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    susceptance_s : float
        1 / X_f, referred to the pantograph's side of the transformer, negative. [S]

    References
    ----------
    [Boullanger2009]_, eq. (2.20) and, for the transformer's ratio, (F.32).
    """
    current = voltage_v * susceptance_s
    return voltage_v * current, 2.0 * current
