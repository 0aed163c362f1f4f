r"""The exponential function without a branch, so that loops over it become vector instructions.

With x = k ln 2 + r, k whole and \|r\| ≤ ½ ln 2,

.. math:: e^x = 2^k e^r

The Taylor polynomial of degree 13 gives e^r to 2e-18 relative, so rounding alone is left: two units
in the last place.  Adding 1.5 · 2⁵² rounds to a whole number and leaves k in the last bits of the
sum; moved by 52 places they add to the exponent of e^r.  Both parts of ln 2 are those of W. J. Cody
and W. Waite: k times the longer one is exact.
"""

import math

import numpy as np

from tpss.kernel import inlined

LARGEST = 700.0
"""Beyond ±700, e^x is taken at ±700: further on it leaves the normal numbers.  Its use here, 1 / (1 +
e^x), is 0 or 1 to the last digit from far smaller arguments on."""

_LOG2_E = 1.0 / math.log(2.0)
_LN2_HIGH = 6.93147180369123816490e-01
_LN2_LOW = 1.90821492927058770002e-10
_ROUND = 1.5 * 2.0**52
_C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10, _C11, _C12, _C13 = (
    1.0 / math.factorial(n) for n in range(2, 14)
)


@inlined
def times_power_of_two(number: float, rounded: float) -> float:
    """A number times 2^k, whose k stands in the last bits of another."""
    bits = np.float64(number).view(np.int64) + (np.float64(rounded).view(np.int64) << np.int64(52))
    return np.int64(bits).view(np.float64)


@inlined
def exponential(x: float) -> float:
    """e^x, between e^-700 and e^700; NaN stays NaN."""
    x = LARGEST if x > LARGEST else x
    x = -LARGEST if x < -LARGEST else x
    rounded = x * _LOG2_E + _ROUND
    k = rounded - _ROUND
    r = (x - k * _LN2_HIGH) - k * _LN2_LOW
    # Short sums that do not wait for each other, in place of one long chain.
    r2 = r * r
    r4 = r2 * r2
    low = (_C2 + _C3 * r) + (_C4 + _C5 * r) * r2
    middle = (_C6 + _C7 * r) + (_C8 + _C9 * r) * r2
    high = (_C10 + _C11 * r) + (_C12 + _C13 * r) * r2
    return times_power_of_two(1.0 + (r + r2 * (low + r4 * (middle + r4 * high))), rounded)
