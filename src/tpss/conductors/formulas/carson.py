r"""Carson's correction for an earth that conducts: his series near the wires, his integral beyond.

With :math:`k = D' \sqrt{\omega\mu_0/\rho}`, in which D' is the distance from a conductor to the image
of the other, the series converges for any k, but loses digits to terms that cancel as k grows.  From
`LAST_OF_SERIES` on the integral is taken, along a way on which it hardly oscillates.
"""

import numpy as np
from numpy.typing import ArrayLike

from tpss.conductors.formulas.vacuum import PERMEABILITY_H_PER_M, Complex, Real

LAST_OF_SERIES = 3.0
"""k beyond which the integral is taken; both agree there to 1e-12. [1]"""

TERMS = 40
"""Terms of the series: the last one is less than 1e-20 at `LAST_OF_SERIES`."""

PANELS, NODES, FARTHEST = 40, 24, 80.0
"""Panels of Gauss-Legendre quadrature, nodes of each, and where it ends: there exp(-s/2) is 4e-18."""

Q_CONSTANT = np.log(2.0) - np.euler_gamma + 0.5
"""0.6159315 of Carson's Q. [1]"""


def carson(
    omega_rad_s: float, resistivity_ohm_m: float, heights_m: ArrayLike, across_m: ArrayLike
) -> Complex:
    r"""Correction of the impedance between two wires, or of one, above a conducting earth. [Ω/m]

    .. math:: \Delta Z = \frac{j\omega\mu_0}{\pi} \int_0^\infty
              \frac{e^{-(h_i + h_j)\lambda} \cos x\lambda}
                   {\lambda + \sqrt{\lambda^2 + j\omega\mu_0/\rho}} \, d\lambda

    Parameters
    ----------
    omega_rad_s : float
        Angular frequency, more than 0. [rad/s]
    resistivity_ohm_m : float
        Of the earth, the same at all depths. [Ω m]
    heights_m : array
        Sum of both heights above ground; twice that of a single wire. [m]
    across_m : array
        Distance between both, measured across the line. [m]

    References
    ----------
    [Carson1926]_.
    """
    height, across = np.broadcast_arrays(np.asarray(heights_m, float), np.asarray(across_m, float))
    wave = np.sqrt(omega_rad_s * PERMEABILITY_H_PER_M / resistivity_ohm_m)
    k, angle = wave * np.hypot(height, across), np.arctan2(np.abs(across), height)
    correction = np.empty(k.shape, complex)
    near = k <= LAST_OF_SERIES
    correction[near] = series(k[near], angle[near])
    correction[~near] = integral(k[~near], angle[~near])
    return np.asarray(omega_rad_s * PERMEABILITY_H_PER_M / np.pi * correction)


def series(k: ArrayLike, angle_rad: ArrayLike) -> Complex:
    r"""P + jQ by Carson's series. [1]

    .. math:: P = \frac{\pi}{8} - b_1 k\cos\theta + b_2 [(c_2 - \ln k) k^2\cos 2\theta
                  + \theta k^2\sin 2\theta] + b_3 k^3\cos 3\theta - d_4 k^4\cos 4\theta - \dots

    .. math:: Q = \tfrac12 (0.6159315 - \ln k) + b_1 k\cos\theta - d_2 k^2\cos 2\theta
                  + b_3 k^3\cos 3\theta - b_4 [(c_4 - \ln k) k^4\cos 4\theta
                  + \theta k^4\sin 4\theta] + \dots

    The magnitude of b falls by i (i + 2) from one to the next but one; its sign is + for i = 1 to 4,
    - for 5 to 8 and so on.  A sign carried along by the recursion would be another one from i = 5 on.

    Parameters
    ----------
    k : array
        Distance to the image, by the earth's wave number. [1]
    angle_rad : array
        Angle between the vertical and the way to the image, 0 to π/2. [rad]

    References
    ----------
    [Carson1926]_; [Dommel1986]_, section 4.1, for any number of terms.
    """
    k, angle = np.asarray(k, float), np.asarray(angle_rad, float)
    p: Real = np.full(k.shape, np.pi / 8.0)
    q = (Q_CONSTANT - np.log(k)) / 2.0
    b, c = [np.nan, np.sqrt(2.0) / 6.0, 1.0 / 16.0], [np.nan, np.nan, Q_CONSTANT + 0.75]
    for i in range(1, TERMS + 1):
        if i > 2:
            b.append(b[i - 2] / (i * (i + 2)))
            c.append(c[i - 2] + 1.0 / i + 1.0 / (i + 2))
        signed = b[i] * (-1.0) ** ((i - 1) // 4)
        even = k**i * np.cos(i * angle)
        with_log = (c[i] - np.log(k)) * even + angle * k**i * np.sin(i * angle)
        without = np.pi / 4.0 * even
        p += signed * (-even, with_log, even, -without)[(i - 1) % 4]
        q += signed * (even, -without, even, -with_log)[(i - 1) % 4]
    return np.asarray(p + 1j * q)


def integral(k: ArrayLike, angle_rad: ArrayLike) -> Complex:
    r"""P + jQ by Carson's integral, for k of 1 and more. [1]

    .. math:: P + jQ = \frac{j}{2} [F(k e^{j\theta}) + F(k e^{-j\theta})], \qquad
              F(p) = \int_0^\infty \frac{e^{-p\lambda}}{\lambda + \sqrt{\lambda^2 + j}} \, d\lambda

    Each half is taken along :math:`\lambda = s e^{\mp j\theta/3} / k`, which no branch point bars: there
    the exponential falls as :math:`e^{-s\cos(2\theta/3)}`, where along the real axis it would oscillate
    for ever once conductors are much farther apart than they are high.

    Parameters
    ----------
    k, angle_rad : array
        As of `series`.

    References
    ----------
    [Carson1926]_.
    """
    k, angle = np.asarray(k, float)[..., None], np.asarray(angle_rad, float)[..., None]
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    width = FARTHEST / PANELS
    s = (width * (np.arange(PANELS)[:, None] + (nodes + 1.0) / 2.0)).ravel()
    weight = np.tile(width / 2.0 * weights, PANELS)
    both = np.zeros(np.broadcast_shapes(k.shape, angle.shape)[:-1], complex)
    for sign in (1.0, -1.0):
        turned = np.exp(-1j * sign * angle / 3.0) / k
        way = s * turned
        decay = np.exp(-k * np.exp(1j * sign * angle) * way)
        both += (turned * weight * decay / (way + np.sqrt(way**2 + 1j))).sum(axis=-1)
    return np.asarray(0.5j * both)
