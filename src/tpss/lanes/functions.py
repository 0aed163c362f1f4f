"""Functions that lanes have in a form of their own, without a branch: angles, and looks at bits.

The angles are the polynomials of the Cephes library, exact to about a unit in the last place in the
range of a load flow's angles.
"""

import math
from typing import Any

from tpss.lanes.compile import by_hand, compiled, of_math
from tpss.lanes.masks import is_finite, is_nan, power_of_two_times, select
from tpss.numerics.exponential import times_power_of_two

_ROUND = 1.5 * 2.0**52
_PI_2_HIGH, _PI_2_LOW = 1.5707963267341256, 6.077100506506192e-11

_P = (-8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
      -1.228866684490136173410e2, -6.485021904942025371773e1)  # fmt: skip
_Q = (2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
      4.853903996359136964868e2, 1.945506571482613964425e2)  # fmt: skip
_S = (1.58962301576546568060e-10, -2.50507477628578072866e-8, 2.75573136213857245213e-6,
      -1.98412698295895385996e-4, 8.33333333332211858878e-3, -1.66666666666666307295e-1)  # fmt: skip
_K = (-1.13585365213876817300e-11, 2.08757008419747316778e-9, -2.75573141792967388112e-7,
      2.48015872888517045348e-5, -1.38888888888730564116e-3, 4.16666666666665929218e-2)  # fmt: skip


@compiled(fused=True)
def atan2(y: Any, x: Any) -> Any:
    """Angle of a point, from that to the nearest of 0, 45 and 90 degrees. [rad]"""
    a, b = abs(y), abs(x)
    far = a > 2.414213562373095 * b
    near = a <= 0.66 * b
    over = select(near, a, select(far, -b, a - b))
    under = select(near, b, select(far, a, a + b))
    base = select(near, 0.0, select(far, 1.5707963267948966, 0.7853981633974483))
    t = over / under
    z = t * t
    p = (((_P[0] * z + _P[1]) * z + _P[2]) * z + _P[3]) * z + _P[4]
    q = ((((z + _Q[0]) * z + _Q[1]) * z + _Q[2]) * z + _Q[3]) * z + _Q[4]
    angle = base + (t * (z * p / q) + t)
    angle = select(x < 0.0, 3.141592653589793 - angle, angle)
    return math.copysign(angle, y)


@compiled(fused=True)
def _turn(x: Any) -> Any:
    """Sine and cosine of the angle to the nearest quarter turn, and the number of quarters."""
    n = (x * 0.6366197723675814 + _ROUND) - _ROUND
    r = (x - n * _PI_2_HIGH) - n * _PI_2_LOW
    z = r * r
    s = ((((_S[0] * z + _S[1]) * z + _S[2]) * z + _S[3]) * z + _S[4]) * z + _S[5]
    k = ((((_K[0] * z + _K[1]) * z + _K[2]) * z + _K[3]) * z + _K[4]) * z + _K[5]
    return r + r * z * s, 1.0 - 0.5 * z + z * z * k, n - 4.0 * ((n * 0.25 + _ROUND) - _ROUND)


@compiled(fused=True)
def sin(x: Any) -> Any:
    """Sine."""
    sine, cosine, quarters = _turn(x)
    odd = select(quarters == 1.0, cosine, select(quarters == -1.0, -cosine, sine))
    return select(abs(quarters) == 2.0, -sine, odd)


@compiled(fused=True)
def cos(x: Any) -> Any:
    """Cosine."""
    sine, cosine, quarters = _turn(x)
    odd = select(quarters == 1.0, -sine, select(quarters == -1.0, sine, cosine))
    return select(abs(quarters) == 2.0, -cosine, odd)


of_math.update(sin=sin, cos=cos, atan2=atan2, isnan=is_nan, isfinite=is_finite)
by_hand[times_power_of_two] = power_of_two_times, False
