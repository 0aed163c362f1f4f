r"""Feed-forward networks with one hidden layer, as the thesis uses them for its machine curves.

.. math:: y = b^2 + \sum_l w^2_l \, f\Big(b^1_l + \sum_k w^1_{k,l} \hat x_k\Big)

The thesis scales every input and the output to [-1, 1].  Both maps are affine, so they are folded
into the weights once, on loading; a kernel then sees SI units only:

.. math::
    \hat x = 2\frac{x - x_{min}}{x_{max} - x_{min}} - 1
    \;\Rightarrow\; w'^1 = \frac{2 w^1}{x_{max} - x_{min}}, \quad
    b'^1 = b^1 - w^1 \Big(\frac{2 x_{min}}{x_{max} - x_{min}} + 1\Big)

and, with the output's half range h = (y_max - y_min)/2, w'² = h w² and b'² = h (b² + 1) + y_min.

References
----------
[Boullanger2009]_, eq. (B.1)-(B.4), (C.1), (C.10), (D.1), (D.8), (E.1), (E.6).
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import kernel

Array = npt.NDArray[np.float64]


def network_record(neurons: int, inputs: int) -> np.dtype[Any]:
    """Type of a network's record, with the scaling folded in: inputs and output in SI units.

    ``hidden`` has a row for each neuron: the weights of the inputs, the bias, and the weight of the
    neuron in the output.  ``trained`` has a row for each input: the ends of its training range.
    """
    return np.dtype(
        (
            np.record,
            [
                ("hidden", float, (neurons, inputs + 2)),
                ("output_bias", float),
                ("trained", float, (inputs, 2)),
            ],
        )
    )


FeedForwardNetwork = Any
"""A record with the fields of `network_record`."""


def fold_scaling(
    coefficients: Mapping[str, Any], input_to_si: Sequence[float]
) -> tuple[Array, float, Array]:
    """Fields of a network's record, in SI units, from the coefficients as they are printed.

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
    output_weight = half_range * np.array(coefficients["w2"], dtype=float)
    output_bias = float(half_range * (coefficients["b2"] + 1.0) + coefficients["output_min"])
    hidden = np.column_stack([weight, bias, output_weight])
    return hidden, output_bias, np.column_stack([low, high])


@kernel
def tansig(y: float) -> float:
    r"""Hyperbolic tangent as the thesis writes it, 2 / (1 + e^{-2y}) - 1.

    References
    ----------
    [Boullanger2009]_, eq. (B.3), (C.17), (F.8), (F.12).
    """
    return 2.0 / (1.0 + np.exp(-2.0 * y)) - 1.0


@kernel
def logsig(y: float) -> float:
    """Logistic function, 1 / (1 + e^{-y}).

    References
    ----------
    [Boullanger2009]_, eq. (B.4), (F.16).
    """
    return 1.0 / (1.0 + np.exp(-y))


@kernel
def outside(value: float, network: FeedForwardNetwork, k: int) -> bool:
    """Whether input `k` lies outside the range on which the network was trained."""
    return value < network.trained[k, 0] or value > network.trained[k, 1]
