"""Small dense systems of real-linear maps of the complex plane, see `pairs`."""

import math

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined
from tpss.numerics.pairs import compose, determinant, inverse

Complexes = npt.NDArray[np.complex128]


@inlined
def eliminate(rows: Complexes) -> float:
    """Turn the rows [B | R] of a system into [1 | B⁻¹ R], and return the sign of the determinant of B.

    By Gauss and Jordan; of each column the largest pivot that is left is taken.  To exchange two rows
    of pairs exchanges two of real rows twice, which leaves the sign.

    Parameters
    ----------
    rows : Complexes, shape (n, m, 2)
        A pair each; the first n columns are those of B.  Overwritten; infinite or NaN if B is singular.
    """
    sign = 1.0
    for c in range(rows.shape[0]):
        largest, at_row = -1.0, c
        for r in range(c, rows.shape[0]):
            size = abs(determinant(rows[r, c, 0], rows[r, c, 1]))
            if size > largest:
                largest, at_row = size, r
        sign *= math.copysign(1.0, determinant(rows[at_row, c, 0], rows[at_row, c, 1]))
        scale_p, scale_q = inverse(rows[at_row, c, 0], rows[at_row, c, 1])
        for j in range(c, rows.shape[1]):
            p, q = compose(scale_p, scale_q, rows[at_row, j, 0], rows[at_row, j, 1])
            if at_row != c:
                rows[at_row, j, 0], rows[at_row, j, 1] = rows[c, j, 0], rows[c, j, 1]
            rows[c, j, 0], rows[c, j, 1] = p, q
        for r in range(rows.shape[0]):
            if r != c:
                factor_p, factor_q = rows[r, c, 0], rows[r, c, 1]
                for j in range(c, rows.shape[1]):
                    p, q = compose(factor_p, factor_q, rows[c, j, 0], rows[c, j, 1])
                    rows[r, j, 0] -= p
                    rows[r, j, 1] -= q
    return sign
