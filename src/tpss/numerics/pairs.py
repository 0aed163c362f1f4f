r"""Real-linear maps of the complex plane, as pairs of complex numbers.

A train's current is not an analytic function of its voltage (it depends on V and on its conjugate),
so a derivative has two parts: a small change δ gives

.. math:: (p, q) \, \delta = p \, \delta + q \, \bar\delta .

Every 2 × 2 real matrix is such a pair, an impedance is the pair (z, 0), and the algebra is short:
composition (p₁p₂ + q₁q̄₂, p₁q₂ + q₁p̄₂), determinant |p|² - |q|², inverse (p̄, -q) / determinant.
"""

import math

from tpss.kernel import fused, fused_like_numpy

Pair = tuple[complex, complex]
"""A real-linear map (p, q)."""


@fused
def squared(z: complex) -> float:
    """|z|²."""
    return z.real * z.real + z.imag * z.imag


@fused_like_numpy
def magnitude(z: complex) -> float:
    """|z|, without the care for overflow that makes `abs` five times slower.

    To the last digit what numpy makes of a result's voltages.
    """
    return math.sqrt(z.real * z.real + z.imag * z.imag)


@fused
def scaled(z: complex, factor: float) -> complex:
    """A complex number times a real one, without the detour over a complex factor.

    Compiled code makes a real factor or divisor complex first: a product costs twice as much then,
    a quotient ten times.
    """
    return complex(z.real * factor, z.imag * factor)


@fused
def apply(p: complex, q: complex, delta: complex) -> complex:
    """The map (p, q) of a change."""
    return p * delta + q * delta.conjugate()


@fused
def compose(p1: complex, q1: complex, p2: complex, q2: complex) -> tuple[complex, complex]:
    """The map (p1, q1) after (p2, q2)."""
    return p1 * p2 + q1 * q2.conjugate(), p1 * q2 + q1 * p2.conjugate()


@fused
def determinant(p: complex, q: complex) -> float:
    """Determinant of the map as a 2 × 2 real matrix."""
    return squared(p) - squared(q)


@fused
def inverse(p: complex, q: complex) -> tuple[complex, complex]:
    """Inverse of the map; infinite or NaN if it is singular."""
    scale = 1.0 / determinant(p, q)
    return scaled(p.conjugate(), scale), scaled(q, -scale)
