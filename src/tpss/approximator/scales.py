"""How the networks represent outputs: some by a logarithm, all scaled to [-1, 1].

Most outputs are products of what they depend on, such as the energy of the traffic and the length: their
logarithms are sums, and errors relative.  The lowest voltage is not, but its drop is, as it increases
with the product of load and impedance.
"""

from typing import Any

import numpy as np

from tpss.approximator.model_file import Output
from tpss.approximator.network import Array
from tpss.errors import ApproximatorError

ABOVE = 0.05
"""Distance from the highest trained voltage up to the reference of drops, in trained ranges."""


def output_of(name: str, values: Array) -> Output:
    """Scaling of an output with these values in the trained cases.

    Raises
    ------
    ApproximatorError
        It is the same in all cases, or lacks values.
    """
    if not np.isfinite(values).all():
        raise ApproximatorError(f"the table lacks {name} in a case that finished: run it again")
    lowest, highest = float(values.min()), float(values.max())
    if not lowest < highest:
        raise ApproximatorError(f"{name} is the same in all cases: there is nothing to learn")
    unscaled = Output(
        name=name,
        scale="drop" if name.endswith("_kv") else "log" if lowest > 0.0 else "linear",
        reference=highest + ABOVE * (highest - lowest),
        low=0.0,
        high=1.0,
        usual=1.0,
        factor=0.0,
    )
    low, high = transformed(np.array([lowest, highest]), unscaled).tolist()
    return unscaled.model_copy(update={"low": low, "high": high})


def transformed(values: Any, output: Output) -> Array:
    """Values, their logarithms, or those of the drops to them, as the networks use them."""
    plain: Array = np.asarray(values, dtype=float)
    if output.scale == "log":
        plain = np.log(plain)
    elif output.scale == "drop":
        plain = -np.log(output.reference - plain)
    return plain


def restored(values: Array, output: Output) -> Array:
    """Inverse of `transformed`."""
    if output.scale == "log":
        return np.exp(values)
    if output.scale == "drop":
        return output.reference - np.exp(-values)
    return values


def scaled(values: Any, output: Output) -> Array:
    """Values of an output scaled to [-1, 1].

    References
    ----------
    [Boullanger2009]_, eq. (C.10).
    """
    return 2.0 * (transformed(values, output) - output.low) / (output.high - output.low) - 1.0


def unscaled(values: Array, output: Output) -> Array:
    """Values of an output from scaled ones.

    References
    ----------
    [Boullanger2009]_, eq. (F.10).
    """
    return restored(output.low + (output.high - output.low) * (values + 1.0) / 2.0, output)
