r"""Ensembles of feed-forward networks with one hidden tanh layer and direct connections.

.. math::

    y_o = b^2_o + \sum_k w^0_{k,o} \hat x_k
        + \sum_l w^2_{l,o} \, \tanh\Big(b^1_l + \sum_k w^1_{k,l} \hat x_k\Big)

Inputs and outputs are scaled to [-1, 1].  The direct connections, which the source does not have,
represent the linear part, and the neurons the rest.  The members of an ensemble have the same shape
and have seen different cases; their spread shows how much the prediction depends on that.

References
----------
[Boullanger2009]_, eq. (B.1)-(B.3), (C.1), (C.10).
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

BLOCK = 512
"""Rows that are evaluated at a time: their neurons stay in the processor's cache."""


@dataclass(frozen=True)
class Ensemble:
    """Weights of all members: of inputs and outputs, of inputs and neurons, of neurons and outputs."""

    w0: Array
    """Shape (members, inputs, outputs): direct connections."""
    w1: Array
    """Shape (members, inputs, neurons)."""
    b1: Array
    """Shape (members, neurons)."""
    w2: Array
    """Shape (members, neurons, outputs)."""
    b2: Array
    """Shape (members, outputs)."""

    @property
    def size(self) -> int:
        """Number of members."""
        return len(self.w1)

    @property
    def neurons(self) -> int:
        """Neurons of a member."""
        return int(self.w1.shape[2])

    def evaluate(self, x: Array) -> Array:
        """Outputs of each member, shape (members, rows, outputs), of scaled inputs (rows, inputs).

        In single precision, which is three times as fast: the cases are less exact than its six digits.

        References
        ----------
        [Boullanger2009]_, eq. (B.1)-(B.3).
        """
        outputs = np.empty((self.size, len(x), self.b2.shape[1]))
        w0, w1, b1, w2 = (part.astype(np.float32) for part in (self.w0, self.w1, self.b1, self.w2))
        single = x.astype(np.float32)
        for first in range(0, len(x), BLOCK):
            rows = slice(first, first + BLOCK)
            neurons = single[rows] @ w1
            neurons += b1[:, None, :]
            np.tanh(neurons, out=neurons)
            outputs[:, rows] = neurons @ w2 + single[rows] @ w0
        outputs += self.b2[:, None, :]
        return outputs


def logistic(y: Array) -> Array:
    """Probability from the output of a classifying network, 1 / (1 + e^{-y}).

    References
    ----------
    [Boullanger2009]_, eq. (B.4).
    """
    return 0.5 * (1.0 + np.tanh(0.5 * y))
