"""Modified Bessel functions of complex arguments, scaled so that none overflows.

The trapezoidal rule on their integrals converges faster than any power of its step.
"""

import numpy as np
from numpy.typing import ArrayLike

from tpss.conductors.formulas.vacuum import Complex

POINTS = 600
"""Points of the rule over half a circle: exact to the last digits for arguments up to 5000."""

STEP, STEPS, WIDE = 0.05, 500, 100.0
"""Step of the rule along the real axis up to an argument of `WIDE`, as the root of which it narrows
beyond, and number of steps: for arguments from 1e-9 on."""


def scaled_i(order: int, z: ArrayLike) -> Complex:
    r"""Modified Bessel function of the first kind, without its growth. [1]

    .. math:: e^{-z} I_n(z) = \frac1\pi \int_0^\pi e^{z (\cos t - 1)} \cos nt \, dt

    Parameters
    ----------
    order : int
        n, 0 or 1.
    z : array
        Argument, of a positive real part. [1]

    References
    ----------
    [AbramowitzStegun1964]_, 9.6.19.
    """
    t = np.pi * np.arange(POINTS + 1) / POINTS
    weight = np.cos(order * t) / POINTS
    weight[[0, -1]] /= 2.0
    z = np.asarray(z, complex)[..., None]
    summed: Complex = (weight * np.exp(z * (np.cos(t) - 1.0))).sum(axis=-1)
    return summed


def scaled_k(order: int, z: ArrayLike) -> Complex:
    r"""Modified Bessel function of the second kind, without its decay. [1]

    .. math:: e^{z} K_n(z) = \int_0^\infty e^{-z (\cosh t - 1)} \cosh nt \, dt

    Parameters
    ----------
    order : int
        n, 0 or 1.
    z : array
        Argument, with an angle of at most 45 degrees. [1]

    References
    ----------
    [AbramowitzStegun1964]_, 9.6.24.
    """
    z = np.asarray(z, complex)[..., None]
    step = STEP / np.sqrt(np.maximum(abs(z) / WIDE, 1.0))
    t = step * np.arange(STEPS + 1)
    weight = step * np.cosh(order * t)
    weight[..., 0] /= 2.0
    summed: Complex = (weight * np.exp(-z * (np.cosh(t) - 1.0))).sum(axis=-1)
    return summed
