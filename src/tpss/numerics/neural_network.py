r"""Feed-forward networks with one hidden layer, as the thesis uses them for its machine curves.

.. math:: y = b^2 + \sum_l w^2_l \, f\Big(b^1_l + \sum_k w^1_{k,l} \hat x_k\Big)

The thesis scales every input and the output to [-1, 1].  Both maps are affine, so they are folded
into the weights once, on loading; a kernel then sees SI units only:

.. math::
    \hat x = 2\frac{x - x_{min}}{x_{max} - x_{min}} - 1
    \;\Rightarrow\; w'^1 = \frac{2 w^1}{x_{max} - x_{min}}, \quad
    b'^1 = b^1 - w^1 \Big(\frac{2 x_{min}}{x_{max} - x_{min}} + 1\Big)

and, with the output's half range h = (y_max - y_min)/2, w'² = h w² and b'² = h (b² + 1) + y_min.

The hidden layer is either tansig or logsig.  As tansig(y) = 2 logsig(2y) - 1, that too is affine and
folded in, so one kernel serves every network.  All have `NEURONS` neurons, the surplus ones without
weight: loops over them have no rest, and the compiler turns them into vector instructions.

References
----------
[Boullanger2009]_, eq. (B.1)-(B.4), (C.1), (C.10), (D.1), (D.8), (E.1), (E.6).
"""

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import fused, inlined, kernel
from tpss.numerics.exponential import exponential
from tpss.record import Record

Array = npt.NDArray[np.float64]

NEURONS = 16
"""Neurons of a record: as many as the largest network has, and a whole number of vectors."""

MOST_INPUTS = 3

TAYLOR_TERMS = 8
SERIES_INPUT = 1
"""Input along which `series` follows a network: the voltage of those that have one."""

EIGHTH_OVER_FIRST = 10.21
"""Bound of the eighth derivative of logsig over the first one. [1]"""

LONGEST_MOVE = 0.5
"""Farthest that a series lets the input of a neuron move from its centre. [1]"""


class FeedForwardNetwork(Record):
    """A network of logsig neurons with the scaling folded in: inputs and output in SI units."""

    weight: Annotated[Array, (MOST_INPUTS, NEURONS)]
    """Weight of each input in each neuron."""
    bias: Annotated[Array, (NEURONS,)]
    """Bias of each neuron."""
    output: Annotated[Array, (NEURONS,)]
    """Weight of each neuron in the output."""
    output_bias: float
    """Bias of the output."""
    taylor: Annotated[Array, (TAYLOR_TERMS, NEURONS)]
    """w² (w¹)^k / k! of the input `SERIES_INPUT`."""
    remainder: Annotated[Array, (NEURONS,)]
    """Bounds what those terms leave out, over the rounding."""
    by_first: Annotated[Array, (NEURONS,)]
    """w² w¹ of the first input: with the neurons' p = s(1 - s) the slope over it."""
    closest_8: float
    """One over the eighth power of the distance for which that holds."""
    steepest: Annotated[Array, (MOST_INPUTS,)]
    """Bound of the output's slope over each input."""
    trained: Annotated[Array, (MOST_INPUTS, 2)]
    """Ends of each input's training range."""


def fold_scaling(
    coefficients: Mapping[str, Any], input_to_si: Sequence[float]
) -> tuple[Array, Array, Array, float, Array]:
    """Weights, biases, output weights, output bias and training range in SI units.

    Parameters
    ----------
    coefficients : mapping
        ``W1`` (neurons, inputs), ``b1``, ``w2``, ``b2`` and the ranges ``input_min``, ``input_max``,
        ``output_min``, ``output_max`` in the printed units.
    input_to_si : sequence of float
        What one printed unit of each input is in SI units.

    References
    ----------
    [Boullanger2009]_, eq. (B.1), (B.2), (C.1), (C.10), (D.1), (D.8), (E.1), (E.6).
    """
    to_si = np.array(input_to_si, dtype=float)
    low = np.array(coefficients["input_min"], dtype=float) * to_si
    high = np.array(coefficients["input_max"], dtype=float) * to_si
    printed = np.array(coefficients["W1"], dtype=float)
    half_range = (coefficients["output_max"] - coefficients["output_min"]) / 2.0
    weight = printed * 2.0 / (high - low)
    bias = np.array(coefficients["b1"]) - printed @ (2.0 * low / (high - low) + 1.0)
    output = half_range * np.array(coefficients["w2"], dtype=float)
    output_bias = float(half_range * (coefficients["b2"] + 1.0) + coefficients["output_min"])
    return weight, bias, output, output_bias, np.column_stack([low, high])


def tansig_as_logsig(
    weight: Array, bias: Array, output: Array, output_bias: float
) -> tuple[Array, Array, Array, float]:
    r"""A tansig network as a network of logsig neurons, by tansig(y) = 2 logsig(2y) - 1.

    .. math:: \text{tansig}(y) = \tanh(y) = \frac{2}{1 + e^{-2y}} - 1

    References
    ----------
    [Boullanger2009]_, eq. (B.3), (C.17), (F.8), (F.12).
    """
    return 2.0 * weight, 2.0 * bias, 2.0 * output, output_bias - float(output.sum())


def build_network(
    coefficients: Mapping[str, Any], input_to_si: Sequence[float]
) -> FeedForwardNetwork:
    """Network from the coefficients as they are printed.

    Parameters
    ----------
    coefficients : mapping
        As in `fold_scaling`, and ``transfer``: tansig or logsig.
    input_to_si : sequence of float
        What one printed unit of each input is in SI units.

    References
    ----------
    [Boullanger2009]_, eq. (B.1)-(B.4).
    """
    weight, bias, output, output_bias, trained = fold_scaling(coefficients, input_to_si)
    if coefficients["transfer"] == "tansig":
        weight, bias, output, output_bias = tansig_as_logsig(weight, bias, output, output_bias)
    neurons, inputs = weight.shape
    network = FeedForwardNetwork.blank(1)[0]
    network.weight[:inputs, :neurons] = weight.T
    network.bias[:neurons] = bias
    network.output[:neurons] = output
    network.output_bias = output_bias
    # The derivative of logsig never exceeds 1/4.
    network.steepest[:] = np.abs(network.weight * network.output).sum(axis=1) / 4.0
    network.by_first[:] = network.weight[0] * network.output
    prepare_series(network)
    network.trained[:] = (-np.inf, np.inf)
    network.trained[:inputs] = trained
    return network


def prepare_series(network: FeedForwardNetwork) -> None:
    """Write what `series` needs of a network."""
    weight, output = network.weight[SERIES_INPUT], network.output
    for k in range(TAYLOR_TERMS):
        network.taylor[k] = output * weight**k / math.factorial(k)
    rounding = float(np.finfo(float).eps * np.abs(output).sum())
    worst = EIGHTH_OVER_FIRST * math.exp(LONGEST_MOVE) / math.factorial(TAYLOR_TERMS)
    network.remainder[:] = worst / rounding * np.abs(output) * np.abs(weight) ** TAYLOR_TERMS
    network.closest_8 = float(np.abs(weight).max() / LONGEST_MOVE) ** TAYLOR_TERMS


@inlined
def logistic(value: float) -> float:
    """The logistic function, 1 / (1 + e^{-y}).

    References
    ----------
    [Boullanger2009]_, eq. (B.4), (F.16).
    """
    return 1.0 / (1.0 + exponential(-value))


@inlined
def logsig(neurons: Array) -> None:
    """Put the logistic function of each value, 1 / (1 + e^{-y}), in its place, shape (NEURONS,).

    References
    ----------
    [Boullanger2009]_, eq. (B.4), (F.16).
    """
    for n in range(NEURONS):
        neurons[n] = logistic(neurons[n])


@fused
def weigh(weight: Array, neurons: Array) -> float:
    """Sum of weighted neurons, both of shape (NEURONS,), in four sums that do not wait for each other.

    References
    ----------
    [Boullanger2009]_, eq. (B.2).
    """
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for n in range(0, NEURONS, 4):
        a += weight[n] * neurons[n]
        b += weight[n + 1] * neurons[n + 1]
        c += weight[n + 2] * neurons[n + 2]
        d += weight[n + 3] * neurons[n + 3]
    return (a + b) + (c + d)


@kernel
def outside(value: float, network: FeedForwardNetwork, k: int) -> bool:
    """Whether input `k` lies outside the range on which the network was trained."""
    return value < network.trained[k, 0] or value > network.trained[k, 1]
